"""`udec trade DECK`: what accuracy costs for the user's deck, and the cheapest setting within a tolerance.

A quantity whose values converge as the time-step is halved has a reference (extrapolation.py); others are not
compared, and neither are runs that did not reach the force ratio of their SOLVE. The settings (settings.py)
run as long as the budget lasts (setting_runner.py). The cheapest one is recommended whose error plus that of
the reference is within the tolerance, for every quantity with a reference. docs/trade.md says more.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from udec_ia.deck.deck_variables import Values
from udec_ia.heap.word_scheme import scheme
from udec_ia.printable_text import counted
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.extrapolation import HIGHEST, Extrapolation, converges, extrapolate, share
from udec_ia.studies.setting_runner import Options, Row, SettingRunner
from udec_ia.studies.settings import Fraction, Setting, longer_steps, reference_setting, shorter_steps
from udec_ia.studies.survey_run import RunSeparation, find_separation
from udec_ia.studies.worker_pool import RUNS

WANTED = 0.1  # of the tolerance: the error of the reference that it is refined for
LEVELS, FINEST = 2, 6  # halvings of the reference: at first, and at most
REST_ORDER = 12.0  # greatest order where rest is sought more closely from level to level
SPREAD = 0.5  # of the tolerance: what the error of a reference may be
SCATTER = 0.2, 0.02  # share, and seconds, by which two times differ before one is the shorter


@dataclass
class AccuracyStudy:
    """The study of one deck. rows: all settings. references: of the quantities, None without a value.

    known: quantities that are compared. levels: rows of the reference, the step halved from one to the next.
    best: the recommended one. fraction: that of the deck at first, None if it does not matter. separation:
    where the finest runs part. solved: what SOLVE reports in the deck as it is. notes: sentences.
    """

    deck: Deck
    tolerance: float
    folder: Path
    rows: list[Row] = field(default_factory=list)
    levels: list[Row] = field(default_factory=list)
    references: dict[str, Extrapolation | None] = field(default_factory=dict)
    known: list[str] = field(default_factory=list)
    best: Row | None = None
    fraction: Fraction | None = None
    separation: RunSeparation | None = None
    solved: str = ""
    notes: list[str] = field(default_factory=list)

    @property
    def margins(self) -> dict[str, float]:
        """By how much measured errors may be wrong: the errors of the references."""
        return {name: one.share for name in self.known if (one := self.references[name])}

    @property
    def can_recommend(self) -> bool:
        """True if a known quantity is not the same number at all steps."""
        return depends_on_step(self.references, self.known)

    def path(self, row: Row) -> Path:
        """The folder of a run."""
        return self.folder / RUNS / row.setting.name

    def values(self, name: str) -> list[float]:
        """A quantity in all runs that are compared."""
        return [row.result.quantities[name] for row in self.rows if row.result and row.compared]

    def add_rows(self, rows: Iterable[Row]) -> None:
        """Add settings that are not in it yet."""
        self.rows += [row for row in rows if row not in self.rows]


def study_accuracy(
    text: str, name: str, values: Values | None, folder: Path, options: Options, where: Path | None = None
) -> AccuracyStudy:
    """Study the deck `text`. name: of its file. where: its folder. folder: for what is written.

    Raises UdecError for what is wrong with the deck, and if nothing can be written.
    """
    deck = Deck(text, name, values, where)
    study = AccuracyStudy(deck, options.tolerance, folder)
    with SettingRunner(deck, options, folder) as runner:
        why = runner.run_own_deck()
        if why:
            study.notes.append(why)
            return study
        study.fraction = runner.fraction
        if runner.own.result:
            study.solved = runner.own.result.message
            study.references = dict.fromkeys([*runner.own.result.quantities][1:])
        if options.half_step:
            study.rows = [runner.own, runner.row(Setting(runner.wide, 0.5))]
            runner.run_rows(study.rows)
            study.levels = [row for row in study.rows if row.compared]
            return study
        runner.drop_unable_builds()
        _reference(study, runner)
        if len(study.levels) > 1:
            _settings(study, runner)
        dropped = [row.setting.name for row in study.rows if row.result is None]
        if dropped:
            study.notes.append(f"not run, as they go beyond the budget: {', '.join(dropped)}")
        study.notes += runner.notes
    return study


def _reference(study: AccuracyStudy, runner: SettingRunner) -> None:
    """Halve the step until the references are good enough, or the budget ends, or nothing converges."""
    own, deck = Setting(runner.wide), study.deck
    solves, stepped = deck.has("solve"), deck.is_stepped
    highest = REST_ORDER if solves else HIGHEST
    wanted = [runner.row(reference_setting(own, k, stepped, solves)) for k in range(LEVELS + 1)]
    while True:
        runner.options.show(f"reference: {', '.join(row.setting.name for row in wanted)}")
        study.add_rows(wanted)
        runner.run_rows(wanted)
        study.levels += [row for row in wanted if row.compared]
        if len(study.levels) > 1:
            one, two = (study.path(row) for row in study.levels[-2:])
            study.separation = find_separation(one, two, study.tolerance)
        values = {
            name: [row.result.quantities[name] for row in study.levels if row.result]
            for name in study.references
        }
        study.references = {name: extrapolate(found, highest) for name, found in values.items()}
        enter_errors(study)
        unknown = any(
            one and one.share > WANTED * study.tolerance and converges(values[name])
            for name, one in study.references.items()
        )
        k = len(study.levels)
        if not unknown or k > FINEST or any(not row.compared for row in wanted):
            return
        wanted = [runner.row(reference_setting(own, k, stepped, solves))]
        if runner.predicted_seconds(wanted) > runner.left / 2:
            return


def _settings(study: AccuracyStudy, runner: SettingRunner) -> None:
    """Run what may be cheaper than the reference, and choose."""
    deck, builds = study.deck, runner.builds
    solves, stepped = deck.has("solve"), deck.is_stepped
    _try(study, runner, longer_steps(runner.survey, builds, stepped, solves, deck.rests))
    if study.can_recommend and (study.best is None or study.best.setting.step < 1):
        finest = study.best.setting.step if study.best else min(row.setting.step for row in study.levels)
        _try(study, runner, shorter_steps(builds, finest, stepped, solves))


def _try(study: AccuracyStudy, runner: SettingRunner, settings: Iterable[Setting]) -> None:
    """Run settings, and choose."""
    rows = [runner.row(one) for one in settings]
    many, seconds = counted(len(rows), "setting"), runner.predicted_seconds(rows)
    runner.options.show(f"{many} to run, about {seconds:.3g} s; {runner.left:.3g} s of the budget are left")
    study.add_rows(rows)
    runner.run_rows(rows)
    enter_errors(study)
    if study.can_recommend:
        study.best = recommended(study.rows, study.margins, study.tolerance)


# ---- errors and choice


def enter_errors(study: AccuracyStudy) -> None:
    """Find the quantities that can be compared, and enter the errors of all rows.

    If the finest runs have parted for good, two numbers may still be near each other by chance: then only
    quantities that converge with an order, or are the same, are compared.
    """
    study.known = [
        name
        for name, one in study.references.items()
        if one
        and one.share <= SPREAD * study.tolerance
        and (study.separation is None or math.isfinite(one.order) or one.error == 0)
    ]
    for row in study.rows:
        if row.result is not None and row.compared:
            found = row.result.quantities
            known = [(name, study.references[name]) for name in study.known if study.can_recommend]
            row.errors = {name: one.error_of(found[name]) for name, one in known if one}


def depends_on_step(references: Mapping[str, Extrapolation | None], known: Sequence[str]) -> bool:
    """True if one of the known quantities is not the same number at all steps, as 0 is above all."""
    return any((one := references[name]) is not None and one.error > 0 for name in known)


def is_within(row: Row, margins: Mapping[str, float], tolerance: float) -> bool:
    """True if all errors, with what they may be wrong by, are within the tolerance."""
    if not row.compared or not row.errors:
        return False
    return all(error + margins[name] <= tolerance for name, error in row.errors.items())


def recommended(rows: Sequence[Row], margins: Mapping[str, float], tolerance: float) -> Row | None:
    """The cheapest setting within the tolerance; of equals the one that needs less memory.

    With 32-bit reals only where they are faster by more than times scatter: they lose more in another deck.
    """
    fit = [row for row in rows if is_within(row, margins, tolerance)]
    wide = [row for row in fit if scheme(row.setting.build).real_bits == 64]
    best, safe = (min(some, key=lambda row: (row.cost, row.memory), default=None) for some in (fit, wide))
    if best is None or safe is None:
        return best
    part, seconds = SCATTER
    return best if safe.cost - best.cost > max(part * safe.cost, seconds) else safe


def pareto_set(rows: Sequence[Row]) -> list[Row]:
    """Rows to which no other is better in error, time and memory, or as good in all and better in one."""
    ran = [row for row in rows if math.isfinite(row.error)]
    marks = {id(row): (row.error, row.cost, row.memory) for row in ran}

    def is_beaten(own: tuple[float, ...]) -> bool:
        others = (one for one in marks.values() if one != own)
        return any(all(x <= y for x, y in zip(one, own, strict=True)) for one in others)

    return [row for row in ran if not is_beaten(marks[id(row)])]


def path_differences(study: AccuracyStudy) -> dict[str, float]:
    """By how much quantities differ on another loading path, that of SOLVE ... STATIC; {} if none was run.

    As shares of their values in the finest run of the reference.
    """
    static = [row.result for row in study.rows if row.result and row.compared and row.setting.static]
    if not static or not study.levels or study.levels[-1].setting.static:
        return {}
    (own,) = (row.result.quantities for row in study.levels[-1:] if row.result)
    return {
        name: max(share(abs(one.quantities[name] - own[name]), own[name]) for one in static)
        for name in study.references
    }
