"""A run that is watched CYCLE by CYCLE: time-steps, seconds, and where blocks are on the way.

What is found goes to two files in the folder of the run. How a CYCLE is cut into pieces changes no digit of
it.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import thread_time
from typing import Any

import numpy as np

from udec_ia.compiling.compile_time import compile_seconds
from udec_ia.heap.accessors import getr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.running.critical_step import bound, estimate
from udec_ia.running.observer import Observer
from udec_ia.running.stiffness_bound import damped_step
from udec_ia.study.runs import Run

SURVEY, TRACKS = "survey.json", "tracks.npz"
MARKS = 8  # looks at where blocks are, in each CYCLE
REHEARSED = 256  # cycles of a piece of a rehearsal, at most


@dataclass
class Segment:
    """One CYCLE or SOLVE.

    asked, done: cycles. began: time of the model before it (s). step: its time-step (s). fraction: of the
    estimate, or of the bound if `safe`. estimate, bound: critical steps when the time-step was made (s); 0
    if not asked for. scaled: with scaled masses. seconds: of the processor, without compiling. static: the
    deck says SOLVE ... STATIC.
    """

    asked: int
    solve: bool
    began: float
    step: float
    fraction: float
    safe: bool
    estimate: float
    bound: float
    scaled: bool = False
    done: int = 0
    seconds: float = 0.0
    static: bool = False


@dataclass(frozen=True)
class Surveyed(Run):
    """A run that leaves a survey. rehearsed: seconds after which each CYCLE or SOLVE ends, 0 for never.

    limits: ask for estimate and bound. lines: numbers that the lines of its deck have in the user's.
    """

    rehearsed: float = 0.0
    limits: bool = False
    lines: tuple[int, ...] = ()

    @property
    def made_of(self) -> dict[str, str]:
        """See Run."""
        return super().made_of | {"survey": f"{self.rehearsed} {self.limits}"}

    def observers(self, model: Any) -> Sequence[Observer]:
        """See Run."""
        return (Survey(self, Found(model)),)


class Found:
    """What is found of one model."""

    def __init__(self, model: Any) -> None:
        self.model = model
        self.segments: list[Segment] = []
        self.tracks: list[tuple[float, Any]] = []

    def look(self) -> None:
        """Note where blocks are."""
        h = self.model.array.h
        blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
        rows = np.column_stack([blocks, getr(h, blocks, g.KX), getr(h, blocks, g.KY)])
        self.tracks.append((float(h.cd[g.TIME]), rows))

    def write(self) -> None:
        """Write the files."""
        self.model.out.mkdir(parents=True, exist_ok=True)
        text = json.dumps([asdict(one) for one in self.segments], indent=1)
        (self.model.out / SURVEY).write_text(text + "\n", encoding="utf-8")
        if self.tracks:
            arrays = {f"at{k}": rows for k, (_, rows) in enumerate(self.tracks)}
            np.savez(self.model.out / TRACKS, times=np.array([time for time, _ in self.tracks]), **arrays)


class Survey(Observer):
    """Observes the CYCLEs and SOLVEs of `run`."""

    def __init__(self, run: Surveyed, found: Found) -> None:
        self.asked_for, self.found = run, found
        self._marks: list[int] = []
        self._clock = self._compiled = 0.0

    def begin(self, array: MainArray, solves: bool) -> None:
        """See Observer."""
        h, found = array.h, self.found.segments
        asked = int(h.ci[g.NCYC])
        one = Segment(
            asked,
            solves,
            float(h.cd[g.TIME]),
            float(h.cr[g.TDEL]),
            float(h.cr[g.FRAC]),
            bool(h.ci[g.LSAFE]),
            *((found[-1].estimate, found[-1].bound) if found else (0.0, 0.0)),
            scaled=bool(h.ci[g.LSCALE]),
        )
        if self.asked_for.limits and (not found or found[-1].step != one.step):
            one.estimate, one.bound = estimate(array).step, damped_step(h, bound(array).step)
        found.append(one)
        self._marks = [] if solves else sorted({round(asked * k / MARKS) for k in range(1, MARKS + 1)})
        self.found.look()

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """See Observer: up to the next mark."""
        done = self.found.segments[-1].done
        ahead = [mark - done for mark in self._marks if mark > done]
        if self.asked_for.rehearsed:
            n = min(n, REHEARSED)
        self._clock, self._compiled = thread_time(), compile_seconds()
        return min([n, *ahead[:1]])

    def look(self, array: MainArray, cycles: int) -> None:
        """See Observer."""
        one = self.found.segments[-1]
        one.seconds += max(thread_time() - self._clock - (compile_seconds() - self._compiled), 0.0)
        one.done += cycles
        if one.done in self._marks:
            self.found.look()

    def is_over(self) -> bool:
        """True if there are to be no more cycles."""
        one, limit = self.found.segments[-1], self.asked_for.rehearsed
        return one.done > 1 and 0 < limit < one.seconds

    def end(self, array: MainArray) -> None:
        """See Observer."""
        self.found.write()


def segments(folder: Path) -> list[Segment]:
    """The CYCLEs and SOLVEs of the run in a folder, as far as it came."""
    try:
        found = json.loads((folder / SURVEY).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return []
    return [Segment(**one) for one in found]


def tracks(folder: Path) -> list[tuple[float, Any]]:
    """Times, and address and place of each block then, (n, 3), of the run in a folder."""
    try:
        with np.load(folder / TRACKS) as found:
            return [(float(time), found[f"at{k}"]) for k, time in enumerate(found["times"])]
    except FileNotFoundError:
        return []
