"""Structures are drawn as lines: tension in red, compression in blue, broken ones dashed in grey."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TENSION, COMPRESSION, BROKEN = "#b3261e", "#1f5fa8", "#8a857c"
THIN, THICK = 1.0, 4.0  # points: lines without force, and with the largest


def draw_structures(axes: Axes, rows: Any) -> str:
    """All structures, the wider the greater their axial force. Returns a note on it."""
    from matplotlib.collections import LineCollection

    size = np.abs(rows["force"])
    largest = float(size.max(initial=0.0))
    widths = THIN + (THICK - THIN) * size / (largest or 1.0)
    colours = np.where(rows["broken"], BROKEN, np.where(rows["force"] < 0, COMPRESSION, TENSION))
    styles = ["dashed" if broken else "solid" for broken in rows["broken"]]
    lines = LineCollection(
        list(rows["line"]), colors=colours, linewidths=widths, linestyles=styles, capstyle="round", zorder=3.8
    )
    axes.add_collection(lines)
    note = f"largest axial force of a structure: {largest:.4g} N/m; tension is red, compression blue"
    return note + ("; broken ones are dashed" if rows["broken"].any() else "")
