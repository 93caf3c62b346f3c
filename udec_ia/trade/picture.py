"""The picture of a price list: error against time and against memory, each with its Pareto set."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from udec_ia.output.block_drawing import INK, write
from udec_ia.trade.judge import Row
from udec_ia.trade.trade import Price

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

SIZE = (7.5, 6.5)  # inches
COLOURS = ("#1f6f8b", "#c8553d", "#7a9e3b", "#8a6fb0")
FRONT = "#33302b"
SHORT, LONG = 8, 1e3  # axes, by the greatest over the smallest number on them
SMALLEST = 1e-16  # error that is drawn for none


def draw(price: Price, title: str, base: Path) -> list[Path]:
    """Write base.png and base.svg; returns their names, none if no setting has an error."""
    rows = [row for row in price.rows if math.isfinite(row.error)]
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
        _panel(time, price, rows, [row.cost for row in rows], "seconds")
        _panel(memory, price, rows, [row.memory / 1e6 for row in rows], "IA() in use, MB")
        time.legend(fontsize=8)
        figure.suptitle(title, fontsize=10, color=INK, parse_math=False)
        return write(figure, base)


def _panel(panel: Axes, price: Price, rows: list[Row], x: list[float], label: str) -> None:
    error = [max(row.error, SMALLEST) for row in rows]
    builds = [*dict.fromkeys(row.setting.build for row in rows)]
    for build, colour in zip(builds, COLOURS, strict=False):
        some = [k for k, row in enumerate(rows) if row.setting.build == build]
        at = [x[k] for k in some], [error[k] for k in some]
        panel.plot(*at, "o", color=colour, markersize=4, label=build)
    front = [k for k in sorted(range(len(rows)), key=lambda k: (x[k], error[k])) if _best_until(k, x, error)]
    at = [x[k] for k in front], [error[k] for k in front]
    panel.plot(*at, color=FRONT, linewidth=0.8, label="Pareto set")
    panel.axhline(price.tolerance, color=COLOURS[1], linewidth=0.8, linestyle="--", label="tolerance")
    if price.best in rows:
        k = rows.index(price.best)
        panel.plot(x[k], error[k], "o", markersize=11, fillstyle="none", color=FRONT, label="recommended")
    panel.set(xscale="log", yscale="log")
    panel.set_xlabel(label, fontsize=9, color=INK)
    panel.set_ylabel("greatest error", fontsize=9, color=INK)
    _number(panel.xaxis, x)
    _number(panel.yaxis, error)
    panel.tick_params(labelsize=8, colors=INK)
    panel.grid(color="#e4e0d8", linewidth=0.6)


def _number(axis: Axis, values: list[float]) -> None:
    """Plain numbers along a logarithmic axis, several even where all `values` are of one size."""
    from matplotlib.ticker import AutoLocator, LogLocator, NullLocator

    times = max(values) / min(values)
    marks = LogLocator(subs=(1,) if times > LONG else (1, 2, 5))
    axis.set_major_locator(marks if times > SHORT else AutoLocator())
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(lambda value, _: f"{value:g}")


def _best_until(k: int, x: list[float], error: list[float]) -> bool:
    """True if nothing that costs no more than row `k` has a smaller error, or as small a one for less."""
    return not any(
        a <= x[k] and e <= error[k] and (a, e) != (x[k], error[k]) for a, e in zip(x, error, strict=True)
    )
