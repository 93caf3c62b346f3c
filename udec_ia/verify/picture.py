"""Pictures for the page: computed numbers over exact curves, and small files."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from udec_ia.output.block_drawing import INK, title
from udec_ia.output.history_graph import COLOURS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE = (7.2, 3.4)  # inches of a graph
DPI = 90
SHADES = 64  # colours of a file


def graph(name: str, x: str, y: str, exact: Mapping[str, Any], computed: Sequence[Any]) -> Figure:
    """Curves over one pair of axes: `exact` as lines, `computed` as points in the same order of colours."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(SIZE, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    title(axes, name)
    for colour, (label, points) in zip(COLOURS, exact.items(), strict=False):
        axes.plot(*points, color=colour, linewidth=1.2, label=label)
    for k, points in enumerate(computed):
        style: dict[str, Any] = {"markersize": 3.5, "markerfacecolor": "white", "markeredgewidth": 0.9}
        label = "computed" if k == 0 else "_"  # said once
        axes.plot(*points, "o", color=COLOURS[k % len(COLOURS)], label=label, **style)
    axes.set_xlabel(x, fontsize=9, color=INK)
    axes.set_ylabel(y, fontsize=9, color=INK)
    axes.grid(color="#e4e0d8", linewidth=0.6)
    axes.tick_params(labelsize=8, colors=INK, width=0.6)
    for spine in axes.spines.values():
        spine.set(linewidth=0.6, color="#8a857c")
    figure.legend(loc="outside right upper", fontsize=8, frameon=False)
    return figure


def png(figure: Figure) -> bytes:
    """The picture as a small PNG."""
    from PIL import Image

    whole, small = io.BytesIO(), io.BytesIO()
    figure.savefig(whole, format="png", dpi=DPI)
    with Image.open(whole) as image:
        image.convert("RGB").quantize(SHADES).save(small, "png", optimize=True)
    return small.getvalue()
