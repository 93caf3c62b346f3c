"""How many digits of each quantity a deck determines, what limits them, and which fields lose the others.

Small noise in the last place grows in proportion: rounding costs as many digits in words of any length. If
64-bit reals have less than half of the digits more that they should have, the motion itself loses them: that
is chaos. What half the step changes by more than the spread is the error of the step.

Between two cycles of a perturbed run each real that has changed since the last kick is moved by xi units in
the last place, xi uniform in [-1, 1], and rounded: as if its last rounding were done once more, up or down at
random. There are KICKS at most. If a kick stands for k cycles it is sqrt(k) units high, as random steps add
up. The digits that perturbed results share are -log10(sigma/|mu|), with their standard deviation sigma and
mean mu (D. Sohier et al., ACM Trans. Math. Softw. 47(2), 2021).

Which fields lose them: the same with noise in one kind of groups only, and in single fields of those kinds
that have at least SHARE of the spread.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from statistics import fmean, stdev
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import layouts, read_table
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.printable_text import counted
from udec_ia.reader.group_tables import addresses as listed
from udec_ia.running.cycle_observer import between_cycles
from udec_ia.studies.execute_run import RunObserver
from udec_ia.studies.setting_runner import SettingRunner
from udec_ia.studies.settings import Setting
from udec_ia.studies.study_run import ENDED, RunResult, StudyRun

KICKS = 1000
STAYING = ("block", "corner", "gridpoint", "zone", "sdef")  # groups that come and go by commands only
PASSING = ("contact", "domain")  # groups that come and go in cycles
FEWEST = 3  # results of a sample
OF_FIELDS = 6  # runs with noise in some fields
KICK = 4e-4  # seconds, about
SHARE = 0.5  # of the digits that longer words have more; and of a spread, as four equal sources have
COLUMNS = ("quantity", "value", "digits", "32-bit digits", "step", "what limits it")
FIELD_COLUMNS = ("field", "spread", "share")


# ---- digits of a sample


class Digits(NamedTuple):
    """Of a sample. spread: sigma/|mu|. full: digits that the words have, and a sample of equal numbers."""

    mean: float
    spread: float
    digits: float
    full: float


def shared_digits(results: Sequence[float], bits: int) -> Digits | None:
    """The digits of results with `bits` bits in their fraction (52, 23); None for too few results."""
    found = [value for value in results if math.isfinite(value)]
    full = (bits + 1) * math.log10(2)
    if len(found) < FEWEST:
        return None
    mean, sigma = fmean(found), stdev(found)
    if sigma == 0:
        return Digits(mean, 0.0, full, full)
    spread = sigma / abs(mean) if mean else math.inf
    return Digits(mean, spread, min(-math.log10(spread), full) if mean else 0.0, full)


# ---- perturbed runs


@dataclass(frozen=True)
class PerturbedRun(StudyRun):
    """seed: of the noise, 0 for none. fields: "block.KX" ..., () for all. cycles: of the whole run, about."""

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
        self._fields: dict[str, Any] = {}  # numbers of words (n,) from the first of a group on
        for kind, every in noisy_fields().items():
            offset = layouts(array.scheme.ratio)[kind].offset
            some = [one.partition(".")[2] for one in every if not run.fields or one in run.fields]
            if some:
                self._fields[kind] = np.array([offset[name] - 1 for name in some], np.int64)
        self._staying = np.zeros(0, np.int64)
        self._before: Any = None

    def begin(self, array: MainArray, solves: bool) -> None:
        """Find the groups whose addresses stay during the run."""
        self._staying = self._cells(array, {kind: listed(array, kind) for kind in STAYING})

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the next kick."""
        h = array.h
        self._before = h.ra[: int(h.ci[g.MFREE]) // array.scheme.ratio + 1].copy()
        return min(n, self.every - int(h.ci[g.MCTOT]) % self.every)

    def look(self, array: MainArray, cycles: int) -> None:
        """Kick: move what has changed."""
        h = array.h
        if not between_cycles(h) or h.ci[g.MCTOT] % self.every:
            return
        passing = {kind: list_of(h, kind) for kind in PASSING}
        cells = np.concatenate([self._staying, self._cells(array, passing)])
        cells = cells[cells < len(self._before)]
        now = h.ra[cells]
        moved = np.isfinite(now) & (now != self._before[cells]) & (now != 0)
        cells, now = cells[moved], now[moved]
        xi = self._random.uniform(-1, 1, len(now)) * self.every**0.5
        h.ra[cells] = now + (xi * np.spacing(np.abs(now))).astype(now.dtype)

    def _cells(self, array: MainArray, groups: dict[str, Any]) -> Any:
        """Where the reals of groups are, as numbers of reals. groups: addresses by kind."""
        found = [np.zeros(0, np.int64)]
        for kind, words in self._fields.items():
            if kind in groups:
                first = (np.asarray(groups[kind], np.int64) - 1) // array.scheme.ratio
                found.append((first[:, None] + words).ravel())
        return np.concatenate(found)


@dataclass
class Ensemble:
    """Perturbed runs of a deck. results: by word scheme. half: with half the step. notes: sentences."""

    runner: SettingRunner
    names: list[str] = field(default_factory=list)
    half: RunResult | None = None
    results: dict[str, list[RunResult]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def digits(self, build: str, name: str) -> Digits | None:
        """Of one quantity."""
        bits = int(np.finfo(scheme(build).real_type).nmant)
        return shared_digits(_values(self.results[build], name), bits)

    def step_digits(self, name: str) -> float:
        """Digits that a run with half the step shares, NaN without one."""
        if self.runner.own.result is None or self.half is None:
            return math.nan
        a, b = self.runner.own.result.quantities[name], self.half.quantities[name]
        return math.inf if a == b else -math.log10(abs(a - b) / abs(b)) if b else 0.0

    def rows(self) -> list[tuple[object, ...]]:
        """A line for each quantity: the COLUMNS."""
        found: list[tuple[object, ...]] = []
        for name in self.names:
            one, *others = (self.digits(build, name) for build in self.results)
            two = others[0] if others else None
            step = min(self.step_digits(name), one.full) if one else math.nan  # equal numbers share all
            numbers = one.digits if one else math.nan, two.digits if two else math.nan, step
            cells = ["" if math.isnan(number) else round(number, 1) for number in numbers]
            found.append((name, one.mean if one else "", *cells, verdict(one, two, step)))
        return found


def _values(results: Sequence[RunResult], name: str) -> list[float]:
    """A quantity of the runs that have ended, at rest where that was asked for."""
    return [one.quantities[name] for one in results if one.status == ENDED and one.at_rest]


def verdict(wide: Digits | None, narrow: Digits | None, step: float) -> str:
    """What limits a quantity."""
    if wide is None:
        return "too few runs have ended: see log.txt in their folders"
    by_step = "the time-step; " if step < wide.digits else ""
    lost = max(wide.full - wide.digits, 0)
    if narrow is None:
        return f"{by_step}rounding or chaos takes {lost:.1f} digits: too few runs have shorter reals"
    more, gained = wide.full - narrow.full, max(wide.digits - narrow.digits, 0.0)
    if gained < SHARE * more:
        return f"{by_step}chaos: of the {more:.1f} digits more in longer words {gained:.1f} are left"
    return f"{by_step}rounding takes {lost:.1f} digits"


def measure_digits(runner: SettingRunner, runs: int) -> Ensemble:
    """Run the ensembles of a deck, `runs` of each word scheme, fewer if the budget is too small."""
    found, own = Ensemble(runner), runner.own
    why = runner.run_own_deck()
    if why or own.result is None:
        found.notes.append(why)
        return found
    found.names = [*own.result.quantities]
    row = runner.row(Setting(runner.wide, 0.5))
    runner.run_rows([row])
    if row.compared and runner.deck.is_stepped:
        found.half = row.result
    else:
        found.notes.append(f"no digits of the step: {row.why or 'FRACTION does not change it'}")
    runner.drop_unable_builds()
    cycles, builds = _cycles(runner), runner.builds[:2]
    seconds = own.result.seconds + KICK * min(cycles, KICKS)
    runs = max(FEWEST, min(runs, int(max(runner.left, 0) * runner.processes / (2 * seconds))))
    for build in builds:
        found.results[build] = perturbed(runner, build, runs)
    found.notes += runner.notes
    found.notes.append(
        f"{runs} runs in each word scheme, {counted(cycles, 'cycle')}, noise every "
        f"{counted(max(1, cycles // KICKS), 'cycle')}"
    )
    return found


def _cycles(runner: SettingRunner) -> int:
    """Cycles of the deck as it is."""
    return sum(one.done for one in runner.survey)


def perturbed(
    runner: SettingRunner, build: str, runs: int, fields: tuple[str, ...] = (), label: str = "noise"
) -> list[RunResult]:
    """`runs` perturbed runs of the deck as it is."""
    run = PerturbedRun(
        label,
        runner.deck.written(Setting(build)),
        runner.deck.name,
        quantities=runner.options.quantities,
        build=build,
        constitutive=runner.options.constitutive,
        fields=fields,
        cycles=_cycles(runner),
    )
    seeds = range(1, runs + 1)
    return runner.results([replace(run, name=f"{build},{label}={seed}", seed=seed) for seed in seeds])


# ---- fields


def blame_fields(found: Ensemble, quantity: str = "") -> tuple[str, list[tuple[object, ...]]]:
    """The shares of kinds of groups and fields in a spread, by default of the quantity with fewest digits."""
    runner, (build, *_) = found.runner, found.results
    known = {name: one for name in found.names if (one := found.digits(build, name)) and one.spread > 0}
    quantity = quantity or min(known, key=lambda name: known[name].digits, default="")
    if quantity not in known:
        return "no digit is lost, so no field is to blame", []
    line = f"{quantity}: its spread with noise in one field or kind of groups, and the share of the whole"
    waiting, rows = [*noisy_fields().items()], list[tuple[str, float, float]]()
    while waiting and runner.left > 0:
        name, fields = waiting.pop(0)
        results = perturbed(runner, build, OF_FIELDS, tuple(fields), f"noise in {name}")
        one = shared_digits(_values(results, quantity), 52)
        spread = one.spread if one else math.inf
        rows.append((name, spread, spread / known[quantity].spread))
        if len(fields) > 1 and rows[-1][2] >= SHARE:
            waiting += [(field, [field]) for field in fields]
    if waiting:
        line = f"{line}; not all were tried within the budget"
    rows.sort(key=lambda row: -row[2])
    return line, [row for row in rows if row[1] > 0]


def noisy_fields() -> dict[str, list[str]]:
    """The fields that noise can be in, by kind of group."""
    return {
        group.name: [f"{group.name}.{field.name}" for field in group.fields if field.real]
        for group in read_table().groups
        if group.name in (*STAYING, *PASSING)
    }
