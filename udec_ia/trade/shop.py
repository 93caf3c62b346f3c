"""Runs of one deck in other settings: how they are made, what they will cost, and what they have cost."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import TextIO

from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.ops.laws.law_file import read_laws
from udec_ia.study.many import RUNS, run_all
from udec_ia.study.progress import Told
from udec_ia.study.runs import ERROR, Result
from udec_ia.trade import cost, meant
from udec_ia.trade.batches import SLICE, batch, foresee, hopeless, turn
from udec_ia.trade.deck import Deck
from udec_ia.trade.judge import Row
from udec_ia.trade.levers import Fraction, Numbers, Setting
from udec_ia.trade.places import at_own_line, own_lines
from udec_ia.trade.steps import numbers
from udec_ia.trade.surveyed import Segment, Surveyed, segments
from udec_ia.trade.writing import written

QUANTITIES = (
    "displacement = max block.DISPLACEMENT",
    "mean displacement = mean block.DISPLACEMENT",
    "force = max contact.KCFN",
)
TOLERANCE, BUDGET = 1e-3, 300.0
NARROW = {"i64r64": "i32r32", "i32r64": "i32r32", "i16r64": "i16r32"}  # schemes with half the reals
WIDE = {"i32r32": "i32r64", "i16r32": "i16r64"}
SURVEYED, WARM, REHEARSAL = "survey", "warm", "rehearsal"
REHEARSED = 0.03  # seconds of each CYCLE in a rehearsal
LATE, SHORT = 5.0, 5.0  # a run ends after so many times what was predicted, and so many seconds at least


@dataclass(frozen=True)
class Options:
    """What a price list is asked for. budget: seconds of the clock. jobs: see many.run_all.

    builds: word schemes beside the one with 64-bit reals; by default the one with 32-bit reals. half_step:
    run the deck and the same with half the step, and nothing else. stream: takes how it is going.
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

    def tell(self, text: str) -> None:
        """Show how it is going."""
        print(text, file=self.stream, flush=True)


def _fraction(one: Segment) -> Fraction:
    """What FRACTION has to say for the time-step of a CYCLE or SOLVE."""
    return Fraction(one.fraction, " SCALED" if one.scaled else " SAFE" if one.safe else "")


class Shop:
    """Runs settings of one deck, and knows what they cost. said: what there is to say of that.

    Raises UdecError 34 for a law that cannot be used, before anything runs.
    """

    def __init__(self, deck: Deck, options: Options, folder: Path) -> None:
        self.deck, self.options, self.folder = deck, options, folder
        read_laws(options.constitutive)
        self.wide = WIDE.get(options.build, options.build)
        self.builds = [*dict.fromkeys((self.wide, *(options.builds or (NARROW[self.wide],))))]
        self.surveyed: Result | None = None
        self.survey: list[Segment] = []
        self.fraction: Fraction | None = None  # what the deck begins with, as far as that matters
        self.rates: dict[str, cost.Rates] = {}
        self.left = options.budget  # seconds of the clock
        self.said: list[str] = []
        self._done: dict[str, list[Row]] = {}

    def run(
        self,
        setting: Setting,
        numbers: Numbers | None = None,
        name: str = "",
        beside: tuple[str, ...] = (),
        **named: object,
    ) -> Surveyed:
        """The run of a setting. beside: quantities to be known beside those that are asked for."""
        pieces = self.deck.pieces(setting, numbers, self.fraction)
        return Surveyed(
            name or setting.name,
            written(pieces),
            self.deck.name,
            quantities=("end of time = time", *self.options.quantities, *beside),
            build=setting.build,
            constitutive=self.options.constitutive,
            lines=own_lines(pieces),
            **named,  # type: ignore[arg-type]
        )

    def rehearse(self) -> None:
        """Learn what a cycle costs in each word scheme. One that has no first cycle is left out."""
        for build in [*self.builds]:
            names = [f"{WARM},{build}", f"{REHEARSAL},{build}"]  # the first one loads what it needs
            runs = [self.run(Setting(build), name=name, rehearsed=REHEARSED) for name in names]
            result = self.results(runs)[-1]
            if result.status == ERROR and result.cycles == 0 and build != self.wide:
                self.builds.remove(build)
                self.said.append(f"{build} is left out, as it cannot run the deck: {result.message}")
            self.rates[build] = cost.rates(result, self._segments(result.name))

    def rehearsal(
        self, setting: Setting, seconds: float, beside: tuple[str, ...] = ()
    ) -> tuple[Result, list[Segment]]:
        """A rehearsal, each CYCLE and SOLVE of which ends after some seconds, and these."""
        run = self.run(setting, None, f"{REHEARSAL},{setting.name}", beside, rehearsed=seconds)
        (result,) = self.results([run])
        return result, self._segments(run.name)

    def look(self) -> Result:
        """The survey."""
        run = self.run(Setting(self.wide), name=SURVEYED, limits=True)
        self.surveyed = result = self.results([run])[0]
        self.survey = self._segments(SURVEYED)
        if self.survey:
            self.fraction = next((_fraction(one) for one in self.survey if not one.static), None)
            found, rehearsed = cost.rates(result, self.survey), dict(self.rates)
            apart = rehearsed[self.wide].apart if self.wide in rehearsed else found.apart
            found = cost.Rates(apart, found.each)  # without what limits need
            for build in rehearsed:
                times = cost.ratio(rehearsed[build], rehearsed[self.wide])
                self.rates[build] = found if build == self.wide else cost.scaled(found, times)
        return result

    def rehearsed(self) -> float:
        """Seconds that the survey will take, without what SOLVE needs."""
        found = self._segments(f"{REHEARSAL},{self.wide}")
        return self.rates[self.wide].seconds([one.done if one.solve else one.asked for one in found])

    def row(self, setting: Setting) -> Row:
        """A setting, with what it will cost."""
        put = numbers(self.survey, setting)
        cycles = cost.cycles_of(self.survey, put, setting)
        return Row(setting, put, self.rates[setting.build].seconds(cycles))

    def price(self, rows: Sequence[Row]) -> float:
        """Seconds of the clock that rows take."""
        return sum(row.predicted for row in rows) / self._processes

    def do(self, rows: Sequence[Row]) -> list[Row]:
        """Run rows, as many as the budget allows, and drop the dearest. Returns those that were dropped."""
        ahead, dropped = [*rows], list[Row]()
        while ahead:
            while ahead and self.price(ahead) > self.left:
                dropped.append(ahead.pop(ahead.index(max(ahead, key=turn))))
            if not ahead:
                break
            build = next(one for one in self.builds if any(row.setting.build == one for row in ahead))
            known = build == self.wide or build in self._done  # the survey has shown what the wide one takes
            some = batch(ahead, build, SLICE * self.options.budget, self._processes, known)
            ahead = [row for row in ahead if row not in some]
            self._run(some)
            foresee(ahead, some)
            without, why = hopeless(ahead, some, self.surveyed.message if self.surveyed else "")
            if without:
                self.said.append(f"{why}; not run: {', '.join(row.setting.name for row in without)}")
            for row in without:
                row.why = why
            ahead = [row for row in ahead if row not in without]
            dropped += without
        return dropped

    @property
    def _processes(self) -> int:
        return self.options.jobs or 1

    def _run(self, rows: Sequence[Row]) -> None:
        """Run rows of one word scheme."""
        build = rows[0].setting.build
        allowed = max(SHORT, self.left)
        limits = [min(max(SHORT, LATE * row.predicted), allowed) for row in rows]
        runs = [
            self.run(row.setting, row.numbers, limit=last) for row, last in zip(rows, limits, strict=True)
        ]
        for row, result in zip(rows, self.results(runs), strict=True):
            row.result = result
            row.why = self._astray(row)
        self._done[build] = self._done.get(build, []) + [row for row in rows if row.ran]
        self._learn(build)
        self.left -= sum(row.result.seconds for row in rows if row.result) / self._processes

    def _astray(self, row: Row) -> str:
        """Why a row that has run is no run of the deck, "" if it is."""
        if row.result is None or self.surveyed is None or not row.ran:
            return ""
        found = self._segments(row.setting.name)
        k = meant.astray(self.survey, found, row.setting, row.numbers)
        if k >= 0:
            by = f" ({setter})" if (setter := self.deck.setter(k)) else ""
            return f"the deck sets its time-step itself{by}, which cannot be varied; write FRACTION instead"
        time, own = meant.lasts(found, row.result.time), meant.lasts(self.survey, self.surveyed.time)
        if meant.differs(time, own):
            return f"the CYCLEs of {row.setting.name} last {time:.4g} s, those of the deck {own:.4g} s"
        return ""

    def _learn(self, build: str) -> None:
        """See what a cycle has cost in all runs of a word scheme until now, and so what each of them has.

        A single run of a small model takes times that differ by a quarter from one time to the next.
        """
        done = [(row, self._segments(row.setting.name)) for row in self._done[build]]
        if not done:
            return
        rates = self.rates[build]
        apart = [row.result.seconds - sum(one.seconds for one in found) for row, found in done if row.result]
        rates = cost.Rates(max(median(apart), 0.0), rates.each)
        spent = sum(one.seconds for _, found in done for one in found)
        thought = sum(rates.seconds([one.done for one in found]) - rates.apart for _, found in done)
        self.rates[build] = cost.scaled(rates, spent / thought) if spent > 0 and thought > 0 else rates
        for row, found in done:
            row.cost = self.rates[build].seconds([one.done for one in found])

    def results(self, runs: list[Surveyed]) -> list[Result]:
        """What comes of runs."""
        told, of = Told(self.options.stream, len(runs)), {run.name: run for run in runs}
        try:
            found = run_all(
                runs,
                self.folder,
                jobs=self.options.jobs,
                timed=True,
                told=lambda result, why: told(at_own_line(result, of[result.name]), why),
            )
        finally:
            told.close()
        return [at_own_line(result, of[result.name]) for result in found]

    def _segments(self, name: str) -> list[Segment]:
        found = segments(self.folder / RUNS / name)
        for one, static in zip(found, self.deck.statics, strict=False):  # a run may have failed half-way
            one.static = static
        return found
