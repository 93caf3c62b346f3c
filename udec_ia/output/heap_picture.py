"""The heap beside the rock, in the same colours: what a block, a corner or a contact is in both.

The heap is read as a page, from left to right and down; each stretch of words has the colour of the kind of
group with the largest share of it. Of a damaged heap the blocks that hang together are drawn, and no domains.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.checker import check_links
from udec_ia.heap.accessors import iget
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.memory_use import FINE, cover, stretch
from udec_ia.layout import offsets as g
from udec_ia.output.block_drawing import (
    INK,
    POINT,
    diameter,
    draw_outlines,
    limits,
    paper,
    picture_path,
    scale_for,
    style_frame,
    title,
    write_as,
)
from udec_ia.output.drawn_outlines import Outlines, State, apex, domain_polygons, outlines, reals
from udec_ia.printable_text import counted
from udec_ia.reader.kind_colours import COLOURS
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import KINDS, NAMES, Atlas

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PAGE = (3.6, 4.4)  # inches of the heap, width and height
CELLS = 180 * 220  # stretches that it shows, at most
GAP = 0.95  # inches between blocks and heap
KEY, BELOW = 0.6, 0.55  # inches for the key to the colours, and from the blocks down to it
MANY = 3000  # domains beyond which they are not drawn: they could not be seen
PALE = "55"  # opacity of areas
FAR = 100.0  # times the median distance of corners from their middle: nothing sound is further away
BEYOND = 1e30  # m: no arc is there


def draw(array: MainArray, out: str | Path, name: str = "") -> Listing:
    """Draw heap and blocks to the file `out`, PNG or SVG. name: title.

    ValueError for another kind of file, error 31 if it cannot be written.
    """
    path = picture_path(out)
    write_as(figure(array, name), path)
    return Listing([f"wrote {path}"])


def figure(array: MainArray, name: str) -> Figure:
    """The picture: blocks on the left, the heap on the right, a key to the colours below."""
    atlas = Atlas(array.h)
    o, left_out = outlines_left(atlas)
    box = limits([State(0, 0.0, o)])
    inches = scale_for(box, 0.0)
    height = (box[3] - box[2]) * inches
    below = KEY + max(PAGE[1] - height, 0.0)
    picture, axes = paper(box, inches, GAP + PAGE[0], below)
    title(axes, name)
    sound = not check_links(array)
    _rock(axes, atlas, o, sound, inches)
    page = _page_axes(picture, axes, max(PAGE[1], height))
    _heap(page, atlas)
    _key(picture, axes, atlas)
    if left_out or not sound:
        why = f"{counted(left_out, 'block')} left out" if left_out else "no domains are drawn"
        axes.set_title(f"damaged: {why}", loc="right", fontsize=8, color=COLOURS["not linked"])
    return picture


def _rock(axes: Axes, atlas: Atlas, o: Outlines, sound: bool, inches: float) -> None:
    """Domains, blocks, zones, and the points where corners, grid-points and contacts are."""
    from matplotlib.collections import PolyCollection

    if sound and len(atlas.groups["domain"]) <= MANY:
        inner = [domain.polygon for domain in domain_polygons(atlas.h) if not domain.outer]
        blue, thin = COLOURS["domain"], min(1.2, 0.03 * _size(o, inches))
        axes.add_collection(
            PolyCollection(inner, facecolors=blue + PALE, edgecolors=blue, linewidths=thin, zorder=2.8)
        )
    every = np.ones(len(o.address), bool)
    draw_outlines(axes, o, every, COLOURS["block"] + PALE, COLOURS["block"], inches)
    size = min(5.0, 0.1 * _size(o, inches))
    triangles = list(_triangles(atlas, o))
    axes.add_collection(
        PolyCollection(
            triangles, facecolors="none", edgecolors=COLOURS["zone"], linewidths=0.12 * size, zorder=2.6
        )
    )
    for kind, places in _dots(atlas, o):
        axes.plot(*places.T, "o", color=COLOURS[kind], markersize=size, markeredgewidth=0.0, zorder=3)


def _size(o: Outlines, inches: float) -> float:
    """The size of a block in the picture, in points."""
    return diameter(o) * inches / POINT if len(o.address) else 0.0


def _dots(atlas: Atlas, o: Outlines) -> Iterator[tuple[str, Any]]:
    """Places of corners, grid-points and contacts (n, 2) in m, as far as they are any."""
    yield "corner", apex(o.corner, o.centre, o.radius)
    for kind, kx, ky in (("gridpoint", g.KXG, g.KYG), ("contact", g.KXC, g.KYC)):
        places = reals(atlas.h, atlas.groups[kind], kx, ky)
        yield kind, places[_is_near(places, o.corner)]


def _triangles(atlas: Atlas, o: Outlines) -> Iterator[Any]:
    """The zones whose three grid-points are there, (3, 2) in m."""
    corners = [word for word in atlas.shapes["zone"] if word.field.role == "triple"]
    at = np.stack([atlas.gather(word, atlas.groups["zone"]) for word in corners], axis=-1)
    at = at[atlas.holding("gridpoint", at).all(axis=1)]
    places = reals(atlas.h, at, g.KXG, g.KYG)
    good = _is_near(places.reshape(-1, 2), o.corner).reshape(-1, 3).all(axis=1)
    yield from places[good]


def outlines_left(atlas: Atlas) -> tuple[Outlines, int]:
    """The outlines of all blocks that are whole and near, and the number of the others."""
    every = atlas.groups["block"].tolist()
    with np.errstate(all="ignore"):
        whole = outlines(atlas.h, [ib for ib in every if _is_whole(atlas, ib)])
        arcs = np.abs(np.concatenate([whole.centre, whole.radius[:, None]], axis=1)) < BEYOND
        good = _is_near(whole.corner, whole.corner) & arcs.all(axis=1)
        near = _is_near(whole.centroid, whole.corner)
        near[near] = np.logical_and.reduceat(good, whole.first[:-1])[near] if len(good) else False
        left = outlines(atlas.h, whole.address[near].tolist())
    rounding = left.rounding if 0.0 <= left.rounding < BEYOND else 0.0
    return replace(left, rounding=rounding), len(every) - len(left.address)


def _is_whole(atlas: Atlas, ib: int) -> bool:
    """True if the reverse list of a block closes, and all its corners belong to the block."""
    starts, corner = memoryview(atlas.starts), KINDS.index("corner") + 1
    first = ip = iget(atlas.h, ib, g.KP)
    seen: set[int] = set()
    while ip not in seen:
        if not 0 < ip < len(starts) or starts[ip] != corner or iget(atlas.h, ip, g.KNB) != ib:
            return False
        seen.add(ip)
        ip = iget(atlas.h, ip, g.KR)
    return ip == first and len(seen) > 2


def _is_near(places: Any, corners: Any) -> Any:
    """True for each of `places` (n, 2) in m that is finite and not far from where corners (m, 2) are."""
    finite = corners[np.isfinite(corners).all(axis=1)]
    if not len(finite):
        return np.zeros(len(places), bool)
    middle = np.median(finite, axis=0)
    reach = FAR * np.median(np.abs(finite - middle).max(axis=1))
    return np.isfinite(places).all(axis=1) & (np.abs(places - middle).max(axis=1, initial=0.0) <= reach)


def _page_axes(picture: Figure, axes: Axes, height: float) -> Axes:
    """Room for the heap on the right, its top where that of the blocks is."""
    width, whole = picture.get_size_inches()
    top = axes.get_position().y1
    return picture.add_axes(
        (1.0 - (PAGE[0] + 0.2) / width, top - height / whole, PAGE[0] / width, height / whole)
    )


def _heap(page: Axes, atlas: Atlas) -> None:
    """The words that have been in use as a page, and the addresses at which its lines begin."""
    from matplotlib.colors import ListedColormap

    step = stretch(atlas, CELLS)
    found = cover(atlas, step)
    box = page.get_window_extent()
    across = max(int(np.ceil(np.sqrt(len(found) * box.width / box.height))), 1)
    lines = max(-(-len(found) // across), 1)
    cells = np.full(across * lines, NAMES.index("unused"))
    cells[: len(found)] = found
    colours = ListedColormap([COLOURS[name] for name in NAMES])
    page.imshow(
        cells.reshape(lines, across),
        colours,
        vmin=-0.5,
        vmax=len(NAMES) - 0.5,
        aspect="auto",
        interpolation="nearest",
    )
    if step <= FINE and len(found) <= 60 * 60:
        _borders(page, (atlas.bounds[0][atlas.bounds[0] < atlas.free] - 1) // step, across, lines)
    rows = np.unique(np.linspace(0, lines - 1, min(lines, 9)).astype(int))
    page.set_yticks(rows, [str(int(row) * across * step + 1) for row in rows])
    page.set_xticks([])
    style_frame(page)
    unit = "a cell is one word" if step == 1 else f"a cell is {step} words"
    page.set_title(f"IA(), {atlas.free - 1} words in use", loc="left", fontsize=10, color=INK)
    page.set_xlabel(unit, fontsize=8, color=INK)


def _borders(page: Axes, begins: Any, across: int, lines: int) -> None:
    """White lines between the lines of the page, and before each group."""
    from matplotlib.collections import LineCollection

    row, place = np.divmod(begins, across)
    ends = [
        [(x - 0.5, y - 0.5), (x - 0.5, y + 0.5)] for x, y in zip(place.tolist(), row.tolist(), strict=True)
    ]
    rules = [[(-0.5, y - 0.5), (across - 0.5, y - 0.5)] for y in range(1, lines)]
    page.add_collection(LineCollection(ends, colors="white", linewidths=1.2))
    page.add_collection(LineCollection(rules, colors="white", linewidths=0.5))


def _key(picture: Figure, axes: Axes, atlas: Atlas) -> None:
    """Which colour is which kind, with groups and words."""
    from matplotlib.patches import Patch

    first, last, kind = atlas.bounds
    patches = []
    for number in np.unique(kind[first < atlas.free]).tolist():
        here = kind == number
        words, name = int((last[here] - first[here] + 1).sum()), NAMES[number]
        many = f"{int(here.sum())}, " if name in KINDS else ""
        patches.append(Patch(color=COLOURS[name], label=f"{name}: {many}{words} words"))
    place = axes.get_position()
    corner = (place.x0, place.y0 - BELOW / picture.get_figheight())
    style: dict[str, Any] = {
        "fontsize": 8,
        "frameon": False,
        "labelcolor": INK,
        "borderaxespad": 0.0,
        "borderpad": 0.0,
    }
    picture.legend(handles=patches, loc="upper left", bbox_to_anchor=corner, ncols=4, **style)
