"""Blocks with zones that a command cuts: their parts get new zones (report 2.7).

A cut along zone sides is exact (kernels/split/share_zones.py), but a line of SPLIT crosses zones. So the
block is cut with the coarsest zones that have the line as a side. Then each part is divided as GENERATE
AUTOMATIC does it, with sides as long as before. The grid-points on the outline stay, with their velocities.
New ones get the velocity that the old zones have there, and new zones the mean stress of the old ones under
them. Last, a rigid motion is added to all free points, so that linear and angular momentum stay.

Grid-points on an edge of the block that are too near to the ends of the cut are removed, with their contacts.
Conditions and histories of removed grid-points and zones are transferred to the nearest new ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely

from udec_ia.heap.accessors import Memory, getr, iget, integers, puti, putr, size_of
from udec_ia.heap.find_lose import lose
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.displacements import put_mean_displacement
from udec_ia.kernels.body.fdef import pvelfd, sum_over_points
from udec_ia.kernels.body.mass_distribution import share_mass
from udec_ia.kernels.geometry.block_shape import crad, density_of, geo, makeb
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.kernels.links.longer_groups import lose_gridpoint, point_displacements_at
from udec_ia.kernels.split.split_conditions import copy_after
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.corner_rounding import update_flagged
from udec_ia.ops.commands.energy_account import stored_energies
from udec_ia.ops.commands.generate_zones import (
    Outline,
    Place,
    places_of,
    put_mesh,
    words_of_mesh,
)
from udec_ia.ops.commands.grid_points_inside import triangulate
from udec_ia.ops.commands.remove_edge_points import edge_points, flag_around, off_line, take_points_out
from udec_ia.ops.commands.triangulation import EQUILATERAL, mesh
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.cuts.block_division import Division, Reals
from udec_ia.reader.zone_rows import ZoneRows, reals, zone_rows

ON_SIDE = 1e-6  # of an area: a point to which a corner of its zone contributes less is on the opposite side
ROOMY = 3.0  # rounding lengths: parts of an edge are at least 2/3 of a side, and hold two roundings
NEAR = 0.25  # of the sides of zones: how near to an end of a cut a grid-point on the same edge may be


class Rezoned(NamedTuple):
    """A block with zones that was cut.

    before, after: number of its zones. sharpest: the least angle of the new ones (degrees) and its place (x,
    y). energy: by how much the energy that is stored in the model has changed (J/m).
    """

    before: int
    after: int
    sharpest: tuple[float, float, float]
    energy: float


def near_points(array: MainArray, ib: int, division: Division, shortest: float) -> list[int]:
    """Corners of GENERATE on the edges of block `ib` that a division would leave too near to its cuts."""
    h = array.h
    corners = edge_points(h, ib)
    inner = sorted({k for edge in division.curve for k in edge})
    place = reals(h, np.array(corners, np.int64), g.KXP, g.KYP)
    away = shapely.distance(shapely.points(place), shapely.multipoints(division.points[inner]))
    near = (away > 0) & (away < max(shortest, NEAR * _side(zone_rows(h, ib))))
    return [ip for ip, is_near in zip(corners, near, strict=True) if is_near and _is_straight(h, ib, ip)]


def _is_straight(h: Memory, ib: int, ip: int) -> bool:
    """True if the edge of block `ib` is bent at its corner `ip` by no more than the greatest overlap."""
    return off_line(h, ip, iget(h, ip, g.KR), next_corner(h, ib, ip)) <= float(h.cr[g.DTOL2])


def _side(rows: ZoneRows) -> float:
    """Side of equilateral zones as large as these on average."""
    areas = shapely.area(shapely.polygons(rows.place[rows.triples]))
    return float((areas.mean() / EQUILATERAL) ** 0.5)


# What refers to grid-points or zones: kind, field, and the field for their block
REFERENCES = ("bound", g.KUG, g.KUB), ("summand", g.KQG, g.KQB), ("history", g.KHG, None)


def _referred(h: Memory) -> set[int]:
    """Groups of which a condition, a sum or a history has the address."""
    found = [integers(h, list_of(h, kind), field) for kind, field, _ in REFERENCES]
    return {*np.concatenate(found).tolist()} - {0}


class ZonedCut:
    """One block with zones while it is cut: what it had before, for its parts."""

    def __init__(self, array: MainArray, ib: int) -> None:
        self.array, h = array, array.h
        self.energy = sum(stored_energies(h))
        self.rows = zone_rows(h, ib)
        self.side = max(_side(self.rows), ROOMY * float(h.cr[g.DTOL]))
        self.velocity = reals(h, self.rows.points, g.KXDG, g.KYDG)
        if h.ci[g.LDISP]:
            self.moved = reals(h, point_displacements_at(h, self.rows.points), g.KGDX, g.KGDY)
        self.mass = reals(h, self.rows.points, g.KGPM)[:, 0]
        self.had_mass = getr(h, ib, g.KBM) > 0
        self.given, self.summands = _velocity_conditions(h), _by_point(h, "summand", g.KQG)
        self.fixed = g.ALONG_X | g.ALONG_Y if ib in self.given else 0  # as a whole
        self.held = _referred(h) & {*self.rows.points.tolist(), *self.rows.zones.tolist()}

    def divide_coarsely(self, ib: int, division: Division, near: list[int], slack: float) -> Division:
        """Remove the corners `near` from block `ib`; its zones get the edges of the faces as sides.

        slack: distance (m) within which a point of the division is a corner or on an edge. Returns the
        division with its points where the grid-points are, and without the feet of dead ends. Error 1 or 23.
        """
        h = self.array.h
        take_points_out(h, ib, near)
        outline = Outline(h, ib)
        on_cuts = {k for edge in division.curve for k in edge}
        found = {}
        for k in sorted({k for face in division.faces for k in face}):
            x, y = division.points[k].tolist()
            found[k] = outline.place(x, y, slack)
        used = [k for k, place in found.items() if k in on_cuts or (place.corner and not place.on_edge)]
        places, row = [found[k] for k in used], {k: i for i, k in enumerate(used)}
        faces = [[k for k in face if k in row] for face in division.faces]
        points = division.points.copy()
        points[used] = [(place.x, place.y) for place in places]
        triples: list[tuple[int, int, int]] = []
        for face in faces:
            ring = points[face]
            zones = triangulate((ring - ring[0]) / np.ptp(ring), len(ring))
            triples += [(row[face[i]], row[face[j]], row[face[k]]) for i, j, k in zones.tolist()]
        self._put_mesh(ib, places, triples, False)
        h = self.array.h
        if not self.had_mass:
            putr(h, ib, g.KBM, geo(h, ib)[0])  # the grid-points are distributed by their masses
        share_mass(h, ib)
        crad(h, ib, False)
        flag_around(h, ib)
        return division._replace(points=points, faces=faces)

    def divide_parts(self, parts: Sequence[int]) -> Rezoned:
        """Divide the parts of the block into zones, with the stresses and velocities that the block had.

        Error 1 or 28.
        """
        array = self.array
        is_cycling = bool(array.h.ci[g.MCTOT] > 0)
        meshes = []
        for ib in parts:
            outline = Outline(array.h, ib)
            found = mesh(outline.end, self.side, self.rows.paired, array.h.cr.dtype.type)
            places = places_of(outline, found)
            zones = self._put_mesh(
                ib, places, [(i, j, k) for i, j, k in found.zones.tolist()], self.rows.paired
            )
            self._stress(array.h, zones, found.points[found.zones])
            if not is_cycling:
                makeb(array.h, ib, density_of(array.h, ib))
            share_mass(array.h, ib)
            meshes.append(found)
        self._refer_to_new(parts)
        if self.had_mass:
            self._keep_momentum(parts)
        for ib in parts:
            if self.had_mass:
                sum_over_points(array.h, ib)
            if array.h.ci[g.LDISP]:
                put_mean_displacement(array.h, ib)
            pvelfd(array.h, ib)
            crad(array.h, ib, is_cycling)
            flag_around(array.h, ib)
        update_flagged(array)
        renew_forces(array)
        after = sum(len(one.zones) for one in meshes)
        energy = sum(stored_energies(array.h)) - self.energy
        return Rezoned(len(self.rows.zones), after, min(one.sharpest for one in meshes), energy)

    def _put_mesh(
        self, ib: int, places: list[Place], triples: list[tuple[int, int, int]], paired: bool
    ) -> list[int]:
        """Divide block `ib` anew; new grid-points get their velocities. Returns the zones."""
        require(self.array, words_of_mesh(self.array.h, places, triples))
        h = self.array.h
        new = [row for row, place in enumerate(places) if place.on_edge or not place.corner]
        self._drop_zones(h, ib)
        points, zones = put_mesh(h, ib, places, triples, paired)
        self._set_in_motion(ib, [points[row] for row in new])
        return zones

    def _drop_zones(self, h: Memory, ib: int) -> None:
        """Take the zones out of block `ib`; what is at corners stays, and all to which something refers."""
        ie, rows = iget(h, ib, g.KBEX), zone_rows(h, ib)
        kept = {iget(h, ip, g.KGP) for ip in Outline(h, ib).corners} | self.held
        for iz in rows.zones.tolist():
            if iz not in kept:
                lose(h, iz, g.NVZO)
        for ig in rows.points.tolist():
            if ig not in kept:
                lose_gridpoint(h, ig)
        for field in (g.KFG, g.KFZ, g.KFNG, g.KFNZ):
            puti(h, ie, field, 0)

    def _stress(self, h: Memory, zones: list[int], triangles: Any) -> None:
        """Give `zones` the mean stress, by area, of the old ones in their triangles (m, 3, 2)."""
        old, new = shapely.polygons(self.rows.place[self.rows.triples]), shapely.polygons(triangles)
        one, other = shapely.STRtree(old).query(new, predicate="intersects")
        area = shapely.area(shapely.intersection(new[one], old[other]))
        total = np.bincount(one, area, len(new))
        for field, component in zip((g.KZS11, g.KZS12, g.KZS22), self.rows.stress.T, strict=True):
            mean = np.bincount(one, area * component[other], len(new)) / total
            for iz, value in zip(zones, mean.astype(h.cr.dtype), strict=True):
                putr(h, iz, field, value)

    def _set_in_motion(self, ib: int, points: list[int]) -> None:
        """Give new grid-points of block `ib` the velocities, and displacements, of the old zones there.

        A point has the velocity conditions that all old grid-points around it have.
        """
        if not points:
            return
        h, rows = self.array.h, self.rows
        place, corners = reals(h, np.array(points), g.KXG, g.KYG), rows.place[rows.triples]
        tree = shapely.STRtree(shapely.polygons(corners))
        zone = tree.query_nearest(shapely.points(place), all_matches=False)[1]
        a, b, c = corners[zone].transpose(1, 0, 2)
        sides = (b, c), (c, a), (a, b)
        weights = np.stack([_cross(end - start, place - start) for start, end in sides], axis=1)
        weights /= weights.sum(axis=1, keepdims=True)
        number = h.cr.dtype.type

        def at_points(values: Any) -> Any:
            return (values[rows.triples[zone]] * weights[..., None]).sum(axis=1).astype(number)

        velocity = at_points(self.velocity)
        around = [
            rows.points[rows.triples[one][w > ON_SIDE]].tolist() for one, w in zip(zone, weights, strict=True)
        ]
        for ig, (xd, yd) in zip(points, velocity, strict=True):
            putr(h, ig, g.KXDG, xd)
            putr(h, ig, g.KYDG, yd)
            puti(h, ig, g.KGFIX, self.fixed)
        if h.ci[g.LDISP]:
            for field, values in zip((g.KGDX, g.KGDY), at_points(self.moved).T, strict=True):
                putr(h, point_displacements_at(h, np.array(points)), field, values)
        for ig, ends in zip(points, around, strict=True):
            self._copy_conditions(ib, ig, ends)
            self._copy_summands(ib, ig, ends)

    def _copy_conditions(self, ib: int, ig: int, around: list[int]) -> None:
        """Give grid-point `ig` of block `ib` the velocity conditions of all grid-points `around` it."""
        first, *others = (self.given.get(one, []) for one in around)
        require(self.array, len(first) * size_of(self.array.h, g.NVBN))
        h = self.array.h
        for iu in first:
            if all(any(_gives(h, iu) == _gives(h, ju) for ju in one) for one in others):
                copy = copy_after(h, iu, g.NVBN, g.KU)
                puti(h, copy, g.KUB, ib)
                puti(h, copy, g.KUG, ig)
                puti(h, ig, g.KGFIX, iget(h, ig, g.KGFIX) | iget(h, iu, g.KUFIX))

    def _copy_summands(self, ib: int, ig: int, around: list[int]) -> None:
        """Count grid-point `ig` of block `ib` in sums of reactions that have all grid-points `around` it."""
        first, *others = (self.summands.get(one, []) for one in around)
        require(self.array, len(first) * size_of(self.array.h, g.NVSM))
        h = self.array.h
        for iq in first:
            if all(any(iget(h, iq, g.KQH) == iget(h, jq, g.KQH) for jq in one) for one in others):
                copy = copy_after(h, iq, g.NVSM, g.KQ)
                puti(h, copy, g.KQB, ib)
                puti(h, copy, g.KQG, ig)

    def _refer_to_new(self, parts: Sequence[int]) -> None:
        """What refers to an old grid-point or zone that is no more refers to the nearest new one now."""
        h, old = self.array.h, self.rows
        new = [zone_rows(h, ib) for ib in parts]
        gone = self.held.difference(*(one.points.tolist() for one in new))
        if not gone:
            return
        points = _nearest(gone, (old.points, old.place), parts, [(one.points, one.place) for one in new])
        zones = _nearest(gone, (old.zones, old.centroids), parts, [(one.zones, one.centroids) for one in new])
        _refer(h, points | zones)
        for ig in points:
            lose_gridpoint(h, ig)
        for iz in zones:
            lose(h, iz, g.NVZO)

    def _keep_momentum(self, parts: Sequence[int]) -> None:
        """Add a rigid motion to the free grid-points of the parts, so that their momentum is that before."""
        h = self.array.h
        points = np.concatenate([zone_rows(h, ib).points for ib in parts])
        place, velocity = reals(h, points, g.KXG, g.KYG), reals(h, points, g.KXDG, g.KYDG)
        mass = reals(h, points, g.KGPM)[:, 0]
        free = integers(h, points, g.KGFIX) == 0
        if not free.any() or iget(h, parts[0], g.KBFIX) == g.FIXED:
            return
        centre = mass[free] @ place[free] / mass[free].sum()
        arms = place - centre
        momentum = self.mass @ self.velocity - mass @ velocity
        spin = self.mass @ _cross(self.rows.place - centre, self.velocity) - mass @ _cross(arms, velocity)
        inertia = mass[free] @ (arms[free] ** 2).sum(axis=1)
        turn = spin / inertia if inertia > 0 else 0.0  # a single free point cannot turn
        velocity += momentum / mass[free].sum() + turn * np.stack([-arms[:, 1], arms[:, 0]], axis=1)
        for ig, (xd, yd) in zip(points[free].tolist(), velocity[free].astype(h.cr.dtype), strict=True):
            putr(h, ig, g.KXDG, xd)
            putr(h, ig, g.KYDG, yd)


def _nearest(
    gone: set[int], old: tuple[Any, Any], parts: Sequence[int], new: Sequence[tuple[Any, Any]]
) -> dict[int, tuple[int, int]]:
    """For each of the `old` groups that are `gone` the nearest new one, and its block.

    old, new: addresses (n,) and places (n, 2); new: those in each of the parts.
    """
    rows = np.flatnonzero(np.isin(old[0], [*gone]))
    tree = shapely.STRtree(shapely.points(np.concatenate([place for _, place in new])))
    nearest = tree.query_nearest(shapely.points(old[1][rows]), all_matches=False)[1]
    groups = np.concatenate([groups for groups, _ in new])[nearest].tolist()
    blocks = np.repeat(parts, [len(groups) for groups, _ in new])[nearest].tolist()
    return dict(zip(old[0][rows].tolist(), zip(groups, blocks, strict=True), strict=True))


def _refer(h: Memory, to: dict[int, tuple[int, int]]) -> None:
    """What refers to a key of `to` refers to that group in that block now.

    A velocity that the new grid-point has already is not given twice.
    """
    has = {
        (ig, _gives(h, iu)) for ig, given in _velocity_conditions(h).items() for iu in given if ig not in to
    }
    repeated = []
    for kind, field, host in REFERENCES:
        for one in list_of(h, kind).tolist():
            if iget(h, one, field) not in to:
                continue
            new, ib = to[iget(h, one, field)]
            puti(h, one, field, new)
            if host is not None:
                puti(h, one, host, ib)
            if kind == "bound" and iget(h, one, g.KUFIX) != 0:
                puti(h, new, g.KGFIX, iget(h, new, g.KGFIX) | iget(h, one, g.KUFIX))
                if (new, _gives(h, one)) in has:
                    repeated.append(one)
                has.add((new, _gives(h, one)))
    drop(h, "bound", repeated)


def _cross(a: Reals, b: Reals) -> Reals:
    """Cross products of vectors, (n, 2) both."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _velocity_conditions(h: Memory) -> dict[int, list[int]]:
    """The conditions that give velocities, by grid-point, or by block if they act on it as a whole."""
    bounds = list_of(h, "bound")
    found: dict[int, list[int]] = {}
    for iu in bounds[integers(h, bounds, g.KUFIX) != 0].tolist():
        found.setdefault(iget(h, iu, g.KUG) or iget(h, iu, g.KUB), []).append(iu)
    return found


def _by_point(h: Memory, kind: str, field: Any) -> dict[int, list[int]]:
    """The groups of a kind by the grid-point in that field."""
    found: dict[int, list[int]] = {}
    for one in list_of(h, kind).tolist():
        found.setdefault(iget(h, one, field), []).append(one)
    return found


def _gives(h: Memory, iu: int) -> tuple[float, ...]:
    """What a condition gives: directions, signal and velocities."""
    return iget(h, iu, g.KUFIX), iget(h, iu, g.KUS), float(getr(h, iu, g.KUVX)), float(getr(h, iu, g.KUVY))
