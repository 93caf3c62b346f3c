"""Blocks, grid-points and edges in a range of a command (RANGE), and why there are none."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import hypot
from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, Offset, getr, iget, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.geometry.range_selection import blocks_between, edges_between, points_between
from udec_ia.kernels.links.linked_lists import nextcp
from udec_ia.kernels.water.domain_outline import room_for_outlines, trace_outline
from udec_ia.layout import offsets as g
from udec_ia.ops.common.number_limits import finite
from udec_ia.reader.group_ranges import EVERYWHERE, Range, Selection, holds
from udec_ia.reader.group_tables import addresses
from udec_ia.reader.list_walks import chain

Point = tuple[float, float]
EXPOSED = 2.0  # times D: an edge is on the outside with more of its length than its roundings have
NO_BLOCK_YET = "there is no block yet: create one with BLOCK"


def check_range(array: MainArray, where: Range) -> None:
    """Error 28 unless the limits of the range are finite."""
    if not isinstance(where, Selection):
        finite(array, **dict(zip(("x1", "x2", "y1", "y2"), where, strict=True)))


def blocks_in(array: MainArray, where: Range) -> list[int]:
    """Addresses of the blocks in the range, in list order."""
    check_range(array, where)
    h = array.h
    if not isinstance(where, Selection):
        return [int(ib) for ib in blocks_between(h, *map(float, where))]
    blocks = blocks_between(h, *EVERYWHERE)
    places = _reals(h, blocks, g.KX), _reals(h, blocks, g.KY)

    def are_outside() -> Any:
        return np.isin(blocks, integers(h, outside_corners(array), g.KNB))

    inside = holds(array, where, *places, blocks, outside=are_outside)
    return [int(ib) for ib in blocks[inside]]


def points_in(array: MainArray, where: Range) -> Any:
    """Blocks and grid-points in the range, (n, 2); 0 for the centroid of a block that has none."""
    h = array.h
    if not isinstance(where, Selection):
        return points_between(h, *map(float, where))
    found = points_between(h, *EVERYWHERE)
    blocks, points = found.T
    places = [
        np.where(points != 0, _reals(h, np.where(points, points, 1), of_point), _reals(h, blocks, of_block))
        for of_point, of_block in ((g.KXG, g.KX), (g.KYG, g.KY))
    ]

    def are_outside() -> Any:
        ends = outside_corners(array)
        ends = np.concatenate([ends, integers(h, ends, g.KR)])
        known = zip(integers(h, ends, g.KNB).tolist(), *_places(h, ends), strict=True)
        corners = {*known}
        return np.array([one in corners for one in zip(blocks.tolist(), *map(list, places), strict=True)])

    return found[holds(array, where, *places, blocks, outside=are_outside)]


def edges_in(array: MainArray, where: Range) -> Any:
    """Blocks and end corners of the edges with both ends in the range, (n, 2), clockwise round each block."""
    h = array.h
    if not isinstance(where, Selection):
        return edges_between(h, *map(float, where))
    found = edges_between(h, *EVERYWHERE)
    blocks, ends = found.T
    inside = np.ones(len(found), bool)
    for ip in (ends, integers(h, ends, g.KR)):
        inside &= holds(
            array, where, *_places(h, ip), blocks, outside=lambda: np.isin(ends, outside_corners(array))
        )
    return found[inside]


def outside_corners(array: MainArray) -> Any:
    """Corners at the ends of the edges on the outline of all blocks, the wall of the outer domain."""
    h, idm = array.h, int(array.h.ci[g.IODPNT])
    if not idm or not iget(h, idm, g.KDLOOP):  # there are no contacts
        return addresses(array, "corner")
    line = room_for_outlines(h)
    n = trace_outline(h, idm, line, 0)
    length = np.hypot(np.diff(line.x[:n]), np.diff(line.y[:n]))
    ends, place = np.unique(line.edge[1:n], return_inverse=True)
    exposed = np.bincount(place, length, len(ends)) > EXPOSED * float(h.cr[g.DTOL])
    return ends[exposed & (ends != 0)]


def _places(h: Memory, corners: Any) -> tuple[Any, Any]:
    return _reals(h, corners, g.KXP), _reals(h, corners, g.KYP)


def _reals(h: Memory, addresses: Any, field: Offset) -> Any:
    """A real field of groups, as 64-bit numbers."""
    return np.asarray(getr(h, addresses, field), np.float64)


def why_no_block(array: MainArray, where: Range) -> str:
    """Why no block lies in the range."""
    h = array.h
    places = (
        (f"block@{ib}", ((float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))),))
        for ib in chain(h, int(h.ci[g.IBPNT]), g.KB)
    )
    return why_nothing(where, "centroid", places)


def range_text(where: Range) -> str:
    """The range as a deck has it."""
    return where.text if isinstance(where, Selection) else "{:g} {:g} {:g} {:g}".format(*where)


def limits_turned(where: Range) -> str:
    """Which limits of the range are in the wrong order, so that nothing can lie in it; "" if none are."""
    if isinstance(where, Selection):
        return ""
    x1, x2, y1, y2 = where
    limits = (("x1", x1, "x2", x2), ("y1", y1, "y2", y2))
    turned = [f"{low} = {a:g} is not below {high} = {b:g}" for low, a, high, b in limits if a >= b]
    return " and ".join(turned) + ", where a range is x1 x2 y1 y2" if turned else ""


def why_nothing(where: Range, what: str, things: Iterable[tuple[str, tuple[Point, ...]]]) -> str:
    """Why nothing lies in the range: its limits, or the nearest thing, given as a name and its points."""
    if turned := limits_turned(where):
        return turned
    if isinstance(where, Selection):
        return f"no {what} in {where.text}"
    x1, x2, y1, y2 = where

    def off(points: tuple[Point, ...]) -> float:
        return max(hypot(max(x1 - x, 0, x - x2), max(y1 - y, 0, y - y2)) for x, y in points)

    nearest = min(things, key=lambda thing: off(thing[1]), default=None)
    if nearest is None:
        return NO_BLOCK_YET
    name, points = nearest
    place = " to ".join(f"({x:g}, {y:g})" for x, y in points)
    here = f"x {x1:g} to {x2:g}, y {y1:g} to {y2:g}"
    limit = "" if off(points) else ", on a limit and so outside"
    return f"no {what} in {here}, the nearest is {name} at {place}{limit}"


def items(h: Memory, ib: int) -> Iterator[int]:
    """Corners and contacts of block `ib`, clockwise."""
    first = item = iget(h, ib, g.KP)
    while True:
        yield item
        item = nextcp(h, ib, item)
        if item == first:
            return
