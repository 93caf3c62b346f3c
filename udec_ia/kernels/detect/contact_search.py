"""Search for contacts: segments of a domain that are near enough (UPDT), and segments that overlap too much.

A contact is formed where two segments of different blocks come nearer than ATOL (report 2.2): an arc and an
edge, or two arcs. The arc must face the other segment; the far side of its block belongs to another domain.
Small domains test all pairs. In large ones, such as the outer domain or an open cavity, every segment is
entered in the grid cells that it covers, with a margin. Only segments with a common cell are tested, so the
cost grows with the length of the boundary and not with its square.

A contact is formed while its overlap is at most CTOL. The program detects every moving block that penetrates
deeper without a contact. If ROUND or CHANGE alters outlines, a corner that was free beside its neighbours may
lie deeper in one of them, and would never get a contact. Two blocks that overlap border on one domain, so
`deep_overlap` tests all segments that face each other in every domain.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, real
from udec_ia.kernels.detect.point_depth import AROUND, do_not_meet, would_cross
from udec_ia.kernels.detect.third_block_in_gap import third_block_between
from udec_ia.kernels.geometry.box_sweep import ABOVE, BELOW, LEFT, RIGHT, overlapping_boxes, stable_order
from udec_ia.kernels.geometry.contact_geometry import cc, ce, distance_past, faces, is_blunt, meet, over_ends
from udec_ia.kernels.links.linked_lists import corner_of, is_contact, nextcp, other, prevcp
from udec_ia.kernels.map.domain_segments import (
    ARC,
    BLOCK,
    COLUMNS,
    CORNER,
    ITEM,
    collect,
    count_items,
    distance_ahead,
    is_on_arc,
    next_not_virtual,
    not_virtual,
    same_segment,
)
from udec_ia.layout import offsets as g

FACING = 0.25  # angle by which a block, whose edges are at least 2 D long, may turn between two updates
STRAY = -1  # not a code: an overlap that can have no contact
SMALL = 48  # segments of a domain up to which all pairs are tested
CROWDED = 64  # pairs for each segment, from which on long edges enter by their exposed parts


@kernel
def _past(h: Memory, ip: int, iq: int, along: float, leaving: bool) -> float:
    """Distance of the centre of corner `ip` past corner `iq` along the edge that leaves or reaches it.

    If `iq` has an arc, the distance is past the arc. arc_on_arc tests the same number, so rounding cannot
    leave a gap between arc and edge. along: distance from `iq` along the edge to the touching point. It
    counts for a blunt corner, where this may be the end of its arc, up to GTOL before the end of the edge,
    where a contact leaves it (contact_reclassification.py). It also counts at a concave corner, from ETOL
    before it, since a blunt arc in a notch is deep in the edge at once. Two edges that meet in an edge point
    share the zone within FTOL of their bisector.
    """
    rad = getr(h, iq, g.KRAD)
    if rad > 0 and is_blunt(h, ip):
        return along - (h.cr[g.DTOL] - h.cr[g.GTOL])
    if rad > 0:
        dx, dy = getr(h, ip, g.KXCP) - getr(h, iq, g.KXCP), getr(h, ip, g.KYCP) - getr(h, iq, g.KYCP)
        ahead, behind = over_ends(h, iq, dx, dy)
        return ahead if leaving else behind
    if rad < 0:
        return along + h.cr[g.ETOL]
    way = distance_past(h, iq, ip)
    return (way if leaving else -way) + h.cr[g.FTOL]


@kernel
def arc_on_edge(h: Memory, ip: int, iq: int, limit: float) -> tuple[bool, float]:
    """Can the arc of corner `ip` and the edge that ends at `iq` have a contact of at most that overlap?

    Also returned: their overlap.
    """
    ex, ey, overlap, along, z = ce(h, ip, iq)
    if overlap < -h.cr[g.ATOL] or overlap > limit:
        return False, overlap
    if _past(h, ip, iget(h, iq, g.KR), along, True) < 0 or _past(h, ip, iq, z - along, False) < 0:
        return False, overlap
    return faces(h, ip, -ex, -ey, real(h, FACING)), overlap


@kernel
def arc_on_arc(h: Memory, ip: int, iq: int, limit: float) -> tuple[bool, float]:
    """Can the arcs of corners `ip` and `iq` have a contact of at most that overlap?

    Also returned: their overlap. Two points of edges, both without a radius, cannot: each of them touches the
    edges at the other.
    """
    dx, dy = getr(h, iq, g.KXCP) - getr(h, ip, g.KXCP), getr(h, iq, g.KYCP) - getr(h, ip, g.KYCP)
    radii = getr(h, ip, g.KRAD) + getr(h, iq, g.KRAD)
    reach = radii + h.cr[g.ATOL]
    if radii == 0 or dx * dx + dy * dy > reach * reach:
        return False, -reach
    _, _, overlap = cc(h, ip, iq)
    if overlap > limit:
        return False, overlap
    ahead1, behind1 = over_ends(h, ip, dx, dy)
    ahead2, behind2 = over_ends(h, iq, -dx, -dy)
    return max(max(ahead1, behind1), max(ahead2, behind2)) <= h.cr[g.GTOL], overlap


@kernel
def has_contact(h: Memory, ib: int, ip: int, jp: int, jarc: int) -> bool:
    """True if the arc of corner `ip` of block `ib` already has a contact with segment (jp, jarc)."""
    ic = prevcp(h, ib, ip)
    while is_contact(h, ic):
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            if not is_on_arc(h, ib, ic):
                return False
            jb = other(h, ib, ic)
            if corner_of(h, jb, ic) == jp and is_on_arc(h, jb, ic) == (jarc == 1):
                return True
        ic = prevcp(h, ib, ic)
    return False


@kernel
def _has_contact_near(h: Memory, ib: int, iad: int, jb: int, x: float, y: float) -> bool:
    """True if a contact with block `jb` near item `iad` of block `ib` lies within FTOL of (x, y)."""
    ahead, behind = nextcp(h, ib, iad), int64(iad)
    for _ in range(AROUND):
        for ic in (ahead, behind):
            if is_contact(h, ic) and other(h, ib, ic) == jb and iget(h, ic, g.KCCOD) != g.VIRTUAL:
                dx, dy = getr(h, ic, g.KXC) - x, getr(h, ic, g.KYC) - y
                if dx * dx + dy * dy < h.cr[g.FTOL] * h.cr[g.FTOL]:
                    return True
        ahead, behind = nextcp(h, ib, ahead), prevcp(h, ib, behind)
    return False


@inlined
def _distance_beyond(h: Memory, ib: int, ic: int, jb: int, way: float) -> float:
    """The distance `way` beyond contact `ic` of block `ib`, increased if that is also with block `jb`."""
    if other(h, ib, ic) == jb and way > h.cr[g.FTOL]:
        return way + h.cr[g.ETOL]
    return way


@kernel
def _distance_outside(
    h: Memory, ib: int, ip: int, arc: bool, iad: int, jb: int, x: float, y: float, nx: float, ny: float
) -> float:
    """Distance of a contact at (x, y) outside the exposure of a segment that follows item `iad`.

    (nx, ny): its normal, away from block `ib`. Two contacts with the same block `jb` are out of order only if
    a tip is inside another. A contact that is past the other one by more than FTOL counts as ETOL further
    outside.
    """
    worst = real(h, 0.0)
    before, after = not_virtual(h, ib, iad), next_not_virtual(h, ib, iad)
    if same_segment(h, before, ip, arc):
        way = distance_ahead(h, ip, arc, before, x, y, nx, ny)
        worst = max(worst, _distance_beyond(h, ib, before, jb, way))
    if same_segment(h, after, ip, arc):
        way = -distance_ahead(h, ip, arc, after, x, y, nx, ny)
        worst = max(worst, _distance_beyond(h, ib, after, jb, way))
    return worst


@kernel
def facing(h: Memory, seg: Any, i: int, j: int, limit: float) -> tuple[int, float]:
    """Code of the contact, of at most that overlap, that segments `i` and `j` can have, 0 for none.

    One of them at least is an arc. Also returned: their overlap.
    """
    ip, jp = seg[i, CORNER], seg[j, CORNER]
    if seg[i, ARC] + seg[j, ARC] == 2:
        code = g.CORNER_CORNER
        can, overlap = arc_on_arc(h, ip, jp, limit)
    elif seg[i, ARC] == 1:
        code = g.CORNER_EDGE
        can, overlap = arc_on_edge(h, ip, jp, limit)
    else:
        code = g.EDGE_CORNER
        can, overlap = arc_on_edge(h, jp, ip, limit)
    return (code if can else 0), overlap


@kernel
def _stray_or_none(h: Memory, ib: int, jb: int, overlap: float, x: float, y: float) -> int:
    """0, or STRAY if blocks `ib` and `jb` overlap by more than FTOL and have no contact near (x, y)."""
    if overlap <= h.cr[g.FTOL]:
        return 0
    near = h.cr[g.DTOL] + h.cr[g.FTOL] + overlap
    ip = iget(h, ib, g.KP)
    item = nextcp(h, ib, ip)
    while item != ip:
        if is_contact(h, item) and other(h, ib, item) == jb and iget(h, item, g.KCCOD) != g.VIRTUAL:
            dx, dy = getr(h, item, g.KXC) - x, getr(h, item, g.KYC) - y
            if dx * dx + dy * dy <= near * near:
                return 0
        item = nextcp(h, ib, item)
    return STRAY


@kernel
def _gap_is_occupied(h: Memory, seg: Any, i: int, j: int, gap: Any) -> bool:
    """True if a third block is in the gap of the contact that segments `i` and `j` would have."""
    ib, iad, jb, jad = seg[i, BLOCK], seg[i, ITEM], seg[j, BLOCK], seg[j, ITEM]
    return third_block_between(h, ib, iad, nextcp(h, ib, iad), jb, gap) or third_block_between(
        h, jb, jad, nextcp(h, jb, jad), ib, gap
    )


@kernel
def contact_needed(h: Memory, seg: Any, i: int, j: int) -> tuple[int, float]:
    """Code of the contact that segments `i` and `j` should have, 0 for none, and its urgency.

    STRAY if their blocks overlap there, and no contact can be made. The urgency is the overlap, less the
    distance outside the contact's place in the list. An open contact with a block in its gap, which would be
    given up at once, is not made but requested again.
    """
    zero = real(h, 0.0)
    ib, ip, iarc = seg[i, BLOCK], seg[i, CORNER], seg[i, ARC]
    jb, jp, jarc = seg[j, BLOCK], seg[j, CORNER], seg[j, ARC]
    if ib == jb or iarc + jarc == 0:
        return 0, zero
    code, overlap = facing(h, seg, i, j, h.cr[g.DTOL])
    if code == 0:
        return 0, zero
    if iarc == 1:
        had = has_contact(h, ib, ip, jp, jarc)
    else:
        had = has_contact(h, jb, jp, ip, iarc)
    if had:
        return 0, zero
    nx, ny, _, x, y, _ = meet(h, code, ip, jp)
    if _has_contact_near(h, ib, seg[i, ITEM], jb, x, y) or _has_contact_near(h, jb, seg[j, ITEM], ib, x, y):
        return 0, zero
    gap = nx, ny, overlap, x, y
    if overlap > h.cr[g.FTOL] and do_not_meet(h, ib, jb, gap):
        return 0, zero
    if overlap > h.cr[g.CTOL] or would_cross(h, ib, seg[i, ITEM], jb, seg[j, ITEM], x, y):
        return _stray_or_none(h, ib, jb, overlap, x, y), zero
    wrong = max(
        _distance_outside(h, ib, ip, iarc == 1, seg[i, ITEM], jb, x, y, nx, ny),
        _distance_outside(h, jb, jp, jarc == 1, seg[j, ITEM], ib, x, y, -nx, -ny),
    )
    if wrong > h.cr[g.ETOL]:
        return _stray_or_none(h, ib, jb, overlap, x, y), zero
    passed = wrong > h.cr[g.FTOL]
    if (passed and overlap <= 0) or _gap_is_occupied(h, seg, i, j, gap):
        h.ci[g.NTIPS] += 1
        return _stray_or_none(h, ib, jb, overlap, x, y), zero
    return code, overlap - wrong


@kernel
def _ends(h: Memory, seg: Any, i: int) -> tuple[float, float, float, float, float]:
    """Ends of segment `i`, x and y twice, and its radius: an arc ends where it begins, in its centre."""
    ip = seg[i, CORNER]
    if seg[i, ARC] == 1:
        x, y = getr(h, ip, g.KXCP), getr(h, ip, g.KYCP)
        return x, y, x, y, getr(h, ip, g.KRAD)
    ia = iget(h, ip, g.KR)
    return getr(h, ia, g.KXP), getr(h, ia, g.KYP), getr(h, ip, g.KXP), getr(h, ip, g.KYP), real(h, 0.0)


@inlined
def _box_around(ends: Any, margin: float) -> tuple[float, float, float, float]:
    """Box around `_ends`: lower x and y, upper x and y; extended by `margin` on all sides."""
    ax, ay, bx, by, radius = ends
    grow = radius + margin
    return min(ax, bx) - grow, min(ay, by) - grow, max(ax, bx) + grow, max(ay, by) + grow


@kernel
def box(h: Memory, seg: Any, i: int, margin: float) -> tuple[float, float, float, float]:
    """Box around segment `i`, as _box_around."""
    return _box_around(_ends(h, seg, i), margin)


@inlined
def precedes(code: int, urgent: float, best: int, highest: float) -> bool:
    """True if a contact of that code and urgency precedes the best one so far; STRAY is last."""
    if code > 0:
        return best <= 0 or urgent > highest
    return code == STRAY and best == 0


@kernel
def _search_pairs(h: Memory, seg: Any, n: int) -> tuple[int, int, int]:
    """The most urgent contact among all pairs of segments: code and the two rows; code 0 for none."""
    best, bi, bj = 0, 0, 0
    highest = real(h, 0.0)
    half = h.cr[g.ATOL] * real(h, 0.5)
    for i in range(n):
        ax, ay, bx, by = box(h, seg, i, half)
        for j in range(i + 1, n):
            if seg[i, ARC] + seg[j, ARC] == 0 or seg[i, BLOCK] == seg[j, BLOCK]:
                continue
            cx, cy, dx, dy = box(h, seg, j, half)
            if cx > bx or dx < ax or cy > by or dy < ay:
                continue
            code, urgent = contact_needed(h, seg, i, j)
            if precedes(code, urgent, best, highest):
                best, bi, bj, highest = code, i, j, urgent
    return best, bi, bj


@kernel
def _exposed_part(h: Memory, seg: Any, i: int, beyond: float) -> tuple[float, float, float, float, float]:
    """As _ends, for the part of an edge between the contacts around the exposure, and `beyond` on both sides.

    So a long edge with many exposures enters each cell only a few times.
    """
    ax, ay, bx, by, radius = _ends(h, seg, i)
    tx, ty = bx - ax, by - ay
    z = np.sqrt(tx * tx + ty * ty)
    if seg[i, ARC] == 1 or z == 0:
        return ax, ay, bx, by, radius
    ib, ip, start, end = seg[i, BLOCK], seg[i, CORNER], real(h, 0.0), z
    before, after = not_virtual(h, ib, seg[i, ITEM]), next_not_virtual(h, ib, seg[i, ITEM])
    tx, ty = tx / z, ty / z
    if same_segment(h, before, ip, False):
        start = (getr(h, before, g.KXC) - ax) * tx + (getr(h, before, g.KYC) - ay) * ty
    if same_segment(h, after, ip, False):
        end = (getr(h, after, g.KXC) - ax) * tx + (getr(h, after, g.KYC) - ay) * ty
    start, end = max(min(start, end) - beyond, real(h, 0.0)), min(max(start, end) + beyond, z)
    return ax + tx * start, ay + ty * start, ax + tx * end, ay + ty * end, radius


@kernel
def _mean_length(h: Memory, seg: Any, n: int, exposed: bool) -> float:
    """Mean extent of the segments. exposed: of their exposed parts."""
    total, zero, half = real(h, 0.0), real(h, 0.0), h.cr[g.ATOL] * real(h, 0.5)
    for i in range(n):
        ends = _exposed_part(h, seg, i, zero) if exposed else _ends(h, seg, i)
        ax, ay, bx, by = _box_around(ends, half)
        total += max(bx - ax, by - ay)
    return total / real(h, n)


@kernel
def _cells(h: Memory, seg: Any, n: int, cell: float, exposed: bool, key: Any, row: Any) -> int:
    """Enter every segment in the cells it covers; an edge piece by piece, so a long slant stays thin.

    exposed: only the exposed part, and a cell's length more. Returns the number of entries; with empty arrays
    it only counts them.
    """
    m = 0
    for i in range(n):
        ax, ay, bx, by, radius = _exposed_part(h, seg, i, cell) if exposed else _ends(h, seg, i)
        grow = radius + h.cr[g.ATOL] * real(h, 0.5)
        pieces = 1 + int(max(abs(bx - ax), abs(by - ay)) / cell)
        for k in range(pieces):
            px, py = ax + (bx - ax) * k / pieces, ay + (by - ay) * k / pieces
            qx, qy = ax + (bx - ax) * (k + 1) / pieces, ay + (by - ay) * (k + 1) / pieces
            for cx in range(
                int(np.floor((min(px, qx) - grow) / cell)), int(np.floor((max(px, qx) + grow) / cell)) + 1
            ):
                for cy in range(
                    int(np.floor((min(py, qy) - grow) / cell)), int(np.floor((max(py, qy) + grow) / cell)) + 1
                ):
                    if len(key) > 0:
                        key[m] = cx * 0x40000000 + cy
                        row[m] = i
                    m += 1
    return m


@kernel
def _sorted_cells(h: Memory, seg: Any, n: int, exposed: bool) -> tuple[Any, Any, int]:
    """Cells with the segments in them, sorted by cell, and the number of pairs that have a cell in common."""
    cell, nothing = _mean_length(h, seg, n, exposed), np.empty(0, np.int64)
    m = _cells(h, seg, n, cell, exposed, nothing, nothing)
    key, row = np.empty(m, np.int64), np.empty(m, np.int64)
    _cells(h, seg, n, cell, exposed, key, row)
    order = stable_order(key)
    key, row = key[order], row[order]
    pairs, first = 0, 0
    for k in range(m):
        if key[k] != key[first]:
            first = k
        pairs += k - first
    return key, row, pairs


@kernel
def _search_cells(h: Memory, seg: Any, n: int) -> tuple[int, int, int]:
    """As _search_pairs, for pairs with a common cell of a grid whose spacing is the mean edge length."""
    key, row, pairs = _sorted_cells(h, seg, n, False)
    if pairs > CROWDED * n:
        key, row, pairs = _sorted_cells(h, seg, n, True)
    best, bi, bj = 0, 0, 0
    highest = real(h, 0.0)
    first, m = 0, len(key)
    while first < m:
        last = first
        while last < m and key[last] == key[first]:
            last += 1
        for u in range(first, last):
            for v in range(u + 1, last):
                i, j = row[u], row[v]
                if seg[i, ARC] + seg[j, ARC] == 0 or seg[i, BLOCK] == seg[j, BLOCK]:
                    continue
                code, urgent = contact_needed(h, seg, i, j)
                if precedes(code, urgent, best, highest):
                    best, bi, bj, highest = code, i, j, urgent
        first = last
    return best, bi, bj


@kernel
def search(h: Memory, seg: Any, n: int) -> tuple[int, int, int]:
    """The most urgent contact that `n` segments of a domain need: code and two rows; code 0 for none.

    STRAY if no contact can be made any more, and two blocks overlap without one.
    """
    h.ci[g.NTIPS] = 0
    if n <= SMALL:
        return _search_pairs(h, seg, n)
    return _search_cells(h, seg, n)


@kernel
def _boxes(h: Memory, seg: Any, n: int, reach: float) -> Any:
    """Boxes around the segments, extended so that the boxes of two that overlap by up to `reach` meet."""
    boxes = np.empty((n, 4), np.float64)
    half = reach * real(h, 0.5)
    for i in range(n):
        boxes[i, LEFT], boxes[i, BELOW], boxes[i, RIGHT], boxes[i, ABOVE] = box(h, seg, i, half)
    return boxes


@kernel
def _deep_in_domain(h: Memory, idm: int, reach: float) -> tuple[int, int, float]:
    """deep_overlap for one domain, which has a loop."""
    items = count_items(h, idm)
    seg = np.empty((2 * items + 2, COLUMNS), np.int64)
    n, _ = collect(h, idm, seg, np.empty((min(h.ci[g.NVIRT], items), 3), np.int64))
    pairs = overlapping_boxes(_boxes(h, seg, n, reach), n)
    for k in range(len(pairs)):
        i, j = pairs[k, 0], pairs[k, 1]
        if seg[i, BLOCK] == seg[j, BLOCK] or seg[i, ARC] + seg[j, ARC] == 0:
            continue
        code, overlap = facing(h, seg, i, j, reach)
        if code != 0 and overlap > h.cr[g.CTOL]:
            return seg[i, CORNER], seg[j, CORNER], overlap
    return int64(0), int64(0), real(h, 0.0)


@kernel
def deep_overlap(h: Memory, reach: float) -> tuple[int, int, float]:
    """Corners of two segments that overlap by more than CTOL, up to `reach`, and the overlap; or zeros."""
    idm = h.ci[g.IDPNT]
    while idm != 0:
        if iget(h, idm, g.KDLOOP) != 0:  # 0: a lone block
            ip, iq, overlap = _deep_in_domain(h, idm, reach)
            if ip != 0:
                return ip, iq, overlap
        idm = iget(h, idm, g.KD)
    return int64(0), int64(0), real(h, 0.0)
