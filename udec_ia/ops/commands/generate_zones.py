"""GENERATE: a block is divided into zones (GEN; report 4.2, Appendix I-1).

MANUAL: grid-points within 0.9 D of a corner are moved to it, others within 0.9 D of an edge to the edge,
where they become corners of the block; every corner must have one. A flat corner then counts as a point of an
edge, too. Wrong zones are refused before anything is changed. AUTOMATIC: triangulation.py makes the zones.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, getr, iget, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MANY_BLOCKS, MainArray, compact
from udec_ia.kernels.body.displacements import displacement_of_point
from udec_ia.kernels.body.mass_distribution import share_mass
from udec_ia.kernels.body.motion import set_corner_velocities
from udec_ia.kernels.geometry.block_shape import crad, geo
from udec_ia.kernels.links.linked_lists import is_corner
from udec_ia.kernels.links.longer_groups import (
    contact_words,
    corner_words,
    domain_words,
    find_gridpoint,
    gridpoint_words,
    point_displacement_at,
)
from udec_ia.kernels.split.spli import corner_on_edge
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.change_or_delete_blocks import change_types
from udec_ia.ops.commands.corner_rounding import update_flagged
from udec_ia.ops.commands.remove_edge_points import flag_around
from udec_ia.ops.commands.triangulation import Mesh, mesh
from udec_ia.ops.common.array_growth import all_or_nothing, require
from udec_ia.ops.common.block_ranges import blocks_in, items, why_no_block
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.printable_text import counted
from udec_ia.reader.group_ranges import Range
from udec_ia.reader.group_tables import all_addresses
from udec_ia.reader.list_walks import chain
from udec_ia.reader.zone_rows import has_zones

Point = tuple[float, float]
Triple = tuple[int, int, int]
NEAR = 0.9  # part of the rounding length within which a grid-point is placed on a corner or an edge


@dataclass
class Place:
    """The place of a grid-point: at a corner, on the edge that ends at a corner, or inside (corner 0).

    along: distance from the start of the edge.
    """

    x: float
    y: float
    corner: int = 0
    on_edge: bool = False
    along: float = 0.0


class Outline:
    """The corners of a block, clockwise, as arrays; edge k ends at corner k."""

    def __init__(self, h: Memory, ib: int) -> None:
        self.corners = [ip for ip in items(h, ib) if is_corner(h, ip)]
        self.end = np.array([(getr(h, ip, g.KXP), getr(h, ip, g.KYP)) for ip in self.corners], float)
        self.start = np.roll(self.end, 1, axis=0)
        self.length = np.hypot(*(self.end - self.start).T)
        self.unit = (self.end - self.start) / self.length[:, np.newaxis]

    @property
    def area(self) -> float:
        """Area of the block."""
        return float((self.end[:, 0] * self.start[:, 1] - self.start[:, 0] * self.end[:, 1]).sum() / 2)

    @property
    def where(self) -> str:
        """The ranges of the coordinates of the block, in words."""
        (ax, ay), (bx, by) = self.end.min(axis=0), self.end.max(axis=0)
        return f"x {ax:g} to {bx:g}, y {ay:g} to {by:g}"

    def place(self, x: float, y: float, near: float) -> Place:
        """The place of a grid-point at (x, y), moved to a corner or an edge within the distance `near`."""
        away = np.hypot(self.end[:, 0] - x, self.end[:, 1] - y)
        k = int(away.argmin())
        if away[k] <= near:
            return Place(float(self.end[k, 0]), float(self.end[k, 1]), self.corners[k])
        to = np.array((x, y)) - self.start
        along = (to * self.unit).sum(axis=1)
        off = np.abs(to[:, 0] * self.unit[:, 1] - to[:, 1] * self.unit[:, 0])
        off[(along < 0) | (along > self.length)] = np.inf
        k = int(off.argmin())
        if off[k] <= near:
            px, py = self.start[k] + along[k] * self.unit[k]
            return Place(float(px), float(py), self.corners[k], True, float(along[k]))
        return Place(x, y)

    def distance(self, x: float, y: float) -> float:
        """Distance of the point (x, y), 0 inside."""
        return float(shapely.Polygon(self.end).distance(shapely.Point(x, y)))

    def holds(self, x: float, y: float) -> bool:
        """True if the point (x, y) lies inside."""
        above = self.end[:, 1] > y
        crosses = above != (self.start[:, 1] > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            part = (y - self.start[:, 1]) / (self.end[:, 1] - self.start[:, 1])
            at = self.start[:, 0] + part * (self.end[:, 0] - self.start[:, 0])
        return bool(np.count_nonzero(crosses & (at > x)) % 2)


def generate(
    array: MainArray,
    ib: int,
    points: Sequence[Point],
    triples: Sequence[Triple],
    near: float,
    paired: bool = False,
) -> list[str]:
    """Divide block `ib` into zones. Returns remarks on grid-points that were moved.

    points: the last one is number 1. triples: three of these numbers for each zone, in either sense. near:
    distance within which a point is moved to a corner or an edge. paired: zones 1 and 2, 3 and 4 ... are
    pairs for mixed discretisation. Errors 14, 25, 26, 28 and 33; nothing is changed then.
    """
    h = array.h
    outline = Outline(h, ib)
    places = [outline.place(x, y, near) for x, y in reversed(points)]  # in the order of their numbers
    boundary = _boundary(outline, places, float(h.cr[g.DTOL]))
    zones = _clockwise(places, triples)
    _check_cover(outline, places, boundary, zones)
    if paired:
        _check_pairs(zones)
    divide(array, [(ib, places, zones)], paired)
    moved = zip(range(1, len(places) + 1), reversed(points), places, strict=True)
    return [
        f"grid-point {number} ({x:g}, {y:g}) was moved onto the block's outline at ({place.x:g}, {place.y:g})"
        for number, (x, y), place in moved
        if math.hypot(place.x - x, place.y - y) > 1e-3 * float(h.cr[g.DTOL])
    ]


def divide(
    array: MainArray, meshes: Sequence[tuple[int, list[Place], Sequence[Triple]]], paired: bool
) -> None:
    """Put grid-points and zones into blocks.

    meshes: a block, the places of its grid-points, and its zones, clockwise triples of rows of the places.
    Error 1 if there is no memory for all of it and for new contacts, 20 if lists are broken; nothing is
    changed then.
    """
    with all_or_nothing(array):
        change_types(array, [ib for ib, _, _ in meshes], g.MFDEF)
        first = int(array.h.ci[g.MFREE])  # nobody else knows an address from here on
        for ib, places, zones in meshes:
            require(array, words_of_mesh(array.h, places, zones))
            h = array.h
            put_mesh(h, ib, places, zones, paired)
            share_mass(h, ib)
            _set_in_motion(h, ib)
            crad(h, ib, False)
            flag_around(h, ib)
            update_flagged(array)
        if array.h.ci[g.MCTOT] > 0:
            renew_forces(array)
            # Kinds lie mixed, block by block. The first cycle arranges those that came before it.
            if len(meshes) >= MANY_BLOCKS:
                compact(array, all_addresses(array), first)


def blocks_to_zone(array: MainArray, where: Range) -> list[int]:
    """The blocks in the range that have no zones. Error 24 if no block is there."""
    blocks = blocks_in(array, where)
    if not blocks:
        raise UdecError(24, why_no_block(array, where), parameter="x1")
    h = array.h
    return [ib for ib in blocks if not has_zones(h, ib)]


def _boundary(outline: Outline, places: list[Place], d: float) -> list[int]:
    """Rows of `places` on the outline, clockwise.

    Error 26 for a corner without a grid-point, 28 for two at one place, 14 if they stand too close.
    """
    on: dict[int, list[int]] = {ip: [] for ip in outline.corners}
    for row, place in enumerate(places):
        if place.corner:
            on[place.corner].append(row)
        elif not outline.holds(place.x, place.y):
            detail = f"grid-point {row + 1} ({place.x:g}, {place.y:g}) lies outside the block"
            advice = f"the first block in the range lies in {outline.where}; the last grid-point is number 1"
            raise UdecError(28, detail, advice, parameter="gridpoints")
    found: list[int] = []
    for k, ip in enumerate(outline.corners):
        edge = sorted((row for row in on[ip] if places[row].on_edge), key=lambda row: places[row].along)
        corner = [row for row in on[ip] if not places[row].on_edge]
        x, y = outline.end[k]
        if not corner:
            raise UdecError(26, f"the corner ({x:g}, {y:g}) has no grid-point", "give one for every corner")
        if len(corner) > 1:
            numbers = " and ".join(str(row + 1) for row in corner)
            raise UdecError(28, f"grid-points {numbers} are within {NEAR} D of the corner ({x:g}, {y:g})")
        found += edge + corner
    for one, two in zip(found, found[1:] + found[:1], strict=True):
        a, b = places[one], places[two]
        need = d * ((not a.on_edge) + (not b.on_edge))
        distance = math.hypot(b.x - a.x, b.y - a.y)
        if distance < need * (1 - 1e-6) or distance == 0:
            detail = f"grid-points {one + 1} and {two + 1} are {distance:g} apart, and rounding is by {d:g}"
            raise UdecError(14, detail, "increase their distance, or use a smaller ROUND")
    return found


def _clockwise(places: list[Place], triples: Sequence[Triple]) -> list[Triple]:
    """The zones as rows of `places`, all clockwise. Error 25 for a wrong number, 33 for a flat zone."""
    zones = []
    for number, triple in enumerate(triples, 1):
        for n in triple:
            if not 1 <= n <= len(places):
                advice = f"grid-points are numbered from 1 to {len(places)}"
                raise UdecError(25, f"{n} in zone {number}", advice, parameter="zones")
        i, j, k = (n - 1 for n in triple)
        a, b, c = places[i], places[j], places[k]
        turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
        if abs(turn) <= 1e-6 * ((b.x - a.x) ** 2 + (b.y - a.y) ** 2 + (c.x - a.x) ** 2 + (c.y - a.y) ** 2):
            raise _no_cover(f"zone {number} ({triple[0]}, {triple[1]}, {triple[2]}) has no area")
        zones.append((i, j, k) if turn < 0 else (i, k, j))
    return zones


def _check_cover(outline: Outline, places: list[Place], boundary: list[int], zones: list[Triple]) -> None:
    """Error 33 unless the zones fill the block: side to side, without gap or overlap."""
    sides: dict[tuple[int, int], int] = {}
    for number, (i, j, k) in enumerate(zones, 1):
        for side in ((i, j), (j, k), (k, i)):
            if side in sides:
                what = f"zones {sides[side]} and {number} lie on the same side of grid-points"
                raise _no_cover(f"{what} {side[0] + 1} and {side[1] + 1}")
            sides[side] = number
    outer = set(zip(boundary, boundary[1:] + boundary[:1], strict=True))
    for i, j in outer:
        if (i, j) not in sides:
            raise _no_cover(f"no zone stands on the edge between grid-points {i + 1} and {j + 1}")
    for (i, j), number in sides.items():
        if (j, i) not in sides and (i, j) not in outer:
            raise _no_cover(f"zone {number} has no neighbour over grid-points {i + 1} and {j + 1}")
    used = {row for zone in zones for row in zone}
    for row in range(len(places)):
        if row not in used:
            raise _no_cover(f"grid-point {row + 1} belongs to no zone")
    total = sum(_area(places, zone) for zone in zones)
    if abs(total - outline.area) > 1e-6 * outline.area:
        raise _no_cover(f"the zones have the area {total:g}, the block {outline.area:g}")


def _no_cover(what: str) -> UdecError:
    """The error of zones that do not fill their block."""
    return UdecError(33, what, parameter="zones")


def _check_pairs(zones: list[Triple]) -> None:
    """Error 33 unless zones 1 and 2, 3 and 4 ... have a common side."""
    advice = "with MIXED, zones 1 and 2, 3 and 4 ... have a common side"
    if len(zones) % 2:
        detail = f"{counted(len(zones), 'zone')} cannot be made into pairs"
        raise UdecError(33, detail, advice, parameter="mixed")
    for k in range(0, len(zones), 2):
        if len({*zones[k], *zones[k + 1]}) != 4:
            raise UdecError(33, f"zones {k + 1} and {k + 2} are not a pair", advice, parameter="mixed")


def _area(places: list[Place], zone: Triple) -> float:
    a, b, c = (places[row] for row in zone)
    return ((c.x - a.x) * (b.y - a.y) - (b.x - a.x) * (c.y - a.y)) / 2


def put_mesh(
    h: Memory, ib: int, places: list[Place], zones: Sequence[Triple], paired: bool
) -> tuple[list[int], list[int]]:
    """Give block `ib` grid-points and zones; returns the addresses of both, in the order given.

    zones: clockwise triples of rows of `places`. There must be memory for all of it.
    """
    for place in sorted((p for p in places if p.on_edge), key=lambda p: p.along):
        real = h.cr.dtype.type
        place.corner = int(corner_on_edge(h, ib, place.corner, real(place.x), real(place.y)))
    points = _make_gridpoints(h, ib, places)
    return points, _make_zones(h, ib, points, zones, paired)


def words_of_mesh(h: Memory, places: list[Place], zones: Sequence[Triple]) -> int:
    """Words that put_mesh may need, with the contacts that form at new corners."""
    new = sum(place.on_edge for place in places)
    words = new * (corner_words(h) + 2 * contact_words(h) + 2 * domain_words(h))
    return words + len(places) * gridpoint_words(h) + len(zones) * size_of(h, g.NVZO)


def _make_gridpoints(h: Memory, ib: int, places: list[Place]) -> list[int]:
    """Grid-points at the given places; addresses in their order. A corner keeps the one that it has."""
    ie = iget(h, ib, g.KBEX)
    addresses = []
    for place in reversed(places):
        ig = iget(h, place.corner, g.KGP) if place.corner else 0
        is_new = ig == 0
        if is_new:
            ig = int(find_gridpoint(h))
        puti(h, ig, g.KG, iget(h, ie, g.KFG))
        puti(h, ie, g.KFG, ig)
        putr(h, ig, g.KXG, place.x)
        putr(h, ig, g.KYG, place.y)
        if place.corner:
            putr(h, ig, g.KXG, getr(h, place.corner, g.KXP))
            putr(h, ig, g.KYG, getr(h, place.corner, g.KYP))
        if place.corner and is_new:
            puti(h, ig, g.KCOR, place.corner)
            flat = place.on_edge or getr(h, place.corner, g.KRAD) == 0
            puti(h, ig, g.KGEDGE, int(flat))
            puti(h, place.corner, g.KGP, ig)
        addresses.append(ig)
    puti(h, ie, g.KFNG, len(addresses))
    return addresses[::-1]


def _set_in_motion(h: Memory, ib: int) -> None:
    """Give the grid-points and corners of block `ib` the velocities of the block, and its displacement.

    All velocities stay, so the angular momentum grows with the moment of inertia.
    """
    xd, yd, td = (float(getr(h, ib, k)) for k in (g.KXD, g.KYD, g.KTD))
    if h.ci[g.MCTOT] > 0:
        putr(h, ib, g.KBI, _lumped_inertia(h, ib))
    for ig, rx, ry in _arms(h, ib):
        putr(h, ig, g.KXDG, xd - td * ry)
        putr(h, ig, g.KYDG, yd + td * rx)
        if h.ci[g.LDISP]:
            ux, uy = displacement_of_point(h, ib, h.cr.dtype.type(rx), h.cr.dtype.type(ry))
            putr(h, point_displacement_at(h, ig), g.KGDX, ux)
            putr(h, point_displacement_at(h, ig), g.KGDY, uy)
    set_corner_velocities(h, ib)


def _arms(h: Memory, ib: int) -> list[tuple[int, float, float]]:
    """Grid-points of block `ib`, and their distances in x and y from its centroid."""
    x, y = float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
    points = chain(h, iget(h, iget(h, ib, g.KBEX), g.KFG), g.KG)
    return [(ig, float(getr(h, ig, g.KXG)) - x, float(getr(h, ig, g.KYG)) - y) for ig in points]


def _lumped_inertia(h: Memory, ib: int) -> float:
    """Moment of inertia of the masses at the grid-points of block `ib`."""
    return sum(float(getr(h, ig, g.KGPM)) * (rx * rx + ry * ry) for ig, rx, ry in _arms(h, ib))


def inertia_ratio(h: Memory, ib: int) -> float:
    """Moment of inertia of the masses at grid-points over that of block `ib` as a body; 1 without a mass."""
    area, _, _, jxx, _, jyy = (float(n) for n in geo(h, ib))
    exact = float(getr(h, ib, g.KBM)) * (jxx + jyy) / area
    return _lumped_inertia(h, ib) / exact if exact else 1.0


def record_inertia(array: MainArray, blocks: Sequence[int]) -> dict[int, float]:
    """The inertia_ratio of each of the `blocks`, which have got zones; ZINER remembers the greatest."""
    h = array.h
    ratios = {ib: float(inertia_ratio(h, ib)) for ib in blocks}
    h.cr[g.ZINER] = max(float(h.cr[g.ZINER]), *ratios.values())
    return ratios


def _make_zones(h: Memory, ib: int, addresses: list[int], zones: Sequence[Triple], paired: bool) -> list[int]:
    """Zones of block `ib`, in the order given, with the stress that the block has; returns them."""
    ie = iget(h, ib, g.KBEX)
    made = []
    for triple in reversed(zones):
        iz = int(find(h, g.NVZO))
        puti(h, iz, g.KZ, iget(h, ie, g.KFZ))
        puti(h, ie, g.KFZ, iz)
        for i, row in enumerate(triple):
            puti(h, iz, g.KZG, addresses[row], i)
        for here, first in ((g.KZS11, g.KFS11), (g.KZS12, g.KFS12), (g.KZS22, g.KFS22)):
            putr(h, iz, here, getr(h, ie, first))
        made.append(iz)
    puti(h, ie, g.KFNZ, len(zones))
    puti(h, ie, g.KFMIX, int(paired))
    return made[::-1]


# ---- GENERATE ... AUTOMATIC: a block is divided into zones with sides of about a given length

SLACK = 1e-6  # share of the rounding length by which the distance to a corner may be too short


def generate_automatically(
    array: MainArray,
    blocks: Sequence[int],
    edge: float,
    growth: float = 0.0,
    centre: Point = (0.0, 0.0),
    paired: bool = False,
) -> str:
    """Divide blocks into zones. Returns one line on the mesh.

    Their sides have about the length `edge` (m) plus `growth` times the distance of the block from `centre`.
    paired: zones 1 and 2, 3 and 4 ... are pairs for mixed discretisation. Errors 1, 14, 23 and 28; nothing
    is changed then.
    """
    if growth < 0:
        raise UdecError(28, f"a growth of {growth:g}", "give 0 or more", parameter="graded")
    outlines = [Outline(array.h, ib) for ib in blocks]
    edges = [edge + growth * outline.distance(*centre) for outline in outlines]
    meshes = [
        mesh(outline.end, d, paired, array.h.cr.dtype.type)
        for outline, d in zip(outlines, edges, strict=True)
    ]
    for outline, found, d in zip(outlines, meshes, edges, strict=True):
        _check_room(found, len(outline.corners), d, float(array.h.cr[g.DTOL]))
    divided = [
        (ib, places_of(outline, found), [(i, j, k) for i, j, k in found.zones.tolist()])
        for ib, outline, found in zip(blocks, outlines, meshes, strict=True)
    ]
    divide(array, divided, paired)
    what = f"block@{blocks[0]} has" if len(blocks) == 1 else f"{len(blocks)} blocks have"
    angle, x, y = min(one.sharpest for one in meshes)
    return (
        f"{what} {sum(len(one.zones) for one in meshes)} zones and "
        f"{sum(len(one.points) for one in meshes)} grid-points, "
        f"the least angle is {angle:.1f} degrees, at ({x:.4g}, {y:.4g})"
    )


def _check_room(found: Mesh, corners: int, edge: float, d: float) -> None:
    """Error 14 if a grid-point on an edge stands in the rounding of a corner."""
    ends = np.append(found.ring, found.ring[0])
    for i, j in pairwise(ends.tolist()):
        distance = float(np.hypot(*(found.points[i] - found.points[j])))
        if (i < corners) != (j < corners) and distance < d * (1 - SLACK):
            x, y = found.points[min(i, j)]
            detail = f"a grid-point would be {distance:g} from the corner ({x:g}, {y:g}), rounded by {d:g}"
            advice = f"use an EDGE longer than {edge:g}, or first ROUND {0.9 * distance:.2g}"
            raise UdecError(14, detail, advice, parameter="edge")


def places_of(outline: Outline, found: Mesh) -> list[Place]:
    """The places of the points of the mesh, whose first points are the corners."""
    places = [Place(float(x), float(y)) for x, y in found.points]
    for place, ip in zip(places, outline.corners, strict=False):
        place.corner = ip
    edge = 1  # the ring begins at corner 0, with the edge that ends at corner 1
    for i in found.ring[1:].tolist():
        k = edge % len(outline.corners)
        if i < len(outline.corners):
            edge += 1
            continue
        place = places[i]
        place.corner, place.on_edge = outline.corners[k], True
        place.along = float(np.hypot(*(found.points[i] - outline.start[k])))
    return places
