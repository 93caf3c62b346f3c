"""How many digits of each quantity a deck determines, what limits them, and which fields lose the others.

Small noise in the last place grows in proportion: rounding costs as many digits in words of any length. If
64-bit reals have less than half of the digits more that they should have, the motion itself loses them: that
is chaos. What half the step changes by more than the spread is the error of the step.

Between two cycles of a perturbed run each real that has changed since the last kick is moved by xi units in
the last place, xi uniform in [-1, 1], and rounded to the nearest: as if the last rounding of each number were
done once more, up or down at random (Verrou and CADNA do that to every operation). There are KICKS at most.
If a kick stands for k cycles it is sqrt(k) units high: random steps, each as likely up as down, add up so.

Digits that a sample of perturbed results shares, with confidence: D. Sohier, P. de Oliveira Castro,
F. Fevotte, B. Lathuiliere, E. Petit, O. Jamond, Confidence intervals for stochastic arithmetic, ACM Trans.
Math. Softw. 47(2), 2021, for errors that are normal and centred: with the confidence 1 - a the s first bits
of a result are significant with the probability p if

    s <= -log2(sigma/|mu|) - [1/2 log2((n - 1)/chi2) + log2(F((p + 1)/2))]

sigma, mu: of the n results; chi2: the a/2 quantile of the chi-squared distribution with n - 1 degrees of
freedom; F: quantile of the normal distribution.

Noise in a few fields explains the loss if the spread with noise in them alone is at least SHARE of that with
noise in all. A least such set is found by delta debugging (A. Zeller, R. Hildebrandt, Simplifying and
isolating failure-inducing input, IEEE Trans. Software Eng. 28, 2002), first among kinds of groups, then among
their fields.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from statistics import NormalDist, fmean, stdev
from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import layouts, read_table
from udec_ia.printable_text import counted
from udec_ia.reader.group_tables import addresses as listed
from udec_ia.running.cycle_observer import between_cycles
from udec_ia.studies.execute_run import RunObserver
from udec_ia.studies.setting_runner import END_TIME, SettingRunner
from udec_ia.studies.settings import Setting
from udec_ia.studies.study_run import ENDED, RunResult, StudyRun

KICKS = 1000
STAYING = ("block", "corner", "gridpoint", "zone", "sdef")  # groups that come and go by commands only
PASSING = {"contact": (g.ICPNT, g.KC), "domain": (g.IDPNT, g.KD)}  # those of cycles: head and link
KINDS = (*STAYING, *PASSING)
PROBABILITY = CONFIDENCE = 0.95
FEWEST = 3  # results of a sample
ENSEMBLE, OF_FIELDS = 16, 6  # runs of an ensemble, and of one with noise in some fields
KICK = 4e-4  # seconds, about
SHARE = 0.5  # of the digits that longer words have more; and of a spread, as four equal sources have
COLUMNS = (
    *("quantity", "value", "digits", "at least", "32-bit digits", "32-bit at least", "step"),
    "what limits it",
)
FIELD_COLUMNS = ("field", "spread", "share")


# ---- digits of a sample


@dataclass(frozen=True)
class Digits:
    """Of `runs` results. mean; spread: sigma/|mu|; digits: -log10 of it; lower: lower end of the interval.

    full: digits that the words have; a sample of equal numbers has as many.
    """

    runs: int
    mean: float
    spread: float
    digits: float
    lower: float
    full: float


def shared_digits(results: Sequence[float], bits: int) -> Digits | None:
    """The digits of results with so many bits in their fraction (52, 23); None for too few results."""
    found = [value for value in results if math.isfinite(value)]
    full = (bits + 1) * math.log10(2)
    if len(found) < FEWEST:
        return None
    mean, sigma = fmean(found), stdev(found)
    if sigma == 0:
        return Digits(len(found), mean, 0.0, full, full, full)
    spread = sigma / abs(mean) if mean else math.inf
    own = min(-math.log10(spread), full) if spread < math.inf else 0.0
    return Digits(len(found), mean, spread, own, own - doubt(len(found)), full)


def doubt(runs: int) -> float:
    """Decimal digits that a sample of so many results does not guarantee: the bracket above."""
    quantile = chi_squared((1 - CONFIDENCE) / 2, runs - 1)
    bits = 0.5 * math.log2((runs - 1) / quantile) + math.log2(NormalDist().inv_cdf((PROBABILITY + 1) / 2))
    return bits * math.log10(2)


def chi_squared(p: float, degrees: int) -> float:
    """The p quantile of the chi-squared distribution (E. B. Wilson and M. M. Hilferty, PNAS 17, 1931).

    For the 0.025 quantile it is too small: by half for 2 degrees, by 2 % for 7, which leaves more doubt.
    """
    part = 2 / (9 * degrees)
    return float(degrees * (1 - part + NormalDist().inv_cdf(p) * math.sqrt(part)) ** 3)


# ---- perturbed runs


@dataclass(frozen=True)
class PerturbedRun(StudyRun):
    """A perturbed run. seed: of the noise, 0 for none. fields: "block.KX" ..., all if there are none.

    cycles: of the whole run, about.
    """

    seed: int = 1
    fields: tuple[str, ...] = ()
    cycles: int = 0

    @property
    def made_of(self) -> dict[str, str]:
        return super().made_of | {"noise": f"{self.seed} {self.fields} {self.cycles}"}

    def observers(self, model: Any) -> list[RunObserver]:
        return [_Noise(model.array, self)] if self.seed else []


class _Noise(RunObserver):
    """Kicks the reals of a model, as `run` asks for."""

    def __init__(self, array: MainArray, run: PerturbedRun) -> None:
        self.every = max(1, run.cycles // KICKS)
        self._random = np.random.default_rng(run.seed)
        ratio = array.scheme.ratio
        shapes = {
            kind: [layouts(ratio)[kind].offset[field.partition(".")[2]] - 1 for field in fields]
            for kind, every in noisy_fields().items()
            if (fields := [field for field in every if not run.fields or field in run.fields])
        }
        self._fields = {kind: np.array(found, np.int64) for kind, found in shapes.items()}
        self._staying = np.zeros(0, np.int64)
        self._before: Any = None

    def begin(self, array: MainArray, solves: bool) -> None:
        """See RunObserver: groups are where they will stay."""
        parts = [self._cells(array, kind, listed(array, kind)) for kind in self._fields if kind in STAYING]
        self._staying = np.concatenate([np.zeros(0, np.int64), *parts])

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """See RunObserver: until the next kick."""
        h = array.h
        self._before = h.ra[: int(h.ci[g.MFREE]) // array.scheme.ratio + 1].copy()
        return min(n, self.every - int(h.ci[g.MCTOT]) % self.every)

    def look(self, array: MainArray, cycles: int) -> None:
        if between_cycles(array.h) and array.h.ci[g.MCTOT] % self.every == 0:
            self._kick(array)

    def _kick(self, array: MainArray) -> None:
        """Move what has changed."""
        h = array.h
        parts = [
            self._cells(array, kind, addresses(h, int(h.ci[head]), link))
            for kind, (head, link) in PASSING.items()
            if kind in self._fields
        ]
        cells = np.concatenate([self._staying, *parts])
        cells = cells[cells < len(self._before)]
        now = h.ra[cells]
        moved = np.isfinite(now) & (now != self._before[cells]) & (now != 0)
        cells, now = cells[moved], now[moved]
        xi = self._random.uniform(-1, 1, len(now)) * self.every**0.5
        h.ra[cells] = now + (xi * np.spacing(np.abs(now))).astype(now.dtype)

    def _cells(self, array: MainArray, kind: str, at: Any) -> Any:
        """Where the reals of groups are, as numbers of reals."""
        first = (np.asarray(at, np.int64) - 1) // array.scheme.ratio
        return (first[:, None] + self._fields[kind]).ravel()


@dataclass
class Ensemble:
    """Perturbed runs of a deck. results: by word scheme. half: with half the step. notes: sentences."""

    runner: SettingRunner
    names: list[str] = field(default_factory=list)
    plain: RunResult | None = None
    half: RunResult | None = None
    results: dict[str, list[RunResult]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def digits(self, build: str, name: str) -> Digits | None:
        """Of one quantity."""
        bits = int(np.finfo(scheme(build).real_type).nmant)
        return shared_digits(_values(self.results[build], name), bits)

    def step_digits(self, name: str) -> float:
        """Digits that a run with half the step shares, NaN without one."""
        if self.plain is None or self.half is None:
            return math.nan
        a, b = self.plain.quantities[name], self.half.quantities[name]
        return math.inf if a == b else -math.log10(abs(a - b) / abs(b)) if b else 0.0

    def rows(self) -> list[tuple[object, ...]]:
        """A line for each quantity: the COLUMNS."""
        found: list[tuple[object, ...]] = []
        for name in self.names:
            one, *others = (self.digits(build, name) for build in self.results)
            two = others[0] if others else None
            parts = [getattr(a, part) if a else math.nan for a in (one, two) for part in ("digits", "lower")]
            step = min(self.step_digits(name), one.full) if one else math.nan  # equal numbers share all
            cells = ["" if math.isnan(number) else round(number, 1) for number in (*parts, step)]
            found.append((name, one.mean if one else "", *cells, verdict(one, two, step)))
        return found


def _values(results: Sequence[RunResult], name: str) -> list[float]:
    """A quantity of the runs that have ended, at rest where that was asked for."""
    return [one.quantities[name] for one in results if one.status == ENDED and one.at_rest]


def verdict(wide: Digits | None, narrow: Digits | None, step: float) -> str:
    """What limits a quantity."""
    if wide is None:
        return "too few runs have ended: see log.txt in their folders"
    by_step = "the time-step; " if step < wide.lower else ""
    lost = max(wide.full - wide.digits, 0)
    if narrow is None:
        return f"{by_step}rounding or chaos takes {lost:.1f} digits: too few runs have shorter reals"
    more, gained = wide.full - narrow.full, max(wide.digits - narrow.digits, 0.0)
    if gained < SHARE * more:
        return f"{by_step}chaos: of the {more:.1f} digits more in longer words {gained:.1f} are left"
    return f"{by_step}rounding takes {lost:.1f} digits"


def measure_digits(runner: SettingRunner, runs: int) -> Ensemble:
    """Run the ensembles of a deck, `runs` of each word scheme."""
    options, deck, found = runner.options, runner.deck, Ensemble(runner)
    why = runner.run_own_deck()
    if why or runner.own.result is None:
        found.notes.append(why)
        return found
    found.plain = runner.own.result
    found.names = [*found.plain.quantities][1:]
    row = runner.row(Setting(runner.wide, 0.5))
    runner.run_rows([row])
    if row.compared and deck.is_stepped:
        found.half = row.result
    else:
        found.notes.append(f"no digits of the step: {row.why or 'FRACTION does not change it'}")
    runner.drop_unable_builds()
    cycles = sum(one.done for one in runner.survey)
    seconds = found.plain.seconds + KICK * min(cycles, KICKS)
    runs = max(FEWEST, min(runs, int(max(runner.left, 0) * runner.processes / (2 * seconds))))
    options.show(f"{runs} runs of {seconds:.3g} s in each of {' and '.join(runner.builds[:2])}")
    for build in runner.builds[:2]:
        found.results[build] = perturbed(runner, build, cycles, range(1, runs + 1))
    found.notes += runner.notes
    found.notes.append(
        f"{runs} runs in each word scheme, {counted(cycles, 'cycle')}, noise every "
        f"{counted(max(1, cycles // KICKS), 'cycle')}; confidence and probability 95 %"
    )
    return found


def perturbed(
    runner: SettingRunner,
    build: str,
    cycles: int,
    seeds: range,
    fields: tuple[str, ...] = (),
    label: str = "noise",
) -> list[RunResult]:
    """Perturbed runs of the deck as it is."""
    text, options = runner.deck.written(Setting(build)), runner.options
    runs = [
        PerturbedRun(
            f"{build},{label}={seed}",
            text,
            runner.deck.name,
            quantities=(END_TIME, *options.quantities),
            build=build,
            constitutive=options.constitutive,
            seed=seed,
            fields=fields,
            cycles=cycles,
        )
        for seed in seeds
    ]
    return runner.results(runs)


# ---- fields


class OutOfBudgetError(Exception):
    """The budget has ended before the search."""


class FieldBlame:
    """Finds the fields from which the spread of a quantity of an ensemble comes.

    quantity: by default the one with the fewest digits.
    """

    def __init__(self, found: Ensemble, quantity: str = "") -> None:
        self.found = found
        self.build, *_ = found.results
        measured = {name: found.digits(self.build, name) for name in found.names}
        known = {name: one for name, one in measured.items() if one is not None and one.spread > 0}
        self.quantity = quantity or min(known, key=lambda name: known[name].digits, default="")
        self.whole = known[self.quantity].spread if self.quantity in known else 0.0
        self.cycles = sum(one.done for one in found.runner.survey)
        self.tests: dict[tuple[str, ...], float] = {}  # spreads of the ensembles that were run

    def spread(self, fields: Sequence[str]) -> float:
        """The spread with noise in some fields only."""
        key = tuple(sorted(fields))
        if key not in self.tests:
            if self.found.runner.left <= 0:
                raise OutOfBudgetError
            seeds, label = range(1, OF_FIELDS + 1), f"noise{len(self.tests)}"
            results = perturbed(self.found.runner, self.build, self.cycles, seeds, key, label)
            one = shared_digits(_values(results, self.quantity), 52)
            self.tests[key] = one.spread if one else float("inf")
        return self.tests[key]

    def explains(self, fields: Sequence[str]) -> bool:
        """True if noise in these fields alone is enough."""
        return bool(fields) and self.spread(fields) >= SHARE * self.whole

    def search(self) -> tuple[str, list[tuple[object, ...]]]:
        """The result as a sentence, and a line for each field to blame: the FIELD_COLUMNS."""
        if not self.quantity or self.whole == 0:
            return "no digit is lost, so no field is to blame", []
        every = noisy_fields()

        def fields_of(kinds: Sequence[str]) -> list[str]:
            return [field for kind in kinds for field in every[kind]]

        try:
            kinds = smallest_part([*every], lambda some: self.explains(fields_of(some)))
            fields = fields_of(kinds)
            if self.explains(fields_of([kind for kind in every if kind not in kinds])):
                why = (
                    f"noise in each {' and '.join(kinds)} explains the loss, and so does noise in all other "
                    "groups: the digits are lost in the motion itself, whatever is perturbed"
                )
            else:
                fields = smallest_part(fields, self.explains)
                why = "noise in these fields alone explains the loss; noise in other groups does not"
            spreads = [(field, self.spread([field])) for field in fields]
            return f"{self.quantity}: {why}", [(field, one, one / self.whole) for field, one in spreads]
        except OutOfBudgetError:
            why = "the budget has ended before the fields were found; give a greater one"
            return f"{self.quantity}: {why}", []


def noisy_fields() -> dict[str, list[str]]:
    """The fields that noise can be in, by kind of group."""
    return {
        group.name: [f"{group.name}.{field.name}" for field in group.fields if field.real]
        for group in read_table().groups
        if group.name in KINDS
    }


def smallest_part(items: list[str], is_enough: Callable[[list[str]], bool]) -> list[str]:
    """A smallest part of `items` that is enough: none of the parts that were tried within it is (ddmin).

    All of them are assumed to be enough.
    """
    parts = 2
    while len(items) > 1:
        size = -(-len(items) // parts)
        chunks = [items[k : k + size] for k in range(0, len(items), size)]
        rests = [[one for one in items if one not in chunk] for chunk in chunks] if len(chunks) > 2 else []
        better = next((one for one in [*chunks, *rests] if is_enough(one)), None)
        if better is not None:
            parts = 2 if better in chunks else max(parts - 1, 2)
            items = better
        elif parts >= len(items):
            break
        else:
            parts = min(2 * parts, len(items))
    return items
