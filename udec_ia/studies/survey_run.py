"""A run that records its CYCLEs and SOLVEs, with time-steps and seconds, in a file in its folder."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.running.critical_step import bound
from udec_ia.running.stiffness_bound import damped_step
from udec_ia.studies.execute_run import CpuTime, RunObserver
from udec_ia.studies.study_run import StudyRun

SURVEY = "survey.json"


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
    """Records the CYCLEs and SOLVEs of one model in the folder `out`."""

    def __init__(self, bounds: bool, out: Path) -> None:
        self.bounds, self.out = bounds, out
        self.segments: list[Segment] = []
        self._cpu = CpuTime()
        self._before = 0.0
        self._bound: float | None = None  # of the time-step in use

    def after_command(self, array: MainArray) -> None:
        """Forget the bound when the next CYCLE calculates the time-step again."""
        if not array.h.ci[g.LREADY]:
            self._bound = None

    def begin(self, array: MainArray, solves: bool) -> None:
        """Begin the record of a CYCLE or SOLVE."""
        h = array.h
        if self._bound is None:
            self._bound = damped_step(h, bound(array).step) if self.bounds else 0.0
        one = Segment(
            asked=int(h.ci[g.NCYC]),
            solve=solves,
            began=float(h.cd[g.TIME]),
            step=float(h.cr[g.TDEL]),
            fraction=float(h.cr[g.FRAC]),
            safe=bool(h.ci[g.LSAFE]),
            bound=self._bound,
            scaled=bool(h.ci[g.LSCALE]),
        )
        self.segments.append(one)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        self._before = self._cpu.seconds
        return n

    def look(self, array: MainArray, cycles: int) -> None:
        one = self.segments[-1]
        one.seconds += self._cpu.seconds - self._before
        one.done += cycles

    def end(self, array: MainArray) -> None:
        text = json.dumps([asdict(one) for one in self.segments], indent=1)
        (self.out / SURVEY).write_text(text + "\n", encoding="utf-8")


def read_segments(folder: Path) -> list[Segment]:
    """The CYCLEs and SOLVEs of the run in a folder, as far as it came."""
    file = folder / SURVEY
    return [Segment(**one) for one in json.loads(file.read_text(encoding="utf-8"))] if file.exists() else []
