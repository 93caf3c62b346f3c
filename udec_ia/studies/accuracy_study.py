"""Studies what accuracy costs for a deck, and finds the cheapest setting within a tolerance (docs/trade.md).

A quantity whose values converge as the time-step is halved has a reference (extrapolation.py); others are not
compared, and neither are runs that did not reach the force ratio of their SOLVE. The cheapest setting is
recommended whose error plus that of the reference is within the tolerance, for every known quantity.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from udec_ia.deck.deck_variables import Values
from udec_ia.heap.word_scheme import scheme
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.extrapolation import HIGHEST, Extrapolation, converges, extrapolate, share
from udec_ia.studies.setting_runner import Options, Row, SettingRunner
from udec_ia.studies.settings import BEYOND, Fraction, Setting, rounded, share_of_bound

REFINEMENT_GOAL = 0.1  # of the tolerance: the error at which a reference is refined no further
LEVELS, FINEST = 2, 6  # halvings of the reference: at first, and at most
REST_ORDER = 12.0  # greatest order where rest is sought more closely from level to level
REFERENCE_LIMIT = 0.5  # of the tolerance: the greatest error of a reference
MOTION_LIMIT = 0.1  # of the tolerance: the same for a motion whose values have no order
STEP_RATIO = 2**0.5  # of neighbouring time-steps: the cheapest one is found to within that factor
LARGEST_STEP = 16.0  # over the step of the deck
SAFE = (0.9, 0.5)
TIGHTER = 0.1  # ratio of SOLVE, from one level of the reference to the next
TIME_SCATTER = 0.2, 0.02  # share, and seconds, by which two times differ before one is the shorter


@dataclass
class AccuracyStudy:
    """The study of one deck. rows: all settings, the cheapest first; best: the recommended one.

    levels: rows of the reference, the step halved from one to the next. references: what quantities tend to;
    known: those that are compared. fraction: that of the deck at first, None if it does not matter. solved:
    what SOLVE reports in the deck as it is. notes: sentences.
    """

    deck: Deck
    tolerance: float
    rows: list[Row] = field(default_factory=list)
    levels: list[Row] = field(default_factory=list)
    references: dict[str, Extrapolation] = field(default_factory=dict)
    known: list[str] = field(default_factory=list)
    best: Row | None = None
    fraction: Fraction | None = None
    solved: str = ""
    notes: list[str] = field(default_factory=list)

    @property
    def can_recommend(self) -> bool:
        """True if a known quantity is not the same number at all steps."""
        return any(self.references[name].error > 0 for name in self.known)

    def values(self, name: str, rows: Iterable[Row] | None = None) -> list[float]:
        """A quantity in rows, by default all, that are compared."""
        rows = self.rows if rows is None else rows
        return [row.result.quantities[name] for row in rows if row.result and row.compared]

    def is_within(self, row: Row) -> bool:
        """True if all errors, with those of the references, are within the tolerance."""
        errors = [error + self.references[name].share for name, error in row.errors.items()]
        return row.compared and bool(errors) and max(errors) <= self.tolerance

    def run_rows(self, runner: SettingRunner, settings: Iterable[Setting]) -> list[Row]:
        """Run settings as far as the budget lasts."""
        rows = [runner.row(setting) for setting in settings]
        self.rows += [row for row in rows if row not in self.rows]
        runner.run_rows(rows)
        return rows

    def choose(self) -> None:
        """Find the quantities that can be compared, the errors of all rows, and the recommended one.

        Values of a motion that scatter may be near each other by chance: where the deck only has CYCLEs, a
        quantity without an order must be known ten times as well as others.
        """
        solves = self.deck.has("solve")
        limits = {
            name: MOTION_LIMIT if math.isnan(reference.order) and not solves else REFERENCE_LIMIT
            for name, reference in self.references.items()
        }
        shares = {name: reference.share / self.tolerance for name, reference in self.references.items()}
        self.known = [name for name, share in shares.items() if share <= limits[name]]
        compared = self.known if self.can_recommend else []
        for row in self.rows:
            if row.result is not None and row.compared:
                values = row.result.quantities
                row.errors = {name: self.references[name].error_of(values[name]) for name in compared}
        self.best = recommended([row for row in self.rows if self.is_within(row)])


def study_accuracy(
    text: str, name: str, values: Values | None, folder: Path, options: Options, where: Path | None = None
) -> AccuracyStudy:
    """Study the deck `text`. name: of its file. where: its folder. folder: for what is written.

    Raises UdecError for what is wrong with the deck, and if nothing can be written.
    """
    deck = Deck(text, name, values, where)
    study = AccuracyStudy(deck, options.tolerance)
    with SettingRunner(deck, options, folder) as runner:
        why = runner.run_own_deck()
        if why or runner.own.result is None:
            study.notes.append(why)
            return study
        study.fraction, study.solved = runner.fraction, runner.own.result.message
        study.references = dict.fromkeys(runner.own.result.quantities, Extrapolation(math.nan, math.inf))
        if options.half_step:
            study.levels = study.run_rows(runner, [Setting(runner.wide), Setting(runner.wide, 0.5)])
            study.levels = [row for row in study.levels if row.compared]
            return study
        runner.drop_unable_builds()
        _reference(study, runner)
        if len(study.levels) > 1:
            study.run_rows(runner, _longer_steps(runner))
            study.choose()
            if study.can_recommend and (study.best is None or study.best.setting.step < 1):
                finest = min(row.setting.step for row in ([study.best] if study.best else study.levels))
                study.run_rows(runner, _shorter_steps(runner, finest))
                study.choose()
        dropped = [row.setting.name for row in study.rows if row.result is None]
        if dropped:
            study.notes.append(f"not run, as they go beyond the budget: {', '.join(dropped)}")
        study.notes += runner.notes
    study.rows.sort(key=lambda row: (row.cost, row.predicted))
    return study


def _reference(study: AccuracyStudy, runner: SettingRunner) -> None:
    """Halve the step until the references are good enough, or the budget ends, or nothing converges."""
    highest = REST_ORDER if study.deck.has("solve") else HIGHEST
    settings = [_level(runner, k) for k in range(LEVELS + 1)]
    while True:
        rows = study.run_rows(runner, settings)
        study.levels += [row for row in rows if row.compared]
        values = {name: study.values(name, study.levels) for name in study.references}
        if study.levels:
            study.references = {name: extrapolate(found, highest) for name, found in values.items()}
        study.choose()
        is_unknown = any(
            reference.share > REFINEMENT_GOAL * study.tolerance and converges(values[name])
            for name, reference in study.references.items()
        )
        k = len(study.levels)
        if not is_unknown or k > FINEST or any(not row.compared for row in rows):
            return
        settings = [_level(runner, k)]
        if runner.predicted_seconds([runner.row(setting) for setting in settings]) > runner.left / 2:
            return


def _level(runner: SettingRunner, k: int) -> Setting:
    """The reference after `k` halvings; where the deck has a SOLVE also closer to rest."""
    ratio = TIGHTER**k if runner.deck.has("solve") else 1.0
    step = 2.0**-k if runner.deck.is_stepped else 1.0
    return Setting(runner.wide, step, ratio=float(f"{ratio:.6g}"))


def _longer_steps(runner: SettingRunner) -> list[Setting]:
    """Steps of the deck and above, as far as they can be stable; FRACTION f SAFE; SOLVE ... STATIC."""
    deck, survey = runner.deck, runner.survey
    if not deck.is_stepped:
        return _with_tighter(runner, [Setting(build) for build in runner.builds])
    fractions = [segment.fraction for segment in survey if segment.safe and not segment.static]
    largest = min((1 / fraction for fraction in fractions), default=math.inf)
    steps = [STEP_RATIO**k for k in range(9) if STEP_RATIO**k <= min(LARGEST_STEP * 1.01, largest)]
    settings: list[Setting] = []
    for build in runner.builds:
        stepped = [Setting(build, rounded(step)) for step in steps]
        settings += [one for one in stepped if one.step == 1 or share_of_bound(survey, one) <= BEYOND]
        if any(0 < segment.bound < math.inf for segment in survey):
            settings += [Setting(build, safe=safe) for safe in SAFE]
        if deck.rests:
            settings.append(Setting(build, static=True))
    return _with_tighter(runner, settings)


def _shorter_steps(runner: SettingRunner, finest: float) -> list[Setting]:
    """Steps below that of the deck, down to `finest`, if they matter to it."""
    settings: list[Setting] = []
    step = 1 / STEP_RATIO
    while runner.deck.is_stepped and step > finest * 0.99:
        settings += [Setting(build, rounded(step)) for build in runner.builds]
        step /= STEP_RATIO
    return _with_tighter(runner, settings)


def _with_tighter(runner: SettingRunner, settings: list[Setting]) -> list[Setting]:
    """These settings, and with a SOLVE the same closer to rest."""
    closer = settings if runner.deck.has("solve") else []
    return settings + [replace(setting, ratio=setting.ratio * TIGHTER) for setting in closer]


def recommended(rows: Sequence[Row]) -> Row | None:
    """The cheapest of rows within the tolerance; 32-bit reals only if they save more than times scatter."""
    wide = [row for row in rows if scheme(row.setting.build).real_bits == 64]
    best, safe = (min(group, key=lambda row: (row.cost, row.memory), default=None) for group in (rows, wide))
    if best is None or safe is None:
        return best
    part, seconds = TIME_SCATTER
    return best if safe.cost - best.cost > max(part * safe.cost, seconds) else safe


def pareto_set(rows: Sequence[Row]) -> list[Row]:
    """Rows to which no other is better in error, time and memory, or as good in all and better in one."""
    marks = [(row.error, row.cost, row.memory) for row in rows if math.isfinite(row.error)]

    def is_beaten(row: Row) -> bool:
        own = row.error, row.cost, row.memory
        others = (one for one in marks if one != own)
        return any(all(x <= y for x, y in zip(one, own, strict=True)) for one in others)

    return [row for row in rows if math.isfinite(row.error) and not is_beaten(row)]


def path_differences(study: AccuracyStudy) -> dict[str, float]:
    """Shares by which quantities differ on the loading path of SOLVE ... STATIC; {} if that was not run."""
    static = [row for row in study.rows if row.compared and row.setting.static]
    if not static or not study.levels or study.levels[-1].setting.static:
        return {}
    differences = {}
    for name in study.references:
        (finest,) = study.values(name, study.levels[-1:])
        differences[name] = max(share(abs(value - finest), finest) for value in study.values(name, static))
    return differences
