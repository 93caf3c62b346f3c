"""Segments of one block on the large domains around it, and how far segments are apart at least.

The rows are those of domain_segments.py, with the domain in place of the piece. Distances are bounds: a
corner counts as its whole circle, or as all places within D of it if it is blunt.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, real
from udec_ia.kernels.detect.contact_search import box, has_contact
from udec_ia.kernels.geometry.contact_geometry import is_blunt
from udec_ia.kernels.geometry.point_distance import distance_from_segment
from udec_ia.kernels.links.linked_lists import idomp, is_corner, next_corner, nextcp
from udec_ia.kernels.map.domain_segments import ARC, BLOCK, CORNER, PIECE, add_arc, add_segment, is_on_arc
from udec_ia.layout import offsets as g

DOMAIN = PIECE  # of a segment of one block: this column has its domain


@kernel
def items_of(h: Memory, ib: int) -> int:
    """Number of corners and contacts of block `ib`."""
    ip = iget(h, ib, g.KP)
    n, item = 1, nextcp(h, ib, ip)
    while item != ip:
        n += 1
        item = nextcp(h, ib, item)
    return n


@kernel
def _if_large(h: Memory, idm: int) -> int:
    """Domain `idm` if it is large, else 0."""
    return int64(idm) if iget(h, idm, g.KDLRG) != 0 else int64(0)


@kernel
def collect_block(h: Memory, ib: int, seg: Any, n: int) -> int:
    """Enter the segments of block `ib` on large domains in `seg` from row `n` on; returns the next row.

    The rows are those of domain_segments.py, with the domain in place of the piece. Virtual contacts, which
    have no place, do not divide a segment.
    """
    start = iget(h, ib, g.KP)
    idm = _if_large(h, idomp(h, ib, start))
    item, last, arc = int64(start), int64(start), False
    corner = next_corner(h, ib, start)
    if idm != 0:
        n = add_segment(seg, n, ib, corner, 0, start, idm)
    while True:
        item = nextcp(h, ib, item)
        if is_corner(h, item):
            if idm != 0 and not arc:
                n = add_arc(h, seg, n, ib, item, last, idm)
            if item == start:
                return n
            corner, arc, last = next_corner(h, ib, item), False, item
            if idm != 0:
                n = add_segment(seg, n, ib, corner, 0, item, idm)
        elif iget(h, item, g.KCCOD) != g.VIRTUAL:
            on_arc = is_on_arc(h, ib, item)
            if idm != 0 and on_arc and not arc:
                n = add_arc(h, seg, n, ib, corner, last, idm)
            idm = _if_large(h, iget(h, item, g.KD2) if iget(h, item, g.KB1) == ib else iget(h, item, g.KD1))
            arc, last = on_arc, item
            if idm != 0 and arc:
                n = add_arc(h, seg, n, ib, corner, item, idm)
            elif idm != 0:
                n = add_segment(seg, n, ib, corner, 0, item, idm)


@kernel
def _arc_from_edge(h: Memory, ip: int, iq: int) -> float:
    """A distance that the arc of corner `ip` is not nearer than to the edge that ends at corner `iq`."""
    ia = iget(h, iq, g.KR)
    ax, ay = np.float64(getr(h, ia, g.KXP)), np.float64(getr(h, ia, g.KYP))
    bx, by = np.float64(getr(h, iq, g.KXP)), np.float64(getr(h, iq, g.KYP))
    if is_blunt(h, ip):  # its circle reaches far beyond the arc, which is within D of the corner
        x, y, within = (
            np.float64(getr(h, ip, g.KXP)),
            np.float64(getr(h, ip, g.KYP)),
            np.float64(h.cr[g.DTOL]),
        )
    else:
        x, y = np.float64(getr(h, ip, g.KXCP)), np.float64(getr(h, ip, g.KYCP))
        within = np.float64(getr(h, ip, g.KRAD))
    return distance_from_segment(x, y, ax, ay, bx, by) - within


@kernel
def _arc_from_arc(h: Memory, ip: int, iq: int) -> float:
    """The same of the arcs of corners `ip` and `iq`."""
    dx = np.float64(getr(h, iq, g.KXP)) - np.float64(getr(h, ip, g.KXP))
    dy = np.float64(getr(h, iq, g.KYP)) - np.float64(getr(h, ip, g.KYP))
    by_corners = np.sqrt(dx * dx + dy * dy) - 2.0 * np.float64(h.cr[g.DTOL])
    dx = np.float64(getr(h, iq, g.KXCP)) - np.float64(getr(h, ip, g.KXCP))
    dy = np.float64(getr(h, iq, g.KYCP)) - np.float64(getr(h, ip, g.KYCP))
    radii = np.float64(getr(h, ip, g.KRAD)) + np.float64(getr(h, iq, g.KRAD))
    return max(by_corners, np.sqrt(dx * dx + dy * dy) - radii)


@inlined
def gap_bound(h: Memory, seg: Any, i: int, j: int) -> float:
    """A distance below which segments `i` and `j` are not apart; infinite if they cannot meet."""
    arcs = seg[i, ARC] + seg[j, ARC]
    if arcs == 0 or seg[i, DOMAIN] != seg[j, DOMAIN]:
        return np.inf
    if arcs == 2:
        return _arc_from_arc(h, seg[i, CORNER], seg[j, CORNER])
    if seg[i, ARC] == 1:
        return _arc_from_edge(h, seg[i, CORNER], seg[j, CORNER])
    return _arc_from_edge(h, seg[j, CORNER], seg[i, CORNER])


@inlined
def is_near(h: Memory, seg: Any, i: int, outline: Any, reach: float) -> bool:
    """True if the box of segment `i` is nearer than `reach` to the box `outline`, in x and in y."""
    ax, ay, bx, by = box(h, seg, i, real(h, 0.0))
    return bool(
        ax - outline[2] < reach
        and outline[0] - bx < reach
        and ay - outline[3] < reach
        and outline[1] - by < reach
    )


@kernel
def collect_near(h: Memory, ib: int, seg: Any, n: int, outline: Any, reach: float) -> int:
    """As _collect_block, but only segments near the box `outline`."""
    m = collect_block(h, ib, seg, n)
    last = n
    for i in range(n, m):
        if is_near(h, seg, i, outline, reach):
            seg[last] = seg[i]
            last += 1
    return last


@inlined
def have_contact(h: Memory, seg: Any, i: int, j: int) -> bool:
    """True if segments `i` and `j`, one of which is an arc, have a contact with each other."""
    if seg[i, ARC] == 1:
        return has_contact(h, seg[i, BLOCK], seg[i, CORNER], seg[j, CORNER], seg[j, ARC])
    return has_contact(h, seg[j, BLOCK], seg[j, CORNER], seg[i, CORNER], seg[i, ARC])
