"""Where a group lies in the rock, as a picture: its blocks among their neighbours, and the group marked.

A corner, a contact, a grid-point or a block is marked where it is. Other groups are where the groups are that
they lead to, such as the grid-points of a zone, or those that lead to them, such as the contacts of a domain.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.heap.accessors import Offset, getr, iget
from udec_ia.heap_tools.heap_lookup import pointers, what
from udec_ia.layout import offsets as g
from udec_ia.output.block_drawing import (
    INK,
    draw_addresses,
    draw_outlines,
    paper,
    picture_path,
    scale_for,
    title,
    write_as,
)
from udec_ia.output.drawn_outlines import Outlines, outlines
from udec_ia.reader.group_positions import homes
from udec_ia.reader.kind_colours import COLOURS
from udec_ia.reader.place_grammar import address_of
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import KINDS, Atlas, Span, called

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FAR = 100.0  # times the median distance of corners from their middle: nothing sound is further away
BEYOND = 1e30  # m: no arc is there


def outlines_left(atlas: Atlas) -> tuple[Outlines, int]:
    """The outlines of all blocks that are whole and near, and the number of the others."""
    every = atlas.groups["block"].tolist()
    with np.errstate(all="ignore"):
        whole = outlines(atlas.h, [ib for ib in every if is_whole(atlas, ib)])
        arcs = np.abs(np.concatenate([whole.centre, whole.radius[:, None]], axis=1)) < BEYOND
        good = is_near(whole.corner, whole.corner) & arcs.all(axis=1)
        near = is_near(whole.centroid, whole.corner)
        near[near] = np.logical_and.reduceat(good, whole.first[:-1])[near] if len(good) else False
    rounding = whole.rounding if 0.0 <= whole.rounding < BEYOND else 0.0
    return part(replace(whole, rounding=rounding), near), len(every) - int(near.sum())


def part(o: Outlines, chosen: Any) -> Outlines:
    """Some of the blocks: those with True in `chosen` (m,)."""
    corners = np.diff(o.first)
    of_blocks = ("centroid", "fixed", "material", "address", "kind")
    of_corners = ("corner", "centre", "radius", "corner_address")
    return replace(
        o,
        first=np.cumsum([0, *corners[chosen]]),
        **{name: getattr(o, name)[chosen] for name in of_blocks},
        **{name: getattr(o, name)[np.repeat(chosen, corners)] for name in of_corners},
    )


def is_whole(atlas: Atlas, ib: int) -> bool:
    """True if the reverse list of a block comes round, and all its corners are those of the block."""
    starts, corner = memoryview(atlas.starts), KINDS.index("corner") + 1
    first = ip = iget(atlas.h, ib, g.KP)
    seen: set[int] = set()
    while ip not in seen:
        if not 0 < ip < len(starts) or starts[ip] != corner or iget(atlas.h, ip, g.KNB) != ib:
            return False
        seen.add(ip)
        ip = iget(atlas.h, ip, g.KR)
    return ip == first and len(seen) > 2


def is_near(places: Any, corners: Any) -> Any:
    """True for each of `places` (n, 2) in m that is finite and not far from where corners (m, 2) are."""
    finite = corners[np.isfinite(corners).all(axis=1)]
    if not len(finite):
        return np.zeros(len(places), bool)
    middle = np.median(finite, axis=0)
    reach = FAR * np.median(np.abs(finite - middle).max(axis=1))
    return np.isfinite(places).all(axis=1) & (np.abs(places - middle).max(axis=1, initial=0.0) <= reach)


def points(atlas: Atlas, at: Any, kx: Offset, ky: Offset) -> Any:
    """Places (n, 2) in m of groups at some addresses."""
    return np.stack([np.asarray(getr(atlas.h, at, k), np.float64) for k in (kx, ky)], axis=-1)


POINTS = {
    "block": (g.KX, g.KY),
    "corner": (g.KXP, g.KYP),
    "contact": (g.KXC, g.KYC),
    "gridpoint": (g.KXG, g.KYG),
}
OF_ITSELF = ("member", "triple", "watched")  # roles of pointers to what is where the group is
MARGIN = 0.6  # around its blocks, as a share of their size
FACE = "#efeae0"  # of the other blocks


def draw(atlas: Atlas, place: int | str, out: str | Path) -> Listing:
    """What the word at a place is, and where its group lies drawn to the file `out`, PNG or SVG.

    place: an address, or text such as block@88. IndexError outside IA(), ValueError for no such place,
    what lies nowhere or another kind of file, error 31 if it cannot be written.
    """
    path, span, found = picture_path(out), atlas.span(address_of(atlas, place)), what(atlas, place)
    o, _ = outlines_left(atlas)
    own = np.isin(o.address, homes(atlas, span))
    if not own.any():
        raise ValueError(f"{called(atlas, span)} lies in no block that can be drawn")
    write_as(_figure(atlas, span, o, own), path)
    return found._replace(said=[*found.said, f"wrote {path}"])


def _figure(atlas: Atlas, span: Span, o: Outlines, own: Any) -> Figure:
    """The blocks `own`, the groups that mark the place, and what is around them."""
    places = spots(atlas, span)
    places = places[is_near(places, o.corner)]
    box = _around(np.concatenate([o.corner[np.repeat(own, np.diff(o.first))], places]))
    inches = scale_for(box, 0.0)
    inside = _reaching(o, box)
    o, own = part(o, inside), own[inside]
    figure, axes = paper(box, inches)
    title(axes, called(atlas, span))
    draw_outlines(axes, o, ~own, FACE, INK, inches)
    draw_outlines(axes, o, own, COLOURS["block"] + "55", COLOURS["block"], inches)
    draw_addresses(axes, o, inches)
    colour = COLOURS[span.kind]
    if len(places) > 2 and span.kind != "domain":
        axes.fill(*places.T, facecolor=colour + "55", edgecolor=colour, zorder=3)
    ring: dict[str, Any] = {
        "markersize": 13,
        "markerfacecolor": "none",
        "markeredgecolor": colour,
        "markeredgewidth": 2,
    }
    axes.plot(*places.T, "o", zorder=7, **ring)
    return figure


def _around(places: Any) -> tuple[float, float, float, float]:
    """x and y range of some places, and a margin."""
    low, high = places.min(axis=0), places.max(axis=0)
    size = MARGIN * float(max(high - low)) or 0.5
    return float(low[0] - size), float(high[0] + size), float(low[1] - size), float(high[1] + size)


def _reaching(o: Outlines, box: tuple[float, float, float, float]) -> Any:
    """True for each block with a part in a range."""
    low, high = np.minimum.reduceat(o.corner, o.first[:-1]), np.maximum.reduceat(o.corner, o.first[:-1])
    x1, x2, y1, y2 = box
    return (high[:, 0] > x1) & (low[:, 0] < x2) & (high[:, 1] > y1) & (low[:, 1] < y2)


def spots(atlas: Atlas, span: Span) -> Any:
    """Places (n, 2) in m where a group is, or the groups are that it leads to or that lead to it."""
    at = [span.first]
    if span.kind not in POINTS:
        words = [word for word in atlas.words(span) if word.field.role in OF_ITSELF]
        at = [int(atlas.value(word)) for word in words]
        if span.kind == "domain":
            loops = [one for one in pointers(atlas) if one.word is not None and one.word.field.role == "loop"]
            at += [int(iad) for one in loops for iad in one.at[one.to == span.first]]
    found = [np.zeros((0, 2))]
    for iad in dict.fromkeys(at):
        kind = KINDS[atlas.starts[iad] - 1] if atlas.holds("any", iad) else ""
        if kind in POINTS:
            found.append(points(atlas, np.array([iad]), *POINTS[kind]))
    return np.concatenate(found)
