"""Blocks, contacts, domains and addresses are drawn on the axes of a matplotlib figure.

Blocks that do not move have the colour of their material, hatched if they are fixed. Those that move get a
shade for each state, the darker the later.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.file_replacement import put_in_place
from udec_ia.interrupt_signals import defer_signals
from udec_ia.output.drawn_outlines import Contacts, Domain, Outlines, State, beside_corners, curves
from udec_ia.printable_text import printable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FIT = (7.0, 5.5)  # inches that the blocks may fill when no plot scale is set
LARGEST = 40.0  # inches that they may fill at any plot scale
MARGINS = (0.75, 0.25, 0.55, 0.45)  # left, right, bottom, top, in inches
KEY_STATES = 10  # states that the key names; of more, an even selection
STAGE_LETTERS = 12  # of the name of a stage that its key has room for
POINT = 1.0 / 72.0  # inch
LETTER = 0.08  # inches that one takes in a title, about
INK = "#33302b"
HATCH = "#b7ab93"
HATCH_WIDTH = 0.4
ROCKS = ("#ecdfc4", "#c9d6c5", "#d9c9d3", "#c7d5e0", "#e6cdb8", "#d5d3ae", "#cdc8e0", "#dfd7cf")
TINTS = ("#1b9e77", "#d95f02", "#7570b3", "#e7298a", "#66a61e", "#a6761d")
FORCE = "#b3261e"
FORCE_LENGTH = 0.15  # of the picture: the line of the largest contact force
PIECE = 2000  # blocks in one compound path
LEGIBLE = 16.0  # points that a block or domain must measure to be given its address
ROOMY = 90.0  # points that it must measure to be given those of its corners


def limits(states: list[State], margin: float = 0.04) -> tuple[float, float, float, float]:
    """x and y range over all states, with a margin as a share of the size.

    The range reaches beyond the first state by its size at most: a block that flies away must not shrink the
    rest to a dot.
    """
    lows = np.array([state.outlines.corner.min(axis=0) for state in states if len(state.outlines.corner)])
    highs = np.array([state.outlines.corner.max(axis=0) for state in states if len(state.outlines.corner)])
    if not len(lows):
        return 0.0, 1.0, 0.0, 1.0
    size = max(highs[0] - lows[0])
    low = np.maximum(lows.min(axis=0), lows[0] - size) - margin * size
    high = np.minimum(highs.max(axis=0), highs[0] + size) + margin * size
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def scale_for(box: tuple[float, float, float, float], scale: float) -> float:
    """Inches per metre: `scale` if it is set and the picture stays within LARGEST, else what fits."""
    width, height = box[1] - box[0], box[3] - box[2]
    if scale > 0.0:
        return min(scale, LARGEST / max(width, height))
    return min(FIT[0] / width, FIT[1] / height)


def load_matplotlib() -> None:
    """Import matplotlib: an import that Ctrl-C cuts in two would fail from then on."""
    with defer_signals(also_second=True):
        import matplotlib.backends.backend_agg
        import matplotlib.colors
        import matplotlib.legend
        import matplotlib.quiver  # noqa: F401


def paper(
    box: tuple[float, float, float, float], inches: float, key: float = 0.0, notes: float = 0.0
) -> tuple[Figure, Axes]:
    """An empty picture of the range `box` in metres, `inches` per metre.

    key, notes: inches to be left free on the right and at the bottom.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    left, right, bottom, top = MARGINS
    bottom += notes
    width, height = (box[1] - box[0]) * inches, (box[3] - box[2]) * inches
    size = (max(left + width + right + key, 4.0), bottom + height + top)
    figure = Figure(size, facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.add_axes((left / size[0], bottom / size[1], width / size[0], height / size[1]))
    axes.set(xlim=box[:2], ylim=box[2:], xlabel="x (m)", ylabel="y (m)")
    style_frame(axes)
    return figure, axes


def style_frame(axes: Axes) -> None:
    """Thin lines and small numbers around a picture."""
    axes.tick_params(labelsize=8, colors=INK, width=0.6)
    for spine in axes.spines.values():
        spine.set(linewidth=0.6, color="#8a857c")


def title(axes: Axes, name: str, when: str = "") -> None:
    """Write the name of the run over the picture; a $ in it begins no formula.

    when: text at the right of it, or below it if there is no room for both.
    """
    inches = axes.bbox.width / axes.figure.dpi
    above = "\n" if when and inches < LETTER * (len(name) + len(when)) else ""
    axes.set_title(drawable(name) + above, loc="left", fontsize=10, color=INK, parse_math=False)
    if when:
        axes.set_title(when, loc="right", fontsize=9, color=INK)


def drawable(name: str) -> str:
    """`name` with a ? for each character that the font of pictures does not have."""
    from matplotlib.font_manager import FontProperties, findfont, get_font

    font = get_font(findfont(FontProperties()))
    return "".join(c if font.get_char_index(ord(c)) else "?" for c in printable(name))


def draw_blocks(axes: Axes, states: list[State], inches: float) -> None:
    """All blocks of all states, each drawn again only where it has moved, and a key to the shades."""
    from matplotlib import colormaps

    drawn = to_draw(states, 0.25 * POINT / inches)
    moved = list(moved_blocks(states, drawn))
    shades = colormaps["YlGnBu"](np.linspace(0.3, 0.95, len(states)))
    for state, new, shade in zip(states, drawn, shades, strict=True):
        moving = np.isin(state.outlines.address, moved)
        draw_still_blocks(axes, state.outlines, new & ~moving, inches)
        draw_outlines(axes, state.outlines, new & moving, (*shade[:3], 0.3), tuple(shade), inches)
    if len(states) > 1:
        _key(axes, states, shades)


def _key(axes: Axes, states: list[State], shades: Any) -> None:
    """Which shade is which state, on the right of the picture."""
    from matplotlib.patches import Patch

    named = np.linspace(0, len(states) - 1, min(len(states), KEY_STATES)).round().astype(int)
    names = [drawable(one.stage)[:STAGE_LETTERS] or f"{one.time:.4g} s" for one in states]
    patches = [
        Patch(
            facecolor=(*shades[i][:3], 0.3),
            edgecolor=shades[i],
            label=f"{states[i].cycle}    {names[i]}",
        )
        for i in named
    ]
    axes.legend(
        handles=patches,
        title="cycle, time",
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        fontsize=8,
        title_fontsize=8,
        frameon=False,
    )


def to_draw(states: list[State], tolerance: float) -> list[Any]:
    """For each state: which of its blocks are to be drawn, being new or visibly elsewhere than last drawn."""
    last: dict[int, Any] = {}
    masks = []
    for state in states:
        o = state.outlines
        shape = np.hstack([o.corner, o.centre])
        mask = np.zeros(len(o.address), bool)
        for i, address in enumerate(o.address.tolist()):
            here = shape[o.first[i] : o.first[i + 1]]
            before = last.get(address)
            if before is None or before.shape != here.shape or abs(here - before).max() > tolerance:
                mask[i] = True
                last[address] = here
        masks.append(mask)
    return masks


def moved_blocks(states: list[State], drawn: list[Any]) -> set[int]:
    """Addresses of the blocks that are drawn more than once, or are gone in the last state."""
    seen: set[int] = set()
    moved: set[int] = set()
    for state, mask in zip(states, drawn, strict=True):
        now = set(state.outlines.address[mask].tolist())
        moved |= now & seen
        seen |= now
    return moved | (seen - set(states[-1].outlines.address.tolist()))


def draw_still_blocks(axes: Axes, o: Outlines, chosen: Any, inches: float) -> None:
    """Blocks in the colours of their materials; fixed ones hatched."""
    for material in np.unique(o.material[chosen]):
        face = ROCKS[(material - 1) % len(ROCKS)]
        here = chosen & (o.material == material)
        draw_outlines(axes, o, here & ~o.fixed, face, INK, inches)
        draw_outlines(axes, o, here & o.fixed, face, INK, inches, hatched=True)


def draw_outlines(
    axes: Axes, o: Outlines, chosen: Any, face: Any, edge: Any, inches: float, hatched: bool = False
) -> None:
    """The chosen blocks in one colour, with their centroids: as few compound paths as possible.

    The range of the axes is given: add_patch would look for that of the paths, and take longer than to draw.
    """
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Curve

    if not chosen.any():
        return
    vertices, codes, block = curves(o)
    thin = min(1.0, 0.03 * diameter(o) * inches / POINT)
    indices = np.flatnonzero(chosen)
    for start in range(0, len(indices), PIECE):
        piece = np.isin(block, indices[start : start + PIECE])
        curve = Curve(vertices[piece], codes[piece])
        if hatched:
            axes.add_artist(PathPatch(curve, facecolor=face, edgecolor=HATCH, linewidth=0.0, hatch="////"))
        axes.add_artist(
            PathPatch(curve, facecolor="none" if hatched else face, edgecolor=edge, linewidth=thin)
        )
    size = min(6.0, 0.12 * diameter(o) * inches / POINT)
    x, y = o.centroid[chosen].T
    axes.plot(x, y, "+", color=INK, markersize=size, markeredgewidth=0.6 * thin, zorder=2.5)


def diameter(o: Outlines) -> float:
    """Median over the blocks of the greater side of the bounding box, in m."""
    sides = np.maximum.reduceat(o.corner, o.first[:-1]) - np.minimum.reduceat(o.corner, o.first[:-1])
    return float(np.median(sides.max(axis=1)))


def draw_contacts(
    axes: Axes, contacts: Contacts, addresses: bool, box: tuple[float, float, float, float]
) -> None:
    """Contacts as points, forces as lines (the longest 15 % of the picture), virtual contacts dashed."""
    from matplotlib.collections import LineCollection

    real = ~contacts.virtual
    size = np.hypot(*contacts.force.T)
    longest = size.max(initial=0.0)
    if longest > 0.0:
        half = contacts.force * (FORCE_LENGTH / 2 * max(box[1] - box[0], box[3] - box[2]) / longest)
        lines = np.stack([contacts.place - half, contacts.place + half], axis=1)[real]
        axes.add_collection(
            LineCollection(list(lines), colors=FORCE, linewidths=1.2, capstyle="round", zorder=4)
        )
    dots: dict[str, Any] = {"markersize": 3, "markeredgecolor": FORCE, "markeredgewidth": 0.6, "zorder": 5}
    for loaded, face in ((size > 0.0, FORCE), (size == 0.0, "white")):
        x, y = contacts.place[real & loaded].T
        axes.plot(x, y, "o", markerfacecolor=face, **dots)
    links = list(contacts.link[contacts.virtual])
    axes.add_collection(LineCollection(links, colors=INK, linewidths=0.8, linestyles="--", zorder=4))
    if addresses:
        places = np.where(contacts.virtual[:, None], contacts.link.mean(axis=1), contacts.place)
        for place, address in zip(places, contacts.address, strict=True):
            axes.annotate(
                str(address), place, (3, 3), textcoords="offset points", fontsize=6, color=FORCE, zorder=6
            )


def draw_domains(axes: Axes, domains: tuple[Domain, ...], inches: float) -> None:
    """Domains, tinted, and named by their addresses where there is room; the outer one has no inside."""
    from matplotlib.collections import PolyCollection

    label = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.8}
    style: dict[str, Any] = {
        "ha": "center",
        "va": "center",
        "fontsize": 6,
        "zorder": 6,
        "bbox": label,
    }
    inner = [(domain, TINTS[i % len(TINTS)]) for i, domain in enumerate(domains) if not domain.outer]
    faces, edges = [(tint, 0.35) for _, tint in inner], [tint for _, tint in inner]
    polygons = [domain.polygon for domain, _ in inner]
    axes.add_collection(
        PolyCollection(polygons, facecolors=faces, edgecolors=edges, linewidths=1.2, zorder=3)
    )
    for domain, tint in inner:
        low, high = domain.polygon.min(axis=0), domain.polygon.max(axis=0)
        if (high - low).max() * inches / POINT > LEGIBLE:
            axes.annotate(str(domain.address), tuple((low + high) / 2), color=tint, **style)


def draw_addresses(axes: Axes, o: Outlines, inches: float) -> None:
    """Addresses of blocks at their centroids, and of corners inside them, wherever there is room to read."""
    middles = np.repeat(o.centroid, np.diff(o.first), axis=0)
    room = np.maximum.reduceat(np.abs(o.corner - middles).max(axis=1), o.first[:-1]) * 2.0 * inches / POINT
    style: dict[str, Any] = {"ha": "center", "color": INK, "zorder": 6}
    for i in np.flatnonzero(room > LEGIBLE):
        above: dict[str, Any] = {
            "textcoords": "offset points",
            "va": "bottom",
            "fontsize": min(9.0, 0.2 * room[i]),
        }
        axes.annotate(str(o.address[i]), o.centroid[i], (0, 4), **above, **style)
        if room[i] > ROOMY:
            corners = o.corner_address[o.first[i] : o.first[i + 1]]
            for (x, y), address in zip(beside_corners(o, int(i)), corners, strict=True):
                axes.annotate(str(address), (x, y), va="center", fontsize=6, alpha=0.7, **style)


DPI = 150
MANY = 3000
TYPES = (".png", ".svg")


def write(figure: Figure, base: Path) -> list[Path]:
    """Write base.png and base.svg; returns both paths. Error 31 if that cannot be done.

    What has more than MANY parts of its own colour, as arrows or zones, is an image in the SVG.
    """
    for axes in figure.axes:
        for one in axes.collections:
            one.set_rasterized(max(len(one.get_paths()), np.size(one.get_offsets()) // 2) > MANY)
        for line in axes.lines:
            line.set_rasterized(np.size(line.get_xdata()) > MANY)
    paths = [base.with_name(f"{base.name}{kind}") for kind in TYPES]
    for path in paths:
        write_as(figure, path)
    return paths


def write_as(figure: Figure, path: Path) -> None:
    """Write the file `path`, as the end of its name says. Error 31 if it cannot be done."""
    from matplotlib import rc_context

    image, kind = io.BytesIO(), path.suffix[1:].lower()
    with rc_context({"svg.hashsalt": "udec"}):  # the same picture is the same file
        figure.savefig(image, format=kind, dpi=DPI, metadata={"Date": None} if kind == "svg" else None)
    put_in_place(path, image.getvalue(), force=False)


def picture_path(name: str | Path) -> Path:
    """The path of a picture that is to be written. ValueError unless it ends as the type of one does."""
    path = Path(name)
    if path.suffix.lower() not in TYPES:
        raise ValueError(f"{printable(str(name))}: the name of a picture ends in {' or '.join(TYPES)}")
    return path
