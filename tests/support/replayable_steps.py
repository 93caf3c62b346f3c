"""What is done to a model, kept twice: as steps that can be played again on any other model, and as the
lines of a deck that `udec run` accepts.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from naive.geometry import Outline

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget, putr
from udec_ia.layout.field_table import read_table
from udec_ia.layout.offsets import IBPNT, KB, KP, KR, KTD, KXD, KXP, KYD, KYP
from udec_ia.model import Model

KEYWORDS = {one.argument: one.keyword.upper() for one in read_table().joint_properties}
OF_STRUCTURES = {one.argument: one.keyword.upper() for one in read_table().structural_properties}
ENDS = (14, 15, 32)  # the cycle is completed, the map may be unsound
Numbers = tuple[float, ...]


@dataclass(frozen=True)
class Step:
    """One thing done to a model: a method of Model, or "throw" with the block's place in the block list."""

    name: str
    numbers: Numbers
    words: dict[str, Any] = field(default_factory=dict)


def blocks(model: Model) -> list[int]:
    """Addresses of the blocks, in list order."""
    h, found, ib = model.h, [], int(model.h.ci[IBPNT])
    while ib:
        found.append(ib)
        ib = iget(h, ib, KB)
    return found


def outline(model: Model, ib: int) -> Outline:
    """The corners of block `ib`, clockwise."""
    h, points, first = model.h, [], iget(model.h, ib, KP)
    ip = first
    while True:
        points.append((float(getr(h, ip, KXP)), float(getr(h, ip, KYP))))
        ip = iget(h, ip, KR)
        if ip == first:
            return points[::-1]


def lines_of(model: Model, step: Step) -> list[str]:
    """`step` as lines of a deck. A block is thrown by three RSETs."""
    if step.name == "group":
        return [f"GROUP {' '.join(map(str, step.numbers))}"]
    numbers = " ".join(f"{number:.17g}" for number in step.numbers)
    if step.name == "throw":
        ib, which = blocks(model)[int(step.numbers[0])], model.array.scheme.ratio >> 1
        pairs = zip((KXD, KYD, KTD), step.numbers[1:], strict=True)
        return [f"RSET {value:.17g} {ib} {k[which]}" for k, value in pairs]
    if step.name == "block":
        return [f"BLOCK MATERIAL={step.words.get('material', 1)} {numbers}"]
    if step.name == "property":
        values = " ".join(f"{word.upper()}={value:.17g}" for word, value in step.words.items())
        return [f"PROPERTY MATERIAL={numbers} {values}"]
    if step.name == "jproperty":
        words = {"unit": str.upper, "model": str.upper, "between": lambda pair: "BETWEEN {} {}".format(*pair)}
        values = " ".join(
            words.get(word, lambda value, word=word: f"{KEYWORDS[word]}={value:.17g}")(value)
            for word, value in step.words.items()
        )
        return [f"JPROPERTY JMATERIAL={numbers} {values}"]
    if step.name == "sproperty":
        values = " ".join(f"{OF_STRUCTURES[word]}={value:.17g}" for word, value in step.words.items())
        return [f"SPROPERTY SMATERIAL={numbers} {values}"]
    return [" ".join([step.name.upper(), numbers, *(in_deck(*word) for word in step.words.items())])]


def in_deck(word: str, value: Any) -> str:
    """A word of a step as it stands in a deck."""
    if isinstance(value, str):
        return value.upper()
    if value is True:
        return word.upper()
    if word == "within":
        word = "RANGE"
    return " ".join([word.upper(), *(f"{number:.17g}" for number in np.ravel(value))])


def obey(model: Model, step: Step) -> None:
    """Do `step`. Raises UdecError."""
    if step.name == "throw":
        for k, value in zip((KXD, KYD, KTD), step.numbers[1:], strict=True):
            putr(model.h, blocks(model)[int(step.numbers[0])], k, value)
        return
    numbers = step.numbers
    if step.name in ("cycle", "property", "jproperty", "sproperty", "function"):
        numbers = (int(numbers[0]), *numbers[1:])
    getattr(model, step.name)(*numbers, **step.words)


class Scene:
    """A scene as far as it has been played.

    watch is called after every command and every cycle. errors counts the numbered errors by number.
    ended: one of the errors in ENDS has stopped the scene.
    """

    def __init__(self, model: Model, watch: Callable[[Scene], None] | None = None) -> None:
        self.model = model
        self.steps: list[Step] = []
        self.lines: list[str] = ["START"]
        self.errors: Counter[int] = Counter()
        self.ended = False
        self.watch = watch
        model.start()

    def do(self, name: str, *numbers: float, **words: Any) -> bool:
        """Do a step and note it; False if it ended in a numbered error."""
        if self.ended:
            return False
        step = Step(name, numbers, words)
        lines = lines_of(self.model, step)
        try:
            obey(self.model, step)
        except UdecError as error:
            self.errors[error.number] += 1
            self.lines += [f"* error {error.number}: {line}" for line in lines]
            return False
        self.steps.append(step)
        self.lines += lines
        if self.watch is not None:
            self.watch(self)
        return True

    def cycle(self, n: int) -> None:
        """`n` cycles, watched one by one."""
        done = 0
        while done < n and not self.ended:
            try:
                self.model.cycle(1)
            except UdecError as error:
                self.errors[error.number] += 1
                self.ended = error.number in ENDS
                done += self.ended
                break
            done += 1
            if self.watch is not None:
                self._cycled(done)
        if done:
            self._note_cycles(done)

    def _cycled(self, done: int) -> None:
        """Watch with the cycles done so far among the lines, so that a failure can be replayed."""
        assert self.watch is not None
        self.lines.append(f"CYCLE {done}")
        self.watch(self)
        self.lines.pop()

    def _note_cycles(self, done: int) -> None:
        self.steps.append(Step("cycle", (done,)))
        self.lines.append(f"CYCLE {done}")

    @property
    def deck(self) -> str:
        """The scene as a deck."""
        return "\n".join([*self.lines, "STOP", ""])


def replay(model: Model, steps: list[Step], after: Callable[[Model], Model] | None = None) -> Model:
    """Do `steps` on `model`; after each, `after` may put another model in its place. Returns the last one.

    What ended the scene, always in its last step, ends it here too, and nothing comes after it: an overlap
    may have become too great then.
    """
    model.start()
    for step in steps:
        try:
            obey(model, step)
        except UdecError as error:
            if error.number not in ENDS or step is not steps[-1]:
                raise
            break
        if after is not None:
            model = after(model)
    return model
