"""The table of a study and its picture: where they go, how they are written and drawn.

The table has a line for each run: a CSV file, and an HDF5 file bit for bit, with a field for each column in
the dataset `table`; the deck and the quantities are in its attributes. The picture shows each quantity
against the one variable that changes, or as a map over two. A run without a value is a cross.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.deck.deck_variables import Values
from udec_ia.errors import UdecError
from udec_ia.files import check_name, put_in_place
from udec_ia.output.block_drawing import INK, TYPES, drawable, write
from udec_ia.studies.study_run import RunResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BEFORE = ("run",)
BEHIND = (
    *("status", "error", "cycles", "seconds", "wall_seconds", "words", "peak_memory"),
    *("warnings", "message"),
)
GREATEST = 2**63  # in absolute value, beyond which whole numbers are reals
FIRST = b"run,"  # how a CSV file of the program begins
FRONTS = {".csv": FIRST, ".h5": b"\x89HDF\r\n", ".png": b"\x89PNG\r\n", ".svg": b"<?xml "}
DRAWN_BY = b"Matplotlib"  # near the beginning of pictures of the program
BEGINNING = 1024  # bytes of them
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

    def rows(self) -> list[tuple[Any, ...]]:
        """The lines, with Python's numbers."""
        return [*zip(*map(self.column, self.columns), strict=True)]

    def write(self, base: Path, attributes: Mapping[str, str]) -> list[Path]:
        """Write base.csv and base.h5, with attributes for the latter. Returns both names. UdecError 31."""
        files = table_paths(base)
        put_in_place(files[0], self._csv(), _refusal, force=False)
        put_in_place(files[1], self._hdf5(attributes), force=False)
        return files

    def _csv(self) -> bytes:
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(self.rows())
        return text.getvalue().encode()

    def _hdf5(self, attributes: Mapping[str, str]) -> bytes:
        import h5py

        types = [
            (name, column.dtype if isinstance(column, np.ndarray) else h5py.string_dtype())
            for name, column in self.columns.items()
        ]
        image = io.BytesIO()
        with h5py.File(image, "w", libver=("v108", "v108")) as file:
            table = file.create_dataset("table", data=np.array(self.rows(), np.dtype(types)))
            table.attrs.update(attributes)
        return image.getvalue()


def table_paths(base: Path) -> list[Path]:
    """base.csv and base.h5."""
    return [base.with_name(f"{base.name}.{kind}") for kind in ("csv", "h5")]


def _column(values: Sequence[Any]) -> Any:
    """Integers as int64 if all can be, other numbers as 64-bit reals, anything else as text."""
    whole = all(isinstance(one, int | np.integer) and not isinstance(one, bool) for one in values)
    if whole and all(abs(one) < GREATEST for one in values):
        return np.array(values, np.int64)
    if all(isinstance(one, int | float | np.number) for one in values):
        return np.array(values, np.float64)
    return [str(one) for one in values]


def _refusal(front: bytes, _: int) -> str:
    return "" if front.startswith(FIRST) else "exists, but is not a table of a study"


# ---- where they go


def check_paths(paths: Iterable[Path]) -> None:
    """Error 31 unless the files `paths` can be written, as far as that is known beforehand."""
    for path in paths:
        front = FRONTS[path.suffix]
        try:
            there = _begins(path)
            check_name(path, there if there.startswith(front) else front)
        except OSError as error:
            raise UdecError(31, f"{path}: {error.strerror or error}") from error


def drawn_before(base: Path) -> list[Path]:
    """The pictures that an earlier study has drawn beside its table; [] without one."""
    if not _begins(table_paths(base)[0]).startswith(FIRST):
        return []
    return [path for path in picture_paths(base) if DRAWN_BY in _begins(path)]


def _begins(path: Path) -> bytes:
    """The beginning of a file, b"" if there is none that can be read."""
    with suppress(OSError):
        if path.is_file():
            with path.open("rb") as file:
                return file.read(BEGINNING)
    return b""


if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
    """Write base.png and base.svg; returns their names. variables: see axes_of. Error 31."""
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
