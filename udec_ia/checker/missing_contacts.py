"""Invariant 8: no two blocks overlap or touch without a contact between them.

Every point where the outlines of two blocks meet, an arc with an edge or with another arc, needs a contact of
the two nearby; nearer to it than FTOL there is never a second one. A blunt arc that touches by one end may
come to touch by the other, or by the edge beside it: until its domain is updated, that is for an overlap of
up to ETOL, one contact stands for both.

Outlines meet if they do so to the rounding of one calculation; a gap wider than GTOL never counts. A narrower
gap, or an overlap of up to FTOL, needs no contact if a third block stands in it: deeper than the tips are
thick, or with a tip between them that is thinner than the overlaps on its two sides. Two blocks that press on
such a tip overlap by what these overlaps exceed its thickness: its contacts carry their force.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import cached_property
from math import hypot, isqrt

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_places import Touches
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.kernels.audit.outline_arrays import Outlines, in_rounded
from udec_ia.kernels.audit.outline_intersections import EDGE, intersections_without_contact, mark_crossing
from udec_ia.reader.field_reading import HOSTS, Numbers, kernel_rows

CHUNK = 100_000  # pairs of blocks looked at together
AROUND = 8  # directions in which it is looked whether a block holds a point
LONELY_MEETINGS, CROSSING = (
    InterpretWhenSmall(intersections_without_contact, 1.7e4),
    InterpretWhenSmall(mark_crossing, 2e4),
)  # pairs


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

    def contacts(self, one: Numbers, two: Numbers) -> Numbers:
        """The first contact of each pair of blocks, and how many it has: two columns."""
        key = self._key(one, two)
        at = np.searchsorted(self.known[:-1], key)  # the last place is for all that come after the others
        if not len(self.known):
            return np.zeros((len(key), 2), np.int64)
        return np.column_stack((self.first[at], np.where(self.known[at] == key, self.many[at], 0)))

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
    for pairs in _close_blocks(o):
        contacts = joined.contacts(*pairs.T)
        _check_meetings(state, o, joined, pairs, contacts)
        unjoined = pairs[contacts[:, 1] == 0]
        cross = np.zeros(len(unjoined), bool)
        CROSSING(len(unjoined), o, unjoined, cross)
        for one, two in unjoined[cross].tolist():
            if not _thin_tips(state, o, joined, one, two):
                pair = f"block@{o.block[one]} and block@{o.block[two]}"
                state.report(8, f"{pair} overlap, but there is no contact between them")


def _check_meetings(state: State, o: Outlines, joined: Joined, pairs: Numbers, contacts: Numbers) -> None:
    """A violation for each meeting of an arc with an edge or an arc that has no contact near it."""
    near, late = state.tolerance("DTOL") + state.tolerance("FTOL"), state.tolerance("ETOL")
    rows = kernel_rows(LONELY_MEETINGS, len(pairs), 6, o, pairs, contacts, joined.point, near, late, of=float)
    for (arc, other, what), (x, y, overlap) in zip(
        rows[:, :3].astype(int).tolist(), rows[:, 3:].tolist(), strict=True
    ):
        one, two, point = int(o.owner[arc]), int(o.owner[other]), np.array((x, y))
        if any(
            hypot(x - u, y - v) <= near + overlap and overlap <= excess + state.tolerance("FTOL")
            for u, v, excess in _thin_tips(state, o, joined, one, two)
        ):
            continue
        reach = max(-overlap / 2, 0.0) + o.fine[one]
        if overlap > state.tolerance("FTOL") or not (
            _tip_at(o, point, reach, state.tolerance("BTOL"), (one, two))
            or _lies_in_third(o, point, state.tolerance("FTOL") / 2, (one, two))
        ):
            pair = f"block@{o.block[one]} and block@{o.block[two]} overlap by {overlap} at ({x}, {y})"
            segment = f"the {'edge' if what == EDGE else 'arc'} of corner@{o.corner[other]}"
            state.report(
                8, f"{pair}, without a contact where the arc of corner@{o.corner[arc]} meets {segment}"
            )


def _tip_at(o: Outlines, point: Numbers, reach: float, width: float, hosts: tuple[int, int]) -> bool:
    """True if a corner of a third block, rounded to less than `width`, comes within `reach` of `point`."""
    tip = np.flatnonzero((o.r > 0) & (2 * o.r < width) & ~np.isin(o.owner, hosts))
    edge = np.concatenate((tip, o.after[tip]))
    start = o.p.take(o.before[edge], 0)
    from_start, to_end = (np.where(o.r[k] > 0, o.d, 0.0) for k in (o.before[edge], edge))
    along = ((point - start) * o.t.take(edge, 0)).sum(axis=1)
    along = np.clip(along, from_start, o.z[edge] - to_end)
    from_edge = point - start - along[:, None] * o.t.take(edge, 0)
    near_arc = np.hypot(*(point - o.c.take(tip, 0)).T) <= o.r[tip] + reach
    return bool(near_arc.any() or (np.hypot(*from_edge.T) <= reach).any())


def _lies_in_third(o: Outlines, point: Numbers, depth: float, hosts: tuple[int, int]) -> bool:
    """True if a third block holds all around `point` to `depth`: no contact is made there by the program."""
    near = np.flatnonzero(((o.low <= point) & (point <= o.high)).all(axis=1))
    thirds = near[~np.isin(near, hosts)]
    angles = np.arange(AROUND) * (2 * np.pi / AROUND)
    around = (point + depth * np.column_stack((np.cos(angles), np.sin(angles)))).tolist()
    return any(all(in_rounded(o, third, x, y) for x, y in around) for third in thirds.tolist())


def _thin_tips(
    state: State, o: Outlines, joined: Joined, one: int, two: int
) -> list[tuple[float, float, float]]:
    """Contacts of block `one` with the tips of third blocks that are thinner than both overlaps together.

    Places, and by what the overlaps exceed the thickness of the tip between the two contacts. Behind the
    circle at its end a tip becomes thicker as a wedge does.
    """
    found = []
    near = state.tolerance("DTOL")
    thirds = {block for pair in joined.points if one in pair for block in pair} - {one, two}
    for third in thirds & {block for pair in joined.points if two in pair for block in pair}:
        tips = np.flatnonzero((o.owner == third) & (o.r > 0))
        centre, axis = o.c.take(tips, 0), o.c.take(tips, 0) - o.p.take(tips, 0)
        length = np.hypot(*axis.T)
        for x, y, overlap in joined.points[min(one, third), max(one, third)]:
            for u, v, depth in joined.points[min(two, third), max(two, third)]:
                middle = np.array((x + u, y + v)) / 2
                behind = np.maximum(((middle - centre) * axis).sum(axis=1) / length, 0.0)
                excess = overlap + depth - 2 * o.r[tips] * (1 + behind / length)
                thin = (np.hypot(*(centre - middle).T) <= near + behind) & (excess > 0)
                if hypot(x - u, y - v) <= near and thin.any():
                    found.append((x, y, float(excess[thin].max())))
    return found


def ragged(count: Numbers) -> tuple[Numbers, Numbers]:
    """For count = (2, 3): owners (0, 0, 1, 1, 1) and places (0, 1, 0, 1, 2)."""
    owner = np.repeat(np.arange(len(count)), count)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)


def _close_blocks(o: Outlines) -> Iterator[Numbers]:
    """Pairs of blocks (two columns) whose boxes overlap, in chunks: a sweep along x in strips of y.

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
        yield np.column_stack((i[meet], j[meet]))
        first = beyond
