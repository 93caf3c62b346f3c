"""A run that records each CYCLE and SOLVE: time-steps, seconds, and where blocks are on the way.

The record is in two files in the folder of the run. From the records of two runs follows where they part.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.accessors import getr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.running.critical_step import bound
from udec_ia.running.stiffness_bound import damped_step
from udec_ia.studies.execute_run import CpuTime, RunObserver
from udec_ia.studies.study_run import StudyRun

SURVEY, TRACKS = "survey.json", "tracks.npz"
MARKS = 8  # records of where blocks are, in each CYCLE


@dataclass
class Segment:
    """One CYCLE or SOLVE.

    asked, done: cycles. began: time of the model before it (s). step: its time-step (s). fraction: of the
    estimate, or of the bound if `safe`. bound: safe critical step when the time-step was made (s), 0 if it
    was not asked for. scaled: with scaled masses. seconds: of the processor, without compiling. static: the
    deck says SOLVE ... STATIC.
    """

    asked: int
    solve: bool
    began: float
    step: float
    fraction: float
    safe: bool
    bound: float
    scaled: bool = False
    done: int = 0
    seconds: float = 0.0
    static: bool = False


@dataclass(frozen=True)
class SurveyRun(StudyRun):
    """A run that leaves a record. bounds: record the safe critical steps as well."""

    bounds: bool = False

    @property
    def made_of(self) -> dict[str, str]:
        return super().made_of | {"survey": str(self.bounds)}

    def observers(self, model: Any) -> list[RunObserver]:
        return [_Recorder(self.bounds, model.session.out)]


class _Recorder(RunObserver):
    """Records the CYCLEs and SOLVEs of one model, with the files in the folder `out`."""

    def __init__(self, bounds: bool, out: Path) -> None:
        self.bounds, self.out = bounds, out
        self.segments: list[Segment] = []
        self.tracks: list[tuple[float, Any]] = []
        self._cpu = CpuTime()
        self._marks: list[int] = []
        self._before = 0.0
        self._bound: float | None = None  # of the time-step in use

    def command_obeyed(self, array: MainArray) -> None:
        """See RunObserver: after some commands the time-step is made anew."""
        if not array.h.ci[g.LREADY]:
            self._bound = None

    def begin(self, array: MainArray, solves: bool) -> None:
        h = array.h
        if self._bound is None:
            self._bound = damped_step(h, bound(array).step) if self.bounds else 0.0
        one = Segment(
            int(h.ci[g.NCYC]),
            solves,
            float(h.cd[g.TIME]),
            float(h.cr[g.TDEL]),
            float(h.cr[g.FRAC]),
            bool(h.ci[g.LSAFE]),
            self._bound,
            bool(h.ci[g.LSCALE]),
        )
        self.segments.append(one)
        self._marks = [] if solves else [round(one.asked * k / MARKS) for k in range(1, MARKS + 1)]
        self._track(array)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """See RunObserver: up to the next mark."""
        done = self.segments[-1].done
        self._before = self._cpu.seconds
        return min([n, *(mark - done for mark in self._marks if mark > done)])

    def look(self, array: MainArray, cycles: int) -> None:
        one = self.segments[-1]
        one.seconds += self._cpu.seconds - self._before
        one.done += cycles
        if one.done in self._marks:
            self._track(array)

    def end(self, array: MainArray) -> None:
        """See RunObserver: write the files."""
        self.out.mkdir(parents=True, exist_ok=True)
        text = json.dumps([asdict(one) for one in self.segments], indent=1)
        (self.out / SURVEY).write_text(text + "\n", encoding="utf-8")
        if self.tracks:
            arrays = {f"at{k}": rows for k, (_, rows) in enumerate(self.tracks)}
            np.savez(self.out / TRACKS, times=np.array([time for time, _ in self.tracks]), **arrays)

    def _track(self, array: MainArray) -> None:
        """Record where blocks are."""
        h = array.h
        blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
        rows = np.column_stack([blocks, getr(h, blocks, g.KX), getr(h, blocks, g.KY)])
        self.tracks.append((float(h.cd[g.TIME]), rows))


def read_segments(folder: Path) -> list[Segment]:
    """The CYCLEs and SOLVEs of the run in a folder, as far as it came."""
    try:
        found = json.loads((folder / SURVEY).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return []
    return [Segment(**one) for one in found]


# ---- where two runs part


class RunSeparation(NamedTuple):
    """time: from which on a block is elsewhere (s). x, y: where it was at first.

    apart: distance at the end (m). moved: the greatest displacement of any block (m).
    """

    time: float
    x: float
    y: float
    apart: float
    moved: float


def find_separation(one: Path, two: Path, share: float) -> RunSeparation | None:
    """Where the runs in two folders part for good by more than `share` of the greatest displacement."""
    pairs = [*zip(_tracks(one), _tracks(two), strict=False)]
    if not pairs:
        return None
    first = pairs[0][0][1]
    apart = np.array([_distances(first, a, b) for (_, a), (_, b) in pairs])  # marks, blocks
    moved = max(float(_distances(first, first, a).max(initial=0.0)) for (_, a), _ in pairs)
    stays = np.flip(np.logical_and.accumulate(np.flip(apart > share * moved, 0), 0), 0)
    if moved == 0 or not stays.any():
        return None
    mark = int(np.argmax(stays.any(axis=1)))
    block = int(np.argmax(np.where(stays[mark], apart[mark], -1.0)))
    x, y = map(float, first[block, 1:])
    return RunSeparation(pairs[mark][0][0], x, y, float(apart[-1, block]), moved)


def _tracks(folder: Path) -> list[tuple[float, Any]]:
    """Times, and address and place of each block then, (n, 3), of the run in a folder."""
    try:
        with np.load(folder / TRACKS) as found:
            return [(float(time), found[f"at{k}"]) for k, time in enumerate(found["times"])]
    except FileNotFoundError:
        return []


def _distances(first: Any, a: Any, b: Any) -> Any:
    """How far each block of `first` is from itself in two states; 0 if one of them does not have it."""
    found = np.zeros(len(first))
    blocks, in_a, in_b = np.intersect1d(a[:, 0], b[:, 0], return_indices=True)
    _, here, there = np.intersect1d(first[:, 0], blocks, return_indices=True)
    found[here] = np.hypot(*(a[in_a[there], 1:] - b[in_b[there], 1:]).T)
    return found
