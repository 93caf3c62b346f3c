"""Zones made into pairs with a common side: a perfect matching, for mixed discretisation.

Zones are the vertices of a graph, common sides its edges. First every zone takes a neighbour that is still
free, zones that have but one left at once (Karp and Sipser). The few zones that stay alone look for an
*alternating path*, over a neighbour to its partner, to that one's neighbour and so on, until it comes to
another zone that is alone: then every zone on the path changes its partner and both have one. Odd circles of
zones on the way are shrunk to one (Edmonds 1965), so that a path is found if there is one.

If there is none, a zone on the outline at the end of such a path is cut in two, from the middle of its side
on the outline to the vertex opposite, and is a pair by itself. That this always does is Petersen's theorem of
1891: glue the mesh to its mirror image along the outline; every zone then has three neighbours, and no common
side alone holds the two parts of the graph together, so all zones of both can be paired. Those of ours that
the theorem pairs with their own image are those to cut.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from udec_ia.ops.mesh.inside import Floats, Ints, common_sides, shapes, sides

ALONE, CUT = -1, -2  # instead of a partner
ENOUGH = 100_000  # zones a search may see before it is content with a cut


def pair_up(points: Floats, zones: Ints, b: int) -> tuple[Floats, Ints, Ints]:
    """Points, zones and the ring of the first `b` points, the zones 2i and 2i + 1 now a pair.

    The number of zones must be even.
    """
    outer, middles, halves = _halves(points, zones)
    order = np.argsort(shapes(np.vstack([points, middles]), halves).reshape(-1, 2).min(axis=1), kind="stable")
    best = np.full(len(zones), -1)
    best[outer[order] // 3] = order  # where a zone has two sides on the outline, the better one
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
    """The sides on the outline, their middles, and the two halves of the zone if it is cut from there.

    A middle is named as if all middles stood behind the points.
    """
    outer = np.setdiff1d(np.arange(zones.size), np.concatenate(common_sides(zones)))
    a, b, opposite = (np.roll(zones, -k, axis=1).ravel()[outer] for k in range(3))
    middle = len(points) + np.arange(len(outer))
    halves = np.stack([a, middle, opposite, middle, b, opposite], axis=1).reshape(-1, 3)
    return outer, (points[a] + points[b]) / 2, halves


def _neighbours(points: Floats, zones: Ints) -> list[list[int]]:
    """The zones that each zone has a side in common with, over its longest side first."""
    one, other = common_sides(zones)
    order = np.argsort(-sides(points, zones).ravel()[one], kind="stable")
    neighbours: list[list[int]] = [[] for _ in zones]
    for t, u in zip((one[order] // 3).tolist(), (other[order] // 3).tolist(), strict=True):
        neighbours[t].append(u)
        neighbours[u].append(t)
    return neighbours


def match(neighbours: list[list[int]], price: list[int]) -> list[int]:
    """The partner of each zone, or CUT. A zone with a price below 0 cannot be cut; high prices are good."""
    partner = [ALONE] * len(neighbours)
    _take(neighbours, partner)
    for t in range(len(partner)):
        if partner[t] == ALONE:
            _Search(neighbours, price, partner, t).run()
    return partner


def _take(neighbours: list[list[int]], partner: list[int]) -> None:
    """Join free neighbours as long as there are any, first the zones that have one free neighbour only."""
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
    """A search for an alternating path from one zone that is alone.

    Reached over a partner, a zone is *outer*: it can be given away. A zone reached from an outer one is
    *inner* until a circle makes it outer too. `came` is the way back; `base` leads outer zones to that
    of the circle they have been shrunk to, and has outer zones only.
    """

    def __init__(self, neighbours: list[list[int]], price: list[int], partner: list[int], root: int) -> None:
        self.neighbours, self.price, self.partner, self.root = neighbours, price, partner, root
        self.came: dict[int, int] = {}
        self.base = {root: root}
        self.queue = deque([root])
        self.best = root  # the outer zone to cut

    def run(self) -> None:
        """Give the root a partner, at the price of a cut if there is no other way."""
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
        """Where the ways back from two outer zones meet."""
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
        """Make all zones on the way back from t outer; from them the way back leads over u, too."""
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
        """Every zone on the way back from u gets another partner."""
        while u >= 0:
            t = self.came[u]
            self.partner[u], self.partner[t], u = t, u, self.partner[t]
