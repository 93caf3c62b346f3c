"""Runs settings of one deck within a budget of time, predicts what they cost, and learns it from the runs.

A run costs seconds of preparing, and for each CYCLE its cycles times seconds a cycle: at first those of a
rehearsal of a few hundredths of a second, then those of all runs of a word scheme until now. Settings run in
the order of their predicted costs, SOLVE ... STATIC first. The budget is time by the clock from the creation
of the runner: creating and starting runs count. What does not come within it is not run.
"""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from time import monotonic
from typing import TextIO

from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.ops.laws.law_file import read_laws
from udec_ia.running.history_series import SOLVE_LIMIT
from udec_ia.studies.deck_rewriting import Deck, at_own_line, own_lines, text_of
from udec_ia.studies.settings import (
    Fraction,
    Numbers,
    Setting,
    check_time_step,
    count_cycles,
    cycled_time,
    expected_cycles,
    is_other_time,
)
from udec_ia.studies.study_run import ENDED, ERROR, RunResult, StudyRun
from udec_ia.studies.survey_run import Segment, SurveyRun, read_segments
from udec_ia.studies.worker_pool import StudyProgress, WorkerPool, check_saves

QUANTITIES = (
    "displacement = max block.DISPLACEMENT",
    "mean displacement = mean block.DISPLACEMENT",
    "force = max contact.KCFN",
)
END_TIME = "end of time = time"  # the first quantity of every run
TOLERANCE, BUDGET = 1e-3, 300.0
NARROW = {"i64r64": "i32r32", "i32r64": "i32r32", "i16r64": "i16r32"}  # schemes with half the reals
WIDE = {"i32r32": "i32r64", "i16r32": "i16r64"}
SURVEY, REHEARSAL = "survey", "rehearsal"
REHEARSED = 0.03  # seconds of each CYCLE in a rehearsal
LATE, SHORT = 5.0, 5.0  # a run ends after so many times the predicted seconds, and so many seconds at least
NOT_AT_REST = "its SOLVE did not reach the force ratio"


@dataclass(frozen=True)
class Options:
    """What a study of accuracy is asked for. budget: seconds by the clock. jobs: see WorkerPool.

    builds: word schemes beside the one with 64-bit reals; by default the one with 32-bit reals. half_step:
    run the deck and the same with half the step, and nothing else. stream: shows the progress.
    """

    quantities: tuple[str, ...] = QUANTITIES
    tolerance: float = TOLERANCE
    budget: float = BUDGET
    build: str = DEFAULT_SCHEME
    builds: tuple[str, ...] = ()
    constitutive: tuple[str, ...] = ()
    jobs: int | None = None
    half_step: bool = False
    stream: TextIO = field(default_factory=io.StringIO)

    def show(self, text: str) -> None:
        """Show the progress."""
        print(text, file=self.stream, flush=True)


@dataclass
class Row:
    """A setting and its run.

    predicted: seconds. result: None if it was not run. cost: seconds by the rates of all runs and the cycles
    that it took. errors: share of the reference, by quantity. why: it is not compared, though it ran.
    """

    setting: Setting
    numbers: Numbers
    predicted: float
    result: RunResult | None = None
    cost: float = math.inf
    errors: dict[str, float] = field(default_factory=dict)
    why: str = ""

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


@dataclass(frozen=True)
class Rates:
    """Costs of a word scheme. preparing: seconds beside cycles. each: seconds a cycle, of each CYCLE."""

    preparing: float
    each: tuple[float, ...]

    @classmethod
    def of(cls, result: RunResult, survey: Sequence[Segment]) -> Rates:
        """Those of one run."""
        each = tuple(one.seconds / max(one.done, 1) for one in survey)
        return cls(max(result.seconds - sum(one.seconds for one in survey), 0.0), each)

    def seconds(self, cycles: Sequence[float]) -> float:
        """Of a run with so many cycles in each CYCLE and SOLVE."""
        return self.preparing + sum(n * rate for n, rate in zip(cycles, self.each, strict=False))

    def times(self, factor: float) -> Rates:
        """The same with all cycles `factor` times as expensive."""
        return Rates(self.preparing, tuple(rate * factor for rate in self.each))

    def over(self, other: Rates) -> float:
        """Seconds a cycle over those of another word scheme, as a mean over all CYCLEs."""
        both = [(a, b) for a, b in zip(self.each, other.each, strict=False) if a > 0 and b > 0]
        return sum(a for a, _ in both) / sum(b for _, b in both) if both else 1.0


class SettingRunner:
    """Runs settings of one deck in `folder`, which it keeps until the end of `with`. notes: sentences.

    Raises UdecError 34 for a law that cannot be used, 31 for a deck whose runs would save to one file.
    """

    def __init__(self, deck: Deck, options: Options, folder: Path) -> None:
        self.deck, self.options, self.folder = deck, options, folder
        self._end = monotonic() + options.budget
        read_laws(options.constitutive)
        self.wide = WIDE.get(options.build, options.build)
        self.builds = [*dict.fromkeys((self.wide, *(options.builds or (NARROW[self.wide],))))]
        self.surveyed: RunResult | None = None
        self.survey: list[Segment] = []
        self.fraction: Fraction | None = None  # that of the deck at first, if it matters
        self.rates: dict[str, Rates] = {}
        self.notes: list[str] = []
        self._done: dict[str, list[Row]] = {}
        self._open = ExitStack()
        self._pool = WorkerPool(folder, jobs=options.jobs, timed=True)
        check_saves([self.run(Setting(self.wide), name=name) for name in ("one", "other")])

    def __enter__(self) -> SettingRunner:
        self._open.enter_context(self._pool)
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    @property
    def left(self) -> float:
        """Seconds of the budget that are left."""
        return self._end - monotonic()

    @property
    def processes(self) -> int:
        """Runs that go on at a time."""
        return max(self._pool.jobs, 1)

    def run(
        self,
        setting: Setting,
        numbers: Numbers | None = None,
        name: str = "",
        beside: tuple[str, ...] = (),
        **named: object,
    ) -> SurveyRun:
        """The run of a setting. beside: quantities beside those that are asked for."""
        pieces = self.deck.pieces(setting, numbers, self.fraction)
        return SurveyRun(
            name or setting.name,
            text_of(pieces),
            self.deck.name,
            quantities=(END_TIME, *self.options.quantities, *beside),
            build=setting.build,
            constitutive=self.options.constitutive,
            lines=own_lines(pieces),
            **named,  # type: ignore[arg-type]
        )

    def rehearse(self) -> None:
        """Learn what a cycle costs in each word scheme. One that has no first cycle is left out."""
        for build in [*self.builds]:
            if self.rates and self.left <= 0:
                self.builds.remove(build)
                continue
            result, segments = self.rehearsal(Setting(build), REHEARSED)
            if result.status == ERROR and result.cycles == 0 and build != self.wide:
                self.builds.remove(build)
                self.notes.append(f"{build} is left out, as it cannot run the deck: {result.message}")
            self.rates[build] = Rates.of(result, segments)

    def rehearsal(
        self, setting: Setting, seconds: float, beside: tuple[str, ...] = ()
    ) -> tuple[RunResult, list[Segment]]:
        """A rehearsal, each CYCLE and SOLVE of which ends after some seconds, and these."""
        run = self.run(setting, None, f"{REHEARSAL},{setting.name}", beside, rehearsed=seconds)
        (result,) = self.results([run])
        return result, self.segments(run.name)

    def predicted_range(self) -> tuple[float, float]:
        """Seconds of the deck as it is, by the rehearsal: at least, and with all cycles of SOLVEs."""
        found = self.segments(f"{REHEARSAL},{Setting(self.wide).name}")
        calls = self.deck.calls("cycle", "solve")
        limits = [
            call.named.get("limit", SOLVE_LIMIT) if call.command.name == "solve" else 0 for call in calls
        ]
        least = [one.done if one.solve else one.asked for one in found]
        most = [max(n, limit) for n, limit in zip(least, limits, strict=False)]
        rates = self.rates[self.wide]
        return rates.seconds(least), rates.seconds(most)

    def survey_deck(self) -> RunResult:
        """The run of the deck as it is, with estimates and bounds of the time-step."""
        run = self.run(Setting(self.wide), name=SURVEY, bounds=True, limit=max(self.left, 1.0))
        self.surveyed = result = self.results([run])[0]
        self.survey = self.segments(SURVEY)
        if self.survey:
            one = next((one for one in self.survey if not one.static), None)
            if one is not None:
                words = " SCALED" if one.scaled else " SAFE" if one.safe else ""
                self.fraction = Fraction(one.fraction, words)
            found, rehearsed = Rates.of(result, self.survey), dict(self.rates)
            preparing = rehearsed[self.wide].preparing if self.wide in rehearsed else found.preparing
            found = Rates(preparing, found.each)  # without what bounds need
            for build in rehearsed:
                times = rehearsed[build].over(rehearsed[self.wide])
                self.rates[build] = found if build == self.wide else found.times(times)
        return result

    def row(self, setting: Setting) -> Row:
        """A setting, with its predicted cost."""
        row = Row(setting, count_cycles(self.survey, setting), 0.0)
        row.predicted = self._predicted(row)
        return row

    def _predicted(self, row: Row) -> float:
        cycles = expected_cycles(self.survey, row.numbers, row.setting)
        return self.rates[row.setting.build].seconds(cycles)

    def predicted_seconds(self, rows: Sequence[Row]) -> float:
        """Seconds by the clock that rows take."""
        return sum(row.predicted for row in rows) / self.processes

    def run_rows(self, rows: Sequence[Row]) -> list[Row]:
        """Run rows as long as the budget lasts, STATIC first and then the cheapest. Returns the others."""
        waiting = sorted(rows, key=lambda row: (not row.setting.static, row.predicted))
        while waiting and waiting[0].predicted < self.left:
            some, waiting = waiting[: self.processes], waiting[self.processes :]
            self._run(some)
            for row in waiting:
                row.predicted = self._predicted(row)
            waiting.sort(key=lambda row: (not row.setting.static, row.predicted))
        return waiting

    def _run(self, rows: Sequence[Row]) -> None:
        allowed = max(self.left, 1.0)
        limits = [min(max(SHORT, LATE * row.predicted), allowed) for row in rows]
        runs = [
            self.run(row.setting, row.numbers, limit=last) for row, last in zip(rows, limits, strict=True)
        ]
        for row, result in zip(rows, self.results(runs), strict=True):
            row.result = result
            row.why = self._why_not_compared(row)
            if row.ran:
                self._done.setdefault(row.setting.build, []).append(row)
        for build in {row.setting.build for row in rows}:
            self._learn(build)

    def _why_not_compared(self, row: Row) -> str:
        """Why a row that has run is not compared, "" if it is."""
        if row.result is None or self.surveyed is None or not row.ran:
            return ""
        found = self.segments(row.setting.name)
        k = check_time_step(self.survey, found, row.setting, row.numbers)
        if k >= 0:
            by = f" ({setter})" if (setter := self.deck.setter(k)) else ""
            return f"the deck sets its time-step itself{by}, which cannot be varied; write FRACTION instead"
        time, own = cycled_time(found, row.result.time), cycled_time(self.survey, self.surveyed.time)
        if is_other_time(time, own):
            return f"the CYCLEs of {row.setting.name} last {time:.4g} s, those of the deck {own:.4g} s"
        return "" if row.result.at_rest else f"{NOT_AT_REST}: {row.result.message}"

    def _learn(self, build: str) -> None:
        """Rates of a word scheme from all its runs until now, and so what each of them has cost.

        The times of a single run of a small model differ by a quarter from one time to the next.
        """
        done = [(row, self.segments(row.setting.name)) for row in self._done.get(build, [])]
        if not done:
            return
        rates = self.rates[build]
        spare = [row.result.seconds - sum(one.seconds for one in found) for row, found in done if row.result]
        rates = Rates(max(median(spare), 0.0), rates.each)
        spent = sum(one.seconds for _, found in done for one in found)
        thought = sum(rates.seconds([one.done for one in found]) - rates.preparing for _, found in done)
        self.rates[build] = rates.times(spent / thought) if spent > 0 and thought > 0 else rates
        for row, found in done:
            row.cost = self.rates[build].seconds([one.done for one in found])

    def results(self, runs: Sequence[StudyRun]) -> list[RunResult]:
        """The results of runs; errors name the lines of the user's deck."""
        of = {run.name: run for run in runs}

        def own(result: RunResult) -> RunResult:
            run = of[result.name]
            return at_own_line(result, run) if isinstance(run, SurveyRun) else result

        with StudyProgress(self.options.stream, len(runs)) as progress:
            found = self._pool.results(runs, lambda result, why: progress.show(own(result), why))
        return [own(result) for result in found]

    def segments(self, name: str) -> list[Segment]:
        """The CYCLEs and SOLVEs of the run of that name."""
        found = read_segments(self._pool.folder / name)
        for one, static in zip(found, self.deck.statics, strict=False):  # a run may have failed half-way
            one.static = static
        return found
