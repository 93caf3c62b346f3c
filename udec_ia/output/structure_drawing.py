"""Structures are drawn as lines: tension in red, compression in blue, broken ones dashed in grey.

The moments of beams are drawn across them, on the side that they put in tension.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.output.colour_scales import Note
from udec_ia.output.field_drawing import COMPRESSION, TENSION
from udec_ia.output.readable_units import in_readable_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BROKEN, MOMENT = "#8a857c", "#2f6f4f"
THIN, THICK = 1.0, 4.0  # points: lines without force, and with the largest
NEGLIGIBLE = 1e-4  # moment over the largest axial force and the size of the picture
HEIGHT = 0.06  # of the largest moment, as a share of the picture


def draw_structures(axes: Axes, rows: Any, size: float) -> Note:
    """All structures, the wider the greater their axial force. size: of the picture, m. Returns a note."""
    from matplotlib.collections import LineCollection, PolyCollection

    force = np.abs(rows["force"])
    largest, greatest = float(force.max(initial=0.0)), float(np.abs(rows["moment"]).max(initial=0.0))
    note = f"axial forces up to {in_readable_units(largest, 'N/m')}, tension red, compression blue"
    if greatest > NEGLIGIBLE * size * largest:
        areas = PolyCollection(
            _diagrams(rows, HEIGHT * size / greatest), facecolor=MOMENT, alpha=0.35, zorder=3.7
        )
        axes.add_collection(areas)
        note += f"; moments up to {in_readable_units(greatest, 'N')}"
    colours = np.where(rows["broken"], BROKEN, np.where(rows["force"] < 0, COMPRESSION, TENSION))
    lines = LineCollection(
        list(rows["line"]),
        colors=colours,
        linewidths=THIN + (THICK - THIN) * force / (largest or 1.0),
        linestyles=["dashed" if broken else "solid" for broken in rows["broken"]],
        capstyle="round",
        zorder=3.8,
    )
    axes.add_collection(lines)
    return Note(note + ("; broken ones are dashed" if rows["broken"].any() else ""))


def _diagrams(rows: Any, scale: float) -> Any:
    """The areas between elements and their moments (n, 4, 2), which are `scale` m long by N."""
    way = rows["line"][:, 1] - rows["line"][:, 0]
    left = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(*way.T)[:, None]
    tops = rows["line"] + scale * rows["moment"][:, :, None] * left[:, None, :]
    return np.concatenate([rows["line"], tops[:, ::-1]], axis=1)
