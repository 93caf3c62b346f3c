"""SPLIT: all blocks in the path of a line are split (SPLIT, TRUE; report 2.7).

The whole path is tested before anything is changed, so a line that one block refuses changes nothing. Then
the blocks are cut one by one, and last the domains at the ends of the cracks are updated: opposite corners of
halves get their contacts. If memory runs out, the line has cut nothing yet, or only its updates are left, so
it can be repeated.

The blocks in the path are found in a list of boxes (four reals and an address a block), which is kept outside
the heap while one split follows another. The boxes are contiguous in memory, so the thousandth line costs as
little per block as the first.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.compiling.non_inlined_calls import call_entry, entry
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, puti, real, size_of
from udec_ia.heap.find_lose import room
from udec_ia.kernels.body.mass_distribution import share_extension
from udec_ia.kernels.contact.map_changes import ALL, NONE_WAITING, change_map, update_geometry
from udec_ia.kernels.detect.update import updating
from udec_ia.kernels.geometry.block_shape import crad, zcs
from udec_ia.kernels.geometry.tolerances import set_rounding
from udec_ia.kernels.links.linked_lists import flag, flag_all, idomp, is_contact, is_corner, nextcp, prevcp
from udec_ia.kernels.links.longer_groups import (
    block_words,
    contact_words,
    corner_words,
    domain_words,
    gridpoint_words,
)
from udec_ia.kernels.split.line_crossing import AT, CORNER, OK, X, Y, first_cut, rounding_is_open, try_cuts
from udec_ia.kernels.split.share_zones import share_zones
from udec_ia.kernels.split.spli import corner_on_edge, spli
from udec_ia.kernels.split.split_conditions import (
    count_list,
    off_grid,
    on_grid,
    share_bounds,
    share_groups,
    share_strength,
)
from udec_ia.layout import offsets as g

DONE, NO_MEMORY, REFUSED_CLOSE, REFUSED_SHORT, NO_ROWS = 0, 1, 2, 3, 4
UPDATE, SETTLE, SHARE, ZONES = 0, 1, 2, 3  # what `cutting` returns


@kernel
def enter_box(h: Memory, ib: int, box: Any) -> None:
    """Fill `box` (x and y from, x and y to) for block `ib`."""
    ip0 = iget(h, ib, g.KP)
    x, y = getr(h, ip0, g.KXP), getr(h, ip0, g.KYP)
    ax, ay, bx, by = x, y, x, y
    ip = iget(h, ip0, g.KR)
    while ip != ip0:
        x, y = getr(h, ip, g.KXP), getr(h, ip, g.KYP)
        ax, ay, bx, by = min(ax, x), min(ay, y), max(bx, x), max(by, y)
        ip = iget(h, ip, g.KR)
    box[0], box[1], box[2], box[3] = ax, ay, bx, by


@kernel
def enter_boxes(h: Memory, boxes: Any, blocks: Any) -> int:
    """Fill `boxes` and `blocks` from the block list, the last block first; returns the number of blocks.

    New blocks are put at the head of the list, so the rows are in the order in which the blocks were made.
    They are cut in this order, whether the boxes were kept or are entered again.
    """
    row = h.ci[g.NBLK]
    ib = h.ci[g.IBPNT]
    while ib != 0:
        row -= 1
        enter_box(h, ib, boxes[row])
        blocks[row] = ib
        ib = iget(h, ib, g.KB)
    return h.ci[g.NBLK]


@inlined
def in_path(boxes: Any, k: int, line: Any, far: Any) -> bool:
    """True unless box `k` lies clear of the line, or on one side of it."""
    ax, ay, bx, by = boxes[k, 0], boxes[k, 1], boxes[k, 2], boxes[k, 3]
    if max(line[0], far[0]) < ax or min(line[0], far[0]) > bx:
        return False
    if max(line[1], far[1]) < ay or min(line[1], far[1]) > by:
        return False
    x, y = (ax + bx) / 2 - line[0], (ay + by) / 2 - line[1]
    return abs(y * line[2] - x * line[3]) <= (bx - ax) * abs(line[3]) + (by - ay) * abs(line[2])


@kernel
def path(
    h: Memory, boxes: Any, blocks: Any, n: int, line: Any, rows: Any, where: Any, which: Any
) -> tuple[int, int, int]:
    """Rows of the blocks that the line splits: status, their number and that of the cuts.

    When a block refuses, its address is returned instead of the number, the place in row 0 of `where`. With
    NO_ROWS a block has more crossings than `where` and `which` have rows.
    """
    far = (line[0] + line[2] * line[4], line[1] + line[3] * line[4])
    found, all_cuts = 0, 0
    for k in range(n):
        if not in_path(boxes, k, line, far):
            continue
        what, cuts = try_cuts(h, blocks[k], line, where, which)
        if what != OK:
            return REFUSED_CLOSE + what - 1, blocks[k], 0
        if cuts > 0:
            rows[found] = k
            found += 1
            all_cuts += cuts
    return DONE, found, all_cuts


@kernel
def _settle_crack(h: Memory, ic: int) -> None:
    """Put a crack contact on the arcs of both corners, or on the edge if one corner is not convex.

    At a concave corner the other edge may be touched as well: the update of its domains finds that.
    """
    first, second = getr(h, iget(h, ic, g.KCP1), g.KRAD) <= 0, getr(h, iget(h, ic, g.KCP2), g.KRAD) <= 0
    if first or second:
        puti(h, ic, g.KCCOD, g.EDGE_CORNER if first else g.CORNER_EDGE)
        flag(h, iget(h, ic, g.KD1))
        flag(h, iget(h, ic, g.KD2))
    update_geometry(h, ic)


@kernel
def _settle_around(h: Memory, ib: int, ip: int) -> None:
    """Update the contacts near the new corner `ip` of block `ib`.

    They are on its arc and on its two edges; contacts farther away do not change.
    """
    reach = h.cr[g.DTOL] * real(h, 3.0)
    x, y = getr(h, ip, g.KXP), getr(h, ip, g.KYP)
    for forwards in (True, False):
        item = nextcp(h, ib, ip) if forwards else prevcp(h, ib, ip)
        while not is_corner(h, item):
            following = nextcp(h, ib, item) if forwards else prevcp(h, ib, item)
            if iget(h, item, g.KCCOD) != g.VIRTUAL:
                if abs(getr(h, item, g.KXC) - x) + abs(getr(h, item, g.KYC) - y) > reach + reach:
                    break
                update_geometry(h, item)
            item = following


@kernel
def _shortest(h: Memory, ib: int) -> float:
    """Length of the shortest edge of block `ib`."""
    ip0 = iget(h, ib, g.KP)
    shortest, _, _ = zcs(h, ip0)
    ip = iget(h, ip0, g.KR)
    while ip != ip0:
        z, _, _ = zcs(h, ip)
        shortest = min(shortest, z)
        ip = iget(h, ip, g.KR)
    return shortest


@outlined
def share(h: Memory, ib: int, jb: int) -> bool:
    """Give block `jb`, cut from block `ib`, its share of extension, conditions and groups."""
    if iget(h, ib, HEAD) == g.MSDEF:
        share_extension(h, ib, jb)
    if h.ci[g.IBNPNT] != 0:
        share_bounds(h, ib, jb)
    if h.ci[g.IMBPNT] != 0:
        share_groups(h, ib, jb)
    if h.ci[g.IBRPNT] != 0:
        share_strength(h, ib, jb)
    return True


def cutting(h: Memory, soft: Any, zoned: bool = False) -> tuple[Any, ...]:
    """Addresses of kernels that `cut_path` calls (compiling.non_inlined_calls), 0 for those not needed.

    soft: None if all blocks are rigid, free of boundary conditions, in no group and not breakable. zoned: the
    block that is cut has zones, and the cut runs along their sides.
    """
    return (
        updating(h),
        entry(change_map, h, NONE_WAITING, ALL, False),
        entry(share, h, 0, 0) if soft is not None else 0,
        entry(share_zones, h, 0, 0) if zoned else 0,
    )


@kernel
def _is_before(h: Memory, ip: int, x: float, y: float) -> bool:
    """True if (x, y), on one of the edges beside corner `ip`, lies on the edge that ends there."""
    ia = iget(h, ip, g.KR)
    ux, uy = getr(h, ip, g.KXP) - getr(h, ia, g.KXP), getr(h, ip, g.KYP) - getr(h, ia, g.KYP)
    return (x - getr(h, ip, g.KXP)) * ux + (y - getr(h, ip, g.KYP)) * uy < 0


@kernel
def cut_block(
    h: Memory, ib: int, where: Any, which: Any, k: int, bends: Any, joints: Any, passes: Any
) -> int:
    """Split block `ib` between rows `k` and `k` + 1 of its crossings; returns the new block.

    bends, joints: see spli. passes: see cutting.
    """
    ia, iz = which[k, CORNER], which[k + 1, CORNER]
    if which[k, AT] == 0:
        edge, ia = ia, corner_on_edge(h, ib, ia, where[k, X], where[k, Y])
        if which[k + 1, AT] == 0 and iz == edge and _is_before(h, ia, where[k + 1, X], where[k + 1, Y]):
            iz = ia
    if which[k + 1, AT] == 0:
        iz = corner_on_edge(h, ib, iz, where[k + 1, X], where[k + 1, Y])
    jb = spli(h, ib, ia, iz, bends, joints)
    if passes[ZONES] != 0:
        call_entry(passes[ZONES], h, ib, jb)
    if passes[SHARE] != 0:
        call_entry(passes[SHARE], h, ib, jb)
    if rounding_is_open(h):
        shortest = min(_shortest(h, ib), _shortest(h, jb))
        if shortest < h.cr[g.DTOL] * real(h, 4.0):
            set_rounding(h, shortest * real(h, 0.125))
    strained = h.ci[g.MCTOT] > 0 and iget(h, ib, HEAD) != g.MRIG  # then corners keep the radius they have
    crad(h, ib, strained)
    crad(h, jb, strained)
    last = iget(h, iget(h, jb, g.KP), g.KR)
    _settle_crack(h, iget(h, last, g.KL))
    _settle_crack(h, iget(h, _start_of_crack(h, jb, len(joints)), g.KLB))
    for b in (ib, jb):
        _settle_around(h, b, iget(h, b, g.KP))
        _settle_around(h, b, _start_of_crack(h, b, len(joints)))
    return jb


@kernel
def _start_of_crack(h: Memory, ib: int, edges: int) -> int:
    """The corner of a new part from which so many edges of the crack run to the corner in KP."""
    ip = iget(h, ib, g.KP)
    for _ in range(edges):
        ip = iget(h, ip, g.KR)
    return ip


@kernel
def update_cracks(h: Memory, blocks: Any, first: int, n: int, update: Any) -> bool:
    """Update the flagged domains around the new blocks in rows `first` to `n`. False if memory ran out.

    Every domain beside a block follows a contact of it that is not virtual, as the crack's two are not. An
    update may move virtual ones to other blocks, so none of them is stored.
    """
    broken = h.ci[g.NBROKE]
    for k in range(first, n):
        ib = blocks[k]
        ip = iget(h, ib, g.KP)
        item = iget(h, ip, g.KL)
        while item != ip:
            if is_contact(h, item) and iget(h, item, g.KCCOD) != g.VIRTUAL:
                idm = idomp(h, ib, item)
                if getr(h, idm, g.KUMAX) > h.cr[g.ETOL] and not call_entry(update, h, idm):
                    return False
                if h.ci[g.NBROKE] != broken:
                    return call_entry(update, h, int64(0))  # the present contact may not exist any more
            item = nextcp(h, ib, item)
    return True


@kernel
def words_of_cut(h: Memory, bends: int) -> int:
    """Words that a cut with so many bends may need."""
    need = block_words(h) + (4 + 2 * bends) * corner_words(h)
    need += (6 + 4 * bends) * contact_words(h) + (5 + 4 * bends) * domain_words(h)
    if h.ci[g.NSOFT] != 0 or h.ci[g.IBNPNT] != 0:
        need += size_of(h, g.NVSD) + off_grid(h) * size_of(h, g.NVBN)
    if h.ci[g.NSOFT] != 0:  # grid-points of a cut along zone sides
        need += size_of(h, g.NVFD) + (2 + bends) * gridpoint_words(h) + on_grid(h) * size_of(h, g.NVBN)
        need += count_list(h, h.ci[g.ISMPNT], g.KQ) * size_of(h, g.NVSM)
    if h.ci[g.IMBPNT] != 0:
        need += count_list(h, h.ci[g.IMBPNT], g.KI) * size_of(h, g.NVMB)
    if h.ci[g.IBRPNT] != 0:
        need += count_list(h, h.ci[g.IBRPNT], g.KBKN) * size_of(h, g.NVBK)
    return need


@kernel
def update_after_cuts(
    h: Memory, blocks: Any, first: int, n: int, rounding_length: float, passes: Any
) -> bool:
    """Update the domains around the new blocks in rows `first` to `n`, or all if the rounding length changed.

    rounding_length: that before the cuts. False if memory ran out.
    """
    if h.cr[g.DTOL] == rounding_length:
        return update_cracks(h, blocks, first, n, passes[UPDATE])
    call_entry(passes[SETTLE], h, np.empty(0, np.int64), int64(ALL), False)
    flag_all(h)
    return call_entry(passes[UPDATE], h, int64(0))


@kernel
def cut_path(
    h: Memory,
    boxes: Any,
    blocks: Any,
    n: int,
    line: Any,
    rows: Any,
    found: int,
    cuts: int,
    where: Any,
    which: Any,
    bends: Any,
    joints: Any,
    passes: Any,
) -> tuple[int, int]:
    """Split the blocks in the given rows by so many cuts and update the domains at the cracks' ends.

    `boxes` and `blocks` have a row for each new block. No part of a block has more crossings than the block,
    so the rows of `where` and `which` for `path` suffice. bends, joints: see spli; a line has no bends.
    passes: see cutting. Returns the status and the new number of boxes.
    """
    first = n
    rounding_length = h.cr[g.DTOL]
    if not room(h, cuts * words_of_cut(h, 0) + h.ci[g.NSPARE]):  # for the whole line: no cut is interrupted
        return NO_MEMORY, n
    for r in range(found):
        row, following = rows[r], n
        while True:
            k = first_cut(h, blocks[row], line, where, which)
            if k < 0:
                if following == n:
                    break
                row = following  # a new block may be crossed once more
                following += 1
                continue
            blocks[n] = cut_block(h, blocks[row], where, which, k, bends, joints, passes)
            enter_box(h, blocks[row], boxes[row])
            enter_box(h, blocks[n], boxes[n])
            n += 1
    updated = update_after_cuts(h, blocks, first, n, rounding_length, passes)
    return (DONE if updated else NO_MEMORY), n
