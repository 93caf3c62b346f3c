"""Boundary of a domain as a sequence of segments, corner arcs and edges (NEXTDS of the report).

A contact can arise only between two segments of the same domain (2.2). A walk around the loop collects a
segment for each exposed arc or edge: after a contact the segment on which it lies, then, at each corner, the
corner's arc and the next edge. The same arc or edge is collected once for every exposure that it has in the
domain.

A row of the array: block, corner, arc, item, piece.
  corner  the corner of the arc, or the corner where the edge ends
  arc     1 for an arc, 0 for an edge
  item    the item of the block's list before the exposure: a contact on it is put after this item
  piece   number of the piece; pieces of one loop are tied together by virtual contacts only
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.kernels.geometry.block_shape import is_edge_point
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, next_corner, nextcp, prevcp
from udec_ia.kernels.map.bridge import nextd
from udec_ia.kernels.map.contact_reclassification import settle
from udec_ia.layout import offsets as g

BLOCK, CORNER, ARC, ITEM, PIECE = 0, 1, 2, 3, 4
COLUMNS = 5


@kernel
def is_on_arc(h: Memory, ib: int, ic: int) -> bool:
    """True if contact `ic` lies on the arc of its corner on block `ib` (QUERY)."""
    code = iget(h, ic, g.KCCOD)
    if code == g.CORNER_CORNER:
        return True
    return code == (g.CORNER_EDGE if iget(h, ic, g.KB1) == ib else g.EDGE_CORNER)


@inlined
def same_segment(h: Memory, iad: int, ip: int, arc: bool) -> bool:
    """True if item `iad` is a contact on the arc of corner `ip`, or on the edge that ends there."""
    if is_corner(h, iad):
        return False
    first, second, code = iget(h, iad, g.KCP1) == ip, iget(h, iad, g.KCP2) == ip, iget(h, iad, g.KCCOD)
    one, two = (g.CORNER_EDGE, g.EDGE_CORNER) if arc else (g.EDGE_CORNER, g.CORNER_EDGE)
    both = arc and code == g.CORNER_CORNER
    return (first and (code == one or both)) or (second and (code == two or both))


@inlined
def direction_along(h: Memory, ip: int, arc: bool) -> tuple[float, float, float]:
    """Clockwise vector along the edge that ends at corner `ip`, or its arc's chord, and its length."""
    if arc and getr(h, ip, g.KRAD) > 0:  # the chord is normal to the line to the centre
        tx, ty = -(getr(h, ip, g.KYCP) - getr(h, ip, g.KYP)), getr(h, ip, g.KXCP) - getr(h, ip, g.KXP)
    else:
        ia = iget(h, ip, g.KR)
        tx, ty = getr(h, ip, g.KXP) - getr(h, ia, g.KXP), getr(h, ip, g.KYP) - getr(h, ia, g.KYP)
    return tx, ty, np.sqrt(tx * tx + ty * ty)


@kernel
def distance_ahead(h: Memory, ip: int, arc: bool, ic: int, x: float, y: float, nx: float, ny: float) -> float:
    """Distance of contact `ic` on a segment of corner `ip` ahead of a contact at (x, y), clockwise.

    (nx, ny): normal of the latter, away from the block of the corner. On an arc the distance is that of the
    two places on the arc. A contact point is in the middle of gap or overlap: on a narrow arc, a gap moves it
    far to one side, and an overlap beyond the circle's centre to the other side.
    """
    rad = getr(h, ip, g.KRAD)
    if arc and rad > 0:
        iq = iget(h, ic, g.KCP1)
        mx, my, _, _, _, _ = meet(h, iget(h, ic, g.KCCOD), iq, iget(h, ic, g.KCP2))
        if iq != ip:
            mx, my = -mx, -my
        dx, dy = mx - nx, my - ny
        apart = rad * np.sqrt(dx * dx + dy * dy)
        return apart if mx * ny > my * nx else -apart
    tx, ty, z = direction_along(h, ip, arc)
    return ((getr(h, ic, g.KXC) - x) * tx + (getr(h, ic, g.KYC) - y) * ty) / z


@kernel
def not_virtual(h: Memory, ib: int, iad: int) -> int:
    """Item `iad` of block `ib`, or the nearest one before it that is not a virtual contact."""
    item = int64(iad)
    while not is_corner(h, item) and iget(h, item, g.KCCOD) == g.VIRTUAL:
        item = prevcp(h, ib, item)
    return item


@kernel
def next_not_virtual(h: Memory, ib: int, iad: int) -> int:
    """The nearest item after item `iad` of block `ib` that is not a virtual contact."""
    item = nextcp(h, ib, iad)
    while not is_corner(h, item) and iget(h, item, g.KCCOD) == g.VIRTUAL:
        item = nextcp(h, ib, item)
    return item


@kernel
def starts_on_arc(h: Memory, ib: int, ic: int) -> bool:
    """True if the exposure of block `ib` after contact `ic` begins on an arc, False if on an edge.

    A virtual contact has no place: the item before it counts.
    """
    item = not_virtual(h, ib, ic)
    return not is_corner(h, item) and is_on_arc(h, ib, item)


@kernel
def loop_start(h: Memory, idm: int) -> tuple[int, int]:
    """Contact KDLOOP of domain `idm` and the block that is walked after it."""
    ic = iget(h, idm, g.KDLOOP)
    if iget(h, ic, g.KD1) == idm:
        return ic, iget(h, ic, g.KB2)
    return ic, iget(h, ic, g.KB1)


@kernel
def count_items(h: Memory, idm: int) -> int:
    """Number of items around domain `idm`."""
    start, first = loop_start(h, idm)
    item, block = start, first
    n = 0
    while True:
        item, block = nextd(h, item, block)
        n += 1
        if item == start and block == first:
            return n


@kernel
def add_segment(seg: Any, n: int, ib: int, ip: int, arc: int, item: int, piece: int) -> int:
    seg[n, BLOCK] = ib
    seg[n, CORNER] = ip
    seg[n, ARC] = arc
    seg[n, ITEM] = item
    seg[n, PIECE] = piece
    return n + 1


@kernel
def add_arc(h: Memory, seg: Any, n: int, ib: int, ip: int, item: int, piece: int) -> int:
    """Collect the arc of corner `ip` if it is convex or an edge point; other corners carry no contact."""
    if getr(h, ip, g.KRAD) > 0 or is_edge_point(h, ip):
        return add_segment(seg, n, ib, ip, 1, item, piece)
    return n


@kernel
def collect(h: Memory, idm: int, seg: Any, ties: Any) -> tuple[int, int]:
    """Fill `seg` with the segments of domain `idm` and `ties` with its virtual contacts.

    A row of `ties`: the virtual contact, the piece it was reached from, the piece it led to first.
    Returns the number of segments and the number of ties; there is one piece more than there are ties.
    """
    start, first = loop_start(h, idm)
    item, block = start, first
    n, nties, depth, piece = 0, 0, 0, 0
    way_back = np.empty(len(ties), np.int64)
    corner = corner_of(h, block, item)
    arc = starts_on_arc(h, block, item)
    if arc:
        n = add_arc(h, seg, n, block, corner, item, 0)
    else:
        n = add_segment(seg, n, block, corner, 0, item, 0)
    while True:
        last, before = item, block
        item, block = nextd(h, item, block)
        if is_corner(h, item):
            if not arc:
                n = add_arc(h, seg, n, block, item, last, piece)
            arc = False
            corner = next_corner(h, block, item)
            n = add_segment(seg, n, block, corner, 0, item, piece)
            continue
        if is_on_arc(h, before, item) and not arc:
            n = add_arc(h, seg, n, before, corner, last, piece)
        if item == start and block == first:
            return n, nties
        if iget(h, item, g.KCCOD) == g.VIRTUAL:
            if depth > 0 and ties[way_back[depth - 1], 0] == item:
                depth -= 1
                piece = ties[way_back[depth], 1]
            else:
                ties[nties, 0] = item
                ties[nties, 1] = piece
                ties[nties, 2] = nties + 1
                way_back[depth] = nties
                depth += 1
                nties += 1
                piece = nties
        corner = corner_of(h, block, item)
        arc = starts_on_arc(h, block, item)
        if arc:
            n = add_arc(h, seg, n, block, corner, item, piece)
        else:
            n = add_segment(seg, n, block, corner, 0, item, piece)


@kernel
def update_loop_geometry(h: Memory, idm: int) -> None:
    """Update codes, places and coordinates of the contacts around domain `idm`, not their forces.

    Blocks have moved since the last contact pass; the search needs the present places of contacts.
    """
    contacts = np.empty(count_items(h, idm), np.int64)
    start, first = loop_start(h, idm)
    item, block = start, first
    n = 0
    while True:
        item, block = nextd(h, item, block)
        if not is_corner(h, item) and iget(h, item, g.KCCOD) != g.VIRTUAL:
            contacts[n] = item
            n += 1
        if item == start and block == first:
            break
    for ic in contacts[:n]:
        settle(h, ic)
