"""The picture of a study: each quantity against the one variable that changes, or as a map over two.

A run without a value, one that ended in an error for instance, is a cross at the foot of a curve or in a map.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.deck.deck_variables import Values
from udec_ia.output.draw import INK, drawable
from udec_ia.output.picture import TYPES, write
from udec_ia.study.table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, CURVE, MAP = 6.5, 2.0, 4.5  # inches of a panel, and its height
TITLE = 0.45  # inches above all panels
LINE, FAILED = "#1f6f8b", "#c8553d"
MANY_DECADES = 50  # greatest over least value, from which on an axis is logarithmic


def axes_of(points: Sequence[Values], quantities: Sequence[str]) -> list[str]:
    """The variables that a picture of runs with the values `points` is drawn over; [] if there is none."""
    changing = [name for name in points[0] if len({str(point[name]) for point in points}) > 1]
    numbers = all(isinstance(point[name], int | float) for point in points for name in changing)
    return changing if quantities and numbers and len(changing) in (1, 2) else []


def pictures_of(base: Path) -> list[Path]:
    """base.png and base.svg."""
    return [base.with_name(f"{base.name}{kind}") for kind in TYPES]


def draw(table: Table, variables: list[str], quantities: list[str], title: str, base: Path) -> list[Path]:
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
