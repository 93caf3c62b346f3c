"""The crack of a fully-deformable block: a path along zone sides from one edge to another.

The zone that has failed most gives the plane: normal to the greatest principal stress, or one of the two
planes of shear. The path ends at the grid-points nearest to where the plane leaves the block, and runs
through a grid-point of the zone, that nearest to the plane. A side costs its length times 1 + d/l, with d the
distance of its middle from the plane and l the mean length of sides; half of that beside a zone that has
failed. So the cheapest path is short, prefers what has failed, and stays near the plane.

The path exists already as zone sides: stress, momentum and kinetic energy are exact when it opens. Sides
between two zones that have not failed are unbroken where the cracks have a joint material.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.kernels.crack.crack_line import parts_fit
from udec_ia.kernels.crack.mean_stress import failure, plane_of_shear
from udec_ia.kernels.geometry.plane_tensors import first_axis
from udec_ia.layout import offsets as g
from udec_ia.reader.zone_rows import zone_rows

TRIES = 16  # zones through which a path is looked for
Side = tuple[int, int]  # rows of two grid-points, the lesser one first


@dataclass(frozen=True)
class ZonePath:
    """A crack along zone sides.

    cause: KFRK. points: (n, 2) in m. stress: (n - 1, 3) components 11, 12 and 22 (Pa), mean of the two zones
    beside each side. failed: (n - 1,), True if one of them has failed.
    """

    cause: int
    points: Any
    stress: Any
    failed: Any


class _Mesh:
    """Zone sides inside block `ib` on which a crack may run."""

    def __init__(self, h: Memory, ib: int, ik: int) -> None:
        rows = zone_rows(h, ib)
        self.place, self.triples, self.stress = rows.place, rows.triples, rows.stress
        self.on_edge = integers(h, rows.points, g.KCOR) != 0
        failures = np.array([failure(h, ik, *row) for row in self.stress])
        self.cause, self.ratio = failures[:, 0].astype(np.int64), failures[:, 1]
        self.failed = self.cause != 0
        beside: dict[Side, list[int]] = {}
        for k, (a, b, c) in enumerate(self.triples.tolist()):
            for i, j in ((a, b), (b, c), (c, a)):
                beside.setdefault((min(i, j), max(i, j)), []).append(k)
        self.outline = np.array([side for side, zones in beside.items() if len(zones) == 1], np.int64)
        self.beside = {  # pairs of zones stay together
            side: two
            for side, two in beside.items()
            if len(two) == 2 and not (rows.paired and two[0] // 2 == two[1] // 2)
        }
        self.sides: dict[int, list[int]] = {}
        for i, j in self.beside:
            self.sides.setdefault(i, []).append(j)
            self.sides.setdefault(j, []).append(i)
        ends = np.array([*self.beside], np.int64).reshape(-1, 2)
        lengths = np.hypot(*(self.place[ends[:, 0]] - self.place[ends[:, 1]]).T)
        self.size = float(lengths.mean()) if len(lengths) else 1.0

    def cost(self, i: int, j: int, off: Any) -> float:
        """Cost of the side between two grid-points. off: distances of all from the plane."""
        length = float(np.hypot(*(self.place[i] - self.place[j])))
        failed = self.failed[self.beside[min(i, j), max(i, j)]].any()
        return length * (1 + abs(float(off[i] + off[j])) / (2 * self.size)) / (2 if failed else 1)

    def exits(self, centre: Any, direction: Any) -> tuple[int, int]:
        """Grid-points nearest to where the line through `centre` in a direction leaves the block.

        The one behind and the one ahead.
        """
        from_centre = self.place[self.outline] - centre
        along, off = from_centre @ direction, from_centre @ (-direction[1], direction[0])
        cut = (off[:, 0] > 0) != (off[:, 1] > 0)
        (a, b), (p, q) = along[cut].T, off[cut].T
        places = a + (b - a) * p / (p - q)
        on_edge = np.flatnonzero(self.on_edge)
        found = [
            centre + direction * t
            for t in (places[places < 0].max(initial=-np.inf), places[places > 0].min(initial=np.inf))
        ]
        near = [int(on_edge[np.hypot(*(self.place[on_edge] - one).T).argmin()]) for one in found]
        return near[0], near[1]

    def cheapest_path(self, start: int, end: int, allowed: Any, off: Any) -> tuple[float, list[int]]:
        """Cost and points of the cheapest path over `allowed` points inside; infinite without one."""
        heap, before, done = [(0.0, start, start)], dict[int, int](), set[int]()
        while heap:
            cost, here, last = heapq.heappop(heap)
            if here in done:
                continue
            done.add(here)
            before[here] = last
            if here == end:
                found = [here]
                while found[-1] != start:
                    found.append(before[found[-1]])
                return cost, found[::-1]
            for there in self.sides.get(here, ()):
                if there not in done and (there == end or (allowed[there] and not self.on_edge[there])):
                    heapq.heappush(heap, (cost + self.cost(here, there, off), there, here))
        return np.inf, []


def zone_path(h: Memory, ib: int, ik: int) -> ZonePath | None:
    """The crack of fully-deformable block `ib` with strength `ik`; None if it has not failed or cannot crack.

    It is that of the zone that has failed most, or of one of the next, if no path through the first fits.
    """
    mesh = _Mesh(h, ib, ik)
    for row in np.argsort(-mesh.ratio, kind="stable")[:TRIES].tolist():
        if mesh.cause[row] == 0:
            return None
        c, s = first_axis(h, *mesh.stress[row])
        planes = [(-s, c)]
        if mesh.cause[row] == g.CRACK_BY_SHEAR:
            one = h.cr.dtype.type(1)
            planes = [plane_of_shear(h, ik, c, s, sign) for sign in (-one, one)]
        found = [_path_along(mesh, row, np.array(plane, np.float64)) for plane in planes]
        fitting = [(cost, path) for cost, path in found if path and _fits(h, ib, ik, mesh, path)]
        if fitting:
            path = min(fitting, key=lambda one: one[0])[1]
            beside = [mesh.beside[min(i, j), max(i, j)] for i, j in pairwise(path)]
            stress, failed = mesh.stress[beside].mean(axis=1), mesh.failed[beside].any(axis=1)
            return ZonePath(int(mesh.cause[row]), mesh.place[path], stress, failed)
    return None


def _path_along(mesh: _Mesh, row: int, direction: Any) -> tuple[float, list[int]]:
    """Cost and grid-points of the path along a plane through zone `row` in that direction."""
    own = mesh.triples[row]
    centre = mesh.place[own].mean(axis=0)
    along = (mesh.place - centre) @ direction
    off = (mesh.place - centre) @ (-direction[1], direction[0])
    ends = mesh.exits(centre, direction)
    inside = [k for k in own.tolist() if k in ends or not mesh.on_edge[k]]
    if not inside:
        return np.inf, []
    start = min(inside, key=lambda k: abs(float(off[k])))
    behind = mesh.cheapest_path(start, ends[0], along < along[start], off)
    ahead = mesh.cheapest_path(start, ends[1], along > along[start], off)
    path = behind[1][:0:-1] + ahead[1]
    return behind[0] + ahead[0], path if behind[1] and ahead[1] and len(path) > 1 else []


def _fits(h: Memory, ib: int, ik: int, mesh: _Mesh, path: list[int]) -> bool:
    """True if block `ib` can be cut along the path, and edges from its ends have room for two roundings."""
    points = mesh.place[path].astype(h.cr.dtype)
    if not parts_fit(h, ib, points.astype(np.float64), getr(h, ik, g.KBKA)):
        return False
    ends = {path[0], path[-1]}
    sides = [side for a, b, c in mesh.triples.tolist() for side in ((a, b), (b, c), (c, a))]
    near = [mesh.place[i] - mesh.place[j] for i, j in sides if i in ends or j in ends]
    lengths = np.hypot(*np.array(near).T)
    return bool(lengths.min() >= 2 * float(h.cr[g.DTOL]))
