"""The outline of a domain: the points at which contacts and corners divide the walls of its blocks.

A wall is the part of a block's boundary from one contact to the next. It begins and ends at contact points,
which both blocks share; between them are true corners, without their roundings. A contact on the arc of a
corner lies before or after it, so that each corner belongs to one wall. Virtual contacts have no place: the
wall goes on behind them.

For the area between the walls, a wall begins and ends at the foot of a contact instead: the point of the
block that is in contact, or faces the other block across the gap. A closed joint has no area then.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.kernels.geometry.block_shape import is_edge_point
from udec_ia.kernels.geometry.contact_geometry import meet_inlined
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, next_corner, nextcp, other, prevcp
from udec_ia.kernels.map.domain_segments import direction_along, is_on_arc, loop_start
from udec_ia.layout import offsets as g

WORDS = 4  # of IA() for each point of the longest outline, at least


class Outline(NamedTuple):
    """Points of an outline, anticlockwise around the domain.

    x, y: (n,) in m. foot_x, foot_y: the same, but the feet of contacts. item: contact or corner at the point.
    block: whose wall it is. edge: corner at the end of the edge on which the piece of wall from the point
    before lies; 0 where a wall begins.
    """

    x: Any
    y: Any
    foot_x: Any
    foot_y: Any
    item: Any
    block: Any
    edge: Any


@kernel
def room_for_outline(h: Memory) -> Outline:
    """An outline for any domain. Only the pages that are written to take memory."""
    n = h.ci[g.MFREE] // WORDS + WORDS
    x, y = np.empty(n, np.float64), np.empty(n, np.float64)
    foot_x, foot_y = np.empty(n, np.float64), np.empty(n, np.float64)
    return Outline(x, y, foot_x, foot_y, np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n, np.int64))


@kernel
def foot(h: Memory, ib: int, ic: int) -> tuple[float, float]:
    """Point of block `ib` at contact `ic`."""
    nx, ny, overlap, x, y, _ = meet_inlined(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
    half = np.float64(overlap) * (0.5 if iget(h, ic, g.KB1) == ib else -0.5)
    return np.float64(x) + half * nx, np.float64(y) + half * ny


@inlined
def with_place(h: Memory, ib: int, iad: int) -> int:
    """Item `iad` of block `ib`; the item before it if it is a virtual contact, which has no place."""
    item = int64(iad)
    while not is_corner(h, item) and iget(h, item, g.KCCOD) == g.VIRTUAL:
        item = prevcp(h, ib, item)
    return item


@inlined
def is_past_corner(h: Memory, ib: int, ic: int) -> bool:
    """True if contact `ic` is on an arc of block `ib`, beyond the corner in the clockwise direction."""
    if not is_on_arc(h, ib, ic):
        return False
    ip = corner_of(h, ib, ic)
    if not getr(h, ip, g.KRAD) > 0:
        return False
    tx, ty, _ = direction_along(h, ip, True)
    x, y = getr(h, ic, g.KXC) - getr(h, ip, g.KXP), getr(h, ic, g.KYC) - getr(h, ip, g.KYP)
    return bool(x * tx + y * ty > 0)


@kernel
def edge_after(h: Memory, ib: int, item: int) -> int:
    """Corner at the end of the edge of block `ib` on which a wall goes on behind `item`, with a place."""
    if is_corner(h, item):
        return next_corner(h, ib, item)
    ip = corner_of(h, ib, item)
    return next_corner(h, ib, ip) if is_past_corner(h, ib, item) else ip


@inlined
def add_point(h: Memory, line: Outline, n: int, item: int, ib: int, edge: int, feet: bool) -> int:
    """Put `item` of block `ib` at place `n` of the outline; returns the number of points."""
    at = with_place(h, ib, item)
    if is_corner(h, at):
        line.x[n], line.y[n] = getr(h, at, g.KXP), getr(h, at, g.KYP)
    else:
        line.x[n], line.y[n] = getr(h, at, g.KXC), getr(h, at, g.KYC)
    line.foot_x[n], line.foot_y[n] = line.x[n], line.y[n]
    if feet and not is_corner(h, at):
        line.foot_x[n], line.foot_y[n] = foot(h, ib, at)
    line.item[n], line.block[n], line.edge[n] = item, ib, edge
    return n + 1


@kernel
def trace_outline(h: Memory, idm: int, line: Outline, feet: bool) -> int:
    """Fill `line` with the outline of domain `idm`, which has a loop. Returns the number of points.

    feet: find those of contacts, too. The first point is that at which a wall begins, the last one that at
    which the last wall ends.
    """
    start, first = loop_start(h, idm)
    item, ib = int64(start), int64(first)
    n = 0
    while True:
        edge = edge_after(h, ib, with_place(h, ib, item))
        n = add_point(h, line, n, item, ib, 0, feet)
        item = nextcp(h, ib, item)
        while is_corner(h, item):
            if item == edge:  # else it was passed before the wall began
                n = add_point(h, line, n, item, ib, edge, feet)
                edge = next_corner(h, ib, item)
            item = nextcp(h, ib, item)
        if iget(h, item, g.KCCOD) != g.VIRTUAL and is_past_corner(h, ib, item):
            ip = corner_of(h, ib, item)
            if ip == edge:
                n = add_point(h, line, n, ip, ib, edge, feet)
                edge = next_corner(h, ib, ip)
        n = add_point(h, line, n, item, ib, edge, feet)
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
    x, y = line.foot_x, line.foot_y
    x0, y0, twice = x[0], y[0], 0.0
    for k in range(1, n - 1):
        twice += (x[k] - x0) * (y[k + 1] - y0) - (x[k + 1] - x0) * (y[k] - y0)
    return twice * 0.5


@kernel
def wall_lengths(h: Memory, line: Outline, n: int, near: Any) -> None:
    """Put into `near`, (n,), how far the joint reaches along the wall from the foot at each of its ends.

    It reaches to the nearest true corner, or half way to the other end; 0 at corners.
    """
    k = 0
    while k < n:
        last = k + 1
        while last + 1 < n and line.edge[last + 1] != 0:
            last += 1
        length, first, after, found = 0.0, 0.0, 0.0, False
        for i in range(k + 1, last + 1):
            dx, dy = line.foot_x[i] - line.foot_x[i - 1], line.foot_y[i] - line.foot_y[i - 1]
            piece = np.sqrt(dx * dx + dy * dy)
            near[i] = 0.0
            length += piece
            after += piece
            if i < last and ends_a_joint(h, line.item[i]):
                if not found:
                    first = length
                found, after = True, 0.0
        near[k] = first if found else length * 0.5
        near[last] = after if found else length * 0.5
        k = last + 1
