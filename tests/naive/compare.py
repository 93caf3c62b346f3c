"""The contacts of a heap against those that the rounded outlines ask for, all pairs of blocks tried.

Asked for is a contact at every place where two outlines touch or overlap and an arc faces what it touches.
The heap has it with the very same two segments, or has another contact of the same two blocks so near that
the two count as one (FTOL), or that is still on its way over a corner (nearer than the rounding length).
"""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np
from shapely.geometry import Point

from naive.contacts import Contact, Corner, Outline, common_area, contacts, round_corners, rounded_polygon

Pair = tuple[int, int]
NEARNESS = 0.55  # BTOL: a contact that is farther away is broken; it stands in the middle of its gap
HALF_ARC_CHORD = 1e-3  # relative area that may be lost between an arc and its 64 chords


def _faces(arc: Corner, ux: float, uy: float) -> bool:
    """True if the direction (ux, uy) from the centre passes through the arc."""
    ahead = ux * arc.arrives[0] + uy * arc.arrives[1]
    behind = ux * arc.leaves[0] + uy * arc.leaves[1]
    return ahead >= 0 and behind <= 0


def asked_for(outlines: dict[int, Outline], d: float, least: float) -> list[Contact]:
    """The contacts that overlap by at least `least` and whose arcs face what they touch."""
    rounded = {name: round_corners(outline, d) for name, outline in outlines.items()}
    found = []
    for contact in contacts(outlines, d, gap=-least):
        if True in contact.on_edge:
            k = contact.on_edge.index(False)
            arc = rounded[contact.blocks[k]][contact.part[k]]
            edge = rounded[contact.blocks[1 - k]][contact.part[1 - k]].arrives
            if not _faces(arc, edge[1], -edge[0]):
                continue
        found.append(contact)
    return found


def _near(outlines: dict[int, Outline], d: float) -> list[dict[int, Outline]]:
    """The pairs of blocks whose boxes come nearer than d."""
    boxes = {name: (np.min(points, axis=0), np.max(points, axis=0)) for name, points in outlines.items()}
    names = sorted(boxes)
    return [
        {one: outlines[one], two: outlines[two]}
        for i, one in enumerate(names)
        for two in names[i + 1 :]
        if (boxes[one][0] <= boxes[two][1] + d).all() and (boxes[two][0] <= boxes[one][1] + d).all()
    ]


def disagreements(outlines: dict[int, Outline], rows: Any, d: float, slack: float) -> list[str]:
    """What is wrong with the contacts of the heap.

    outlines: corners of every block, clockwise, by address. rows: the table of contacts. d: rounding length.
    slack: rounding error of a coordinate.
    """
    real = rows[rows["KCCOD"] < 4]
    places: dict[Pair, list[tuple[float, float]]] = {}
    for one, two, x, y in zip(*(real[name].tolist() for name in ("KB1", "KB2", "KXC", "KYC")), strict=True):
        places.setdefault((min(one, two), max(one, two)), []).append((x, y))
    wrong = []
    for pair in _near(outlines, d):
        key = min(pair), max(pair)
        have = places.get(key, [])
        for contact in asked_for(pair, d, slack):
            x, y = contact.point
            if not any(hypot(x - u, y - v) <= d for u, v in have):
                wrong.append(
                    f"blocks {key} overlap by {contact.overlap} at {contact.point}, no contact there"
                )
        if not have:
            area = common_area(pair[key[0]], pair[key[1]], d)
            if area > HALF_ARC_CHORD * d * d:
                wrong.append(f"blocks {key} share the area {area}, but no contact")
    rounded = {name: rounded_polygon(outline, d).exterior for name, outline in outlines.items()}
    for one, two in places:
        for x, y in places[one, two]:
            away = max(rounded[name].distance(Point(x, y)) for name in (one, two))
            if away > NEARNESS * d:
                wrong.append(f"the contact of blocks {one, two} at ({x}, {y}) is {away} from one of them")
    return wrong
