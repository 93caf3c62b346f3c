"""Joints are drawn in the colours of a quantity: each contact colours its part, or the two sides of it.

Pressure and saturation are those of the domain on each side of a contact.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.output.block_drawing import INK, drawable
from udec_ia.output.colour_scales import (
    FROM_WHITE,
    UNKNOWN,
    WATER_BLUES,
    WHOLE,
    colours_for,
    draw_scale,
)
from udec_ia.output.drawn_outlines import Joints
from udec_ia.reader.drawable_quantities import FROM_ZERO, HIGHEST_SAFETY, OF_JOINTS, SAFETY, STATE, OfJoints
from udec_ia.reader.fracture_rows import CAUSES, ENDS
from udec_ia.reader.joint_rows import STATES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

THIN, THICK = 0.7, 4.0  # points: lines of joints with nothing, and with the largest number
COLOURS = (UNKNOWN, "#f0a030", "#b3261e", "#7570b3", "#1f78b4")  # of STATES
CRACKS = ("#e7298a", "#b3261e", "#1b9e77")  # of CAUSES


def slip_since(joints: Joints, before: Joints) -> Joints:
    """The joints with the slip since `before`; a contact that was not there then has all of its slip."""
    rows = joints.rows.copy()
    _, now, then = np.intersect1d(rows["contact"], before.rows["contact"], return_indices=True)
    same = (joints.blocks[now] == before.blocks[then]).all(axis=1)  # else another one has its address
    rows["slip"][now[same]] -= before.rows["slip"][then[same]]
    return replace(joints, rows=rows)


def draw_joints(axes: Axes, joints: Joints, name: str, beyond: float = 0.0, since: str = "") -> None:
    """All joints, with a key on the right: in colours, wider where the number is larger, or by state.

    name: key of OF_JOINTS. beyond: width of other keys between the picture and this one, as a share of the
    picture. since: the stage from which slip is counted, or "".
    """
    quantity = OF_JOINTS[name]
    values, lines = quantity.values(joints), joints.line
    if name == STATE:
        _draw_states(axes, joints, values, beyond)
        return
    if values.ndim == 2:  # one for each side
        values = values.ravel()
        lines = np.stack([lines[:, :2], lines[:, 1:]], axis=1).reshape(-1, 2, 2)
    palette = WATER_BLUES if quantity.water else FROM_WHITE if quantity.scale == FROM_ZERO else WHOLE
    colours = colours_for(values, quantity.unit, quantity.scale, palette)
    _draw_lines(axes, lines, colours.of(values), THIN + (THICK - THIN) * _weights(values, quantity))
    label = f"{quantity.label} since {drawable(since)}" if since else quantity.label
    draw_scale(axes, colours, label, beyond, endless=quantity.scale == SAFETY)


def _weights(values: Any, quantity: OfJoints) -> Any:
    """Between 0 and 1, how wide the line of each value is: the more so the worse, or the larger."""
    known = np.where(np.isnan(values), np.inf if quantity.scale == SAFETY else 0.0, values)
    if quantity.scale == SAFETY:
        return np.clip((HIGHEST_SAFETY - known) / (HIGHEST_SAFETY - 1.0), 0.0, 1.0)
    return np.abs(known) / (np.abs(known).max(initial=0.0) or 1.0)


def _draw_states(axes: Axes, joints: Joints, states: Any, beyond: float) -> None:
    """Joints in the colours of their states, and how many contacts are in each."""
    _draw_lines(axes, joints.line, np.array(COLOURS)[states], np.where(states == 0, THIN, THICK / 2))
    counts = np.bincount(states, minlength=len(STATES)).tolist()
    names = [f"{state}: {count}" for state, count in zip(STATES, counts, strict=True)]
    _key(axes, OF_JOINTS[STATE].label, names, COLOURS, (1.01 + beyond, 1.0), "upper left")


def draw_cracks(axes: Axes, rows: Any, beyond: float = 0.0) -> None:
    """The cracks that runs have made, rows of reader.fracture_rows, where they were then, by their causes."""
    cause = np.array([CAUSES.index(one) for one in rows["cause"]], int)
    ends = np.stack([rows[name] for name in ENDS], axis=1).reshape(-1, 2, 2)
    _draw_lines(axes, ends, np.array(CRACKS)[cause], np.full(len(ends), THICK / 2))
    counts = np.bincount(cause, minlength=len(CAUSES)).tolist()
    names = [f"{name}: {count}" for name, count in zip(CAUSES, counts, strict=True)]
    _key(axes, "cracks by", names, CRACKS, (1.01 + beyond, 0.0), "lower left")


def _key(
    axes: Axes, title: str, names: list[str], colours: Any, place: tuple[float, float], anchor: Any
) -> None:
    """Which colour is what, on the right of the picture."""
    from matplotlib.legend import Legend
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=colour, linewidth=2.0) for colour in colours]
    style: dict[str, Any] = {"fontsize": 9, "title_fontsize": 9, "labelcolor": INK, "frameon": False}
    key = Legend(
        axes, lines, names, title=title, loc=anchor, bbox_to_anchor=place, borderaxespad=0.0, **style
    )
    key.set_clip_on(False)  # else the layout of a figure leaves it out
    axes.add_artist(key)


def _draw_lines(axes: Axes, places: Any, colours: Any, widths: Any) -> None:
    """Lines through the places (n, k, 2), the widest on top."""
    from matplotlib.collections import LineCollection

    order = np.argsort(widths, kind="stable")
    lines = LineCollection(
        list(places[order]), colors=colours[order], linewidths=widths[order], capstyle="butt", zorder=3.5
    )
    axes.add_collection(lines, autolim=False)
