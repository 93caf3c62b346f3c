"""`udec trade DECK`: what accuracy costs for the user's deck, and the cheapest setting within a tolerance.

Reference. The deck runs in 64-bit reals with its step, a half and a quarter of it. Where a quantity converges
with an order, Richardson's extrapolation is the reference, and its error counts (extrapolation.py). If errors
are too large for the tolerance, and shrink, the step is halved again. A quantity without a reference is not
compared. A run that did not reach the force ratio of its SOLVE is neither reference nor compared.

Settings. Other word schemes, FRACTION, FRACTION f SAFE, and where the deck seeks nothing but rest the ratio
of SOLVE and SOLVE ... STATIC; each CYCLE gets the cycles of the same time (settings.py). They run as long as
the budget lasts (setting_runner.py).

Recommendation. The cheapest setting with (error + error of the reference) within the tolerance, for every
quantity with a reference. A quantity that is the same number at all steps says nothing about them, and
recommends nothing by itself. 32-bit reals are recommended only where they save more time than times scatter.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from udec_ia.deck.deck_variables import Values
from udec_ia.heap.word_scheme import scheme
from udec_ia.printable import counted
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.extrapolation import HIGHEST, Extrapolation, converges, extrapolate, share
from udec_ia.studies.quantities import OfHistory
from udec_ia.studies.quantity_syntax import read_quantities
from udec_ia.studies.setting_runner import NOT_AT_REST, Options, Row, SettingRunner
from udec_ia.studies.settings import Fraction, Setting, longer_steps, reference_setting, shorter_steps
from udec_ia.studies.study_run import ENDED
from udec_ia.studies.survey_run import Parting, find_parting
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
    best: the recommended one. fraction: that of the deck at first, None if it does not matter. parting: where
    the finest runs part. solved: what SOLVE reports in the deck as it is, "" for plain rest. sampled: cycles
    between the samples of quantities of histories. notes: sentences.
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
    parting: Parting | None = None
    solved: str = ""
    sampled: dict[str, int] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    @property
    def margins(self) -> dict[str, float]:
        """By how much measured errors may be wrong: the errors of the references."""
        return {name: one.share for name in self.known if (one := self.references[name])}

    @property
    def tells(self) -> bool:
        """True if the known quantities are enough to choose a setting by."""
        return depends_on_step(self.references, self.known)

    @property
    def obstacle(self) -> str:
        """Why there is nothing to compare with, if no run with half the step can be compared; else ""."""
        if len(self.levels) > 1:
            return ""
        return next((row.why for row in self.rows if row.ran and row.why), "")

    def path(self, row: Row) -> Path:
        """The folder of a run."""
        return self.folder / RUNS / row.setting.name

    def values(self, name: str) -> list[float]:
        """A quantity in all runs that are compared."""
        return [row.result.quantities[name] for row in self.rows if row.result and row.compared]


def study_accuracy(
    text: str, name: str, values: Values | None, folder: Path, options: Options, where: Path | None = None
) -> AccuracyStudy:
    """Study the deck `text`. name: of its file. where: its folder. folder: for what is written.

    Raises UdecError for what is wrong with the deck, and if nothing can be written.
    """
    deck = Deck(text, name, values, where)
    study = AccuracyStudy(deck, options.tolerance, folder)
    with SettingRunner(deck, options, folder) as runner:
        if not _survey(study, runner):
            return study
        if options.half_step:
            study.rows += (rows := [runner.row(Setting(runner.wide, step)) for step in (1.0, 0.5)])
            runner.run_rows(rows)
            study.levels = [row for row in rows if row.compared]
            study.references = dict.fromkeys(_names(study))
            return study
        _reference(study, runner)
        if len(study.levels) > 1:
            _settings(study, runner)
        dropped = [row.setting.name for row in study.rows if row.result is None]
        if dropped:
            study.notes.append(f"not run, as they go beyond the budget: {', '.join(dropped)}")
        study.notes[:0] = runner.notes
    return study


def _survey(study: AccuracyStudy, runner: SettingRunner) -> bool:
    """Run the deck as it is. False, with a note, if there is nothing to compare or no time."""
    options = runner.options
    runner.rehearse()
    least, most = runner.predicted_range()
    how = (
        f"{least:.3g} s"
        if most == least
        else f"{least:.3g} s, and up to {most:.3g} s if SOLVE takes its LIMIT"
    )
    options.show(f"the deck as it is will take {how}, by a rehearsal of it")
    if least > runner.left:
        study.notes.append(
            f"the deck as it is takes {how}, more than is left of the budget of {options.budget:g} s: "
            "give a greater --budget"
        )
        return False
    result = runner.survey_deck()
    if result.status != ENDED or not runner.survey:
        reason = result.message or "it has no CYCLE and no SOLVE"
        study.notes.append(f"the deck as it is gives nothing to compare: {reason}")
        return False
    study.fraction, study.solved = runner.fraction, result.message
    study.sampled = _sample_intervals(options.quantities, study.deck)
    cycles = counted(sum(one.done for one in runner.survey), "cycle")
    options.show(f"it has taken {result.seconds:.3g} s for {cycles}")
    if not result.at_rest:
        study.notes.append(f"the deck as it is gives nothing to compare: {NOT_AT_REST}: {result.message}")
    return result.at_rest


def _sample_intervals(quantities: Sequence[str], deck: Deck) -> dict[str, int]:
    """Cycles between two samples of each quantity of a history, if there are several.

    Samples of runs with other time-steps belong to other times, so that the greatest of them differs.
    """
    asked = {one.name: one.quantity for one in read_quantities(quantities)}
    histories = {name: one.number for name, one in asked.items() if isinstance(one, OfHistory)}
    every = dict(enumerate(deck.intervals, 1))
    return {name: every[number] for name, number in histories.items() if every.get(number, 1) > 1}


def _names(study: AccuracyStudy) -> list[str]:
    """Names of the quantities."""
    first = next((row.result for row in study.levels if row.result), None)
    return [*first.quantities][1:] if first else []


def _reference(study: AccuracyStudy, runner: SettingRunner) -> None:
    """Halve the step until the references are good enough, or the budget ends, or nothing converges."""
    own, deck = Setting(runner.wide), study.deck
    solves, stepped = deck.has("solve"), deck.is_stepped
    wanted = [runner.row(reference_setting(own, k, stepped, solves)) for k in range(LEVELS + 1)]
    while True:
        runner.options.show(f"reference: {', '.join(row.setting.name for row in wanted)}")
        study.rows += wanted
        if runner.run_rows(wanted):
            runner.options.show("the budget does not allow a finer reference")
        study.levels += [row for row in wanted if row.compared]
        study.parting = _parting(study)
        values = {
            name: [row.result.quantities[name] for row in study.levels if row.result]
            for name in _names(study)
        }
        highest = REST_ORDER if solves else HIGHEST
        study.references = {name: extrapolate(found, highest) for name, found in values.items()}
        enter_errors(study)
        unknown = [
            name
            for name, one in study.references.items()
            if one and one.share > WANTED * study.tolerance and converges(values[name])
        ]
        k = len(study.levels)
        if not unknown or k > FINEST or any(not row.compared for row in wanted):
            return
        wanted = [runner.row(reference_setting(own, k, stepped, solves))]
        if runner.predicted_seconds(wanted) > runner.left / 2:
            return


def _parting(study: AccuracyStudy) -> Parting | None:
    """Where the two finest runs of the reference part by more than the tolerance, None if they do not."""
    if len(study.levels) < 2:
        return None
    one, two = (study.path(row) for row in study.levels[-2:])
    return find_parting(one, two, study.tolerance)


def _settings(study: AccuracyStudy, runner: SettingRunner) -> None:
    """Run what may be cheaper than the reference, and choose."""
    deck, builds = study.deck, runner.builds
    solves, stepped = deck.has("solve"), deck.is_stepped
    _try(study, runner, longer_steps(runner.survey, builds, stepped, solves, deck.rests))
    if study.tells and (study.best is None or study.best.setting.step < 1):
        finest = study.best.setting.step if study.best else min(row.setting.step for row in study.levels)
        _try(study, runner, shorter_steps(builds, finest, stepped, solves))


def _try(study: AccuracyStudy, runner: SettingRunner, settings: Iterable[Setting]) -> None:
    """Run settings that have not been run, and choose."""
    done = {row.setting for row in study.rows}
    rows = [runner.row(one) for one in settings if one not in done]
    seconds = runner.predicted_seconds(rows)
    many = counted(len(rows), "setting")
    runner.options.show(f"{many} to run, about {seconds:.3g} s; {runner.left:.3g} s of the budget are left")
    study.rows += rows
    runner.run_rows(rows)
    enter_errors(study)
    if study.tells:
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
        and (study.parting is None or math.isfinite(one.order) or one.error == 0)
    ]
    for row in study.rows:
        if row.result is not None and not row.why:
            found = row.result.quantities
            known = [(name, study.references[name]) for name in study.known if study.tells]
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
    least, seconds = SCATTER
    return best if safe.cost - best.cost > max(least * safe.cost, seconds) else safe


def pareto_set(rows: Sequence[Row]) -> list[Row]:
    """Rows to which no other is better in error, time and memory, or as good in all and better in one."""

    def marks(row: Row) -> tuple[float, float, float]:
        return row.error, row.cost, row.memory

    def beats(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
        return a != b and all(x <= y for x, y in zip(a, b, strict=True))

    ran = [row for row in rows if math.isfinite(row.error)]
    return [row for row in ran if not any(beats(marks(other), marks(row)) for other in ran)]


def path_differences(study: AccuracyStudy) -> dict[str, float]:
    """By how much quantities differ on another loading path, that of SOLVE ... STATIC; {} if none was run.

    As shares of their values in the finest run of the reference.
    """
    static = [
        row.result.quantities for row in study.rows if row.result and row.compared and row.setting.static
    ]
    if not static or not study.levels or study.levels[-1].setting.static:
        return {}
    (own,) = (row.result.quantities for row in study.levels[-1:] if row.result)
    names = [*study.references]
    return {name: max(share(abs(one[name] - own[name]), own[name]) for one in static) for name in names}
