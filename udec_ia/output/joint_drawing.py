"""Joints are drawn by their slip, opening or state, or by their water: each contact colours its part.

Pressure and saturation are those of the domain on each side of a contact.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.output.block_drawing import INK, drawable
from udec_ia.output.drawn_outlines import Joints
from udec_ia.output.field_drawing import draw_scale
from udec_ia.reader.joint_rows import STATES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

SLIP, OPENING, STATE = "slip", "opening", "state"
MEASURES = {SLIP: "slip (m)", OPENING: "opening (m)", STATE: "joints (contacts)"}  # keyword of PLOT: its key
WATER = {  # the same: name in Joints.water, and its key
    "ppressure": ("pressure", "pore pressure (Pa)"),
    "saturation": ("saturation", "saturation"),
    "flow": ("flow", "flow (m2/s)"),
    "aperture": ("aperture", "aperture (m)"),
}
THIN, THICK = 0.7, 4.0  # points: lines of joints with nothing, and with the largest number
PALETTE, PALEST = "YlOrRd", 0.25  # what is below that part of the palette is hardly seen
BLUES = "YlGnBu"
CRACK = "#b3261e"
COLOURS = ("#8a857c", "#f0a030", "#b3261e", "#7570b3", "#1f78b4")  # of STATES


def slip_since(joints: Joints, before: Joints) -> Joints:
    """The joints with the slip since `before`; a contact that was not there then has all of its slip."""
    rows = joints.rows.copy()
    _, now, then = np.intersect1d(rows["contact"], before.rows["contact"], return_indices=True)
    same = (joints.blocks[now] == before.blocks[then]).all(axis=1)  # else another one has its address
    rows["slip"][now[same]] -= before.rows["slip"][then[same]]
    return replace(joints, rows=rows)


def joint_values(joints: Joints, name: str) -> Any:
    """What is drawn of each contact (n,): slip to either side, opening (a closed one has none), or state."""
    if name == OPENING:
        return np.maximum(joints.rows["opening"], 0.0)
    return np.abs(joints.rows["slip"]) if name == SLIP else joints.rows["state"]


def draw_joints(axes: Axes, joints: Joints, name: str, beyond: float = 0.0, since: str = "") -> None:
    """All joints, with a key on the right: wider and darker the more they slip or open, or by state.

    beyond: width of other keys between the picture and this one, as a share of the picture. since: the stage
    from which slip is counted, or "".
    """
    if name in WATER:
        _draw_water(axes, joints, name, beyond)
        return
    values = joint_values(joints, name)
    if name == STATE:
        _draw_states(axes, joints, values, beyond)
        return
    largest = float(values.max(initial=0.0)) or 1.0
    colour = _scale(PALETTE, largest)
    _draw_lines(axes, joints.line, colour.to_rgba(values), THIN + (THICK - THIN) * values / largest)
    label = MEASURES[name].replace(SLIP, f"slip since {drawable(since)}") if since else MEASURES[name]
    draw_scale(axes, colour, label, beyond)


def _scale(palette: str, largest: float) -> ScalarMappable:
    """Colours for numbers from 0 to the largest."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    colours = ListedColormap(colormaps[palette](np.linspace(PALEST, 1.0, 256)))
    return ScalarMappable(Normalize(0.0, largest), colours)


def _draw_water(axes: Axes, joints: Joints, name: str, beyond: float) -> None:
    """Joints by the water on both sides of each contact."""
    measure, label = WATER[name]
    values = joints.water[measure].ravel()
    largest = float(values.max(initial=0.0)) or 1.0
    colour = _scale(BLUES, largest)
    halves = np.stack([joints.line[:, :2], joints.line[:, 1:]], axis=1).reshape(-1, 2, 2)
    _draw_lines(axes, halves, colour.to_rgba(values), THIN + (THICK - THIN) * values / largest)
    draw_scale(axes, colour, label, beyond)


def _draw_states(axes: Axes, joints: Joints, states: Any, beyond: float) -> None:
    """Joints in the colours of their states, and how many contacts are in each."""
    from matplotlib.lines import Line2D

    colours = np.array(COLOURS)[states]
    _draw_lines(axes, joints.line, colours, np.where(states == 0, THIN, THICK / 2))
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


def draw_cracks(axes: Axes, ends: Any) -> None:
    """The cracks that runs have made, (n, 2, 2), where they were then."""
    _draw_lines(axes, ends, np.full(len(ends), CRACK), np.full(len(ends), THICK / 2))


def _draw_lines(axes: Axes, places: Any, colours: Any, widths: Any) -> None:
    """Lines through the places (n, k, 2), the widest on top."""
    from matplotlib.collections import LineCollection

    order = np.argsort(widths, kind="stable")
    lines = LineCollection(
        list(places[order]), colors=colours[order], linewidths=widths[order], capstyle="butt", zorder=3.5
    )
    axes.add_collection(lines)
