"""Open contacts whose gap a third block occupies.

A contact stays in the map while it is open by less than BTOL, and separates its two domains like a wall. A
narrow or fast block can pass through the wall. It is then near a block in another domain, and would never get
a contact with it. So a contact with another block in its gap is not allowed: none is formed there, and an
existing one is given up, which merges its two domains.

A block that enters a gap slowly has a contact with one of the two blocks, since a gap is narrower than 2
ATOL. In the lists it is next to the contact, which is compared with these neighbours each time a part of a
domain has moved by HTOL, a 280th of the rounding length (map_changes.py, domain_pass.py). The update searches
for blocks that entered within one step (update.py).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.kernels.detect.passage_through_block import (
    arc_point,
    place_moved_with,
    previous_place,
    swept_boxes,
)
from udec_ia.kernels.detect.point_depth import depth_in
from udec_ia.kernels.geometry.box_sweep import ABOVE, BELOW, LEFT, RIGHT, overlapping_boxes
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, next_corner, nextcp, other, prevcp
from udec_ia.kernels.map.bridge import delc, nextd, to_virtual
from udec_ia.kernels.map.domain_segments import ARC, BLOCK, CORNER, loop_start
from udec_ia.layout import offsets as g

BESIDE = 3  # items of a list that are searched for a neighbour: there may be a corner between


@kernel
def _crosses(ax: float, ay: float, bx: float, by: float, nx: float, ny: float, half: float) -> bool:
    """True if the segment ab crosses the one from minus to plus `half` along the unit vector (nx, ny)."""
    a, b = nx * ay - ny * ax, nx * by - ny * bx
    if (a > 0) == (b > 0):
        return False
    return abs((nx * ax + ny * ay) * b - (nx * bx + ny * by) * a) < half * abs(b - a)


@kernel
def _edge_crosses_gap(h: Memory, ip: int, x: float, y: float, nx: float, ny: float, half: float) -> bool:
    """True if the straight part of the edge that ends at corner `ip` crosses a gap."""
    ia = iget(h, ip, g.KR)
    ax, ay = getr(h, ia, g.KXP) - x, getr(h, ia, g.KYP) - y
    ux, uy = getr(h, ip, g.KXP) - x - ax, getr(h, ip, g.KYP) - y - ay
    part = h.cr[g.DTOL] / np.sqrt(ux * ux + uy * uy)  # of the edge, that its rounding takes at either end
    first = part if getr(h, ia, g.KRAD) > 0 else real(h, 0.0)
    last = real(h, 1.0) - (part if getr(h, ip, g.KRAD) > 0 else real(h, 0.0))
    return _crosses(ax + ux * first, ay + uy * first, ax + ux * last, ay + uy * last, nx, ny, half)


@kernel
def _arc_crosses_gap(h: Memory, ip: int, x: float, y: float, nx: float, ny: float, half: float) -> bool:
    """True if a gap crosses the circle under the arc of corner `ip`, or one that fits under it in the middle.

    The circle of a blunt corner reaches beyond its block; one as wide as the widest gap does not.
    """
    rad = getr(h, ip, g.KRAD)
    if rad <= 0:
        return False
    r = min(rad, h.cr[g.BTOL] * real(h, 0.5))
    dx, dy = getr(h, ip, g.KXCP) - x, getr(h, ip, g.KYCP) - y
    if r < rad:
        px, py = arc_point(h, ip, 0)
        shift = real(h, 1.0) - r / rad
        dx, dy = dx + (px - x - dx) * shift, dy + (py - y - dy) * shift
    out = max(abs(dx * nx + dy * ny) - half, real(h, 0.0))
    across = dx * ny - dy * nx
    return out * out + across * across < r * r


@inlined
def _lies_beside(h: Memory, ia: int, ip: int, iq: int, x: float, y: float, nx: float, ny: float) -> bool:
    """True if corner `ip`, with its circle and both edges, lies on one side of the line along a gap.

    Then it is not in the gap. ia, iq: the corners before and after.
    """
    a = nx * (getr(h, ia, g.KYP) - y) - ny * (getr(h, ia, g.KXP) - x)
    b = nx * (getr(h, ip, g.KYP) - y) - ny * (getr(h, ip, g.KXP) - x)
    c = nx * (getr(h, iq, g.KYP) - y) - ny * (getr(h, iq, g.KXP) - x)
    middle = nx * (getr(h, ip, g.KYCP) - y) - ny * (getr(h, ip, g.KXCP) - x)
    rad = getr(h, ip, g.KRAD)
    return min(min(a, b), min(c, middle - rad)) > 0 or max(max(a, b), max(c, middle + rad)) < 0


@inlined
def _lies_behind(h: Memory, ip: int, x: float, y: float) -> bool:
    """True if the point (x, y) lies on the side of the edge that ends at corner `ip` where its block is."""
    ia = iget(h, ip, g.KR)
    ax, ay = getr(h, ia, g.KXP), getr(h, ia, g.KYP)
    return bool((x - ax) * (getr(h, ip, g.KYP) - ay) > (y - ay) * (getr(h, ip, g.KXP) - ax))


@inlined
def _contains(h: Memory, ib: int, ip: int, iq: int, x: float, y: float) -> bool:
    """True if the point (x, y) is so deep in block `ib` that a segment there would overlap by FTOL.

    ip: a corner near it, iq: the next one, where the search begins.
    """
    if not _lies_behind(h, ip, x, y):
        return False
    if not (_lies_behind(h, iq, x, y) or _lies_behind(h, iget(h, ip, g.KR), x, y)):
        return False
    return bool(depth_in(h, ib, x, y, real(h, 0.0)) > h.cr[g.FTOL] * real(h, 0.5))


@kernel
def is_in_gap(h: Memory, ib: int, ip: int, x: float, y: float, nx: float, ny: float, half: float) -> bool:
    """True if corner `ip` of block `ib`, rounded, or an edge at it crosses a gap, or the block fills it.

    The gap has the width 2 `half` along the unit vector (nx, ny) and its middle at (x, y).
    """
    iq = next_corner(h, ib, ip)
    if not _lies_beside(h, iget(h, ip, g.KR), ip, iq, x, y, nx, ny) and (
        _arc_crosses_gap(h, ip, x, y, nx, ny, half)
        or _edge_crosses_gap(h, ip, x, y, nx, ny, half)
        or _edge_crosses_gap(h, iq, x, y, nx, ny, half)
    ):
        return True
    return _contains(h, ib, ip, iq, x, y)


@inlined
def nearest_contact(h: Memory, ib: int, iad: int, forwards: bool) -> int:
    """The first real contact of block `ib` at item `iad` or a little further on in its list; 0 for none."""
    item = int64(iad)
    for _ in range(BESIDE):
        if not is_corner(h, item) and iget(h, item, g.KCCOD) != g.VIRTUAL:
            return item
        item = nextcp(h, ib, item) if forwards else prevcp(h, ib, item)
    return int64(0)


@inlined
def _third_block(h: Memory, ib: int, jb: int, item: int) -> int:
    """The third block that contact `item` of block `ib` leads to; 0 if there is none."""
    if item == 0:
        return int64(0)
    kb = other(h, ib, item)
    return int64(0) if kb == jb else kb


@inlined
def _is_between(h: Memory, ib: int, jb: int, item: int, gap: Any) -> bool:
    """True if the third block that contact `item` of block `ib` leads to is between it and block `jb`.

    gap: the result of `meet` for the contact of `ib` and `jb`. If these overlap, the third block must reach
    into the overlap.
    """
    kb = _third_block(h, ib, jb, item)
    if kb == 0:
        return False
    nx, ny, overlap, x, y = gap
    if overlap < 0:
        return is_in_gap(h, kb, corner_of(h, kb, item), x, y, nx, ny, -overlap * real(h, 0.5))
    return depth_in(h, kb, x, y, real(h, 0.0)) > h.cr[g.FTOL]


@kernel
def third_block_between(h: Memory, ib: int, before: int, after: int, jb: int, gap: Any) -> bool:
    """True if a third block with a contact beside one place in the list of block `ib` is in the gap.

    before, after: the items at the place. jb, gap: as in _taken_by.
    """
    one, two = nearest_contact(h, ib, before, False), nearest_contact(h, ib, after, True)
    return _is_between(h, ib, jb, one, gap) or _is_between(h, ib, jb, two, gap)


@kernel
def gap_is_occupied(h: Memory, ic: int, gap: Any) -> bool:
    """True if a third block that has a contact beside contact `ic` is in its gap."""
    ib, jb = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    if third_block_between(h, ib, iget(h, ic, g.KLB1), iget(h, ic, g.KL1), jb, gap):
        return True
    return third_block_between(h, jb, iget(h, ic, g.KLB2), iget(h, ic, g.KL2), ib, gap)


@kernel
def _open_contacts(h: Memory, idm: int, found: Any) -> int:
    """Enter the open contacts around domain `idm` in `found`; returns their number."""
    start, first = loop_start(h, idm)
    item, block = start, first
    n = 0
    while True:
        item, block = nextd(h, item, block)
        if not is_corner(h, item) and iget(h, item, g.KCCOD) != g.VIRTUAL and getr(h, item, g.KCN) < 0:
            found[n] = item
            n += 1
        if item == start and block == first:
            return n


@kernel
def _has_crossed_gap(h: Memory, ib: int, ip: int, ic: int, gap: Any) -> bool:
    """True if the middle of the arc of corner `ip` has crossed the gap of contact `ic` in this step."""
    nx, ny, overlap, x, y = gap
    jp, jb = iget(h, ic, g.KCP1), iget(h, ic, g.KB1)
    px, py = arc_point(h, ip, 0)
    fx, fy = previous_place(h, ib, ip, px, py)
    fx, fy = place_moved_with(h, jb, jp, fx, fy)
    return _crosses(fx - x, fy - y, px - x, py - y, nx, ny, -overlap * real(h, 0.5))


@kernel
def delete_occupied_contact(h: Memory, idm: int, seg: Any, n: int) -> tuple[bool, int]:
    """Give up one contact around domain `idm` that has a third block in its gap, or over which it has jumped.

    Returns True if one was found, and the domain that replaces `idm`.
    """
    found = np.empty(n, np.int64)
    m = _open_contacts(h, idm, found)
    if m == 0:
        return False, int64(idm)
    boxes = swept_boxes(h, seg, n, m)
    half = h.cr[g.BTOL] * real(h, 0.5)
    for k in range(m):
        _, _, _, x, y, _ = meet(
            h, iget(h, found[k], g.KCCOD), iget(h, found[k], g.KCP1), iget(h, found[k], g.KCP2)
        )
        boxes[n + k, LEFT], boxes[n + k, RIGHT] = x - half, x + half
        boxes[n + k, BELOW], boxes[n + k, ABOVE] = y - half, y + half
    pairs = overlapping_boxes(boxes, n + m)
    for k in range(len(pairs)):
        i, j = min(pairs[k, 0], pairs[k, 1]), max(pairs[k, 0], pairs[k, 1]) - n
        if i >= n or j < 0 or seg[i, ARC] == 0:
            continue
        ic, kb, kp = found[j], seg[i, BLOCK], seg[i, CORNER]
        if kb == iget(h, ic, g.KB1) or kb == iget(h, ic, g.KB2):
            continue
        nx, ny, overlap, x, y, _ = meet(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
        gap = nx, ny, overlap, x, y
        if not overlap < 0:
            continue
        inside = is_in_gap(h, kb, kp, x, y, nx, ny, -overlap * real(h, 0.5))
        if inside or _has_crossed_gap(h, kb, kp, ic, gap):
            return True, delete_contact(h, idm, ic)
    return False, int64(idm)


@kernel
def delete_contact(h: Memory, idm: int, ic: int) -> int:
    """Delete contact `ic` around domain `idm`; returns the domain that replaces `idm`."""
    h.ci[g.NBROKE] += 1
    if iget(h, ic, g.KD1) == iget(h, ic, g.KD2):
        to_virtual(h, ic)
        return int64(idm)
    umax = getr(h, idm, g.KUMAX)
    merged = delc(h, ic)
    putr(h, merged, g.KUMAX, max(umax, getr(h, merged, g.KUMAX)))
    return merged
