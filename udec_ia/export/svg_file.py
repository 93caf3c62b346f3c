"""SVG: a state as a drawing for documents, in layers that drawing programs can show, hide and colour.

One unit of the drawing is one metre, and y points up. Each part is a layer; the title of a shape, which
browsers show under the pointer, names its group, and the material of blocks and zones.
"""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from udec_ia.export.scene_parts import LINES, POINTS, Part

MARGIN = 0.02  # of the size of the drawing
STYLE = {  # of each part: fill, stroke, and width of lines in pixels
    "blocks": ("#e9e4d8", "#33302b", 1.0),
    "zones": ("none", "#6d675d", 0.4),
    "contacts": ("#b3261e", "none", 0.0),
    "water": ("#2a6fbb", "none", 0.0),
    "structures": ("none", "#1f6f3f", 2.0),
}
WIDTH = 800  # pixels
SVG_MARK = "<!-- udec_ia -->"  # the first line
DOT = 0.002  # radius of points, of the size of the drawing


def svg_text(parts: list[Part]) -> str:
    """The drawing of a state."""
    places = np.concatenate([part.place for part in parts])
    places = places if len(places) else np.zeros((1, 2))
    low, high = places.min(axis=0), places.max(axis=0)
    size = float((high - low).max()) or 1.0
    low, high = low - MARGIN * size, high + MARGIN * size
    width, height = (high - low).tolist()
    box = f"{low[0]:.10g} {-high[1]:.10g} {width:.10g} {height:.10g}"
    layers = "".join(_layer(part, DOT * size) for part in parts if len(part.ends) > 1)
    return (
        f'{SVG_MARK}\n<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="{WIDTH}" '
        f'height="{WIDTH * height / width:.0f}">\n<g transform="scale(1,-1)">\n{layers}</g>\n</svg>\n'
    )


def _layer(part: Part, dot: float) -> str:
    """The shapes of a part."""
    fill, stroke, width = STYLE[part.name]
    style = f'fill="{fill}" stroke="{stroke}" stroke-width="{width}" stroke-linejoin="round"'
    shapes = "".join(_shape(part, k, dot) for k in range(len(part.ends) - 1))
    return f'<g id="{part.name}" {style}>\n{shapes}</g>\n'


def _shape(part: Part, k: int, dot: float) -> str:
    """The cell `k` of a part."""
    points = part.place[part.corners[part.ends[k] : part.ends[k + 1]]].tolist()
    title = f"<title>{escape(_title(part, k))}</title>"
    if part.kind == POINTS:
        x, y = points[0]
        return f'<circle cx="{x:.10g}" cy="{y:.10g}" r="{dot:.4g}">{title}</circle>\n'
    path = "M" + "L".join(f"{x:.10g},{y:.10g}" for x, y in points) + ("" if part.kind == LINES else "Z")
    return f'<path d="{path}" vector-effect="non-scaling-stroke">{title}</path>\n'


def _title(part: Part, k: int) -> str:
    """What the cell `k` of a part is."""

    def value(name: str) -> Any:
        return part.columns[name][k]

    kind = part.name[:-1] if part.name.endswith("s") else part.name
    title = f"{kind}@{value('address')}" if "address" in part.columns else kind
    return f"{title}, material {value('KMAT')}" if "KMAT" in part.columns else title
