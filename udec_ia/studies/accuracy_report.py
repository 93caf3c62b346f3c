"""The answer of a study of accuracy in five parts, its table, and its picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any

from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.output.block_drawing import INK
from udec_ia.running.solve_result import SLIPPED
from udec_ia.studies.accuracy_study import AccuracyStudy, pareto_set, path_differences
from udec_ia.studies.deck_rewriting import list_changes
from udec_ia.studies.extrapolation import share
from udec_ia.studies.setting_runner import Row
from udec_ia.studies.study_table import StudyTable, draw_panels

COLUMNS = ("setting", "error", "seconds", "MB", "cycles", "what")
HEIGHT = 4.0  # inches of the picture
COLOURS = ("#1f6f8b", "#c8553d", "#7a9e3b", "#8a6fb0")
FRONT = "#33302b"
SMALLEST = 1e-16  # error that is drawn for none
TICKS = 8  # for which an axis of time has room


# ---- the answer


def answer(study: AccuracyStudy) -> list[str]:
    """Five parts: the change, its cost, the accuracy, the loading path, the unknown; one without a result."""
    if not study.rows:
        return study.notes
    return [
        f"to change:{_change(study)}",
        f"cost: {_cost(study)}",
        f"accuracy: {_accuracy(study)}",
        f"loading path: {_loading_path(study)}",
        f"unknown: {_unknown(study)}",
    ]


def _change(study: AccuracyStudy) -> str:
    """The lines of the deck to change and, if it is not the default, the build: each on a line of its own."""
    row = study.best
    if row is not None:
        build, *lines = list_changes(study.deck, row.setting, row.numbers, study.fraction)
        changes = lines if row.setting.build == DEFAULT_SCHEME else [*lines, build]
        setting = f"(setting {row.setting.name}, for a tolerance of {study.tolerance:g})"
        return "\n    ".join(["", *(changes or ["nothing: the deck as it is"]), setting])
    if len(study.levels) < 2:
        reasons = (row.why for row in study.rows if row.ran and row.why)
        why = next(reasons, "no run with half the time-step has ended; give a greater --budget")
    elif study.can_recommend:
        nearest = min(study.rows, key=lambda row: row.error)
        why = f"the least error is {nearest.error:.2e}, of {nearest.setting.name}; give a greater --budget"
    elif len(study.known) == len(study.references):
        why = f"the time-step does not change {' and '.join(study.known)}; ask for another --quantity"
    else:
        why = f"{_without_reference(study)}; ask for another --quantity, or see --digits"
    return f" no recommendation: {why}"


def _cost(study: AccuracyStudy) -> str:
    own = next((row for row in study.levels if row.setting.step == 1), None)
    row = study.best
    if own is None:
        return "not known, as the deck as it is cannot be compared"
    if row is None:
        return f"the deck as it is takes {own.cost:.3g} s"
    gain = own.cost / row.cost if row.cost else 1.0
    margin = max(study.references[name].share for name in row.errors)
    return (
        f"{row.cost:.3g} s, {gain:.2f} times as fast as the deck as it is, with an error of {row.error:.1e} "
        f"(known to within {margin:.1e})"
    )


def _accuracy(study: AccuracyStudy) -> str:
    """What each quantity tends to, how well that is known, and what its error depends on."""
    if len(study.levels) < 2:
        return "not known, as no run with half the time-step can be compared"
    found = []
    for name, one in study.references.items():
        if math.isnan(one.value):
            found.append(f"{name} has no value")
            continue
        if not one.error:
            found.append(f"{name} is {one.value:.7g} at all these steps")
            continue
        by = "" if math.isnan(one.order) else f", power {one.order:.2f}" * (not study.deck.has("solve"))
        if name in study.known:
            what = f"{one.value:.7g} is known to within {one.share:.1e}; the time-step limits it{by}"
        else:
            values = study.values(name)
            spread = f"{min(values):.5g} to {max(values):.5g}, mean {sum(values) / len(values):.5g}"
            how = "converges" if math.isfinite(one.order) else "does not converge at these steps"
            known = f"{one.value:.5g} is known to within {one.share:.1e} only"
            what = f"{how}, {known} ({len(values)} runs: {spread})"
        found.append(f"{name} {what}")
    return "; ".join(found)


def _loading_path(study: AccuracyStudy) -> str:
    """Whether the result depends on the loading path, and by how much."""
    if not study.deck.has("solve"):
        return "not asked: the deck follows a motion, without SOLVE"
    found = path_differences(study)
    slips = SLIPPED in study.solved
    depends = slips or max(found.values(), default=0.0) > study.tolerance
    independent = "does not depend on it" if found else "no sign that the result depends on it"
    return "; ".join(
        [
            "depends on it" if depends else independent,
            study.solved if slips else "no joint slip is reported",
            *[f"SOLVE ... STATIC, another path, changes {name} by {off:.2g}" for name, off in found.items()],
            *["by how much is unknown: load in steps, and compare"] * (depends and not found),
        ]
    )


def _unknown(study: AccuracyStudy) -> str:
    found = [_without_reference(study)] if len(study.known) < len(study.references) else []
    found += study.notes
    not_compared = [row.setting.name for row in study.rows if row.ran and row.why]
    if not_compared:
        found.append(f"not compared: {', '.join(not_compared)} (see --table)")
    return "; ".join([*found, "other decks and quantities may need other settings"])


def _without_reference(study: AccuracyStudy) -> str:
    names = " and ".join(name for name in study.references if name not in study.known)
    return f"without a reference that is known well enough: {names}"


# ---- the table


def table_rows(study: AccuracyStudy) -> list[tuple[Any, ...]]:
    """A line for each setting: the COLUMNS, blank where there is no number."""
    front = [id(row) for row in pareto_set(study.rows)]
    return [
        (
            row.setting.name,
            _cell(row.error),
            _cell(row.cost),
            row.memory / 1e6 if row.result else "",
            row.result.cycles if row.result else 0,
            _what(study, row, id(row) in front),
        )
        for row in study.rows
    ]


def study_table(study: AccuracyStudy) -> StudyTable:
    """The same with the value and the error of every quantity at every setting."""
    table = zip(("run", *COLUMNS[1:]), zip(*table_rows(study), strict=True), strict=True)
    columns: dict[str, Sequence[Any]] = dict(table)
    for name, one in study.references.items():
        values = [row.result.quantities[name] if row.result else math.nan for row in study.rows]
        errors = [
            math.nan if one.is_zero or not row.compared else one.error_of(value)
            for row, value in zip(study.rows, values, strict=True)
        ]
        columns |= {f"value of {name}": [*map(_cell, values)], f"error of {name}": [*map(_cell, errors)]}
    return StudyTable(columns)


def _cell(number: float) -> float | str:
    return number if math.isfinite(number) else ""


def _what(study: AccuracyStudy, row: Row, in_front: bool) -> str:
    if not row.compared or row.result is None:
        return why_not_compared(row)
    found = ["recommended"] if row is study.best else []
    found += ["Pareto set"] if in_front else []
    found += ["within tolerance"] if study.is_within(row) else []
    if row.setting.ratio == 1 and row.result.message != study.solved:
        found.append(row.result.message)
    return ", ".join(part for part in found if part)


def why_not_compared(row: Row) -> str:
    """What happened to a row that is not compared."""
    if row.result is None:
        return "not run: beyond the budget"
    return f"not compared: {row.why}" if row.ran else f"{row.result.status}: {row.result.message}"


def half_step(study: AccuracyStudy) -> list[str]:
    """The check of report 4.6: the same run with half the time-step and twice the cycles."""
    if len(study.levels) < 2:
        rows = [row for row in study.rows if not row.compared]
        return [*study.notes, *(f"{row.setting.name}: {why_not_compared(row)}" for row in rows)]
    found = []
    for name in study.references:
        one, half = study.values(name, study.levels)
        off = share(abs(one - half), half)
        fault = " of it: THE TIME-STEP IS TOO LARGE, take a smaller FRACTION" * (off > study.tolerance)
        found.append(f"{name}: {one:.7g}, with half the step {half:.7g}, off by {off:.1e}{fault}")
    return found


# ---- the picture


def draw_costs(study: AccuracyStudy, title: str, base: Path) -> list[Path]:
    """Draw error over time, with the Pareto set, as base.png and base.svg; [] if no setting has an error."""
    rows = [row for row in study.rows if math.isfinite(row.error)]
    if not rows:
        return []
    rows = [row for row in rows if row.error > 0] or rows  # what is its own reference says nothing

    def draw(panels: Sequence[Any]) -> None:
        """Points for each word scheme, the Pareto set, the tolerance, and the recommended setting."""
        (panel,) = panels
        for build, colour in zip(dict.fromkeys(row.setting.build for row in rows), COLOURS, strict=False):
            points = [_point(row) for row in rows if row.setting.build == build]
            panel.plot(*zip(*points, strict=True), "o", color=colour, markersize=4, label=build)
        points = sorted(map(_point, rows))
        smallest = accumulate((error for _, error in points), min)
        front = [point for point, error in zip(points, smallest, strict=True) if point[1] == error]
        panel.plot(*zip(*front, strict=True), color=FRONT, linewidth=0.8, label="Pareto set")
        panel.axhline(study.tolerance, color=COLOURS[1], linewidth=0.8, linestyle="--", label="tolerance")
        if study.best in rows:
            panel.plot(
                *_point(study.best), "o", markersize=11, fillstyle="none", color=FRONT, label="recommended"
            )
        panel.set(xscale="log", yscale="log")
        _plain_numbers(panel)
        panel.set_xlabel("seconds", fontsize=9, color=INK)
        panel.set_ylabel("greatest error", fontsize=9, color=INK)
        panel.legend(fontsize=8)

    return draw_panels(draw, 1, HEIGHT, title, base)


def _plain_numbers(panel: Any) -> None:
    """Ticks of the logarithmic axis of time as 0.2, 0.5 and 1, about as many as there is room for."""
    low, high = panel.get_xlim()
    for digits in (range(1, 10), (1, 2, 5), (1,)):
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)))
        ticks = [digit * 10.0**decade for decade in decades for digit in digits]
        ticks = [one for one in ticks if low <= one <= high]
        if len(ticks) <= TICKS:
            break
    if ticks:
        panel.set_xticks(ticks, [f"{one:g}" for one in ticks])
        panel.set_xticks([], minor=True)


def _point(row: Row) -> tuple[float, float]:
    """Time and error."""
    return row.cost, max(row.error, SMALLEST)
