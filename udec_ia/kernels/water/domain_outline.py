"""The outline of a domain: the points on its blocks at which contacts and corners divide its walls.

A wall is the part of a block's boundary from one contact to the next. It begins and ends at the foot of the
contact: the point of the block that is in contact, or faces the other block across the gap. Between them are
true corners, without their roundings. A foot on the arc of a corner lies before or after it, as the normal
shows, so that each corner belongs to one wall. Virtual contacts have no place: the wall goes on behind them.

    wall        contact -> corners -> contact, on one block
    jump        from a contact's foot on one block to that on the other

A rounding that is left out of the area of one domain is left out of none: a closed crossing has no area.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.kernels.geometry.block_shape import is_edge_point
from udec_ia.kernels.geometry.contact_geometry import meet_inlined, tangents
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, next_corner, nextcp, other, prevcp
from udec_ia.kernels.map.domain_segments import is_on_arc, loop_start
from udec_ia.layout import offsets as g


class Outline(NamedTuple):
    """Points of an outline, anticlockwise around the domain, as many as count_items allows for.

    x, y: (n,) in m. px, py: where the pressure on the wall begins or ends: at a contact the contact point,
    which both blocks share, so that the forces around a domain cancel. item: contact or corner at the point.
    block: that the point lies on. edge: corner at which the edge ends that leads to the point from the one
    before; 0 if it is a jump.
    """

    x: Any
    y: Any
    px: Any
    py: Any
    item: Any
    block: Any
    edge: Any


@kernel
def room_for_outline(items: int) -> Outline:
    """An outline for a domain with so many items: a contact has two feet and at most two corners more."""
    n = 4 * items + 4
    x, y, px, py = (
        np.empty(n, np.float64),
        np.empty(n, np.float64),
        np.empty(n, np.float64),
        np.empty(n, np.float64),
    )
    return Outline(x, y, px, py, np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n, np.int64))


@kernel
def foot(h: Memory, ib: int, ic: int) -> tuple[float, float]:
    """Point of block `ib` at contact `ic`."""
    nx, ny, overlap, x, y, _ = meet_inlined(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
    half = np.float64(overlap) * (0.5 if iget(h, ic, g.KB1) == ib else -0.5)
    return np.float64(x) + half * nx, np.float64(y) + half * ny


@kernel
def with_place(h: Memory, ib: int, iad: int) -> int:
    """Item `iad` of block `ib`; the item before it if it is a virtual contact, which has no place."""
    item = int64(iad)
    while not is_corner(h, item) and iget(h, item, g.KCCOD) == g.VIRTUAL:
        item = prevcp(h, ib, item)
    return item


@kernel
def is_past_corner(h: Memory, ib: int, ic: int) -> bool:
    """True if contact `ic` is on an arc of block `ib`, beyond the corner in the clockwise direction."""
    if iget(h, ic, g.KCCOD) == g.VIRTUAL or not is_on_arc(h, ib, ic):
        return False
    ip = corner_of(h, ib, ic)
    if not getr(h, ip, g.KRAD) > 0:
        return False
    x, y = foot(h, ib, ic)
    tx, ty, ux, uy = tangents(h, ip)
    return bool((x - getr(h, ip, g.KXP)) * (tx + ux) + (y - getr(h, ip, g.KYP)) * (ty + uy) > 0)


@kernel
def edge_after(h: Memory, ib: int, item: int) -> int:
    """Corner at the end of the edge of block `ib` on which a wall goes on behind `item`, with a place."""
    if is_corner(h, item):
        return next_corner(h, ib, item)
    ip = corner_of(h, ib, item)
    return next_corner(h, ib, ip) if is_past_corner(h, ib, item) else ip


@kernel
def add_point(h: Memory, line: Outline, n: int, item: int, ib: int, edge: int) -> int:
    """Put `item` of block `ib` at place `n` of the outline; returns the number of points."""
    at = with_place(h, ib, item)
    if is_corner(h, at):
        line.x[n], line.y[n] = np.float64(getr(h, at, g.KXP)), np.float64(getr(h, at, g.KYP))
        line.px[n], line.py[n] = line.x[n], line.y[n]
    else:
        line.x[n], line.y[n] = foot(h, ib, at)
        line.px[n], line.py[n] = np.float64(getr(h, at, g.KXC)), np.float64(getr(h, at, g.KYC))
    line.item[n], line.block[n], line.edge[n] = item, ib, edge
    return n + 1


@kernel
def trace_outline(h: Memory, idm: int, line: Outline) -> int:
    """Fill `line` with the outline of domain `idm`, which has a loop. Returns the number of points.

    The first point is the foot at which a wall begins, the last one that at which the last wall ends.
    """
    start, first = loop_start(h, idm)
    item, ib = int64(start), int64(first)
    n = 0
    while True:
        edge = edge_after(h, ib, with_place(h, ib, item))
        n = add_point(h, line, n, item, ib, 0)
        item = nextcp(h, ib, item)
        while is_corner(h, item):
            if item == edge:  # else it was passed before the wall began
                n = add_point(h, line, n, item, ib, edge)
                edge = next_corner(h, ib, item)
            item = nextcp(h, ib, item)
        if iget(h, item, g.KCCOD) != g.VIRTUAL and is_past_corner(h, ib, item):
            ip = corner_of(h, ib, item)
            if ip == edge:
                n = add_point(h, line, n, ip, ib, edge)
                edge = next_corner(h, ib, ip)
        n = add_point(h, line, n, item, ib, edge)
        ib = other(h, ib, item)
        if item == start and ib == first:
            return n


@inlined
def ends_a_joint(h: Memory, ip: int) -> bool:
    """True if corner `ip` is a true corner, not a straight one or a point of an edge."""
    return getr(h, ip, g.KRAD) != 0 and not is_edge_point(h, ip)


@kernel
def area_of(line: Outline, n: int) -> float:
    """Area inside an outline of `n` points."""
    x0, y0, twice = line.x[0], line.y[0], 0.0
    for k in range(1, n - 1):
        twice += (line.x[k] - x0) * (line.y[k + 1] - y0) - (line.x[k + 1] - x0) * (line.y[k] - y0)
    return twice * 0.5


@kernel
def wall_lengths(h: Memory, line: Outline, n: int, near: Any) -> None:
    """Put into `near`, (n,), how far the joint reaches along the wall from each of its ends.

    It reaches to the nearest true corner, or half way to the other end; 0 at corners.
    """
    k = 0
    while k < n:
        last = k + 1
        while last + 1 < n and line.edge[last + 1] != 0:
            last += 1
        near[k : last + 1] = 0.0
        length, first, after, found = 0.0, 0.0, 0.0, False
        for i in range(k + 1, last + 1):
            piece = np.hypot(line.x[i] - line.x[i - 1], line.y[i] - line.y[i - 1])
            length += piece
            after += piece
            if i < last and ends_a_joint(h, line.item[i]):
                if not found:
                    first = length
                found, after = True, 0.0
        near[k] = first if found else length * 0.5
        near[last] = after if found else length * 0.5
        k = last + 1
