"""TIDY: blocks below an area are merged into a neighbour, before zones and cycles.

A sliver goes to the neighbour with which it has the longest joint. Both are removed, and a block with the
outline of both takes their place; it has material, type, joints and groups of the neighbour.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, puti
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.displacements import displacement_of_point, put_displacement
from udec_ia.kernels.links.linked_lists import is_corner, other
from udec_ia.kernels.links.longer_groups import displacement_at, edges_at
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.breakage_command import add_strength, strength_of
from udec_ia.ops.commands.change_or_delete_blocks import become, remove_blocks
from udec_ia.ops.commands.create_block import add_block
from udec_ia.ops.commands.generate_zones import Outline
from udec_ia.ops.commands.group_command import add_members
from udec_ia.ops.commands.split_blocks import ROUNDINGS
from udec_ia.ops.common.block_ranges import items
from udec_ia.ops.common.number_limits import EDGE_DIGITS, last_digit, positive
from udec_ia.ops.cuts.joint_of_cut import GLUE
from udec_ia.printable_text import counted
from udec_ia.reader.block_groups import groups_of_blocks, letters_of
from udec_ia.reader.list_walks import chain

SHOWN = 3  # places in a line


class Merged(NamedTuple):
    """A sliver that was merged: its area (m2) and a point in it."""

    area: float
    x: float
    y: float


class Tidied(NamedTuple):
    """Slivers that were merged, and those that were not: they have zones, or no neighbour fits."""

    merged: list[Merged]
    left: list[Merged]

    def __str__(self) -> str:
        places = [f"({one.x:.6g}, {one.y:.6g})" for one in self.merged[: SHOWN + 1]]
        places[SHOWN:] = ["..."] if len(places) > SHOWN else []
        where = f", {sum(one.area for one in self.merged):.4g} m2 together, at {', '.join(places)}"
        return f"{counted(len(self.merged), 'block')} merged into neighbours{where if places else ''}"


def merge_slivers(array: MainArray, area: float) -> Tidied:
    """TIDY: merge all blocks smaller than `area` (m2), the smallest first.

    Error 26 after the first cycle, 28 unless the area is positive.
    """
    positive(array, area=area)
    h = array.h
    if h.ci[g.MCTOT] > 0:
        raise UdecError(
            26, "a state before the first cycle", "TIDY after the cuts; DELETE AREA < a at any time"
        )
    merged, left = list[Merged](), dict[int, Merged]()
    areas = {ib: Outline(h, ib).area for ib in chain(h, int(h.ci[g.IBPNT]), g.KB)}
    while areas:
        ib = min(areas, key=lambda one: areas[one])
        if areas[ib] >= area:
            break
        outline = shapely.Polygon(Outline(h, ib).end)
        inside = outline.representative_point()
        place = Merged(areas.pop(ib), inside.x, inside.y)
        joined = _merge(array, ib, outline)
        h = array.h
        if joined is None:
            left[ib] = place
            continue
        jb, new = joined
        merged.append(place)
        areas.pop(jb, None)
        left.pop(jb, None)
        areas[new] = Outline(h, new).area
    return Tidied(merged, [*left.values()])


def _merge(array: MainArray, ib: int, outline: Any) -> tuple[int, int] | None:
    """Merge block `ib` into a neighbour. Returns that and the new block, or None if none fits."""
    h = array.h
    if h.ci[g.NBLK] < 3 or _has_zones(array, ib):
        return None
    slack = ROUNDINGS * last_digit(array, float(np.abs(shapely.get_coordinates(outline)).sum(axis=1).max()))
    shortest = EDGE_DIGITS / ROUNDINGS * slack
    near = shapely.buffer(outline, slack, join_style="mitre")
    found = []
    for jb in {other(h, ib, one) for one in items(h, ib) if not is_corner(h, one)}:
        beside = shapely.Polygon(Outline(h, jb).end)
        found.append((-shapely.intersection(beside.exterior, near).length, jb, beside))
    for shared, jb, beside in sorted(found, key=lambda one: one[:2]):
        if shared >= -2 * slack or _has_zones(array, jb) or _is_glued(h, ib, beside, slack):
            continue
        ring = _joined(outline, beside, slack, shortest)
        if ring is not None:
            return jb, _replace(array, (ib, jb), ring)
    return None


def _has_zones(array: MainArray, ib: int) -> bool:
    h = array.h
    return iget(h, ib, HEAD) == g.MFDEF and iget(h, iget(h, ib, g.KBEX), g.KFG) != 0


def _is_glued(h: Memory, ib: int, beside: Any, slack: float) -> bool:
    """True if a joint of block `ib` and a block with the outline `beside` is glued.

    It may be the outline of an excavation that is dug later.
    """
    if h.ci[g.LJOINT] == 0:
        return False
    o = Outline(h, ib)
    glued = integers(h, edges_at(h, np.array(o.corners)), g.KEJ) == GLUE
    middles = shapely.points((o.start[glued] + o.end[glued]) / 2)
    return bool((shapely.distance(middles, beside) <= slack).any())


def _joined(one: Any, two: Any, slack: float, shortest: float) -> Any:
    """The outline of two polygons together, clockwise, at their own corners; None if it is not one ring.

    slack: within which their points are the same. shortest: length of an edge that is kept.
    """
    try:
        whole = shapely.union(one, two, grid_size=slack)
    except shapely.GEOSException:  # their edges are almost parallel
        return None
    if whole.geom_type != "Polygon" or whole.interiors:
        return None
    corners = np.concatenate([shapely.get_coordinates(one), shapely.get_coordinates(two)])
    points = shapely.get_coordinates(whole.exterior)[:-1]
    points = corners[np.hypot(*(points[:, np.newaxis] - corners).transpose(2, 0, 1)).argmin(axis=1)]
    points = points[np.hypot(*(points - np.roll(points, 1, axis=0)).T) > shortest]
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    (ax, ay), (bx, by) = (after - before).T, (points - before).T
    turns = np.abs(ax * by - ay * bx) > 2 * slack * np.hypot(ax, ay)
    ring = points[turns]
    if len(ring) < 3:
        return None
    found = shapely.Polygon(ring)
    if not found.is_valid or abs(found.area - one.area - two.area) > found.length * shortest:
        return None
    return ring[::-1] if shapely.LinearRing(ring).is_ccw else ring


def _replace(array: MainArray, pair: tuple[int, int], ring: Any) -> int:
    """Replace a sliver and its neighbour by a block with the corners `ring`; returns that."""
    h = array.h
    jb = pair[1]
    kept = [iget(h, jb, k) for k in (HEAD, g.KMAT, g.KCONS, g.KBFIX)]
    joints = _joints_along(array, pair, ring)
    strength = strength_of(h, jb)
    moved = _displacement(h, jb, ring) if h.ci[g.LDISP] else None
    names = [name for name, blocks in groups_of_blocks(h).items() if jb in blocks] if h.ci[g.IMBPNT] else []
    remove_blocks(h, list(pair))
    new = add_block(array, [(float(x), float(y)) for x, y in ring], kept[1], kept[2], joints)
    h = array.h
    if kept[0] != g.MRIG:
        become(h, new, kept[0])
    puti(h, new, g.KBFIX, kept[3] & g.FIXED)
    if moved is not None:
        put_displacement(h, new, *moved)
    for name in names:
        add_members(array, letters_of(name), [new])
    if strength is not None:
        add_strength(array, new, strength)
    return new


def _displacement(h: Memory, ib: int, ring: Any) -> tuple[float, float, float]:
    """Displacement, and rotation, of a block with the corners `ring` that moves with block `ib`."""
    centre = shapely.Polygon(ring).centroid
    rx, ry = centre.x - float(getr(h, ib, g.KX)), centre.y - float(getr(h, ib, g.KY))
    ux, uy = displacement_of_point(h, ib, h.cr.dtype.type(rx), h.cr.dtype.type(ry))
    return ux, uy, getr(h, displacement_at(h, ib), g.KBDT)


def _joints_along(array: MainArray, blocks: tuple[int, int], ring: Any) -> list[int]:
    """The number of the joint that made each edge of `ring`, as that of the nearest edge of `blocks`."""
    h = array.h
    if h.ci[g.LJOINT] == 0:
        return []
    outlines = [Outline(h, ib) for ib in blocks]
    edges = [line for o in outlines for line in shapely.linestrings(np.stack([o.start, o.end], axis=1))]
    numbers = integers(h, edges_at(h, np.concatenate([o.corners for o in outlines])), g.KEJ).tolist()
    middles = shapely.points((np.roll(ring, 1, axis=0) + ring) / 2)
    return [numbers[int(np.argmin(shapely.distance(edges, middle)))] for middle in middles]
