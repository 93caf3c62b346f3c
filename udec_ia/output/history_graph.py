"""PLOT HISTORY: what was recorded against time, as PNG and SVG. And the changes of one number.

Histories of one field of several groups share a panel, since they can be compared, and so do quantities of
the whole model in one unit, such as energies. The panels stand one above the other over one time axis. A
curve breaks off where its group has gone.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.output.block_drawing import INK, drawable, picture_path, style_frame, write, write_as
from udec_ia.running.history_series import Series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 7.0  # inches of a panel
PANEL = 1.9  # inches in height
MARGINS = (0.9, 0.25, 0.5, 0.45)  # left, right, bottom, top, in inches
KEY_WIDTH = 2.3  # inches for the keys on the right
KEY_CURVES = 10  # curves of a panel that the key names
MARKED = 60  # numbers below which each is marked by a point
COLOURS = ("#1f6f8b", "#c8553d", "#588b3c", "#7a5ba6", "#b8860b", "#3a4f7a", "#a23b72", "#5f6b6d")


def draw(series: Sequence[Series], name: str, base: Path) -> list[Path]:
    """Draw all of `series` to base.png and base.svg; returns both paths. name: title of the picture.

    Error 31 if they cannot be written.
    """
    return write(figure(series, name), base)


def figure(series: Sequence[Series], name: str) -> Figure:
    """The picture: its panels in the order in which they were asked for."""
    from matplotlib.figure import Figure

    panels: dict[str, list[Series]] = {}
    for one in series:
        panels.setdefault(one.name if one.group else one.unit or one.name, []).append(one)
    left, right, bottom, top = MARGINS
    size = (left + WIDTH + KEY_WIDTH + right, bottom + PANEL * len(panels) + top)
    picture = Figure(size, facecolor="white")
    shared: Axes | None = None
    for place, curves in enumerate(panels.values()):
        low = bottom + PANEL * (len(panels) - 1 - place)
        box = (left / size[0], (low + 0.12) / size[1], WIDTH / size[0], (PANEL - 0.24) / size[1])
        axes = picture.add_axes(box, sharex=shared)
        shared = shared or axes
        _panel(axes, curves)
        if place < len(panels) - 1:
            axes.tick_params(labelbottom=False)
        else:
            axes.set_xlabel("time (s)", fontsize=9, color=INK)
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


def _key(one: Series) -> str:
    return f"{one.number}: {one.group or one.name}" + (f" {one.place}" if one.place else "")


def _panel(axes: Axes, curves: list[Series]) -> None:
    """Curves that belong together, and a key to them."""
    names, unit = {one.name for one in curves}, curves[0].unit
    label = unit if len(names) > 1 else curves[0].name + (f" ({unit})" if unit else "")
    for i, one in enumerate(curves):
        _, time, value = one.numbers.T
        new_times = np.flatnonzero(np.diff(time) < 0) + 1  # RESET TIME
        time, value = (np.insert(numbers, new_times, np.nan) for numbers in (time, value))
        style: dict[str, Any] = {"color": COLOURS[i % len(COLOURS)], "linewidth": 1.2}
        if np.isfinite(value).sum() < MARKED:
            style |= {"marker": "o", "markersize": 2.5}
        axes.plot(time, value, label=_key(one), **style)
    axes.set_ylabel(label, fontsize=9, color=INK)
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
