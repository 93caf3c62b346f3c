"""PLOT HISTORY: what was recorded against time or another history, and the changes of a number.

Histories of one field of several groups share a panel, since they can be compared, and so do quantities of
the whole model in one unit, such as energies. The panels stand one above the other over one axis. A curve
breaks off where its group has gone. Two histories are compared in the cycles in which both were recorded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.output.block_drawing import INK, drawable, picture_path, style_frame, write, write_as
from udec_ia.output.readable_units import readable
from udec_ia.running.history_series import Series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 7.0  # inches of a panel
PANEL, ALONE = 1.9, 3.6  # inches in height: of one of several panels, and of the only one
MARGINS = (0.9, 0.25, 0.5, 0.45)  # left, right, bottom, top, in inches
KEY_WIDTH = 2.3  # inches for the keys on the right
KEY_LETTERS = 28  # of a line of the key
KEY_CURVES = 10  # curves of a panel that the key names
DIGITS = 7  # that all numbers of an axis have in common before they are written apart, above it
MARKED = 60  # numbers below which each is marked by a point
COLOURS = ("#1f6f8b", "#c8553d", "#588b3c", "#7a5ba6", "#b8860b", "#3a4f7a", "#a23b72", "#5f6b6d")


@dataclass(frozen=True)
class Wanted:
    """Numbers of histories: the only one that is drawn, one subtracted from it, and one that is the x axis.

    0: all, none, and time. logx, logy: logarithmic axes.
    """

    number: int = 0
    less: int = 0
    against: int = 0
    logx: bool = False
    logy: bool = False


class Curve(NamedTuple):
    """panel: curves of the same one share a panel. label: of the y axis. key: beside the panel."""

    panel: str
    label: str
    unit: str
    key: str
    x: Any
    y: Any


ALL = Wanted()


def draw(series: Sequence[Series], name: str, base: Path, wanted: Wanted = ALL) -> list[Path]:
    """Draw `series` to base.png and base.svg; returns both paths. name: title of the picture.

    Errors as of `curves_of`, and 31 if they cannot be written.
    """
    return write(figure(series, name, wanted), base)


def figure(series: Sequence[Series], name: str, wanted: Wanted = ALL) -> Figure:
    """The picture: its panels in the order in which they were asked for."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    panels: dict[str, list[Curve]] = {}
    for curve in curves_of(series, wanted):
        panels.setdefault(curve.panel, []).append(curve)
    left, right, bottom, top = MARGINS
    high = PANEL if len(panels) > 1 else ALONE
    size = (left + WIDTH + KEY_WIDTH + right, bottom + high * len(panels) + top)
    picture = Figure(size, facecolor="white")
    shared: Axes | None = None
    across, unit = "time", "s"
    if wanted.against:
        other = series[wanted.against - 1]
        across, unit = f"{other.name} {_key(other)}".replace("\n", " "), other.unit
    scale = readable(unit, _largest([one.x for curves in panels.values() for one in curves]))
    for place, curves in enumerate(panels.values()):
        low = bottom + high * (len(panels) - 1 - place)
        box = (left / size[0], (low + 0.12) / size[1], WIDTH / size[0], (high - 0.24) / size[1])
        with rc_context({"axes.formatter.offset_threshold": DIGITS}):
            axes = picture.add_axes(box, sharex=shared)
        shared = shared or axes
        _panel(axes, curves, scale.size)
        if wanted.logx:
            axes.set_xscale("log", nonpositive="mask")
        if wanted.logy:
            axes.set_yscale("log", nonpositive="mask")
        if place < len(panels) - 1:
            axes.tick_params(labelbottom=False)
        else:
            axes.set_xlabel(scale.label(across), fontsize=9, color=INK)
    picture.text(left / size[0], 1 - 0.3 / size[1], drawable(name), fontsize=10, color=INK, parse_math=False)
    return picture


def draw_changes(rows: Sequence[tuple[int, float, float | None]], name: str, unit: str, path: str) -> Path:
    """Draw a number that stays as it is between its changes to the picture `path`. Returns the path.

    rows: cycle, time in s and the number from then on, None for none; time is the axis, or cycles if there
    was no time. Error 31 if it cannot be written, ValueError for a path that names no picture.
    """
    from matplotlib.figure import Figure

    target, picture = picture_path(path), Figure((WIDTH + 1.2, 2 * PANEL), facecolor="white", layout="tight")
    cycles, times, values = np.array(rows, np.float64).T
    axes = picture.add_subplot()
    passed = bool(np.ptp(times))
    axes.plot(times if passed else cycles, values, color=COLOURS[0], linewidth=1.2, drawstyle="steps-post")
    axes.set_xlabel("time (s)" if passed else "cycle", fontsize=9, color=INK)
    axes.set_ylabel(unit or "value", fontsize=9, color=INK)
    axes.set_title(drawable(name), fontsize=10, color=INK, loc="left", parse_math=False)
    axes.grid(color="#e4e0d8", linewidth=0.6)
    style_frame(axes)
    write_as(picture, target)
    return target


def curves_of(series: Sequence[Series], wanted: Wanted) -> list[Curve]:
    """The curves that are wanted, of numbers in the units of the field table.

    Error 10 if there is no such history, or a difference has two units, 26 without a cycle in common, 28 for
    a logarithmic axis without a number above 0.
    """
    for word, n in (("history", wanted.number), ("less", wanted.less), ("against", wanted.against)):
        if not 0 <= n <= len(series):
            raise UdecError(10, f"there is no history {n}", "PRINT HISTORIES lists them", parameter=word)
    if (wanted.less or wanted.against) and not wanted.number:
        raise UdecError(10, "which history?", "PLOT HISTORY n LESS m AGAINST k", parameter="history")
    chosen = [series[wanted.number - 1]] if wanted.number else series
    curves = [_curve(one, series, wanted) for one in chosen]
    for one in curves:
        for word, numbers in (("logx", one.x), ("logy", one.y)):
            if getattr(wanted, word) and len(numbers) and not (numbers > 0).any():
                raise UdecError(28, f"{word.upper()}, but no number is above 0", parameter=word)
    return curves


def _curve(one: Series, series: Sequence[Series], wanted: Wanted) -> Curve:
    """One history as it is wanted."""
    rows, label, key = one.numbers, one.name, _key(one)
    if wanted.less:
        other = series[wanted.less - 1]
        if other.unit != one.unit:
            raise UdecError(10, f"{one.name} and {other.name} have different units", parameter="less")
        rows, subtracted = _in_common(rows, other.numbers, "less")
        rows = np.column_stack([rows[:, :2], rows[:, 2] - subtracted[:, 2]])
        label, key = f"{label} less {other.name}", f"{key}\nless {_key(other)}"
    if wanted.against:
        rows, across = _in_common(rows, series[wanted.against - 1].numbers, "against")
        x, y = across[:, 2], rows[:, 2]
    else:
        x, y = rows[:, 1], rows[:, 2]
        new_times = np.flatnonzero(np.diff(x) < 0) + 1  # RESET TIME
        x, y = (np.insert(numbers, new_times, np.nan) for numbers in (x, y))
    return Curve(one.name if one.group else one.unit or one.name, label, one.unit, key, x, y)


def _in_common(rows: Any, others: Any, word: str) -> tuple[Any, Any]:
    """The rows of two histories in the cycles that both have. Error 26 if there are none."""
    _, here, there = np.intersect1d(rows[:, 0], others[:, 0], return_indices=True)
    if not len(here):
        advice = "HISTORY with the same number of cycles records both at once"
        raise UdecError(26, "the two histories have no cycle in common", advice, parameter=word)
    return rows[here], others[there]


def _key(one: Series) -> str:
    name = f"{one.number}: {one.group or one.name}"
    apart = "\n" if len(name) + len(one.place) > KEY_LETTERS else " "
    return f"{name}{apart}{one.place}" if one.place else name


def _largest(numbers: Sequence[Any]) -> float:
    """The largest magnitude in some arrays, whatever is not finite left out; 0 if there is none."""
    every = np.concatenate(numbers)
    return float(np.abs(every[np.isfinite(every)]).max(initial=0.0))


def _panel(axes: Axes, curves: list[Curve], size: float) -> None:
    """Curves that belong together, and a key to them. size: of the unit of the x axis."""
    scale = readable(curves[0].unit, _largest([one.y for one in curves]))
    for i, one in enumerate(curves):
        style: dict[str, Any] = {"color": COLOURS[i % len(COLOURS)], "linewidth": 1.2}
        if np.isfinite(one.y).sum() < MARKED:
            style |= {"marker": "o", "markersize": 2.5}
        axes.plot(one.x / size, one.y / scale.size, label=one.key, **style)
    names = {one.label for one in curves}
    axes.set_ylabel(scale.label(names.pop()) if len(names) == 1 else scale.name, fontsize=9, color=INK)
    axes.yaxis.get_offset_text().set(fontsize=8, color=INK)
    axes.grid(color="#e4e0d8", linewidth=0.6)
    style_frame(axes)
    handles, labels = axes.get_legend_handles_labels()
    if len(labels) > KEY_CURVES:
        labels[KEY_CURVES - 1] += f" and {len(labels) - KEY_CURVES} more"
    axes.legend(
        handles[:KEY_CURVES],
        labels[:KEY_CURVES],
        loc="upper left",
        bbox_to_anchor=(1.01, 1.02),
        borderaxespad=0.0,
        fontsize=8,
        frameon=False,
    )
