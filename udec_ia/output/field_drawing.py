"""The contents of a Field are drawn: sides of zones, colours for stresses, crosses and arrows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.layout import offsets as g
from udec_ia.output.drawn_outlines import CONTOURS, Field, Outlines, curves, measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.path import Path as Curve

ALIKE = 0.05  # part of its area by which a block may differ in two states
LONGEST = 0.08  # of the picture: the longest arrow or cross
ARROW = "#1f4e79"
TENSION, COMPRESSION = "#b3261e", "#1f4e79"
MESH, OUTLINE = "#6d675d", "#33302b"


def draw_zones(axes: Axes, now: Field, o: Outlines) -> None:
    """The sides of all zones, as far as the rounded outlines of their blocks reach."""
    from matplotlib.collections import PolyCollection

    if not len(now.zone):
        return
    mesh = PolyCollection(list(now.zone), facecolors="none", edgecolors=MESH, linewidths=0.4, zorder=2.6)
    axes.add_collection(mesh)
    mesh.set_clip_path(_outline(o, o.kind == g.MFDEF), axes.transData)


def draw_contours(axes: Axes, now: Field, o: Outlines, name: str, beyond: float = 0.0) -> None:
    """Zones and simply-deformable blocks in the colour of one of their stresses, with a key on the right.

    beyond: width of other keys, between picture and this one, as a share of the picture. Stresses of both
    signs are red and blue about 0, others have the whole range of a palette.
    """
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import PathCollection, PolyCollection
    from matplotlib.colors import Normalize

    values = measure(now.stress, name)
    low, high, palette = float(values.min(initial=0.0)), float(values.max(initial=0.0)), "RdBu_r"
    if low < 0 < high:
        high = max(high, -low)
        low = -high
    elif len(values):
        low, high, palette = float(values.min()), float(values.max()), "viridis"
    colour = ScalarMappable(Normalize(low, high), colormaps[palette])
    shades = colour.to_rgba(values)
    n = len(now.zone)
    if n:
        zones = PolyCollection(
            list(now.zone), facecolors=shades[:n], edgecolors="face", linewidths=0.2, zorder=2.4
        )
        axes.add_collection(zones)
        zones.set_clip_path(_outline(o, o.kind == g.MFDEF), axes.transData)
    simple = [_outline(o, np.arange(len(o.kind)) == i) for i in np.flatnonzero(o.kind == g.MSDEF)]
    axes.add_collection(PathCollection(simple, facecolors=shades[n:], edgecolors="none", zorder=2.4))
    edges = _outline(o, o.kind != g.MRIG)
    axes.add_collection(
        PathCollection([edges], facecolors="none", edgecolors=OUTLINE, linewidths=0.8, zorder=2.7)
    )
    draw_scale(axes, colour, CONTOURS[name], beyond)


def draw_scale(axes: Axes, colour: ScalarMappable, label: str, beyond: float) -> None:
    """The scale of colours on the right of the picture; beyond: as of draw_contours."""
    strip = axes.inset_axes((1.02 + beyond, 0.0, 0.02, 1.0))
    bar = axes.figure.colorbar(colour, cax=strip)
    bar.set_label(label, fontsize=8)
    strip.tick_params(labelsize=7)
    strip.ticklabel_format(axis="y", scilimits=(-3, 4))
    strip.yaxis.get_offset_text().set_fontsize(7)


def _outline(o: Outlines, chosen: Any) -> Curve:
    """The rounded outlines of the chosen blocks as one path."""
    from matplotlib.path import Path as Curve

    vertices, codes, block = curves(o)
    here = chosen[block]
    return Curve(vertices[here], codes[here])


def draw_principal(axes: Axes, now: Field, size: float) -> str:
    """Crosses along the principal stresses; returns a note on their scale."""
    from matplotlib.collections import LineCollection
    from matplotlib.patheffects import withStroke

    s11, s12, s22 = now.stress.T
    angle = np.arctan2(2 * s12, s11 - s22) / 2
    mean, radius = (s11 + s22) / 2, np.hypot((s11 - s22) / 2, s12)
    largest = float((np.abs(mean) + radius).max(initial=0.0)) or 1.0
    for value, turn in ((mean + radius, 0.0), (mean - radius, np.pi / 2)):
        along = np.stack([np.cos(angle + turn), np.sin(angle + turn)], axis=-1)
        half = along * (np.abs(value) / largest * size * LONGEST / 2)[:, None]
        for chosen, colour in ((value > 0, TENSION), (value < 0, COMPRESSION)):
            lines = np.stack([now.middle - half, now.middle + half], axis=1)[chosen]
            crosses = LineCollection(list(lines), colors=colour, linewidths=0.9, zorder=4)
            crosses.set_path_effects([withStroke(linewidth=1.8, foreground="white")])
            axes.add_collection(crosses)
    return f"largest principal stress: {largest:.4g} Pa (red: tension)"


def draw_velocities(axes: Axes, now: Field, size: float) -> str:
    """Arrows along the velocities of all moving points; returns a note on their scale."""
    return f"largest velocity: {_arrows(axes, now.place, now.velocity, size):.4g} m/s"


def displacements(first: Field, now: Field) -> tuple[Any, Any]:
    """Places now (n, 2) of the points that were there at `first`, and their displacements (n, 2), in m."""
    _, before, after = np.intersect1d(first.address, now.address, return_indices=True)
    same = np.abs(now.area[after] - first.area[before]) <= ALIKE * first.area[before]
    before, after = before[same], after[same]  # not blocks that were cut, or filled in at a free address
    return now.place[after], now.place[after] - first.place[before]


def draw_displacements(axes: Axes, first: Field, now: Field, size: float) -> str:
    """Arrows along the displacements from `first` to `now`; returns a note on their scale."""
    return f"largest displacement: {_arrows(axes, *displacements(first, now), size):.4g} m"


def _arrows(axes: Axes, place: Any, vector: Any, size: float) -> float:
    """Arrows with their tails at `place`, the longest LONGEST of the picture; returns the greatest length."""
    largest = float(np.hypot(*vector.T).max(initial=0.0))
    if largest > 0:
        reach = vector * (size * LONGEST / largest)
        style: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "width": 0.0025}
        axes.quiver(*place.T, *reach.T, color=ARROW, edgecolor="white", linewidth=0.4, zorder=5, **style)
    return largest
