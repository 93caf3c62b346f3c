"""Search for contacts in large domains, block by block.

The domain around many loose blocks has thousands of segments. To search all of them whenever two have come
nearer (update.py) would cost as much for each contact as for all blocks together. So if a domain has more
than MANY pieces (KDLRG), each of its blocks searches its own neighbourhood, and only when it may have come
near to others:

    KBROOM  what is left of the displacement, in x or in y, after which a block searches

For any two blocks a and b without a contact between segments that are a distance s apart, the sum of both
is never more than s/sqrt(2), the displacement with which they may touch, or ETOL if that is more, as in a
small domain. The pass that moves a block reduces its KBROOM; a block that would use it up in one more step
searches: it makes all contacts that it needs, and shares what is left with its neighbours anew. Blocks
farther away than 2 RMAX need no attention, as no KBROOM is more than RMAX. So a block in free flight seldom
searches, and one at rest never.

A contact that is deleted opens a domain to the blocks around another one: those search at once (bridge.py).
If a step is longer than ETOL the whole domain is searched as well, as if it were small.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.errors import OVERLAP_TOO_GREAT
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, puti, real
from udec_ia.heap.find_lose import room_for_two
from udec_ia.kernels.detect.block_segments import (
    DOMAIN,
    collect_block,
    collect_near,
    gap_bound,
    have_contact,
    is_near,
    items_of,
)
from udec_ia.kernels.detect.contact_search import STRAY, contact_needed, precedes
from udec_ia.kernels.geometry.block_grid import box_gap, enter_circle, enter_outline, make_grid, neighbours
from udec_ia.kernels.links.linked_lists import flag_for_search, is_contact, nextcp, request_search
from udec_ia.kernels.links.longer_groups import contact_words, domain_words
from udec_ia.kernels.map.contact_reclassification import settle
from udec_ia.kernels.map.domain_pieces import (
    FIRST_IS_SMALLER,
    SECOND_IS_SMALLER,
    compare_pieces,
    cut_piece,
    join_pieces,
)
from udec_ia.kernels.map.domain_segments import ARC, BLOCK, COLUMNS, CORNER, ITEM
from udec_ia.layout import offsets as g

MANY, FEW = 64, 32  # virtual contacts above which a domain becomes large; in all, below which none is large
PARTS, ON_NONE = 30000, 32767  # KBROOM of RMAX; KBROOM of a block that is on no large domain
PART_OF_BLOCK, TIMES_ETOL = 0.25, 100.0  # RMAX by the mean size of the blocks, and at most by ETOL
FAR_APART = 0.2  # of 2 RMAX


@inlined
def begin_large(h: Memory, idm: int) -> None:
    """Domain `idm` is large from now on; search_due_blocks finds RMAX, and lets all blocks search."""
    puti(h, idm, g.KDLRG, 1)
    h.ci[g.LLARGE] = h.ci[g.NDUE] = 1
    h.cr[g.RMAX] = real(h, 0.0)


@kernel
def _begin_rooms(h: Memory) -> None:
    """Set RMAX; all blocks are to search."""
    h.cr[g.RMAX] = min(_mean_size(h) * real(h, PART_OF_BLOCK), h.cr[g.ETOL] * real(h, TIMES_ETOL))
    ib = h.ci[g.IBPNT]
    while ib != 0:
        request_search(h, ib)
        ib = iget(h, ib, g.KB)


@kernel
def _mean_size(h: Memory) -> float:
    """Harmonic mean of the sizes of all blocks, so that a few large ones count little."""
    total = real(h, 0.0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        total += real(h, 0.5) / getr(h, ib, g.KBRO)
        ib = iget(h, ib, g.KB)
    return real(h, h.ci[g.NBLK]) / total


@kernel
def _end_large(h: Memory) -> None:
    """There are few virtual contacts left: no domain is large any more, and those that were are updated."""
    h.ci[g.LLARGE] = h.ci[g.NDUE] = 0
    idm = h.ci[g.IDPNT]
    while idm != 0:
        if iget(h, idm, g.KDLRG) != 0:
            puti(h, idm, g.KDLRG, 0)
            if getr(h, idm, g.KUMAX) < h.cr[g.ETOL] + h.cr[g.ETOL]:  # else it is flagged
                flag_for_search(h, idm)
        idm = iget(h, idm, g.KD)


@inlined
def use_room(h: Memory, ib: int, fastest: float) -> None:
    """Block `ib` has moved, with at most the velocity `fastest`; it searches if the next step is too much."""
    left = iget(h, ib, g.KBROOM)
    if left != ON_NONE:
        parts = fastest * h.cr[g.TDEL] / h.cr[g.RMAX] * real(h, PARTS)
        step = int64(min(parts, real(h, PARTS))) + (1 if parts > 0 else 0)
        left -= step
        if left < step:
            request_search(h, ib)
        else:
            puti(h, ib, g.KBROOM, left)


@kernel
def _settle_contacts(h: Memory, ib: int) -> None:
    """Update places and codes of the contacts of block `ib`, which has moved since the last contact pass."""
    contacts = np.empty(items_of(h, ib), np.int64)
    n, ip = 0, iget(h, ib, g.KP)
    item = nextcp(h, ib, ip)
    while item != ip:
        if is_contact(h, item) and iget(h, item, g.KCCOD) != g.VIRTUAL:
            contacts[n] = item
            n += 1
        item = nextcp(h, ib, item)
    for ic in contacts[:n]:
        settle(h, ic)


@kernel
def _segments(h: Memory, grid: Any, k: int, rows: Any) -> Any:
    """Space for the segments of the block in row `k` of the grid and of one of those in `rows`."""
    longest = 0
    for row in rows:
        longest = max(longest, items_of(h, grid.blocks[row]))
    return np.empty((2 * (longest + items_of(h, grid.blocks[k])) + 4, COLUMNS), np.int64)


@kernel
def _measure(h: Memory, grid: Any, k: int, rows: Any, apart: Any) -> bool:
    """Fill `apart` with the distances of the block in row `k` of the grid from those in `rows`.

    They are those of segments without a contact with each other, infinite if no large domain has segments of
    both. Where boxes are FAR_APART no segments are compared. False if the block is on no large domain.
    """
    seg = _segments(h, grid, k, rows)
    n = collect_block(h, grid.blocks[k], seg, 0)
    near = np.float64(h.cr[g.ATOL]) * 2.0
    for f in range(len(rows)):
        row = rows[f]
        apart[f] = np.inf
        if row == k or n == 0:
            continue
        gap = box_gap(grid.box[k], grid.box[row])
        if gap > grid.reach * FAR_APART:
            apart[f] = gap * np.sqrt(2.0)
            continue
        m = collect_near(h, grid.blocks[row], seg, n, grid.box[k], grid.reach)
        for i in range(n):
            if m == n or not is_near(h, seg, i, grid.box[row], grid.reach):
                continue
            for j in range(n, m):
                distance = gap_bound(h, seg, i, j)
                if distance < apart[f] and not (distance < near and have_contact(h, seg, i, j)):
                    apart[f] = distance
    return n > 0


@kernel
def _find_urgent(h: Memory, grid: Any, k: int, rows: Any, best: Any) -> int:
    """Code of the most urgent contact between the block in row `k` and those in `rows`; 0 for none.

    best: (2, COLUMNS), gets the rows of its two segments.
    """
    code, highest = 0, real(h, 0.0)
    h.ci[g.NTIPS] = 0
    seg = _segments(h, grid, k, rows)
    n = collect_block(h, grid.blocks[k], seg, 0)
    for row in rows:
        m = collect_near(h, grid.blocks[row], seg, n, grid.box[k], grid.reach)
        for i in range(n):
            for j in range(n, m):
                if gap_bound(h, seg, i, j) > h.cr[g.ATOL]:
                    continue
                needed, urgent = contact_needed(h, seg, i, j)
                if precedes(needed, urgent, code, highest):
                    code, highest = needed, urgent
                    best[0], best[1] = seg[i], seg[j]
    return code


@kernel
def _make_contact(h: Memory, one: Any, two: Any, code: int, grid: Any) -> bool:
    """Make a contact of that code between the segments `one` and `two`. False if memory ran out."""
    ib, iad, jb, jad = one[BLOCK], one[ITEM], two[BLOCK], two[ITEM]
    which = compare_pieces(h, ib, iad, jb, jad)
    if which in (FIRST_IS_SMALLER, SECOND_IS_SMALLER):
        join_pieces(h, ib, iad, jb, jad, code, which)
        return True
    if not room_for_two(h, contact_words(h), domain_words(h)):
        return False
    cut_piece(h, ib, iad, jb, jad, code, one[DOMAIN], which, grid)
    return True


@kernel
def _make_contacts(h: Memory, grid: Any, k: int, rows: Any) -> bool:
    """Make all contacts that the block in row `k` needs with those in `rows`. False if memory ran out.

    Error 15 if it overlaps one of them where no contact can be made.
    """
    _settle_contacts(h, grid.blocks[k])
    for row in rows:
        _settle_contacts(h, grid.blocks[row])
    best = np.empty((2, COLUMNS), np.int64)
    while True:
        code = _find_urgent(h, grid, k, rows, best)
        if code == STRAY and h.ci[g.NERR] == 0:
            h.ci[g.NERR] = OVERLAP_TOO_GREAT
            h.ci[g.IERAD] = best[0, CORNER] if best[0, ARC] == 1 else best[1, CORNER]
        if code <= 0:
            return True
        if not _make_contact(h, best[0], best[1], code, grid):
            return False


@kernel
def _share_room(h: Memory, grid: Any, k: int, rows: Any, apart: Any) -> None:
    """Set KBROOM of the block in row `k`, and reduce that of its neighbours where both together need it."""
    left = PARTS
    for f in range(len(rows)):
        both = max(apart[f] / np.sqrt(2.0), np.float64(h.cr[g.ETOL])) / np.float64(h.cr[g.RMAX]) * PARTS
        if both >= PARTS + PARTS:
            continue
        jb, limit = grid.blocks[rows[f]], int(both)
        if iget(h, jb, g.KBROOM) > limit // 2:
            puti(h, jb, g.KBROOM, limit // 2)
        left = min(left, limit - iget(h, jb, g.KBROOM))
    if h.ci[g.NTIPS] > 0:  # a contact was refused: again in the next cycle in which the block moves
        left = 1
    puti(h, grid.blocks[k], g.KBROOM, left)


@kernel
def search_block(h: Memory, grid: Any, k: int) -> bool:
    """The block in row `k` of the grid makes the contacts that it needs. False if memory ran out."""
    rows = neighbours(h, grid, k)
    apart = np.empty(len(rows), np.float64)
    h.ci[g.NTIPS] = 0
    if not _measure(h, grid, k, rows, apart):
        puti(h, grid.blocks[k], g.KBROOM, ON_NONE)
        return True
    near = rows[apart <= h.cr[g.ATOL]]
    if len(near) > 0:
        made = h.ci[g.NMADE]
        if not _make_contacts(h, grid, k, near):
            return False
        if h.ci[g.NMADE] != made:
            _measure(h, grid, k, rows, apart)
    _share_room(h, grid, k, rows, apart)
    return True


@kernel
def _grid_of_all(h: Memory) -> Any:
    """The grid of all blocks that may be on large domains."""
    blocks = np.empty(h.ci[g.NBLK], np.int64)
    n, ib = 0, h.ci[g.IBPNT]
    while ib != 0:
        if iget(h, ib, g.KBROOM) != ON_NONE:
            blocks[n] = ib
            n += 1
        ib = iget(h, ib, g.KB)
    boxes = np.empty((n, 4), np.float64)
    reach = np.float64(h.cr[g.RMAX]) * 2.0
    cell = np.float64(_mean_size(h)) + reach
    for k in range(n):
        if iget(h, blocks[k], HEAD) == g.MRIG and np.float64(getr(h, blocks[k], g.KBRO)) < cell:
            enter_circle(h, blocks[k], boxes[k])  # quicker, as no corner is read
        else:
            enter_outline(h, blocks[k], boxes[k])
    return make_grid(h, blocks[:n], boxes, cell, reach)


@outlined
def search_due_blocks(h: Memory) -> bool:
    """All blocks that are to search do so. False if memory ran out; it can then be continued.

    If few virtual contacts are left, no domain is large any more.
    """
    if h.ci[g.NVIRT] < FEW:
        _end_large(h)
    elif h.cr[g.RMAX] == 0:
        _begin_rooms(h)
    while h.ci[g.NDUE] != 0:
        h.ci[g.NDUE] = 0
        grid = _grid_of_all(h)
        for k in range(len(grid.blocks)):
            if iget(h, grid.blocks[k], g.KBROOM) == 0 and not search_block(h, grid, k):
                h.ci[g.NDUE] = 1
                return False
    return True
