"""The answer of a study of accuracy in five lines, its table, and its picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.output.block_drawing import INK, write
from udec_ia.studies.accuracy_study import AccuracyStudy, is_within, pareto_set, path_differences
from udec_ia.studies.deck_rewriting import list_changes
from udec_ia.studies.extrapolation import Extrapolation, share
from udec_ia.studies.setting_runner import Row
from udec_ia.studies.study_table import StudyTable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SLIPPED = "joints slipped"  # how SOLVE reports that its result depends on the loading path
COLUMNS = ("setting", "error", "seconds", "MB", "cycles", "what")
SIZE = (7.5, 6.5)  # inches of the picture
COLOURS = ("#1f6f8b", "#c8553d", "#7a9e3b", "#8a6fb0")
FRONT = "#33302b"
SMALLEST = 1e-16  # error that is drawn for none


# ---- the answer


def answer(study: AccuracyStudy) -> list[str]:
    """Five lines: what to change, what it costs, what limits the accuracy, the loading path, the unknown.

    One line if there is nothing to compare.
    """
    if not study.rows:
        return study.notes
    return [
        f"to change: {_change(study)}",
        f"cost: {_cost(study)}",
        f"accuracy: {_accuracy(study)}",
        f"loading path: {_loading_path(study)}",
        f"unknown: {_unknown(study)}",
    ]


def _change(study: AccuracyStudy) -> str:
    row = study.best
    if row is not None:
        changes = "; ".join(list_changes(study.deck, row.setting, row.numbers, study.fraction))
        return f"{row.setting.name} for {study.tolerance:g}: {changes}"
    if len(study.levels) < 2:
        why = next((row.why for row in study.rows if row.ran and row.why), "")
        return (
            f"no recommendation: {why or 'no run with half the time-step has ended; give a greater --budget'}"
        )
    if study.can_recommend:
        nearest = min(study.rows, key=lambda row: row.error)
        return (
            f"no setting that was run keeps to {study.tolerance:g}: the least error is {nearest.error:.2e}, "
            f"of {nearest.setting.name}; give a greater --budget or --tolerance"
        )
    if study.known and len(study.known) == len(study.references):
        names = " and ".join(study.known)
        return f"no recommendation: the time-step does not change {names}; ask for another --quantity"
    cure = "ask for another --quantity, give a greater --tolerance or --budget, or see --digits"
    return f"no recommendation: {_without_reference(study)}; {cure}"


def _cost(study: AccuracyStudy) -> str:
    own = next((row for row in study.levels if row.setting.step == 1), None)
    row = study.best
    if own is None:
        return "not known, as the deck as it is cannot be compared"
    if row is None:
        return f"the deck as it is takes {own.cost:.3g} s"
    gain = own.cost / row.cost if row.cost else 1.0
    margin = max(study.margins[name] for name in row.errors)
    return (
        f"{row.cost:.3g} s, {gain:.2f} times as fast as the deck as it is, with an error of {row.error:.1e} "
        f"(known to within {margin:.1e})"
    )


def _accuracy(study: AccuracyStudy) -> str:
    """What each quantity tends to, and what its error depends on."""
    if len(study.levels) < 2:
        return "not known, as no run with half the time-step can be compared"
    found = []
    for name, one in study.references.items():
        if one is None:
            found.append(f"{name} has no value")
        elif name not in study.known:
            found.append(f"{name} {_why_unknown(study, name, one)}")
        elif not one.error:
            found.append(f"{name} is {one.value:.7g} at all these steps")
        else:
            by = "" if study.deck.has("solve") or math.isnan(one.order) else f", power {one.order:.2f}"
            found.append(
                f"{name} {one.value:.7g} is known to within {one.share:.1e}; the time-step limits it{by}"
            )
    return "; ".join(found)


def _why_unknown(study: AccuracyStudy, name: str, one: Extrapolation) -> str:
    """Why a quantity is not compared, and the range of its values."""
    values = study.values(name)
    if one.is_zero:
        why = f"tends to 0, known to within {one.error:.1e}: it has no relative error"
    elif math.isfinite(one.order):
        why = f"converges to {one.value:.7g}, known to within {one.share:.1e} only"
    else:
        why = f"does not converge at these steps, {one.value:.5g} is known to within {one.share:.1e} only"
    spread = f"{min(values):.5g} to {max(values):.5g}, mean {sum(values) / len(values):.5g}"
    return f"{why} ({len(values)} runs: {spread})"


def _loading_path(study: AccuracyStudy) -> str:
    """Whether the result depends on the loading path, and by how much."""
    split = study.separation
    if not study.deck.has("solve"):
        scatters = any(one and one.error and math.isnan(one.order) for one in study.references.values())
        if split is None or not scatters:
            return "not asked: the deck follows a motion, without SOLVE"
        one, two = (row.setting.name for row in study.levels[-2:])
        return (
            f"the motion depends on small differences: {one} and {two} part at {split.time:.4g} s, at the "
            f"block that was at ({split.x:.4g}, {split.y:.4g}); at the end it is {split.apart:.3g} m "
            f"elsewhere, and the greatest displacement is {split.moved:.3g} m"
        )
    found = path_differences(study)
    slips = SLIPPED in study.solved
    depends = slips or max(found.values(), default=0.0) > study.tolerance
    return "; ".join(
        [
            "depends on it" if depends else "does not depend on it",
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
    """A line for each setting, the cheapest first: the COLUMNS, blank where there is no number."""
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
        for row in _sorted(study)
    ]


def study_table(study: AccuracyStudy) -> StudyTable:
    """The same with the value and the error of every quantity at every setting."""
    table = zip(("run", *COLUMNS[1:]), zip(*table_rows(study), strict=True), strict=True)
    columns: dict[str, Sequence[Any]] = dict(table)
    for name, one in study.references.items():
        values, errors = list[float](), list[float]()
        for row in _sorted(study):
            values.append(row.result.quantities[name] if row.result else math.nan)
            known = row.compared and one is not None and not one.is_zero
            errors.append(one.error_of(values[-1]) if one and known else math.nan)
        columns |= {f"value of {name}": [*map(_cell, values)], f"error of {name}": [*map(_cell, errors)]}
    return StudyTable(columns)


def _cell(number: float) -> float | str:
    return number if math.isfinite(number) else ""


def _sorted(study: AccuracyStudy) -> list[Row]:
    return sorted(study.rows, key=lambda row: (row.cost, row.predicted))


def _what(study: AccuracyStudy, row: Row, in_front: bool) -> str:
    if not row.compared or row.result is None:
        return why_not_compared(row)
    found = ["recommended"] if row is study.best else []
    found += ["Pareto set"] if in_front else []
    found += ["within tolerance"] if is_within(row, study.margins, study.tolerance) else []
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
    one, half = (row.result.quantities for row in study.levels if row.result)
    found = []
    for name in study.references:
        off = share(abs(one[name] - half[name]), half[name])
        fault = " of it: THE TIME-STEP IS TOO LARGE, take a smaller FRACTION" * (off > study.tolerance)
        found.append(f"{name}: {one[name]:.7g}, with half the step {half[name]:.7g}, off by {off:.1e}{fault}")
    return found


# ---- the picture


def draw_costs(study: AccuracyStudy, title: str, base: Path) -> list[Path]:
    """Draw error over time and over memory, each with its Pareto set, as base.png and base.svg.

    Returns their names, none if no setting has an error.
    """
    rows = [row for row in study.rows if math.isfinite(row.error)]
    if not rows:
        return []
    rows = [row for row in rows if row.error > 0] or rows  # what is its own reference says nothing
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with rc_context({"svg.hashsalt": "udec"}):
        figure = Figure(SIZE, facecolor="white", layout="constrained")
        FigureCanvasAgg(figure)
        time, memory = figure.subplots(2, 1)
        _panel(time, study, rows, [row.cost for row in rows], "seconds")
        _panel(memory, study, rows, [row.memory / 1e6 for row in rows], "IA() in use, MB")
        time.legend(fontsize=8)
        figure.suptitle(title, fontsize=10, color=INK, parse_math=False)
        return write(figure, base)


def _panel(panel: Axes, study: AccuracyStudy, rows: list[Row], x: list[float], label: str) -> None:
    error = [max(row.error, SMALLEST) for row in rows]
    builds = [*dict.fromkeys(row.setting.build for row in rows)]
    for build, colour in zip(builds, COLOURS, strict=False):
        some = [k for k, row in enumerate(rows) if row.setting.build == build]
        at = [x[k] for k in some], [error[k] for k in some]
        panel.plot(*at, "o", color=colour, markersize=4, label=build)
    points = sorted(zip(x, error, strict=True))
    smallest = accumulate((one for _, one in points), min)
    front = [point for point, one in zip(points, smallest, strict=True) if point[1] == one]
    panel.plot(*zip(*front, strict=True), color=FRONT, linewidth=0.8, label="Pareto set")
    panel.axhline(study.tolerance, color=COLOURS[1], linewidth=0.8, linestyle="--", label="tolerance")
    if study.best in rows:
        k = rows.index(study.best)
        panel.plot(x[k], error[k], "o", markersize=11, fillstyle="none", color=FRONT, label="recommended")
    panel.set(xscale="log", yscale="log")
    panel.set_xlabel(label, fontsize=9, color=INK)
    panel.set_ylabel("greatest error", fontsize=9, color=INK)
    panel.tick_params(which="both", labelsize=8, colors=INK)
    panel.grid(color="#e4e0d8", linewidth=0.6)
