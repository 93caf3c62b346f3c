"""Zones for GENERATE ... AUTOMATIC: the outline of a block divided into triangles of a given size.

1. Each edge of the outline is divided evenly into parts as near to the given size as possible.
2. Points inside form a lattice of equilateral triangles, and are then moved to improve the worst zones
   (grid_points_inside.py). The zones are the constrained Delaunay triangulation of the package pythoncdt.
3. For mixed discretisation the zones are made into pairs with a common side. B points on the outline and I
   inside make 2I + B - 2 triangles, so B must be even: one edge gets one part more or less.

The mesh is independent of IA(). The same input gives the same mesh, bit for bit. The points on an edge do not
depend on its direction: two blocks with a common edge and the same number of parts get the same points on it.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from udec_ia.errors import UdecError
from udec_ia.ops.commands.grid_points_inside import (
    Floats,
    Ints,
    areas,
    common_sides,
    fill,
    following,
    lattice,
    relax,
    shapes,
    sides,
    triangulate,
)

MAX_ZONES = 2_000_000
EQUILATERAL = 3**0.5 / 4  # area of an equilateral triangle of side 1


@dataclass(frozen=True, eq=False)
class Mesh:
    """A block outline divided into zones.

    points: coordinates, one row a grid-point; the first rows are the corners as given, bit for bit.
    zones: three row numbers of `points` each, clockwise. If paired, rows 2i and 2i + 1 are a pair.
    ring: row numbers of the points on the outline, clockwise, beginning with the first corner.
    """

    points: Floats
    zones: Ints
    ring: Ints

    @property
    def angles(self) -> Floats:
        """The least angle of each zone, degrees."""
        lengths = np.sort(sides(self.points, self.zones), axis=1)
        sine = 2 * areas(self.points, self.zones) / (lengths[:, 1] * lengths[:, 2])
        return np.asarray(np.degrees(np.arcsin(np.minimum(sine, 1))))

    @property
    def sharpest(self) -> tuple[float, float, float]:
        """The least angle of any zone, degrees, and x and y of the centroid of that zone."""
        k = int(self.angles.argmin())
        x, y = self.points[self.zones[k]].mean(axis=0).tolist()
        return float(self.angles[k]), x, y


def mesh(corners: ArrayLike, edge: float, paired: bool = True, real: type = np.float64) -> Mesh:
    """Divide the outline with the given corners (clockwise, m) into zones with sides of about `edge` (m).

    paired: zones are made into pairs. real: type of the coordinates. Error 23 without the package pythoncdt,
    28 for an unsuitable edge or outline.
    """
    given = _checked(corners, edge)
    parts = divisions(np.linalg.norm(following(given) - given, axis=1) / edge, even=paired)
    outline = divide(given, parts)
    b = len(outline)
    unit = min(edge, float(np.ptp(given, axis=0).max()))  # keeps numbers from becoming too small
    local = (outline - given[0]) / unit
    if not closed(zones := triangulate(local, b), b):
        raise UdecError(28, "the outline touches or crosses itself", "no block can have such an outline")
    if unit == edge:
        local = fill(np.vstack([local, lattice(local, parts)]), b)
        local, zones = relax(local, np.arange(b))
    points, ring = np.vstack([outline, given[0] + unit * local[b:]]), np.arange(b)
    if paired:
        points, zones, ring = pair_up(points, zones, b)
        if len(ring) > b:  # there are new points on the outline
            points, zones = relax(points, ring, zones)
    points = points.astype(real).astype(np.float64)
    if not (areas(points, zones) > 0).all():
        advice = "use a longer edge, put the origin nearer to the block, or use a --build with 64-bit reals"
        detail = "zones are too small for the precision of their coordinates"
        raise UdecError(28, detail, advice, parameter="edge")
    return _corners_first(points, zones, ring, np.concatenate([[0], np.cumsum(parts[:-1])]))


def _checked(corners: ArrayLike, edge: float) -> Floats:
    """The corners as an array. Error 28 for an unsuitable edge or outline, or too many zones."""
    given = np.array(corners, dtype=np.float64)
    if not edge > 0 or not np.isfinite(edge):
        raise UdecError(28, f"the edge of a zone must be positive, it is {edge:g}", parameter="edge")
    if given.ndim != 2 or given.shape[0] < 3 or given.shape[1] != 2 or not np.isfinite(given).all():
        raise UdecError(28, "an outline must have three corners or more, with finite coordinates")
    x, y = (given - given[0]).T
    area = 0.5 * float((following(x) * y - x * following(y)).sum())
    if not area > 0:
        raise UdecError(28, "the corners must run clockwise and enclose an area")
    round_it = float(np.linalg.norm(following(given) - given, axis=1).sum())
    zones = area / EQUILATERAL / edge / edge + round_it / edge
    if zones > MAX_ZONES:
        smallest_edge = max((2 * area / (EQUILATERAL * MAX_ZONES)) ** 0.5, 2 * round_it / MAX_ZONES)
        detail = f"zones with an edge of {edge:g} would be {zones:.2g} in number, over {MAX_ZONES:.0g}"
        raise UdecError(28, detail, f"take an edge of {smallest_edge:.1g} or more", parameter="edge")
    return given


def divisions(lengths: Floats, even: bool) -> Ints:
    """The number of parts of each edge, so that the parts are about 1 long.

    even: the sum is even; if it were odd, the edge whose parts are then nearest to 1 gets one more or less.
    """
    parts = np.maximum(np.rint(lengths), 1).astype(np.int64)
    if even and parts.sum() % 2:
        more = np.abs(np.log(lengths / (parts + 1)))
        fewer = np.where(parts > 1, np.abs(np.log(lengths / np.maximum(parts - 1, 1))), np.inf)
        k = int(np.argmin(np.minimum(more, fewer)))
        parts[k] += 1 if more[k] <= fewer[k] else -1
    return parts


def divide(corners: Floats, parts: Ints) -> Floats:
    """The outline with edge k divided into parts[k] equal parts.

    Points are calculated from the nearer end, the middle from both, so that the direction does not matter.
    """
    k = np.repeat(np.arange(len(parts)), parts)
    number = (np.arange(len(k)) - np.repeat(np.cumsum(parts) - parts, parts))[:, None]
    all_parts, a, b = parts[k][:, None], corners[k], following(corners)[k]
    from_a = a + (b - a) * (number / all_parts)
    from_b = b + (a - b) * ((all_parts - number) / all_parts)
    at_end = np.where(2 * number > all_parts, from_b, (a + b) / 2)
    return np.asarray(np.where(2 * number < all_parts, from_a, at_end))


def closed(zones: Ints, b: int) -> bool:
    """True if the zones of the first `b` points fill exactly their outline."""
    if len(zones) != b - 2:
        return False
    start, end = zones.ravel(), np.roll(zones, -1, axis=1).ravel()
    return np.array_equal(np.sort(start[end == (start + 1) % b]), np.arange(b))


def _corners_first(points: Floats, zones: Ints, ring: Ints, corners: Ints) -> Mesh:
    """The mesh with its points in the order: corners, other points of the outline, points inside."""
    old = np.concatenate([corners, ring[~np.isin(ring, corners)]])
    old = np.concatenate([old, np.setdiff1d(np.arange(len(points)), old)])
    new = np.empty_like(old)
    new[old] = np.arange(len(old))
    return Mesh(points[old], new[zones], new[ring])


# ---- Zones made into pairs with a common side: a perfect matching, for mixed discretisation

ALONE, CUT = -1, -2  # instead of a partner
ENOUGH = 100_000  # zones of a search after which a cut is accepted


def pair_up(points: Floats, zones: Ints, b: int) -> tuple[Floats, Ints, Ints]:
    """Points, zones and ring of a mesh with `b` points on its outline and an even number of zones.

    Zones 2i and 2i + 1 of the result are a pair. A zone without a partner is cut in two.
    """
    outer, middles, halves = _halves(points, zones)
    order = np.argsort(shapes(np.vstack([points, middles]), halves).reshape(-1, 2).min(axis=1), kind="stable")
    best = np.full(len(zones), -1)
    best[outer[order] // 3] = order  # of two sides on the outline the better one
    rank = np.full(len(outer), -1)
    rank[order] = np.arange(len(order))
    partner = np.array(match(_neighbours(points, zones), np.where(best < 0, -1, rank[best]).tolist()))
    first = np.flatnonzero(partner > np.arange(len(zones)))
    pairs = np.stack([zones[first], zones[partner[first]]], axis=1).reshape(-1, 3)
    cut = best[partner == CUT]
    name = np.full(len(points) + len(middles), -1)
    name[: len(points)] = np.arange(len(points))
    name[len(points) + cut] = len(points) + np.arange(len(cut))
    return (
        np.vstack([points, middles[cut]]),
        np.vstack([pairs, name[halves.reshape(-1, 2, 3)[cut]].reshape(-1, 3)]),
        np.insert(np.arange(b), zones.ravel()[outer[cut]] + 1, len(points) + np.arange(len(cut))),
    )


def _halves(points: Floats, zones: Ints) -> tuple[Ints, Floats, Ints]:
    """The sides on the outline, their middles, and the two halves of a zone that is cut from the middle.

    Middles are numbered after the points.
    """
    outer = np.setdiff1d(np.arange(zones.size), np.concatenate(common_sides(zones)))
    a, b, opposite = (np.roll(zones, -k, axis=1).ravel()[outer] for k in range(3))
    middle = len(points) + np.arange(len(outer))
    halves = np.stack([a, middle, opposite, middle, b, opposite], axis=1).reshape(-1, 3)
    return outer, (points[a] + points[b]) / 2, halves


def _neighbours(points: Floats, zones: Ints) -> list[list[int]]:
    """The neighbours of each zone, in order of decreasing common sides."""
    one, other = common_sides(zones)
    order = np.argsort(-sides(points, zones).ravel()[one], kind="stable")
    neighbours: list[list[int]] = [[] for _ in zones]
    for t, u in zip((one[order] // 3).tolist(), (other[order] // 3).tolist(), strict=True):
        neighbours[t].append(u)
        neighbours[u].append(t)
    return neighbours


def match(neighbours: list[list[int]], price: list[int]) -> list[int]:
    """The partner of each zone, or CUT. Zones of a high price are cut first, those below 0 never."""
    partner = [ALONE] * len(neighbours)
    _take(neighbours, partner)
    for t in range(len(partner)):
        if partner[t] == ALONE:
            _Search(neighbours, price, partner, t).run()
    return partner


def _take(neighbours: list[list[int]], partner: list[int]) -> None:
    """Join free neighbours while there are any, beginning with zones that have only one free neighbour."""
    waiting = list(reversed(range(len(partner))))
    waiting += [t for t in waiting if len(neighbours[t]) == 1]
    while waiting:
        t = waiting.pop()
        free = [u for u in neighbours[t] if partner[u] == ALONE]
        if partner[t] != ALONE or not free:
            continue
        u = free[0]
        partner[t], partner[u] = u, t
        for v in neighbours[t] + neighbours[u]:
            if partner[v] == ALONE and [partner[w] for w in neighbours[v]].count(ALONE) == 1:
                waiting.append(v)


class _Search:
    """A search for an alternating path from one zone without a partner (Edmonds).

    A zone reached from its partner is *outer*: it can lose its partner. A zone reached from an outer one is
    *inner* until a circle makes it outer, too. came: the path back. base: the base of the circle of each
    outer zone.
    """

    def __init__(self, neighbours: list[list[int]], price: list[int], partner: list[int], root: int) -> None:
        self.neighbours, self.price, self.partner, self.root = neighbours, price, partner, root
        self.came: dict[int, int] = {}
        self.base = {root: root}
        self.queue = deque([root])
        self.best = root  # the outer zone to cut

    def run(self) -> None:
        """Give the root a partner, or cut a zone if there is no path."""
        while self.queue:
            t = self.queue.popleft()
            for u in self.neighbours[t]:
                if u in self.base:
                    if self._top(t) != self._top(u):
                        common = self._common(t, u)
                        self._shrink(t, u, common)
                        self._shrink(u, t, common)
                elif u not in self.came:
                    self.came[u] = t
                    if self.partner[u] < 0:
                        return self._exchange(u)
                    self._reach(self.partner[u])
            if len(self.base) > ENOUGH and self.price[self.best] >= 0:
                break
        given = self.partner[self.best]
        self.partner[self.best] = CUT
        if self.best != self.root:
            self._exchange(given)

    def _reach(self, t: int) -> None:
        self.base[t] = t
        self.queue.append(t)
        if self.price[t] > self.price[self.best]:
            self.best = t

    def _top(self, t: int) -> int:
        while self.base[t] != t:
            self.base[t] = t = self.base[self.base[t]]
        return t

    def _common(self, t: int, u: int) -> int:
        """The zone where the paths back from two outer zones meet."""
        passed: set[int] = set()
        while True:
            if t >= 0:
                t = self._top(t)
                if t in passed:
                    return t
                passed.add(t)
                t = self.came[self.partner[t]] if t != self.root else ALONE
            t, u = u, t

    def _shrink(self, t: int, u: int, common: int) -> None:
        """Make all zones on the path back from t outer; their path back may then lead over u."""
        while self._top(t) != common:
            self.came[t] = u
            u = self.partner[t]
            if u not in self.base:
                self._reach(u)
            for v in (t, u):
                if self.base[v] == v:
                    self.base[v] = common
            t = self.came[u]

    def _exchange(self, u: int) -> None:
        """Exchange the partners along the path back from u."""
        while u >= 0:
            t = self.came[u]
            self.partner[u], self.partner[t], u = t, u, self.partner[t]
