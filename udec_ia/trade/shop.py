"""Runs of one deck in other settings: how they are made, what they will cost, and what they have cost."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import TextIO

from udec_ia.heap.words import DEFAULT_SCHEME
from udec_ia.study.many import RUNS, run_all
from udec_ia.study.progress import Told
from udec_ia.study.runs import Result
from udec_ia.trade import cost
from udec_ia.trade.judge import Row
from udec_ia.trade.levers import Deck, Fraction, Numbers, Setting
from udec_ia.trade.steps import numbers
from udec_ia.trade.surveyed import Segment, Surveyed, segments

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
    """Runs settings of one deck, and knows what they cost."""

    def __init__(self, deck: Deck, options: Options, folder: Path) -> None:
        self.deck, self.options, self.folder = deck, options, folder
        self.wide = WIDE.get(options.build, options.build)
        self.builds = [*dict.fromkeys((self.wide, *(options.builds or (NARROW[self.wide],))))]
        self.survey: list[Segment] = []
        self.fraction: Fraction | None = None  # what the deck begins with, as far as that matters
        self.rates: dict[str, cost.Rates] = {}
        self.left = options.budget  # seconds of the clock
        self._done: dict[str, list[Row]] = {}

    def run(self, setting: Setting, numbers: Numbers | None = None, **named: object) -> Surveyed:
        """The run of a setting."""
        text = self.deck.written(setting, numbers, self.fraction)
        name = str(named.pop("name", setting.name))
        return Surveyed(
            name,
            text,
            quantities=("end of time = time", *self.options.quantities),
            build=setting.build,
            constitutive=self.options.constitutive,
            **named,  # type: ignore[arg-type]
        )

    def rehearse(self) -> None:
        """Learn what a cycle costs in each word scheme."""
        for build in self.builds:
            names = [f"{WARM},{build}", f"{REHEARSAL},{build}"]  # the first one loads what it needs
            runs = [self.run(Setting(build), name=name, rehearsed=REHEARSED) for name in names]
            result = self.results(runs)[-1]
            self.rates[build] = cost.rates(result, self._segments(result.name))

    def rehearsal(self, setting: Setting, seconds: float) -> list[Segment]:
        """The CYCLEs and SOLVEs of a rehearsal, each of which ends after some seconds."""
        run = self.run(setting, name=f"{REHEARSAL},{setting.name}", rehearsed=seconds)
        self.results([run])
        return self._segments(run.name)

    def look(self) -> Result:
        """The survey."""
        run = self.run(Setting(self.wide), name=SURVEYED, limits=True)
        result = self.results([run])[0]
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
        return sum(row.predicted for row in rows) / (self.options.jobs or 1)

    def do(self, rows: Sequence[Row]) -> list[Row]:
        """Run rows, as many as the budget allows, and drop the dearest. Returns those that were dropped."""
        taken = sorted(rows, key=lambda row: row.predicted)
        dropped: list[Row] = []
        while taken and self.price(taken) > self.left:
            dropped.append(taken.pop())
        for build in dict.fromkeys(row.setting.build for row in taken):
            some = [row for row in taken if row.setting.build == build]
            limits = [max(SHORT, LATE * row.predicted) for row in some]
            runs = [
                self.run(row.setting, row.numbers, limit=last) for row, last in zip(some, limits, strict=True)
            ]
            results = self.results(runs)
            for row, result in zip(some, results, strict=True):
                row.result = result
            self._done[build] = self._done.get(build, []) + [row for row in some if row.ran]
            self._learn(build)
        self.left -= sum(row.result.seconds for row in taken if row.result) / (self.options.jobs or 1)
        return dropped

    def _learn(self, build: str) -> None:
        """See what a cycle has cost in all runs of a word scheme until now, and so what each of them has.

        A single run of a small model takes times that differ by a quarter from one time to the next.
        """
        done = [(row, self._segments(row.setting.name)) for row in self._done[build]]
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
        told = Told(self.options.stream, len(runs))
        try:
            return run_all(runs, self.folder, jobs=self.options.jobs, timed=True, told=told)
        finally:
            told.close()

    def _segments(self, name: str) -> list[Segment]:
        found = segments(self.folder / RUNS / name)
        for one, static in zip(found, self.deck.statics, strict=False):  # a run may have failed half-way
            one.static = static
        return found
