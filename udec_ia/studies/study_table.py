"""The table of a study, as CSV, and its picture: each quantity against one variable or as a map over two."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.deck.deck_variables import Values
from udec_ia.errors import UdecError
from udec_ia.file_replacement import check_name, put_in_place
from udec_ia.output.block_drawing import INK, drawable, write
from udec_ia.studies.study_run import RunResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BEHIND = ("status", "error", "cycles", "seconds", "words", "warnings", "message")
FRONTS = {".csv": b"run,", ".png": b"\x89PNG\r\n", ".svg": b"<?xml "}
WIDTH, CURVE, MAP = 6.5, 2.0, 4.5  # inches of a panel, and its height
TITLE = 0.45  # inches above all panels
LINE, FAILED = "#1f6f8b", "#c8553d"
MANY_DECADES = 50  # ratio of greatest and least value from which on an axis is logarithmic


class StudyTable:
    """columns: names and values, in order. Numbers are NumPy arrays, words lists of text."""

    def __init__(self, columns: Mapping[str, Sequence[Any]]) -> None:
        self.columns = {name: _column(values) for name, values in columns.items()}

    @classmethod
    def of(cls, results: Sequence[RunResult]) -> StudyTable:
        """The results of runs that have the same variables and quantities."""
        rows = [
            {"run": one.name, **one.values, **one.quantities}
            | {name: getattr(one, name) for name in BEHIND}
            | {"warnings": len(one.warnings)}
            for one in results
        ]
        return cls({name: [row[name] for row in rows] for name in (rows[0] if rows else ("run", *BEHIND))})

    def column(self, name: str) -> list[Any]:
        """A column, with Python's numbers."""
        column = self.columns[name]
        return list(column.tolist() if isinstance(column, np.ndarray) else column)

    def write(self, base: Path) -> Path:
        """Write base.csv, and return its name. Error 31 if that cannot be done."""
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(zip(*map(self.column, self.columns), strict=True))
        put_in_place(output_paths(base)[0], text.getvalue().encode(), _refusal, force=False)
        return output_paths(base)[0]


def _column(values: Sequence[Any]) -> Any:
    """Numbers as an array, anything else as text."""
    found = np.array(values)
    if found.dtype.kind == "O":  # integers that are too large
        found = found.astype(np.float64)
    return found if found.dtype.kind in "iuf" else [str(one) for one in values]


def _refusal(front: bytes, _: int) -> str:
    return "" if front.startswith(FRONTS[".csv"]) else "exists, but is not a table of a study"


def output_paths(base: Path) -> list[Path]:
    """base.csv, base.png and base.svg."""
    return [base.with_name(f"{base.name}{kind}") for kind in FRONTS]


def check_outputs(base: Path) -> None:
    """Error 31 unless these files can be written, as far as that is known beforehand."""
    for path in output_paths(base):
        try:
            check_name(path, FRONTS[path.suffix])
        except OSError as error:
            raise UdecError(31, f"{path}: {error.strerror or error}") from error


def picture_axes(points: Sequence[Values], quantities: Sequence[str]) -> list[str]:
    """The variables that a picture of runs with the values `points` is drawn over; [] if there is none."""
    changing = [name for name in points[0] if len({str(point[name]) for point in points}) > 1]
    numbers = all(isinstance(point[name], int | float) for point in points for name in changing)
    return changing if quantities and numbers and len(changing) in (1, 2) else []


def draw_table(
    table: StudyTable, variables: list[str], quantities: list[str], title: str, base: Path
) -> list[Path]:
    """Write base.png and base.svg; returns their names. variables: see picture_axes. Error 31."""
    axes = [table.columns[name] for name in variables]

    def draw(panels: Sequence[Axes]) -> None:
        for panel, name in zip(panels, quantities, strict=True):
            if len(axes) == 1:
                _curve(panel, axes[0], table.columns[name], name)
            else:
                _map(panel, axes, table.columns[name], name)
                panel.set_ylabel(variables[1], fontsize=9, color=INK)
            panel.set_xscale(_scale(axes[0]))
        panels[-1].set_xlabel(variables[0], fontsize=9, color=INK)

    return draw_panels(draw, len(quantities), CURVE if len(axes) == 1 else MAP, title, base)


def draw_panels(
    draw: Callable[[Sequence[Axes]], None], count: int, height: float, title: str, base: Path
) -> list[Path]:
    """Write base.png and base.svg with panels, `height` inches each, that `draw` draws into. Error 31."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with rc_context({"svg.hashsalt": "udec"}):
        figure = Figure((WIDTH, height * count + TITLE), facecolor="white", layout="constrained")
        FigureCanvasAgg(figure)
        panels = [*figure.subplots(count, 1, squeeze=False, sharex=True)[:, 0]]
        draw(panels)
        for panel in panels:
            panel.tick_params(which="both", labelsize=8, colors=INK)
            panel.grid(color="#e4e0d8", linewidth=0.6)
        figure.suptitle(drawable(title), fontsize=10, color=INK, parse_math=False)
        return write(figure, base)


def _curve(panel: Axes, x: Any, value: Any, name: str) -> None:
    order, known = np.argsort(x, kind="stable"), np.isfinite(value)
    shown = np.where(known, value, np.nan)
    panel.plot(x[order], shown[order], color=LINE, marker="o", markersize=3, linewidth=1.2)
    panel.plot(x[~known], np.zeros((~known).sum()), "x", color=FAILED, transform=panel.get_xaxis_transform())
    panel.set_ylabel(drawable(name), fontsize=9, color=INK, parse_math=False)


def _map(panel: Axes, axes: list[Any], value: Any, name: str) -> None:
    x, y = (np.unique(one) for one in axes)
    known = np.isfinite(value)
    shown = np.full((len(y), len(x)), np.nan)
    shown[np.searchsorted(y, axes[1][known]), np.searchsorted(x, axes[0][known])] = value[known]
    panel.set_yscale(_scale(y))
    mesh = panel.pcolormesh(x, y, np.ma.masked_invalid(shown), shading="nearest")
    panel.plot(axes[0][~known], axes[1][~known], "x", color=FAILED)
    bar = panel.get_figure().colorbar(mesh, ax=panel)  # type: ignore[union-attr]
    bar.ax.tick_params(labelsize=8, colors=INK)
    bar.set_label(drawable(name), fontsize=9, color=INK, parse_math=False)


def _scale(values: Any) -> str:
    wide = values.min() > 0 and values.max() / values.min() >= MANY_DECADES
    return "log" if wide else "linear"
