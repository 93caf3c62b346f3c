"""Invariant 8: no two blocks overlap or touch without a contact between them.

Found by brute force from the outlines alone: all pairs of blocks whose boxes overlap, and of these all
pairs of an arc with an edge or another arc. Every point where the outlines meet or penetrate each other
needs a contact of the two blocks nearby; nearer to it than FTOL there is never a second one. A blunt arc that
touches by one end may come to touch by the other, too; until its domain is updated, that is for an overlap of
up to ETOL, the contact that there is stands for both. So it does for what comes to touch the edge beside a
blunt arc, for ETOL along the edge.

Outlines meet if they do so to the rounding of one calculation: the program sees the same coordinates, so what
these have gathered over the cycles does not count; nor does a gap wider than GTOL, however coarse they are.
A gap as narrow as that needs no contact if a third block stands in it, for a contact cannot be there; nor
does an overlap of up to FTOL. The third block may lie in both, deeper than their tips are thick, or have a
tip between them, thinner than the overlaps on its two sides: it hands on the force of the one to the other.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cached_property
from math import hypot, isqrt

import numpy as np

from udec_ia.inspect.check.groups import State
from udec_ia.inspect.check.outlines import Outlines, cross, dot, length
from udec_ia.inspect.check.touches import Touches
from udec_ia.inspect.reading import HOSTS, Numbers
from udec_ia.kernels.geometry.contact_geometry import BLUNT

Sides = Sequence[Numbers] | Numbers  # x and y
Meetings = tuple[Numbers, Numbers, Numbers, Numbers]  # corner of an arc, the other corner, point, overlap

CHUNK = 10_000  # pairs of blocks looked at together
AWRY = 0.5  # sine of the angle up to which the end of an arc that does not face an edge is tested against it
FAR = 3.0  # rounding lengths that a corner is away from an edge at most, where its arc meets the edge
AROUND = 8  # directions in which it is looked whether a block holds a point
AWRY_POINT = 0.2  # the same for a point of an edge: a contact is formed up to an angle of 0.25


class Joined:
    """The real contacts by the pair of blocks that they join; a block is its index in `o.block`."""

    def __init__(self, state: State, o: Outlines, touch: Touches) -> None:
        index = np.full(len(state.address["block"]), -1)
        index[state.rows("block", o.block)] = np.arange(len(o.block))
        one, two = (index[state.rows("block", state.column("contact", name)[touch.row])] for name in HOSTS)
        self.blocks = len(o.block)
        pair = self._key(one, two)
        order = np.argsort(pair, kind="stable")
        self.pair, self.point, self.overlap = pair[order], touch.point.take(order, 0), touch.overlap[order]
        self.known, self.first, self.many = np.unique(self.pair, return_index=True, return_counts=True)

    def _key(self, one: Numbers, two: Numbers) -> Numbers:
        return np.minimum(one, two).astype(np.int64) * self.blocks + np.maximum(one, two)

    def joins(self, one: Numbers, two: Numbers) -> Numbers:
        """True for each pair of blocks with a contact."""
        return self._of_pair(one, two)[1] > 0

    def near(self, one: Numbers, two: Numbers, point: Numbers, reach: Numbers) -> Numbers:
        """True for each pair of blocks with a contact within `reach` of `point`."""
        first, many = self._of_pair(one, two)
        row, place = ragged(many)
        away = length(point.take(row, 0) - self.point.take(first[row] + place, 0))
        return np.bincount(row[away <= reach[row]], minlength=len(many)) > 0

    def _of_pair(self, one: Numbers, two: Numbers) -> tuple[Numbers, Numbers]:
        """The first contact of each pair of blocks, and how many it has."""
        key = self._key(one, two)
        at = np.searchsorted(self.known[:-1], key)  # the last place is for all that come after the others
        if not len(self.known):
            return np.zeros(len(key), np.int64), np.zeros(len(key), np.int64)
        return self.first[at], np.where(self.known[at] == key, self.many[at], 0)

    @cached_property
    def points(self) -> dict[tuple[int, int], list[tuple[float, float, float]]]:
        """Contact points and overlaps by the lesser and the greater block of the pair."""
        found: dict[tuple[int, int], list[tuple[float, float, float]]] = defaultdict(list)
        for pair, (x, y), depth in zip(
            self.pair.tolist(), self.point.tolist(), self.overlap.tolist(), strict=True
        ):
            found[divmod(pair, self.blocks)].append((x, y, depth))
        return found


def check_complete(state: State, o: Outlines, touch: Touches) -> None:
    """Invariant 8."""
    joined = Joined(state, o, touch)
    state.leave_lists()
    reach = Reach(o)
    for a, b in _close_blocks(o):
        i, j = reach.corners(np.concatenate((a, b)), np.concatenate((b, a)))
        for found, what in ((_arc_in_edge(o, i, j), "edge"), (_arc_in_arc(o, i, j), "arc")):
            _check_meetings(state, o, joined, found, what)
        apart = ~joined.joins(a, b)
        for one, two in _crossings(o, a[apart], b[apart]):
            if not _thin_tips(state, o, joined, one, two):
                state.report(
                    8,
                    f"block@{o.block[one]} and block@{o.block[two]} overlap, "
                    "but there is no contact between them",
                )


def _check_meetings(state: State, o: Outlines, joined: Joined, found: Meetings, what: str) -> None:
    """A violation for each meeting of an arc with an edge or an arc that has no contact near it."""
    arc, other, point, depth = found
    near = state.tolerance("DTOL") + state.tolerance("FTOL")
    ones, twos = o.owner[arc], o.owner[other]
    late = (o.r[arc] > BLUNT * o.d) & (depth <= state.tolerance("ETOL"))
    late |= _beside_blunt_arc(o, other, point) <= state.tolerance("ETOL")
    for k in np.flatnonzero(~joined.near(ones, twos, point, near + depth + np.where(late, o.d, 0.0))):
        one, two = int(ones[k]), int(twos[k])
        (x, y), overlap = point[k].tolist(), float(depth[k])
        points = _thin_tips(state, o, joined, one, two) if overlap <= state.tolerance("FTOL") else []
        if any(hypot(x - u, y - v) <= near + overlap for u, v, _ in points):
            continue
        reach = max(-overlap / 2, 0.0) + o.fine[arc[k]]
        if overlap > state.tolerance("FTOL") or not (
            _tip_at(o, point[k], reach, state.tolerance("BTOL"), (one, two))
            or _lies_in_third(o, point[k], state.tolerance("FTOL") / 2, (one, two))
        ):
            state.report(
                8,
                f"block@{o.block[one]} and block@{o.block[two]} overlap by {overlap} at ({x}, {y}), without "
                f"a contact where the arc of corner@{o.corner[arc[k]]} meets the {what} of "
                f"corner@{o.corner[other[k]]}",
            )


def _beside_blunt_arc(o: Outlines, j: Numbers, point: Numbers) -> Numbers:
    """Distance of each point, along the edge of corner j, from a blunt arc at one end; inf without one."""
    found = np.full(len(j), np.inf)
    for corner, end in ((j, -1), (o.before[j], 1)):
        away = np.abs(dot(o.p.take(corner, 0) + end * o.d * o.t.take(j, 0) - point, o.t.take(j, 0)))
        found = np.where(o.r[corner] > BLUNT * o.d, np.minimum(found, away), found)
    return found


def _tip_at(o: Outlines, point: Numbers, reach: float, width: float, hosts: tuple[int, int]) -> bool:
    """True if a corner of a third block, rounded to less than `width`, comes within `reach` of `point`."""
    tip = np.flatnonzero((o.r > 0) & (2 * o.r < width) & ~np.isin(o.owner, hosts))
    edge = np.concatenate((tip, o.after[tip]))
    start = o.p.take(o.before[edge], 0)
    along = np.clip(dot(point - start, o.t.take(edge, 0)), o.start[edge], o.end[edge])
    from_edge = point - start - along[:, None] * o.t.take(edge, 0)
    near_arc = np.hypot(*(point - o.c.take(tip, 0)).T) <= o.r[tip] + reach
    return bool(near_arc.any() or (np.hypot(*from_edge.T) <= reach).any())


def _lies_in_third(o: Outlines, point: Numbers, depth: float, hosts: tuple[int, int]) -> bool:
    """True if the rounded outline of a third block holds `point` and all that is nearer to it than `depth`.

    That is the depth from which on the program makes no contact there (detect/gaps.py).
    """
    near = np.flatnonzero(((o.low <= point) & (point <= o.high)).all(axis=1))
    thirds = near[~np.isin(near, hosts)]
    held = np.ones(len(thirds), bool)
    for angle in np.arange(AROUND) * (2 * np.pi / AROUND):
        beside = point + depth * np.array([np.cos(angle), np.sin(angle)])
        held &= _in_rounded(o, np.repeat(beside[None], len(thirds), axis=0), thirds)
    return bool(held.any())


def _thin_tips(
    state: State, o: Outlines, joined: Joined, one: int, two: int
) -> list[tuple[float, float, float]]:
    """Contacts of block `one` with the tips of third blocks that are thinner than both overlaps together."""
    found = []
    near = state.tolerance("DTOL")
    thirds = {block for pair in joined.points if one in pair for block in pair} - {one, two}
    for third in thirds & {block for pair in joined.points if two in pair for block in pair}:
        tips = np.flatnonzero((o.owner == third) & (o.r > 0))
        for x, y, overlap in joined.points[min(one, third), max(one, third)]:
            for u, v, depth in joined.points[min(two, third), max(two, third)]:
                at = np.hypot(*(o.c.take(tips, 0) - (x, y)).T) <= near
                thin = at & (2 * o.r[tips] < overlap + depth)
                if hypot(x - u, y - v) <= near and thin.any():
                    found.append((x, y, overlap))
    return found


def ragged(count: Numbers) -> tuple[Numbers, Numbers]:
    """For count = (2, 3): owners (0, 0, 1, 1, 1) and places (0, 1, 0, 1, 2)."""
    owner = np.repeat(np.arange(len(count)), count)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)


def _close_blocks(o: Outlines) -> Iterator[tuple[Numbers, Numbers]]:
    """Pairs of blocks (index, index) whose boxes overlap, in chunks: a sweep along x in strips of y.

    A box is swept in every strip that it touches, and a pair counts in the first strip that both touch.
    """
    n = len(o.block)
    bounds = np.sort(o.low[:, 1])[:: isqrt(n)]
    strip, last = (np.searchsorted(bounds, y, side="right") for y in (o.low[:, 1], o.high[:, 1]))
    box, place = ragged(last - strip + 1)
    ranked = np.sort(o.low[:, 0])
    start, end = (np.searchsorted(ranked, x, side="right") for x in (o.low[:, 0], o.high[:, 0]))
    swept = (strip[box] + place) * (n + 1)
    key = swept + start[box]
    order = np.argsort(key, kind="stable")
    key, box, swept = key[order], box[order], swept[order]
    count = np.searchsorted(key, swept + end[box], side="right") - np.arange(len(box)) - 1
    total = np.cumsum(count)
    first = 0
    while first < len(box):
        done = total[first - 1] if first else 0
        beyond = max(int(np.searchsorted(total, done + CHUNK, side="right")), first + 1)
        owner, place = ragged(count[first:beyond])
        i, j = box[first + owner], box[first + owner + 1 + place]
        once = swept[first + owner] == np.maximum(strip[i], strip[j]) * (n + 1)
        meet = once & (o.low[i, 1] <= o.high[j, 1]) & (o.low[j, 1] <= o.high[i, 1])
        yield i[meet], j[meet]
        first = beyond


class Reach:
    """Which corners with an arc can meet which edges: boxes around arcs against those of blocks and edges.

    A point of an arc is at most D away from its corner, another D deep under the edge or beside its end, and
    as much farther along the edge as the arc is awry.
    """

    def __init__(self, o: Outlines) -> None:
        self.o = o
        self.at = [x.copy() for x in o.p.T]
        self.near = o.d + o.slack[o.first]  # of the corners of a block
        self.far = FAR * o.d + o.slack + AWRY * np.abs(o.r)
        self.blocks = [(low.copy(), high.copy()) for low, high in zip(o.low.T, o.high.T, strict=True)]

    def corners(self, a: Numbers, b: Numbers) -> tuple[Numbers, Numbers]:
        """Pairs (corner i of block a, corner j of block b) where i has an arc and is near the edge of j."""
        pair, place = ragged(self.o.count[a])
        i = self.o.first[a][pair] + place
        inside, near = self.o.arc[i], self.near[a]
        for x, (low_of, high_of) in zip(self.at, self.blocks, strict=True):
            low, high = (side[pair] for side in (low_of[b] - near, high_of[b] + near))
            inside &= (x[i] >= low) & (x[i] <= high)
        i, b = i[inside], b[pair[inside]]
        pair, place = ragged(self.o.count[b])
        i, j = i[pair], self.o.first[b][pair] + place
        for x, (low_of, high_of) in zip(self.at, self.o.boxes, strict=True):
            here, far = x[i], self.far[i]
            meet = (here + far >= low_of[j]) & (here - far <= high_of[j])
            i, j = i[meet], j[meet]
        return i, j


def _arc_in_edge(o: Outlines, i: Numbers, j: Numbers) -> Meetings:
    """Arcs of corners i whose point deepest under the edge of corner j is on the edge or in the block.

    The deepest point of an arc that does not face the edge is one of its ends; the centre of a blunt one may
    then be far away along the edge. A point of an edge that does not face it has deeper ones beside it, where
    its own edge goes on.
    """
    along, blunt = dot(o.c.take(i, 0) - o.p.take(o.before[j], 0), o.t.take(j, 0)), o.r[i] > BLUNT * o.d
    keep = blunt | ((along >= o.start[j]) & (along <= o.end[j]))
    keep &= dot(o.normal(j), o.outward(i)) < 0
    i, j, blunt = i[keep], j[keep], blunt[keep]
    inward = -o.normal(j)
    early, late = dot(inward, o.t.take(i, 0)), dot(inward, o.t.take(o.after[i], 0))
    deepest = o.c.take(i, 0) + o.r[i][:, None] * inward
    for ends, along, sign in ((early < 0, i, -1.0), ((early >= 0) & (late > 0), o.after[i], 1.0)):
        k = i[ends]
        reach = sign * np.where(o.pointed[k], 0.0, o.d)[:, None]
        deepest[ends] = o.p.take(k, 0) + reach * o.t.take(along[ends], 0)
    depth, along = (
        dot(deepest - o.p.take(j, 0), inward),
        dot(deepest - o.p.take(o.before[j], 0), o.t.take(j, 0)),
    )
    slack = o.rounding(i, j)
    awry = np.where(o.pointed[i], AWRY_POINT, AWRY)
    keep = ~blunt | ((along >= o.start[j]) & (along <= o.end[j]))
    keep &= (depth >= -o.apart(i, j)) & (depth <= o.d) & (-early <= awry) & (late <= awry)
    i, j, deepest, depth, slack = i[keep], j[keep], deepest.compress(keep, 0), depth[keep], slack[keep]
    keep = depth <= slack
    deep = np.flatnonzero(~keep)
    keep[deep] = _inside(o, deepest.take(deep, 0), o.owner[j[deep]])
    return i[keep], j[keep], deepest.compress(keep, 0), depth[keep]


def _arc_in_arc(o: Outlines, i: Numbers, j: Numbers) -> Meetings:
    """Pairs of arcs that overlap along their line of centres, each facing the other."""
    keep = o.arc[j] & (o.owner[i] < o.owner[j])
    i, j = i[keep], j[keep]
    between = o.c.take(j, 0) - o.c.take(i, 0)
    distance = length(between)
    depth = o.r[i] + o.r[j] - distance
    keep = (depth >= -o.apart(i, j)) & (distance > 0)
    for k, towards in ((i, between), (j, -between)):
        keep &= (dot(towards, o.t.take(k, 0)) >= 0) & (dot(towards, o.t.take(o.after[k], 0)) <= 0)
        keep &= dot(towards, o.outward(k)) > 0
    i, j, depth = i[keep], j[keep], depth[keep]
    towards = between.compress(keep, 0) / distance[keep][:, None]
    return i, j, o.c.take(i, 0) + (o.r[i] - depth / 2)[:, None] * towards, depth


def _inside(o: Outlines, point: Numbers, block: Numbers) -> Numbers:
    """True for each point that lies in the polygon of its block (by the crossings of a ray)."""
    pair, place = ragged(o.count[block])
    j = o.first[block[pair]] + place
    a, b, q = o.p.take(o.before[j], 0), o.p.take(j, 0), point.take(pair, 0)
    spans = (a[:, 1] > q[:, 1]) != (b[:, 1] > q[:, 1])
    left = cross(b - a, q - a) > 0
    crossed = np.bincount(pair[spans & (left == (b[:, 1] > a[:, 1]))], minlength=len(block))
    return np.asarray(crossed % 2 == 1)


def _in_rounded(o: Outlines, point: Numbers, block: Numbers) -> Numbers:
    """True for each point that lies in the rounded outline of its block: the polygon without its tips."""
    pair, place = ragged(o.count[block])
    j = o.first[block[pair]] + place
    here = point.take(pair, 0)
    from_centre = here - o.c.take(j, 0)
    tip = (
        (dot(from_centre, o.t.take(j, 0)) >= 0)
        & (dot(from_centre, o.t.take(o.after[j], 0)) <= 0)
        & (o.r[j] > 0)
    )
    tip &= (length(from_centre) > o.r[j]) & (length(here - o.p.take(j, 0)) <= o.d)
    in_tip = np.bincount(pair[tip], minlength=len(block)) > 0
    return _inside(o, point, block) & ~in_tip


def _crossings(o: Outlines, a: Numbers, b: Numbers) -> list[tuple[int, int]]:
    """Pairs of blocks whose straight edges cross, or of which one has a point of its outline in the other.

    Only what lies in the boxes of both can do so.
    """
    low, high = (
        np.maximum(o.low.take(a, 0), o.low.take(b, 0)),
        np.minimum(o.high.take(a, 0), o.high.take(b, 0)),
    )  # the box that both share

    def corners(block: Numbers) -> tuple[Numbers, Numbers]:
        """Pair and corner for all corners of `block`."""
        pair, place = ragged(o.count[block])
        return pair, o.first[block[pair]] + place

    def meets(pair: Numbers, lowest: Sides, highest: Sides) -> Numbers:
        """True for each box, from the lowest to the highest x and y, that has a part in that of its pair."""
        meet = (lowest[0] <= high[pair, 0]) & (highest[0] >= low[pair, 0])
        return np.asarray(meet & (lowest[1] <= high[pair, 1]) & (highest[1] >= low[pair, 1]))

    bad, edges = [], []
    for inner, outer in ((a, b), (b, a)):
        pair, k = corners(inner)
        meet = meets(pair, *([side[k] for side in sides] for sides in zip(*o.boxes, strict=True)))
        edges.append((pair[meet], k[meet]))
        at = o.p.take(k, 0).T
        meet = meets(pair, at - o.d, at + o.d)  # nothing of an arc is farther from its corner
        pair, points = pair[meet], o.rounded(k[meet])
        for point in (points[:, of_arc] for of_arc in range(3)):
            shared = meets(pair, point.T, point.T)
            bad.append(pair[shared][_in_rounded(o, point[shared], outer[pair[shared]])])
    one, two = edges
    count, first = (np.bincount(two[0], minlength=len(a)), np.searchsorted(two[0], np.arange(len(a))))
    row, place = ragged(count[one[0]])
    pair, i = one[0][row], one[1][row]
    j = two[1][first[pair] + place]
    slack = o.rounding(i, j)
    cut = np.ones(len(pair), bool)
    for k, m in ((i, j), (j, i)):
        normal, corner = o.normal(m), o.p.take(m, 0)
        u, v = (dot(point - corner, normal) for point in o.straight(k))
        cut &= (np.minimum(u, v) < -slack) & (np.maximum(u, v) > slack)
    bad.append(pair[cut])
    return [(int(a[k]), int(b[k])) for k in np.unique(np.concatenate(bad))]
