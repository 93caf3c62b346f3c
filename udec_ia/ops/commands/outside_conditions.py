"""BOUNDARY ... PPRESSURE, LEVEL, FLOW, IMPERMEABLE: water outside, on exposed edges (report 2.8).

A condition is one group, to which all edges in the range lead that are on the outside (KEOUT). A new one
takes the place of the one before. A pressure loads these edges, and is that outside of the contacts there.

With the first condition all other edges on the outside become dry. So an edge without a condition is one that
has come to the outside later, and has that of the nearest edge.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypedDict

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import edge_at
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.function_command import existing_function
from udec_ia.ops.commands.water_command import need_water, pressure_field, update_water
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.block_ranges import Point, check_range, edges_in, outside_corners, why_nothing
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.common.number_limits import finite
from udec_ia.reader.group_ranges import EVERYWHERE, Range
from udec_ia.reader.group_tables import addresses

KINDS = (g.PRESSURE_OUTSIDE, g.FLOW_FROM_OUTSIDE, g.IMPERMEABLE)


class OutsideWater(TypedDict, total=False):
    """The water outside: a pressure in Pa at the origin, with its increases per metre in x and y; or the
    height in m of its surface; or the flow in m2/s into each contact on the edges; or none (impermeable).
    """

    ppressure: float | None
    level: float | None
    pxgrad: float | None
    pygrad: float | None
    flow: float | None
    impermeable: bool | None


def set_outside(
    array: MainArray, where: Range, water: OutsideWater, function: int | None, others: bool
) -> int:
    """Give the exposed edges in the range a condition. Returns their number.

    function: number of the FUNCTION that multiplies it. others: other conditions were given as well.
    Errors 10, 24, 26 and 28.
    """
    p, level, q = water.get("ppressure"), water.get("level"), water.get("flow")
    gradients = water.get("pxgrad") or 0.0, water.get("pygrad") or 0.0
    pressed = p is not None or level is not None or any(gradients)
    given = [pressed, q is not None, bool(water.get("impermeable"))]
    if others or given.count(True) != 1 or (given[2] and function is not None):
        advice = "give PPRESSURE or LEVEL, or FLOW, or IMPERMEABLE, on a line of its own"
        raise UdecError(10, "conditions that exclude each other", advice, parameter="x1")
    need_water(array)
    signal = existing_function(array.h, function) if function is not None else 0
    field = pressure_field(array, p, level, *gradients) if pressed else (0.0, 0.0, 0.0)
    return _set(array, where, KINDS[given.index(True)], field, q or 0.0, signal)


def _set(
    array: MainArray, where: Range, kind: int, field: tuple[float, float, float], q: float, signal: int
) -> int:
    """The same. kind: value of KOKIND. field: pressure at the origin, and its increases. q: flow."""
    check_range(array, where)
    finite(array, flow=q)
    edges = exposed_edges(array, where)
    if not edges:
        detail = why_nothing(where, "exposed edge with both ends", _named_edges(array))
        raise UdecError(24, detail, "conditions of water act on edges on the outside", parameter="x1")
    require(array, 2 * size_of(array.h, g.NVOU))
    h = array.h
    if not h.ci[g.IOUPNT]:
        _put(h, exposed_edges(array, EVERYWHERE), _new_condition(h, g.DRY))
    iou = _new_condition(h, kind)
    puti(h, iou, g.KOS, signal)
    for k, value in zip((g.KOP, g.KOGX, g.KOGY, g.KOQ), (*field, q), strict=True):
        putr(h, iou, k, value)
    _put(h, edges, iou)
    _drop_unused(array)
    return len(edges)


def _new_condition(h: Memory, kind: int) -> int:
    """A condition of that kind, first in the list."""
    iou = int(find(h, g.NVOU))
    puti(h, iou, HEAD, g.MOUT)
    puti(h, iou, g.KO, int(h.ci[g.IOUPNT]))
    puti(h, iou, g.KOKIND, kind)
    h.ci[g.IOUPNT] = iou
    return iou


def _put(h: Memory, edges: list[int], iou: int) -> None:
    """Give edges condition `iou`, 0 for none."""
    for ip in edges:
        puti(h, edge_at(h, ip), g.KEOUT, iou)


def _drop_unused(array: MainArray) -> None:
    """Give back the conditions that no edge has, and find pressures and forces anew."""
    used = {*integers(array.h, addresses(array, "edge"), g.KEOUT).tolist()}
    drop(array.h, "outside", [iou for iou in list_of(array.h, "outside").tolist() if iou not in used])
    update_water(array)


def free_outside(array: MainArray, where: Range) -> int:
    """Remove the conditions of water from the edges in the range: they become dry. Returns their number.

    Without the last one no edge has any.
    """
    if not array.h.ci[g.IOUPNT]:
        return 0
    require(array, size_of(array.h, g.NVOU))
    h = array.h
    kinds = {iou: iget(h, iou, g.KOKIND) for iou in list_of(h, "outside").tolist()}
    corners = addresses(array, "corner").tolist()
    wet = {ip for ip in corners if kinds.get(iget(h, edge_at(h, ip), g.KEOUT), g.DRY) != g.DRY}
    gone = [ip for _, ip in edges_in(array, where).tolist() if ip in wet]
    if not gone:
        return 0
    if wet == {*gone}:
        _put(h, corners, 0)
    else:
        dry = next((iou for iou, kind in kinds.items() if kind == g.DRY), 0)
        _put(h, gone, dry or _new_condition(h, g.DRY))
    _drop_unused(array)
    return len(gone)


def exposed_edges(array: MainArray, where: Range) -> list[int]:
    """Corners at the ends of the edges with both ends in the range that are on the outside."""
    corners = edges_in(array, where)[:, 1]
    exposed: list[int] = corners[np.isin(corners, outside_corners(array))].tolist()
    return exposed


def _named_edges(array: MainArray) -> Iterator[tuple[str, tuple[Point, ...]]]:
    """Exposed edges by name, with their ends."""
    h = array.h
    for ip in exposed_edges(array, EVERYWHERE):
        ends = [(float(getr(h, i, g.KXP)), float(getr(h, i, g.KYP))) for i in (iget(h, ip, g.KR), ip)]
        yield f"block@{iget(h, ip, g.KNB)}'s", tuple(ends)
