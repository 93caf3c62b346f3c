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
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, next_corner, nextcp, other
from udec_ia.kernels.map.domain_segments import direction_along, is_on_arc, loop_start, not_virtual
from udec_ia.layout import offsets as g

WORDS = 4  # of IA() for each point of all outlines, at least: a contact has four points, a corner one

Point = tuple[float, float]


class Outlines(NamedTuple):
    """Points of the outlines of all domains, one after another, each anticlockwise around its domain.

    x, y: (n,) in m. foot_x, foot_y: the same, but the feet of contacts. reach: how far the joint reaches
    along the wall from the foot, 0 at corners. item: contact or corner at the point. block: whose wall it
    is. edge: corner at the end of the edge on which the piece of wall from the point before lies; 0 where a
    wall begins. ends: place after the last point of each domain, in the order of their list. outside: in the
    outline of the outer domain, condition of water on the piece before the point; 0 for none.
    """

    x: Any
    y: Any
    foot_x: Any
    foot_y: Any
    reach: Any
    item: Any
    block: Any
    edge: Any
    ends: Any
    outside: Any


@kernel
def room_for_outlines(h: Memory) -> Outlines:
    """Arrays for the outlines. Only the pages that are written to take memory."""
    n = h.ci[g.MFREE] // WORDS + WORDS
    x, y, foot_x, foot_y = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    item, block, edge = np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n, np.int64)
    ends, outside = np.zeros(h.ci[g.NDOM], np.int64), np.empty(n, np.int64)
    return Outlines(x, y, foot_x, foot_y, np.empty(n), item, block, edge, ends, outside)


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
def add_point(h: Memory, line: Outlines, n: int, item: int, ib: int, edge: int) -> int:
    """Put `item` of block `ib` at place `n` of the outlines; returns the number of points."""
    at = not_virtual(h, ib, item)
    if is_corner(h, at):
        line.x[n], line.y[n] = getr(h, at, g.KXP), getr(h, at, g.KYP)
    else:
        line.x[n], line.y[n] = getr(h, at, g.KXC), getr(h, at, g.KYC)
    line.item[n], line.block[n], line.edge[n] = item, ib, edge
    return n + 1


@kernel
def trace_outline(h: Memory, idm: int, line: Outlines, first: int) -> int:
    """Add the outline of domain `idm`, which has a loop, from place `first` on. Returns the place after it.

    The first point is that at which a wall begins, the last one that at which the last wall ends.
    """
    start, first_block = loop_start(h, idm)
    item, ib, n = int64(start), int64(first_block), first
    while True:
        edge = edge_after(h, ib, not_virtual(h, ib, item))
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
        if item == start and ib == first_block:
            return n


@kernel
def trace_outlines(h: Memory) -> Outlines:
    """The outlines of all domains; one without a loop has no points."""
    line = room_for_outlines(h)
    idm, k, end = int64(h.ci[g.IDPNT]), 0, 0
    while idm != 0:
        if iget(h, idm, g.KDLOOP) != 0:
            end = trace_outline(h, idm, line, end)
        line.ends[k] = end
        idm, k = iget(h, idm, g.KD), k + 1
    return line


@inlined
def feet(h: Memory, ic: int, ib: int) -> tuple[Point, Point]:
    """Points of block `ib` and of the other one at contact `ic`."""
    nx, ny, overlap, x, y, _ = meet_inlined(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
    half = np.float64(overlap) * (0.5 if iget(h, ic, g.KB1) == ib else -0.5)
    dx, dy = half * nx, half * ny
    return (np.float64(x) + dx, np.float64(y) + dy), (np.float64(x) - dx, np.float64(y) - dy)


@inlined
def put_foot(line: Outlines, k: int, at: Point) -> None:
    """Foot at place `k` of the outlines."""
    line.foot_x[k], line.foot_y[k] = at


@kernel
def find_feet(h: Memory, line: Outlines, first: int, end: int) -> None:
    """Feet of the contacts of an outline. One wall ends at a contact and the next one begins there."""
    for k in range(first, end):
        put_foot(line, k, (line.x[k], line.y[k]))
    before = end - 1
    for k in range(first, end):
        if line.edge[k] == 0:
            ic = line.item[k]
            if iget(h, ic, g.KCCOD) != g.VIRTUAL:
                one, two = feet(h, ic, line.block[k])
                put_foot(line, k, one)
                put_foot(line, before, two)
            else:
                for i in (before, k):
                    at = not_virtual(h, line.block[i], ic)
                    if not is_corner(h, at):
                        put_foot(line, i, feet(h, at, line.block[i])[0])
        before = k


@inlined
def is_true_corner(h: Memory, ip: int) -> bool:
    """True if corner `ip` is a true corner, not a straight one or a point of an edge."""
    return getr(h, ip, g.KRAD) != 0 and not is_edge_point(h, ip)


@kernel
def area_of(line: Outlines, first: int, end: int) -> float:
    """Area inside an outline."""
    x, y = line.foot_x, line.foot_y
    x0, y0, twice = x[first], y[first], 0.0
    for k in range(first + 1, end - 1):
        twice += (x[k] - x0) * (y[k + 1] - y0) - (x[k + 1] - x0) * (y[k] - y0)
    return twice * 0.5


@kernel
def find_reaches(h: Memory, line: Outlines, first: int, end: int) -> tuple[float, float]:
    """Find how far joints reach: to the nearest true corner along the wall, or half way to its other end.

    Returns the length of the longest wall, and of all walls.
    """
    longest, total, k = 0.0, 0.0, first
    while k < end:
        last = k + 1
        while last + 1 < end and line.edge[last + 1] != 0:
            last += 1
        length, begin, after, found = 0.0, 0.0, 0.0, False
        for i in range(k + 1, last + 1):
            dx, dy = line.foot_x[i] - line.foot_x[i - 1], line.foot_y[i] - line.foot_y[i - 1]
            piece = np.sqrt(dx * dx + dy * dy)
            line.reach[i] = 0.0
            length += piece
            after += piece
            if i < last and is_true_corner(h, line.item[i]):
                if not found:
                    begin = length
                found, after = True, 0.0
        line.reach[k] = begin if found else length * 0.5
        line.reach[last] = after if found else length * 0.5
        longest, total, k = max(longest, length), total + length, last + 1
    return longest, total
