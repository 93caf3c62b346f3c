"""A model that is watched from outside: after every cycle its bodies are compared with what its contacts say.

What is looked at are corners, the rounding length and contacts, through the tables of the model; what they
ought to be is for naive.overlaps. Everything that is done is noted, so that a scene that fails can be printed
as a few lines of Python.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain, combinations
from typing import Any

import numpy as np
from naive.overlaps import (
    Body,
    bare,
    deeper,
    deepest,
    depth,
    outlines,
    parts,
    polygons,
    steps_of,
    touching,
    within,
)
from shapely.geometry import Polygon

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget
from udec_ia.layout import offsets as g
from udec_ia.model import Model

LIMIT = 0.05  # of the rounding length: an overlap that needs a contact
SLACK = 0.02  # of the rounding length: what the chords of the outlines may add to the greatest overlap
LATE = 100  # cycles after which error 15 has nothing to do with an overlap
VIRTUAL = 4
OVERLAP = 15
FATAL = (14, 15, 32, 35, 36)  # a CYCLE that they end leaves blocks deeper in each other than they may be


Pair = frozenset[int]  # of the addresses of two blocks


class Wrong(AssertionError):
    """What the program claims is not so: `kind` of failure, and what was seen."""

    def __init__(self, kind: str, detail: str) -> None:
        super().__init__(f"{kind}: {detail}")
        self.kind, self.detail = kind, detail


class Over(Exception):
    """A numbered error has ended the scene."""

    def __init__(self, number: int) -> None:
        super().__init__(f"error {number}")
        self.number = number


class WatchedModel:
    """A model on which a scene is played: every command through `do`, every cycle through `cycle`."""

    def __init__(self, build: str = "i32r64", model: Model | None = None) -> None:
        self.model = model or Model(build)
        self.calls: list[str] = []
        self.build = build
        self.errors: Counter[int] = Counter()
        self.cycles = 0
        self.fastest = 0.0  # greatest relative displacement of two bodies in one step, in rounding lengths
        self.stopped = np.inf  # depth, in rounding lengths, of what error 15 stopped
        self.touched = -np.inf  # number of the last cycle in which outlines overlapped at all
        self._rings: dict[int, Any] = {}  # addresses of the corners of each block, clockwise

    # ---- what is done

    def do(self, name: str, *numbers: Any, **words: Any) -> Any:
        """Call a method of the model and note the call; None if it ends in a numbered error."""
        given = [*map(repr, numbers), *(f"{word}={value!r}" for word, value in words.items())]
        call = f"m.{name}({', '.join(given)})"
        self._rings = {}
        try:
            answer = getattr(self.model, name)(*numbers, **words)
        except UdecError as error:
            self.errors[error.number] += 1
            self.calls.append(f"# error {error.number}: {call}")
            return None
        self.calls.append(call)
        return True if answer is None else answer

    def throw(self, ib: int, vx: float, vy: float, spin: float) -> None:
        """Give a free block velocities, by RSET."""
        which = self.model.array.scheme.ratio >> 1
        for offset, value in zip((g.KXD, g.KYD, g.KTD), (vx, vy, spin), strict=True):
            self.do("rset", value, ib, offset[which])

    def run(self, deck: str) -> None:
        """Run the lines of a deck, every cycle looked at."""
        for line in deck.split("\n"):
            words = line.split()
            if words[:1] == ["CYCLE"] and words[1] != "0":
                self.cycle(int(words[1]))
            elif words:
                self._rings = {}
                self.model.run(line)

    def cycle(self, n: int, step: int = 1) -> None:
        """`n` cycles, looked at after every `step` of them; within the step, too, if that is one cycle.

        Raises Wrong, or Over if an error ends the run.
        """
        before = self.bodies()
        for done in range(0, n, step):
            k = min(step, n - done)
            self._note_cycles(k)
            try:
                self.model.cycle(k)
            except UdecError as error:
                self.errors[error.number] += 1
                if error.number == OVERLAP:
                    self._justified(before if k == 1 else None)
                raise Over(error.number) from None
            self.cycles += k
            after = self.bodies()
            self._look(before if k == 1 else None, after)
            before = after

    def check(self) -> None:
        """The checker finds nothing."""
        found = self.model.check()
        if found:
            raise Wrong("unsound", f"{found[0]}")

    def _note_cycles(self, k: int) -> None:
        """Note `k` cycles, in one line with those just before."""
        head = "m.cycle("
        if self.calls and self.calls[-1].startswith(head):
            k += int(self.calls.pop()[len(head) : -1])
        self.calls.append(f"{head}{k})")

    @property
    def snippet(self) -> str:
        """The scene as a few lines of Python."""
        return "\n".join(["from udec_ia import Model", f'm = Model("{self.build}")', *self.calls])

    # ---- what is seen

    @property
    def d(self) -> float:
        """The rounding length."""
        return float(self.model.h.cr[g.DTOL])

    @property
    def step(self) -> float:
        """The time-step."""
        return float(self.model.h.cr[g.TDEL])

    def rings(self) -> dict[int, Any]:
        """Addresses of the corners of every block, clockwise, by the block's address."""
        if not self._rings:
            h, ib = self.model.h, int(self.model.h.ci[g.IBPNT])
            while ib:
                first = here = iget(h, ib, g.KP)
                ring = [first]
                while (here := iget(h, here, g.KR)) != first:
                    ring.append(here)
                self._rings[ib] = np.array(ring[::-1])
                ib = iget(h, ib, g.KB)
        return self._rings

    def bodies(self) -> dict[int, Body]:
        """The bodies as they are now, by the addresses of their blocks."""
        corners, plain = self._read(g.KXP, g.KYP), self._read(g.KRAD)[:, 0] == 0
        return {ib: Body(corners[part], plain[part]) for ib, part in self._parts()}

    def _read(self, *offsets: Any) -> Any:
        """Reals of all corners, as 64-bit numbers: one row a corner, ring by ring, a column an offset."""
        h, addresses = self.model.h, np.concatenate(list(self.rings().values()))
        return np.stack([np.asarray(getr(h, addresses, offset), float) for offset in offsets], axis=1)

    def _parts(self) -> Iterator[tuple[int, slice]]:
        """Each block and the rows of its corners in what _read gives."""
        start = 0
        for ib, ring in self.rings().items():
            yield ib, slice(start, start + len(ring))
            start += len(ring)

    def centroid(self, ib: int) -> Any:
        """Centroid of a block."""
        return np.array([getr(self.model.h, ib, g.KX), getr(self.model.h, ib, g.KY)], dtype=float)

    def contacts(self) -> dict[Pair, Any]:
        """Contacts that are not virtual, by their two blocks: (x, y, overlap), arrays (n, 3)."""
        rows = self.model.table("contact")
        rows = rows[rows["KCCOD"] != VIRTUAL]
        pairs = np.sort(np.stack([rows["KB1"], rows["KB2"]], axis=1), axis=1)
        numbers = np.stack([rows["KXC"], rows["KYC"], rows["KCN"]], axis=1).astype(float)
        found: dict[Pair, list[Any]] = {}
        for pair, row in zip(map(frozenset, pairs.tolist()), numbers, strict=True):
            found.setdefault(pair, []).append(row)
        return {pair: np.array(rows) for pair, rows in found.items()}

    def _look(self, before: dict[int, Body] | None, after: dict[int, Body]) -> None:
        """No two bodies overlap without a contact, none lie deeper than may be, none went through another."""
        d, addresses = self.d, list(after)
        fast = before is not None and self._fast(before, after)
        contacts = self.contacts()
        limits = self._limits()
        pressed = [pair for pair, rows in contacts.items() if rows[:, 2].max() > limits[0]]
        close = [(addresses[i], addresses[j]) for i, j in self._close(list(after.values()))]
        looked_at = sorted(set(chain(*close, *pressed)))
        shapes = dict(zip(looked_at, outlines([after[ib] for ib in looked_at], d), strict=True))
        for pair in pressed:
            one, two = pair
            if not shapes[one].intersects(shapes[two]):
                gap, most = shapes[one].distance(shapes[two]) / d, contacts[pair][:, 2].max() / d
                where = f"blocks {one} and {two} are {gap:.3f} D apart"
                raise Wrong("phantom", f"{where}, and a contact of theirs overlaps by {most:.3f} D")
        rows = {ib: row for row, ib in enumerate(looked_at)}
        deep = deeper(list(shapes.values()), [(rows[one], rows[two]) for one, two in close], LIMIT * d)
        for (one, two), is_deep in zip(close, deep, strict=True):
            if is_deep:
                self._look_at(one, two, (shapes[one], shapes[two]), contacts, limits)
            elif len(after) == 2 and shapes[one].intersects(shapes[two]):
                self.touched = self.cycles
        if before is not None and fast:
            for one, two in combinations(addresses, 2):
                if frozenset((one, two)) not in contacts:
                    self._crossed(one, two, before, after, limits[1])

    def _close(self, bodies: list[Body]) -> list[tuple[int, int]]:
        """Rows of the pairs that may overlap; of more than two bodies only those that may do so deeply."""
        pairs = touching(bodies)
        if len(bodies) == 2 or not pairs:
            return pairs
        deep = deeper(polygons(bodies), pairs, LIMIT * self.d)  # rounded they do not lie deeper
        return [pair for pair, is_deep in zip(pairs, deep, strict=True) if is_deep]

    def _look_at(
        self,
        one: int,
        two: int,
        shapes: tuple[Polygon, Polygon],
        contacts: dict[Pair, Any],
        limits: tuple[float, float],
    ) -> None:
        """Look at two outlines that may lie deep in each other."""
        self.touched = self.cycles
        d, here = self.d, contacts.get(frozenset((one, two)), np.zeros((0, 3)))
        for part in parts(*shapes, d):
            if part.depth <= limits[0]:
                break
            where = f"blocks {one} and {two} overlap by {part.depth / d:.3f} D at {part.place}"
            if bare(part, here[:, :2], d):
                raise Wrong("bare", f"{where} without a contact there ({len(here)} elsewhere)")
            if part.depth > limits[1]:
                told = ", ".join(f"{overlap / d:.3f}" for overlap in here[:, 2])
                raise Wrong("deep", f"{where} without error 15; overlaps of its contacts: {told} D")

    def _limits(self) -> tuple[float, float]:
        """Overlaps above which there must be a contact, and error 15."""
        noise = self._noise()
        return LIMIT * self.d + noise, float(self.model.h.cr[g.DTOL2]) + SLACK * self.d + noise

    def _noise(self) -> float:
        """What rounding may add to an overlap."""
        h = self.model.h
        size = float(np.abs(self._read(g.KXP, g.KYP)).max())
        return 16 * size * float(np.finfo(h.cr.dtype).eps) * float(np.sqrt(1.0 + h.ci[g.MCTOT]))

    def _fast(self, before: dict[int, Body], after: dict[int, Body]) -> bool:
        """Whether two bodies may have moved past each other by more than half a rounding length."""
        moves = [after[ib].corners - before[ib].corners for ib in after]
        low = np.array([move.min(axis=0) for move in moves])
        high = np.array([move.max(axis=0) for move in moves])
        relative = float(np.hypot(*(high.max(axis=0) - low.min(axis=0)))) / self.d
        self.fastest = max(self.fastest, relative)
        return relative > 0.5

    def _crossed(
        self, one: int, two: int, before: dict[int, Body], after: dict[int, Body], most: float
    ) -> None:
        """Two bodies that did not touch before and do not now have not been deep in each other in between."""
        d = self.d
        start, end = [before[one], before[two]], [after[one], after[two]]
        moved = steps_of([b.corners for b in start], [b.corners for b in end], d) * d / 10
        first, second = (Polygon(body.corners) for body in start)
        if first.distance(second) > moved:
            return
        for first, second in within(start, end, d):
            if not first.intersects(second):
                continue
            reached = depth(first, second, d)
            if reached > most:
                raise Wrong(
                    "through", f"blocks {one} and {two} were {reached / d:.2f} D deep within the step"
                )

    def _justified(self, before: dict[int, Body] | None) -> None:
        """Error 15 has a reason: two bodies that lie deep in each other, or did so in the last step."""
        after = self.bodies()
        if before is None or all(np.array_equal(before[ib].corners, after[ib].corners) for ib in after):
            before, after = self._moved(after, -1.0), self._moved(after, 1.0)
        reached = 0.0
        for finer in (1, 20):  # what went by on a curve may have been deepest between two sub-steps
            if reached < LIMIT * self.d - self._noise():
                reached = max(
                    deepest([before[one], before[two]], [after[one], after[two]], self.d, finer)
                    for one, two in self._near(before, after)
                )
        self.stopped = reached / self.d
        if reached < LIMIT * self.d - self._noise():
            kind = "late alarm" if self.cycles - self.touched < LATE else "false alarm"
            raise Wrong(kind, f"error 15, and the deepest overlap in the step is {reached / self.d:.3f} D")

    def _near(self, before: dict[int, Body], after: dict[int, Body]) -> Sequence[tuple[int, int]]:
        """Pairs of blocks whose boxes meet in the step; any pair if none do."""
        low = {ib: np.minimum(before[ib].corners.min(axis=0), after[ib].corners.min(axis=0)) for ib in after}
        high = {ib: np.maximum(before[ib].corners.max(axis=0), after[ib].corners.max(axis=0)) for ib in after}
        pairs = list(combinations(after, 2))
        found = [(i, j) for i, j in pairs if (low[i] <= high[j]).all() and (low[j] <= high[i]).all()]
        return found or pairs[:1]

    def _moved(self, bodies: dict[int, Body], t: float) -> dict[int, Body]:
        """The bodies `t` steps away, with the velocities of their corners."""
        moves = t * self.step * self._read(g.KXDP, g.KYDP)
        return {ib: Body(bodies[ib].corners + moves[part], bodies[ib].plain) for ib, part in self._parts()}
