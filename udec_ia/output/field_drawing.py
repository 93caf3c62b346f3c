"""What goes on inside blocks is drawn: sides of zones, colours, crosses of stresses, and arrows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.layout import offsets as g
from udec_ia.output.block_drawing import INK
from udec_ia.output.colour_scales import LONGEST, Note, colours_for, draw_scale, scale_note
from udec_ia.output.drawn_outlines import Field, Outlines, curves
from udec_ia.reader.drawable_quantities import ARROWS, IN_BLOCKS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.path import Path as Curve

ALIKE = 0.05  # part of its area by which a block may differ in two states
ARROW = "#1f4e79"
ARROW_WIDTH = 0.022  # inches
NEGLIGIBLE = 5e-3  # of the longest arrow: not drawn
TENSION, COMPRESSION = "#b3261e", "#1f4e79"
MESH = "#6d675d"
GRAVITY_ARROW = 30.0  # points
LEANS = 1e-6  # share of the gravity across from which on its direction is drawn


def draw_zones(axes: Axes, now: Field, o: Outlines) -> None:
    """The sides of all zones, as far as the rounded outlines of their blocks reach."""
    from matplotlib.collections import PolyCollection

    if not len(now.zone):
        return
    mesh = PolyCollection(list(now.zone), facecolors="none", edgecolors=MESH, linewidths=0.4, zorder=2.6)
    axes.add_collection(mesh, autolim=False)
    mesh.set_clip_path(_outline(o, o.kind == g.MFDEF), axes.transData)


def draw_colours(axes: Axes, now: Field, moved: Any, o: Outlines, name: str, beyond: float = 0.0) -> None:
    """Zones, and blocks without zones, in the colours of a quantity, with a scale on the right.

    moved: displacements of the points (n, 2), NaN where they are not known. name: key of IN_BLOCKS. beyond:
    as of draw_scale.
    """
    from matplotlib.collections import PathCollection, PolyCollection

    quantity = IN_BLOCKS[name]
    values = quantity.values(now, moved)
    if not np.isfinite(values).any():  # rigid blocks have no stresses
        return
    x, y = now.in_blocks(now.place).T
    (x1, x2), (y1, y2) = axes.get_xlim(), axes.get_ylim()
    in_view = values[(x > x1) & (x < x2) & (y > y1) & (y < y2)]
    colours = colours_for(in_view if np.isfinite(in_view).any() else values, quantity.unit, quantity.scale)
    shades = colours.of(values)
    n, known = len(now.corners), np.isfinite(values)
    if n:
        zones = PolyCollection(
            list(now.zone), facecolors=shades[:n], edgecolors="face", linewidths=0.2, zorder=2.4
        )
        axes.add_collection(zones, autolim=False)
        zones.set_clip_path(_outline(o, o.kind == g.MFDEF), axes.transData)
    without_zones = np.flatnonzero(o.kind != g.MFDEF)[known[n:]]
    whole = PathCollection(
        _outlines(o, without_zones), facecolors=shades[n:][known[n:]], edgecolors="none", zorder=2.4
    )
    axes.add_collection(whole, autolim=False)
    coloured = o.kind == g.MFDEF
    coloured[without_zones] = True
    edges = PathCollection(
        [_outline(o, coloured)], facecolors="none", edgecolors=INK, linewidths=0.8, zorder=2.7
    )
    axes.add_collection(edges, autolim=False)
    draw_scale(axes, colours, quantity.label, beyond)


def _outline(o: Outlines, chosen: Any) -> Curve:
    """The rounded outlines of the chosen blocks as one path."""
    from matplotlib.path import Path as Curve

    vertices, codes, block = curves(o)
    here = chosen[block]
    return Curve(vertices[here], codes[here])


def _outlines(o: Outlines, blocks: Any) -> list[Curve]:
    """The rounded outlines of some blocks, given by their indices, as a path each."""
    from matplotlib.path import Path as Curve

    vertices, codes, block = curves(o)
    first, last = np.searchsorted(block, blocks), np.searchsorted(block, blocks, side="right")
    return [Curve(vertices[i:j], codes[i:j]) for i, j in zip(first, last, strict=True)]


def draw_principal(axes: Axes, now: Field, size: float) -> Note:
    """Crosses along the principal stresses; returns a note on their scale. size: of the picture, m."""
    from matplotlib.collections import LineCollection
    from matplotlib.patheffects import withStroke

    known = np.isfinite(now.stress).all(axis=1)
    s11, s12, s22 = now.stress[known].T
    middle = now.middle[known]
    angle = np.arctan2(2 * s12, s11 - s22) / 2
    mean, radius = (s11 + s22) / 2, np.hypot((s11 - s22) / 2, s12)
    largest = float((np.abs(mean) + radius).max(initial=0.0))
    for value, turn in ((mean + radius, 0.0), (mean - radius, np.pi / 2)):
        along = np.stack([np.cos(angle + turn), np.sin(angle + turn)], axis=-1)
        half = along * (np.abs(value) / (largest or 1.0) * size * LONGEST / 2)[:, None]
        for chosen, colour in ((value > 0, TENSION), (value < 0, COMPRESSION)):
            lines = np.stack([middle - half, middle + half], axis=1)[chosen]
            crosses = LineCollection(list(lines), colors=colour, linewidths=0.9, zorder=4)
            crosses.set_path_effects([withStroke(linewidth=1.8, foreground="white")])
            axes.add_collection(crosses, autolim=False)
    note = scale_note("principal stress", "Pa", largest, LONGEST * size, colour=COMPRESSION)
    return note._replace(text=f"{note.text} (blue: compression, red: tension)")


def displacements(first: Field, now: Field) -> Any:
    """Displacements (n, 2) in m of the points of `now` since `first`; NaN for those that were not there."""
    moved = np.full(now.place.shape, np.nan)
    _, before, after = np.intersect1d(first.address, now.address, return_indices=True)
    same = np.abs(now.area[after] - first.area[before]) <= ALIKE * first.area[before]
    before, after = before[same], after[same]  # not blocks that were cut, or filled in at a free address
    moved[after] = now.place[after] - first.place[before]
    return moved


def draw_arrows(axes: Axes, name: str, place: Any, vector: Any, size: float) -> Note:
    """Arrows with their tails at the places (n, 2), the longest LONGEST of the picture; a note on the scale.

    name: key of ARROWS. vector: (n, 2), NaN where it is not known. size: of the picture, m.
    """
    known = np.isfinite(vector).all(axis=1)
    place, vector = place[known], vector[known]
    largest = float(np.hypot(*vector.T).max(initial=0.0))
    arrows = None
    if largest > 0:
        shown = np.hypot(*vector.T) > NEGLIGIBLE * largest  # else only their white edges are seen
        place, reach = place[shown], vector[shown] * (size * LONGEST / largest)
        style: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0}
        style |= {"units": "inches", "width": ARROW_WIDTH}
        arrows = axes.quiver(
            *place.T, *reach.T, color=ARROW, edgecolor="white", linewidth=0.4, zorder=5, **style
        )
    return scale_note(ARROWS[name].label, ARROWS[name].unit, largest, LONGEST * size, arrows)


def leans(gravity: tuple[float, float]) -> bool:
    """True if gravity does not point straight down, as a reader of a picture expects."""
    return abs(gravity[0]) > LEANS * np.hypot(*gravity) or gravity[1] > 0


def draw_gravity(axes: Axes, gravity: tuple[float, float]) -> None:
    """An arrow in the upper right corner along a gravity that does not point straight down."""
    from matplotlib.patches import Circle, FancyArrow
    from matplotlib.transforms import Affine2D, ScaledTranslation

    if not leans(gravity):
        return
    figure: Any = axes.figure
    to_axes: Any = axes.transAxes
    corner = ScaledTranslation(1.0, 1.0, to_axes)
    in_points = Affine2D().scale(1.0 / 72.0) + figure.dpi_scale_trans + corner
    x, y = np.array(gravity) / np.hypot(*gravity) * GRAVITY_ARROW
    middle = -0.9 * GRAVITY_ARROW
    style: dict[str, Any] = {"transform": in_points, "zorder": 7}
    axes.add_artist(
        Circle((middle, middle), 0.75 * GRAVITY_ARROW, facecolor="white", edgecolor="#8a857c", **style)
    )
    shape: dict[str, Any] = {
        "width": 2.0,
        "head_width": 8.0,
        "head_length": 9.0,
        "length_includes_head": True,
    }
    axes.add_artist(FancyArrow(middle - x / 2, middle - y / 2, x, y, color=INK, **shape, **style))
    axes.text(
        middle - 0.32 * y,
        middle + 0.32 * x,
        "g",
        fontsize=9,
        fontstyle="italic",
        color=INK,
        ha="center",
        va="center",
        **style,
    )
