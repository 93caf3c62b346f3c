"""FILL: a new block without stress fills the space between blocks around a point, such as an excavation.

The block has the outline of the space as it is now. Gaps between the blocks around it that are narrower than
two rounding lengths stay open.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import iget, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import water_at
from udec_ia.kernels.map.block_insertion import domain_at
from udec_ia.kernels.map.domain_water import water_of
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.create_block import create
from udec_ia.ops.commands.generate_zones import Outline
from udec_ia.ops.commands.water_command import update_water
from udec_ia.ops.common.block_ranges import NO_BLOCK_YET
from udec_ia.ops.common.number_limits import finite
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import chain


def fill(array: MainArray, x: float, y: float, material: int = 1, constitutive: int = 1) -> int:
    """FILL: make a block in the space around the point (x, y). Returns its address.

    Error 24 if there is no space between blocks, 18 if the point is in a block, 28 if a block that touches
    none of its walls lies in the space, or if it is too narrow.
    """
    ib = create(array, outline_of_space(array, x, y), material, constitutive)
    _begin_water(array, ib)
    return ib


def outline_of_space(array: MainArray, x: float, y: float) -> list[tuple[float, float]]:
    """Corners, clockwise, of the space between blocks around the point (x, y). Errors as of `fill`."""
    finite(array, x=x, y=y)
    h = array.h
    if h.ci[g.NBLK] == 0:
        raise UdecError(24, NO_BLOCK_YET, parameter="x")
    point = shapely.Point(x, y)
    for ib in chain(h, int(h.ci[g.IBPNT]), g.KB):
        if shapely.Polygon(Outline(h, ib).end).intersects(point):
            raise UdecError(18, f"({x:g}, {y:g}) is in block@{ib}", "give a point in a space", parameter="x")
    idm = int(domain_at(h, h.cr.dtype.type(x), h.cr.dtype.type(y)))
    if idm == h.ci[g.IODPNT]:
        detail = f"({x:g}, {y:g}) is outside all blocks"
        raise UdecError(
            24, detail, "give a point in a space between blocks; BLOCK makes others", parameter="x"
        )
    return _outline_in_domain(array, idm, point)


def _begin_water(array: MainArray, ib: int) -> None:
    """Domains beside block `ib` are joints from now on: what was held in the space ends."""
    h = array.h
    if not h.ci[g.LWATER]:
        return
    contacts = table(array, "contact")
    beside = contacts[(contacts["KB1"] == ib) | (contacts["KB2"] == ib)]
    for idm in dict.fromkeys([*beside["KD1"].tolist(), *beside["KD2"].tolist()]):
        if idm != h.ci[g.IODPNT] and iget(h, water_at(h, idm), g.KVCODE) in (g.HELD, g.EXCAVATED):
            h.cd[g.WATPUT] -= water_of(h, idm)
            puti(h, water_at(h, idm), g.KVCODE, g.FLOWS)
            putr(h, idm, g.KPP, 0.0)
            for k in (g.KVSAT, g.KVGX, g.KVGY):
                putr(h, water_at(h, idm), k, 0.0)
    update_water(array)


def _outline_in_domain(array: MainArray, idm: int, point: Any) -> list[tuple[float, float]]:
    """Corners, clockwise, of the space of domain `idm` around the point."""
    contacts = table(array, "contact")
    around = contacts[(contacts["KD1"] == idm) | (contacts["KD2"] == idm)]
    blocks = dict.fromkeys([*around["KB1"].tolist(), *around["KB2"].tolist()])
    walls = [shapely.Polygon(Outline(array.h, ib).end) for ib in blocks]
    rock = shapely.union_all(walls)
    d = float(array.h.cr[g.DTOL])
    core = shapely.box(*rock.bounds).difference(rock.buffer(d, join_style="mitre"))
    space = _part_with(core.buffer(d, join_style="mitre"), point)
    if space is None:
        raise UdecError(28, f"the space is narrower than two rounding lengths, {2 * d:g}", parameter="x")
    if space.interiors:
        detail = "a block that touches none of the others lies in the space"
        raise UdecError(28, detail, "DELETE that block before", parameter="x")
    corners = np.concatenate([shapely.get_coordinates(wall) for wall in walls])
    ring = _at_corners(shapely.get_coordinates(space.exterior)[:-1], corners, float(array.h.cr[g.FTOL]))
    ring = _without_short_edges(ring, 2 * d, float(array.h.cr[g.FTOL]), rock)
    if len(ring) < 3:
        raise UdecError(28, f"the space is too small for edges of {2 * d:g}", parameter="x")
    turn = shapely.LinearRing(ring).is_ccw
    return [(float(px), float(py)) for px, py in (ring[::-1] if turn else ring)]


def _part_with(shape: Any, point: Any) -> Any:
    """The polygon of `shape` that contains the point; None if none does."""
    return next((part for part in shapely.get_parts(shape) if part.intersects(point)), None)


def _at_corners(ring: Any, corners: Any, near: float) -> Any:
    """The points of `ring`, moved to corners of the walls within the distance `near`."""
    moved = ring.copy()
    for k, one in enumerate(ring):
        away = np.hypot(*(corners - one).T)
        if away.min() <= near:
            moved[k] = corners[away.argmin()]
    return moved


def _without_short_edges(ring: Any, shortest: float, near: float, rock: Any) -> Any:
    """The ring without points within `near` of the line between their neighbours, and without short edges.

    Of the two ends of a short edge that one goes without which the ring covers less of `rock`.
    """
    points = [tuple(one) for one in ring]

    def covered_without(i: int) -> float:
        return float(shapely.area(shapely.Polygon(points[:i] + points[i + 1 :]).buffer(0) & rock))

    k = 0
    while len(points) > 2 and k < len(points):
        (ax, ay), (x, y), (bx, by) = points[k - 1], points[k], points[(k + 1) % len(points)]
        length = np.hypot(bx - ax, by - ay)
        off = abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / length if length else 0.0
        if off <= near:
            points.pop(k)
            k = max(k - 1, 0)
        elif np.hypot(x - ax, y - ay) < shortest:
            if len(points) == 3:
                return np.zeros((0, 2))
            points.pop(min(k, (k or len(points)) - 1, key=covered_without))
            k = max(k - 2, 0)
        else:
            k += 1
    return np.array(points)
