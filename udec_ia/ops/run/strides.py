"""Whether reals are too short for what a cycle moves a body by.

A cycle adds velocity times time-step to a coordinate, and the sum is rounded to the last digit. A body that
goes on at one speed is rounded the same way in each cycle: if a stride is 1.4 digits it goes one, and with
less than half a digit it stands still for ever, however fast its velocity says that it is.

So every thousand cycles and at the end of a run places and velocities are noted. For a body that goes on, or
has not moved at all, the way that its velocities make is known, and what it lacks is what was lost. That must
be what the next cycle would lose, too, times the number of cycles: else it was chance, or the body turned
about in between. Of reals of 64 bits no stride is so short.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.run.bearing import borne, overlap
from udec_ia.ops.run.timestep import kind_of

EVERY = 1000  # cycles from one look to the next, at least
ENOUGH = 200  # cycles, before which nothing is said
SAME = 0.1  # share by which the velocity of a body that goes on may change between two looks
AGREED = 0.2  # share by which the two ways to know what was lost may differ
LOST = 0.004  # of the farthest way, from which on it is said
SHORT = 20  # last digits: a given stride that is shorter is told of, as it may be off by a fortieth
HELD = 4  # last digits: what bears a force may move by as much while springs hold it


class Conditions(NamedTuple):
    """Velocities that conditions give: to what, a block or grid-point, and of which block.

    along, speeds: in x and y, whether it is given, and what, m/s. constant: no signal multiplies it.
    """

    at: Any
    blocks: Any
    along: tuple[Any, Any]
    speeds: tuple[Any, Any]
    constant: Any


def _conditions(h: Memory) -> Conditions:
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    bounds = bounds[integers(h, bounds, g.KUFIX) > 0]
    blocks, points, flags = (integers(h, bounds, k) for k in (g.KUB, g.KUG, g.KUFIX))
    return Conditions(
        np.where(points > 0, points, blocks),
        blocks,
        (flags & g.ALONG_X > 0, flags & g.ALONG_Y > 0),
        (getr(h, bounds, g.KUVX), getr(h, bounds, g.KUVY)),
        integers(h, bounds, g.KUS) == 0,
    )


class Bodies(NamedTuple):
    """Blocks that move as one, and grid-points: addresses, and those of their blocks."""

    at: Any
    blocks: Any
    points: int  # from this one on they are grid-points

    def read(self, h: Memory, of_block: tuple[Any, Any], of_point: tuple[Any, Any]) -> Any:
        """Two fields of all, (n, 2), in reals of the array."""
        found = np.empty((len(self.at), 2), h.cr.dtype)
        for part, fields in ((slice(self.points), of_block), (slice(self.points, None), of_point)):
            for axis, field in enumerate(fields):
                found[part, axis] = getr(h, self.at[part], field)
        return found

    def places(self, h: Memory) -> Any:
        """Coordinates."""
        return self.read(h, (g.KX, g.KY), (g.KXG, g.KYG))

    def velocities(self, h: Memory) -> Any:
        """Velocities of the last half of a cycle, or those that conditions give from now on."""
        found = self.read(h, (g.KXD, g.KYD), (g.KXDG, g.KYDG))
        if h.ci[g.IBNPNT] == 0:
            return found
        conditions, order = _conditions(h), np.argsort(self.at)
        for axis, (along, speeds) in enumerate(zip(conditions.along, conditions.speeds, strict=True)):
            given = along & conditions.constant & np.isin(conditions.at, self.at)
            found[order[np.searchsorted(self.at, conditions.at[given], sorter=order)], axis] = speeds[given]
        return found


def bodies_of(h: Memory) -> Bodies:
    """All that a cycle moves."""
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    blocks = blocks[integers(h, blocks, g.KBFIX) != g.FIXED]
    meshed = blocks[integers(h, blocks, HEAD) == g.MFDEF]
    whole = blocks[integers(h, blocks, HEAD) != g.MFDEF]
    points = [addresses(h, iget(h, iget(h, int(ib), g.KBEX), g.KFG), g.KG) for ib in meshed]
    hosts = [np.full(len(some), ib) for ib, some in zip(meshed, points, strict=True)]
    return Bodies(np.concatenate([whole, *points]), np.concatenate([whole, *hosts]), len(whole))


def given(array: MainArray) -> Iterator[str]:
    """CYCLE: a velocity that BOUNDARY gives, its factor being 1, and that reals of 32 bits cannot follow."""
    h, found = array.h, _conditions(array.h)
    if array.scheme.real_bits > 32 or not len(found.at):
        return
    whole = found.at == found.blocks
    some: Any = np.where(whole, 1, found.at)
    digits = []
    for along, speeds, of_block, of_point in zip(
        found.along, found.speeds, (g.KX, g.KY), (g.KXG, g.KYG), strict=True
    ):
        place = np.where(whole, getr(h, found.blocks, of_block), getr(h, some, of_point))
        stride = np.abs(speeds) * h.cr[g.TDEL]
        with np.errstate(over="ignore"):  # at the origin
            digits.append(np.where(along & (stride > 0), stride / np.spacing(np.abs(place)), np.inf))
    shortest = np.minimum(*digits)
    k = int(shortest.argmin())
    if shortest[k] < SHORT:
        yield (
            f"BOUNDARY moves {kind_of(h, int(found.at[k]))} by {shortest[k]:.2g} last digits of its "
            f"coordinates in a cycle, and with reals of {array.scheme.real_bits} bits it goes whole ones or "
            "none: take reals of 64 bits, a greater FRACTION, or an origin within the model"
        )


class Look(NamedTuple):
    """Places and velocities in a cycle, (n, 2), and what the next cycle would lose of the way.

    turns: angular velocities of the blocks that move as one, rad/s.
    """

    cycle: int
    places: Any
    velocities: Any
    lost: Any
    turns: Any


class Strides:
    """Watches one model, from a CYCLE to the next as long as it has the same bodies."""

    def __init__(self) -> None:
        none = np.zeros(0, np.int64)
        self._bodies = Bodies(none, none, 0)
        self._first: Look | None = None  # None for reals of 64 bits
        self._last: Look | None = None
        self._lost: Any = np.zeros((0, 2))
        self._cycles: Any = np.zeros((0, 2))  # in which so much was lost
        self._turned: Any = np.zeros(0)  # cycles in which blocks turned on at one speed

    def begin(self, array: MainArray) -> None:
        """A run begins, whose time-step is known, with the velocities that commands may have given."""
        if array.scheme.real_bits > 32:
            return
        bodies, last = bodies_of(array.h), self._last
        known = last is not None and last.cycle <= array.h.ci[g.MCTOT]
        self._last = None
        if not known or not np.array_equal(bodies.at, self._bodies.at):
            self._bodies, self._first = bodies, None
            self._lost, self._cycles = (np.zeros((len(bodies.at), 2)) for _ in range(2))
            self._turned = np.zeros(bodies.points)
        if len(bodies.at):
            self._last = self._seen(array.h)
            self._first = self._first or self._last

    def look(self, array: MainArray, every: int = EVERY) -> None:
        """Note where all are, and what was lost since the last time, if that is `every` cycles ago."""
        h, before = array.h, self._last
        if before is None or h.ci[g.MCTOT] < before.cycle + every:
            return
        now = self._seen(h)
        self._last = now
        n = now.cycle - before.cycle
        first = before.velocities + (now.velocities - before.velocities) / n  # a velocity is half a cycle old
        moved = now.places - before.places
        with np.errstate(over="ignore", invalid="ignore"):
            lost = moved - n * float(h.cr[g.TDEL]) * (first + now.velocities) / 2
            thought = n * (before.lost + now.lost) / 2
            fastest = np.maximum(np.abs(before.velocities), np.abs(now.velocities))
            goes_on = (np.abs(now.velocities - before.velocities) < SAME * fastest) | (moved == 0)
            counts = goes_on & (np.abs(lost - thought) < AGREED * np.abs(thought))
        if counts.any():
            counts &= self._free(h, moved)
        self._lost += np.where(counts, lost, 0.0)
        self._cycles += np.where(counts, n, 0)
        self._turned += np.where(np.abs(now.turns - before.turns) < SAME * np.abs(now.turns), n, 0)

    def _seen(self, h: Memory) -> Look:
        """What there is now."""
        x, v, dt = self._bodies.places(h), self._bodies.velocities(h), h.cr[g.TDEL]
        wide, speed = x.astype(float), v.astype(float)
        turns = np.asarray(getr(h, self._bodies.at[: self._bodies.points], g.KTD), float)
        with np.errstate(over="ignore", invalid="ignore"):
            lost = ((x + v * dt) - wide) - speed * float(dt)
        return Look(int(h.ci[g.MCTOT]), wide, speed, lost, turns)

    def told(self, array: MainArray) -> Iterator[str]:
        """A run has ended: which body has gone too far or not far enough by most, if by much."""
        self.look(array, 1)
        first, last, h = self._first, self._last, array.h
        if first is None or last is None or last.cycle - first.cycle < ENOUGH:
            return
        many, moved = last.cycle - first.cycle, last.places - first.places
        lost = np.where(2 * self._cycles > many, self._lost, 0.0)
        k, axis = np.unravel_index(int(np.abs(lost).argmax()), lost.shape)
        way = float(np.hypot(*(moved - lost).T).max())
        if not abs(lost[k, axis]) > LOST * way:
            yield from self._turning(h, many, way)
            return
        gone, digit = moved[k, axis], float(np.spacing(np.abs(self._bodies.places(h)[k, axis])))
        stride = abs(last.velocities[k, axis]) * float(h.cr[g.TDEL])
        yield (
            f"reals of {array.scheme.real_bits} bits are too short for the strides of "
            f"{kind_of(h, int(self._bodies.at[k]))} in {'xy'[axis]}: {stride:.2g} m in a cycle are "
            f"{stride / digit:.2g} last digits of its coordinate, and in {many} cycles it has gone "
            f"{gone:.4g} m instead of {gone - lost[k, axis]:.4g} m; take reals of 64 bits, a greater "
            "FRACTION, or an origin within the model"
        )

    def _turning(self, h: Memory, many: int, way: float) -> Iterator[str]:
        """What is said of a block that turns by few last digits in a cycle. way: the farthest of any body."""
        n, digits = self._bodies.points, np.spacing(np.abs(self._bodies.places(h)).max(axis=1))
        whole, digits = self._bodies.at[:n], digits[:n].astype(float)
        reach = np.asarray(getr(h, whole, g.KBRO), float)
        stride = np.abs(np.asarray(getr(h, whole, g.KTD), float)) * float(h.cr[g.TDEL]) * reach
        free = ~self._held(h)[:n] & (2 * self._turned > many)
        at_worst = np.minimum(stride, digits / 2) * many
        counts = free & (stride < SHORT * digits) & (at_worst > np.maximum(LOST * way, HELD * digits))
        if counts.any():
            k = int(np.where(counts, stride, 0.0).argmax())
            yield (
                f"reals of 32 bits are too short for the strides of block@{whole[k]} as it turns: its "
                f"farthest corner goes {stride[k]:.2g} m in a cycle, {stride[k] / digits[k]:.2g} last "
                "digits, and so whole ones or none, each corner by itself: its shape may change; take reals "
                "of 64 bits, a greater FRACTION, or an origin within the model"
            )

    def _held(self, h: Memory) -> Any:
        """Which bodies springs hold where they are: they bear a force, or a point of theirs is held."""
        conditions, (at, blocks, first) = _conditions(h), self._bodies
        of_points = conditions.blocks[conditions.at != conditions.blocks]
        fixed = blocks[first:][integers(h, at[first:], g.KGFIX) > 0]
        return np.isin(blocks, np.concatenate([borne(h), of_points, fixed]))

    def _free(self, h: Memory, moved: Any) -> Any:
        """Which bodies go where their velocities take them, in x and y.

        A condition says how they move, or springs do not hold them, or they have gone farther than springs
        give, those of a mesh left out.
        """
        conditions, (at, blocks, first) = _conditions(h), self._bodies
        # what a signal moves may be where it was by chance, and its velocity the same
        swings = np.isin(blocks, conditions.blocks[~conditions.constant])
        far = np.hypot(*moved.T) > max(overlap(h), HELD * float(np.spacing(self._bodies.places(h)).max()))
        far[first:] = False
        free = far | ~self._held(h)
        driven = [np.isin(at, conditions.at[along]) for along in conditions.along]
        return np.stack([(free | one) & ~swings for one in driven], axis=1)
