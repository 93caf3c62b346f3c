"""Joints are drawn by their slip, opening or state: each contact colours its part of the joint."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.output.block_drawing import INK
from udec_ia.output.drawn_outlines import Joints
from udec_ia.output.field_drawing import draw_scale
from udec_ia.reader.joint_rows import STATES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SLIP, OPENING, STATE = "slip", "opening", "state"
MEASURES = {SLIP: "slip (m)", OPENING: "opening (m)", STATE: "joints (contacts)"}  # keyword of PLOT: its key
THIN, THICK = 0.7, 4.0  # points: lines of joints with nothing, and with the largest number
PALETTE, PALEST = "YlOrRd", 0.25  # what is below that part of the palette is hardly seen
COLOURS = ("#8a857c", "#f0a030", "#b3261e", "#7570b3", "#1f78b4")  # of STATES


def joint_values(joints: Joints, name: str) -> Any:
    """What is drawn of each contact (n,): slip to either side, opening (a closed one has none), or state."""
    if name == OPENING:
        return np.maximum(joints.rows["opening"], 0.0)
    return np.abs(joints.rows["slip"]) if name == SLIP else joints.rows["state"]


def draw_joints(axes: Axes, joints: Joints, name: str, beyond: float = 0.0) -> None:
    """All joints, with a key on the right: wider and darker the more they slip or open, or by state.

    beyond: width of other keys between the picture and this one, as a share of the picture.
    """
    values = joint_values(joints, name)
    if name == STATE:
        _draw_states(axes, joints, values, beyond)
        return
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    largest = float(values.max(initial=0.0)) or 1.0
    palette = ListedColormap(colormaps[PALETTE](np.linspace(PALEST, 1.0, 256)))
    colour = ScalarMappable(Normalize(0.0, largest), palette)
    _draw_lines(axes, joints, colour.to_rgba(values), THIN + (THICK - THIN) * values / largest)
    draw_scale(axes, colour, MEASURES[name], beyond)


def _draw_states(axes: Axes, joints: Joints, states: Any, beyond: float) -> None:
    """Joints in the colours of their states, and how many contacts are in each."""
    from matplotlib.lines import Line2D

    colours = np.array(COLOURS)[states]
    _draw_lines(axes, joints, colours, np.where(states == 0, THIN, THICK / 2))
    counts = np.bincount(states, minlength=len(STATES))
    lines = [
        Line2D([], [], color=colour, linewidth=2.0, label=f"{state}: {count}")
        for state, colour, count in zip(STATES, COLOURS, counts, strict=True)
    ]
    axes.figure.legend(
        handles=lines,
        title=MEASURES[STATE],
        loc="upper left",
        bbox_to_anchor=(1.01 + beyond, 1.0),
        bbox_transform=axes.transAxes,
        fontsize=8,
        title_fontsize=8,
        labelcolor=INK,
        frameon=False,
    )


def _draw_lines(axes: Axes, joints: Joints, colours: Any, widths: Any) -> None:
    """The widest on top."""
    from matplotlib.collections import LineCollection

    order = np.argsort(widths, kind="stable")
    lines = LineCollection(
        list(joints.line[order]), colors=colours[order], linewidths=widths[order], capstyle="butt", zorder=3.5
    )
    axes.add_collection(lines)
