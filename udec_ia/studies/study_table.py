"""The table of a study and its picture: where they go, how they are written and drawn.

The table has a line for each run: a CSV file. The picture shows each quantity against the one variable that
changes, or as a map over two. A run without a value is a cross.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.deck.deck_variables import Values
from udec_ia.errors import UdecError
from udec_ia.file_replacement import check_name, put_in_place
from udec_ia.output.block_drawing import INK, TYPES, drawable, write
from udec_ia.studies.study_run import RunResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BEFORE = ("run",)
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
    def of(
        cls, results: Sequence[RunResult], variables: Iterable[str], quantities: Iterable[str]
    ) -> StudyTable:
        """The results of runs with these variables and quantities."""
        columns: dict[str, list[Any]] = {"run": [one.name for one in results]}
        columns |= {name: [one.values[name] for one in results] for name in variables}
        columns |= {name: [one.quantities[name] for one in results] for name in quantities}
        columns |= {name: [getattr(one, name) for one in results] for name in BEHIND}
        columns["warnings"] = [len(one.warnings) for one in results]
        return cls(columns)

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
        file = table_path(base)
        put_in_place(file, text.getvalue().encode(), _refusal, force=False)
        return file


def table_path(base: Path) -> Path:
    """base.csv."""
    return base.with_name(f"{base.name}.csv")


def _column(values: Sequence[Any]) -> Any:
    """Numbers as an array, anything else as text."""
    found = np.array(values)
    if found.dtype.kind == "O":  # integers that are too large
        found = found.astype(np.float64)
    return found if found.dtype.kind in "iuf" else [str(one) for one in values]


def _refusal(front: bytes, _: int) -> str:
    return "" if front.startswith(FRONTS[".csv"]) else "exists, but is not a table of a study"


def check_paths(paths: Iterable[Path]) -> None:
    """Error 31 unless the files `paths` can be written, as far as that is known beforehand."""
    for path in paths:
        try:
            check_name(path, FRONTS[path.suffix])
        except OSError as error:
            raise UdecError(31, f"{path}: {error.strerror or error}") from error


# ---- the picture


def picture_axes(points: Sequence[Values], quantities: Sequence[str]) -> list[str]:
    """The variables that a picture of runs with the values `points` is drawn over; [] if there is none."""
    changing = [name for name in points[0] if len({str(point[name]) for point in points}) > 1]
    numbers = all(isinstance(point[name], int | float) for point in points for name in changing)
    return changing if quantities and numbers and len(changing) in (1, 2) else []


def picture_paths(base: Path) -> list[Path]:
    """base.png and base.svg."""
    return [base.with_name(f"{base.name}{kind}") for kind in TYPES]


def draw_table(
    table: StudyTable, variables: list[str], quantities: list[str], title: str, base: Path
) -> list[Path]:
    """Write base.png and base.svg; returns their names. variables: see picture_axes. Error 31."""
    axes = [table.columns[name] for name in variables]
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height = (CURVE if len(axes) == 1 else MAP) * len(quantities) + TITLE
    with rc_context({"svg.hashsalt": "udec"}):
        figure = Figure((WIDTH, height), facecolor="white", layout="constrained")
        FigureCanvasAgg(figure)
        panels = figure.subplots(len(quantities), 1, squeeze=False, sharex=True)[:, 0]
        for panel, name in zip(panels, quantities, strict=True):
            if len(axes) == 1:
                _curve(panel, axes[0], table.columns[name], name)
            else:
                _map(panel, axes, table.columns[name], name)
                panel.set_ylabel(variables[1], fontsize=9, color=INK)
            panel.tick_params(labelsize=8, colors=INK)
        panels[-1].set_xlabel(variables[0], fontsize=9, color=INK)
        figure.suptitle(drawable(title), fontsize=10, color=INK, parse_math=False)
        return write(figure, base)


def _curve(panel: Axes, x: Any, value: Any, name: str) -> None:
    order, known = np.argsort(x, kind="stable"), np.isfinite(value)
    panel.plot(
        x[order], np.where(known, value, np.nan)[order], color=LINE, marker="o", markersize=3, linewidth=1.2
    )
    panel.plot(x[~known], np.zeros((~known).sum()), "x", color=FAILED, transform=panel.get_xaxis_transform())
    panel.set_ylabel(drawable(name), fontsize=9, color=INK, parse_math=False)
    panel.grid(color="#e4e0d8", linewidth=0.6)
    panel.set_xscale(_scale(x))


def _map(panel: Axes, axes: list[Any], value: Any, name: str) -> None:
    x, y = (np.unique(one) for one in axes)
    shown = np.full((len(y), len(x)), np.nan)
    shown[np.searchsorted(y, axes[1]), np.searchsorted(x, axes[0])] = np.where(
        np.isfinite(value), value, np.nan
    )
    panel.set_xscale(_scale(x))
    panel.set_yscale(_scale(y))
    mesh = panel.pcolormesh(x, y, np.ma.masked_invalid(shown), shading="nearest")
    unknown = ~np.isfinite(value)
    panel.plot(axes[0][unknown], axes[1][unknown], "x", color=FAILED)
    bar = panel.get_figure().colorbar(mesh, ax=panel)  # type: ignore[union-attr]
    bar.ax.tick_params(labelsize=8, colors=INK)
    bar.set_label(drawable(name), fontsize=9, color=INK, parse_math=False)


def _scale(values: Any) -> str:
    wide = values.min() > 0 and values.max() / values.min() >= MANY_DECADES
    return "log" if wide else "linear"
