"""Runs settings of one deck within a budget of time, and learns what they cost.

A run costs seconds of preparing and seconds a cycle: at first those of the deck as it is, then those of all
runs of a word scheme until now. The budget is time by the clock from the creation of the runner: creating and
starting runs count. Settings beyond it are not run.
"""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median
from time import monotonic
from typing import Any, NamedTuple, TextIO

from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.ops.laws.law_file import read_laws
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.settings import (
    Fraction,
    Numbers,
    Setting,
    count_cycles,
    cycled_time,
    expected_cycles,
    has_its_fraction,
)
from udec_ia.studies.study_run import ENDED, LATE, RunResult, StudyRun
from udec_ia.studies.survey_run import Segment, SurveyRun, read_segments
from udec_ia.studies.worker_pool import StudyProgress, WorkerPool, check_saves

QUANTITIES = (
    "displacement = max block.DISPLACEMENT",
    "mean displacement = mean block.DISPLACEMENT",
    "force = max contact.KCFN",
)
NARROW = {"i64r64": "i32r32", "i32r64": "i32r32", "i16r64": "i16r32"}  # schemes with half the reals
WIDE = {"i32r32": "i32r64", "i16r32": "i16r64"}
RUN_LIMIT_FACTOR = 5.0  # times the predicted seconds, and least seconds, after which a run is ended
TIME_OFF = 0.05  # share of the time of all CYCLEs by which a run may be off, as cycles are whole
NOT_AT_REST = "its SOLVE did not reach the force ratio"


@dataclass(frozen=True)
class Options:
    """What a study of accuracy is asked for. budget: seconds by the clock. jobs: see WorkerPool.

    builds: word schemes beside the one with 64-bit reals; by default the one with 32-bit reals. half_step:
    run the deck and the same with half the step, and nothing else. stream: shows the progress.
    """

    quantities: tuple[str, ...] = QUANTITIES
    tolerance: float = 1e-3
    budget: float = 300.0
    build: str = DEFAULT_SCHEME
    builds: tuple[str, ...] = ()
    constitutive: tuple[str, ...] = ()
    jobs: int | None = None
    half_step: bool = False
    stream: TextIO = field(default_factory=io.StringIO)


@dataclass
class Row:
    """A setting and its run.

    predicted: seconds. result: None if it was not run; segments: its CYCLEs and SOLVEs. cost: seconds by the
    rates of all runs and the cycles that it took. errors: share of the reference, by quantity. why: it is not
    compared, though it ran.
    """

    setting: Setting
    numbers: Numbers
    predicted: float
    result: RunResult | None = None
    cost: float = math.inf
    errors: dict[str, float] = field(default_factory=dict)
    why: str = ""
    segments: list[Segment] = field(default_factory=list)

    @property
    def ran(self) -> bool:
        """True if the run came to its end."""
        return self.result is not None and self.result.status == ENDED

    @property
    def compared(self) -> bool:
        """True if it came to its end, with the time-steps of its setting and the rest that SOLVE wants."""
        return self.ran and not self.why

    @property
    def error(self) -> float:
        """The greatest of its errors."""
        return max(self.errors.values(), default=math.inf) if self.compared else math.inf

    @property
    def memory(self) -> int:
        """Bytes of IA() in use."""
        bits = scheme(self.setting.build).int_bits
        return self.result.words * bits // 8 if self.result else 0


class Rates(NamedTuple):
    """Costs of a word scheme: seconds of preparing a run, and of a cycle."""

    preparing: float
    cycle: float


class SettingRunner:
    """Runs settings of one deck in `folder`, which it keeps until the end of `with`. notes: sentences.

    own, survey: the deck as it is, and its CYCLEs and SOLVEs. fraction: of the deck at first, None if it does
    not matter. UdecError 34 for a law that cannot be used, 31 for a deck whose runs would save to one file.
    """

    def __init__(self, deck: Deck, options: Options, folder: Path) -> None:
        self.deck, self.options = deck, options
        self._end = monotonic() + options.budget
        read_laws(options.constitutive)
        self.wide = WIDE.get(options.build, options.build)
        self.builds = [*dict.fromkeys((self.wide, *(options.builds or (NARROW[self.wide],))))]
        self.own = Row(Setting(self.wide), Numbers(), 0.0)
        self.survey: list[Segment] = []
        self.fraction: Fraction | None = None
        self.rates: dict[str, Rates] = {}
        self.notes: list[str] = []
        self._done: dict[str, list[Row]] = {build: [] for build in self.builds}
        self._pool = WorkerPool(folder, jobs=options.jobs, timed=True)
        self.processes = max(self._pool.jobs, 1)  # runs that go on at a time
        check_saves([self.run(Setting(self.wide), name=name) for name in ("one", "other")])

    def __enter__(self) -> SettingRunner:
        self._pool.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self._pool.__exit__(*error)

    @property
    def left(self) -> float:
        """Seconds of the budget that are left."""
        return self._end - monotonic()

    def run(self, setting: Setting, numbers: Numbers | None = None, **named: Any) -> SurveyRun:
        """The run of a setting. named: fields of the run that are not those of all settings."""
        text = self.deck.written(setting, numbers, self.fraction)
        same = len(text.splitlines()) == len(self.deck.text.splitlines())  # else errors name another file
        run = SurveyRun(
            setting.name,
            text,
            self.deck.name if same else "",
            quantities=self.options.quantities,
            build=setting.build,
            constitutive=self.options.constitutive,
        )
        return replace(run, **named)

    def run_own_deck(self) -> str:
        """Run the deck as it is. Returns why there is nothing to compare with, "" if there is."""
        (result,) = self.results([self.run(self.own.setting, bounds=True, limit=max(self.left, 1.0))])
        self.survey = self.segments(self.own.setting.name)
        if result.status == LATE:
            budget = f"the budget of {self.options.budget:g} s: give a greater --budget"
            return f"the deck as it is takes more than {budget}"
        if result.status != ENDED or not self.survey:
            reason = result.message or "it has no CYCLE and no SOLVE"
            return f"the deck as it is gives nothing to compare: {reason}"
        first = next((segment for segment in self.survey if not segment.static), None)
        if first is not None:
            word = " SCALED" if first.scaled else " SAFE" if first.safe else ""
            self.fraction = Fraction(first.fraction, word)
        self.own.numbers = count_cycles(self.survey, self.own.setting)
        self._enter(self.own, result)
        self.rates = dict.fromkeys(self.builds, self.rates[self.wide])
        return f"{self.own.why}: {result.message}" if self.own.why == NOT_AT_REST else ""

    def drop_unable_builds(self) -> None:
        """Run the deck in the other word schemes; those that cannot run it are left out, with a note."""
        rows = [self.row(Setting(build)) for build in self.builds[1:]]
        self.run_rows(rows)
        for row in rows:
            if row.result is not None and not row.ran:
                self.builds.remove(row.setting.build)
                reason = row.result.message
                self.notes.append(f"{row.setting.build} is left out, as it cannot run the deck: {reason}")

    def row(self, setting: Setting) -> Row:
        """A setting, with its predicted cost; the same row if it has been run."""
        for row in self._done[setting.build]:
            if row.setting == setting:
                return row
        row = Row(setting, count_cycles(self.survey, setting), 0.0)
        row.predicted = self._predicted(row)
        return row

    def _predicted(self, row: Row) -> float:
        rates = self.rates[row.setting.build]
        return rates.preparing + rates.cycle * expected_cycles(self.survey, row.numbers, row.setting)

    def predicted_seconds(self, rows: Sequence[Row]) -> float:
        """Seconds by the clock that rows take."""
        return sum(row.predicted for row in rows if row.result is None) / self.processes

    def run_rows(self, rows: Sequence[Row]) -> list[Row]:
        """Run rows as long as the budget lasts, STATIC first and then the cheapest. Returns the others."""
        waiting = [row for row in rows if row.result is None]
        while waiting:
            for row in waiting:
                row.predicted = self._predicted(row)
            waiting.sort(key=lambda row: (not row.setting.static, row.predicted))
            if waiting[0].predicted > self.left:
                break
            started, waiting = waiting[: self.processes], waiting[self.processes :]
            runs = []
            for row in started:
                limit = min(RUN_LIMIT_FACTOR * max(1.0, row.predicted), max(self.left, 1.0))
                runs.append(self.run(row.setting, row.numbers, limit=limit))
            for row, result in zip(started, self.results(runs), strict=True):
                self._enter(row, result)
        return waiting

    def _enter(self, row: Row, result: RunResult) -> None:
        """Enter the result of a row, and learn the costs of its word scheme from all its runs until now."""
        row.result = result
        if not row.ran:
            return
        row.segments = self.segments(row.setting.name)
        row.why = self._why_not_compared(row, result)
        done = self._done[row.setting.build]
        done.append(row)
        cycling = [sum(segment.seconds for segment in row.segments) for row in done]
        cycles = [sum(segment.done for segment in row.segments) for row in done]
        results = [row.result for row in done if row.result]
        preparing = [result.seconds - spent for result, spent in zip(results, cycling, strict=True)]
        rates = Rates(max(median(preparing), 0.0), sum(cycling) / max(sum(cycles), 1))
        self.rates[row.setting.build] = rates
        for finished, number in zip(done, cycles, strict=True):
            finished.cost = rates.preparing + rates.cycle * number

    def _why_not_compared(self, row: Row, result: RunResult) -> str:
        """Why a row that has run is not compared, "" if it is."""
        if not has_its_fraction(self.survey, row.segments, row.setting, row.numbers):
            return "the deck sets its time-step itself, which cannot be varied; write FRACTION instead"
        deck_result = self.own.result or result
        time, deck_time = cycled_time(row.segments, result.time), cycled_time(self.survey, deck_result.time)
        if abs(time - deck_time) > TIME_OFF * abs(deck_time):
            return f"the CYCLEs of {row.setting.name} last {time:.4g} s, those of the deck {deck_time:.4g} s"
        return "" if result.at_rest else NOT_AT_REST

    def results(self, runs: Sequence[StudyRun]) -> list[RunResult]:
        """The results of runs."""
        return self._pool.results(runs, StudyProgress(self.options.stream, len(runs)).show)

    def segments(self, name: str) -> list[Segment]:
        """The CYCLEs and SOLVEs of the run of that name."""
        segments = read_segments(self._pool.folder / name)
        statics = self.deck.statics  # more than segments if the run failed half-way
        for segment, static in zip(segments, statics, strict=False):
            segment.static = static
        return segments
