"""Invariant 4: what hangs on a virtual contact lies in the domain in which it hangs.

Without the virtual contacts the boundary of a domain falls apart into loops, one for each piece: either all
are outlines of pieces side by side, or one is the wall around a space with the others in it. So every piece
lies inside the wall and outside the outlines of all others, which winding numbers prove.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_map import SIDES
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.kernels.audit.outline_arrays import Outlines, rounded
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import Numbers

ROUNDED = InterpretWhenSmall(rounded, 2e5)  # corners


def check_pieces(state: State, o: Outlines) -> None:
    """Invariant 4, for the pieces that virtual contacts tie."""
    virtual = np.flatnonzero(state.column("contact", "KCCOD") == g.VIRTUAL)
    if not len(virtual) or len(o.block) < len(state.address["block"]):
        return
    rings = state.rings
    corner = np.full(len(rings.item), -1)  # of each item, among those of the outlines
    corner[~rings.contact] = np.arange(len(o.corner))
    for domain, loops in _loops(state, virtual).items():
        hosts = np.array([rings.owner[loop[0]] for loop in loops])
        end = o.first[hosts]
        middle = (o.p[end] + o.p[o.before[end]]) / 2  # of an edge of each piece: no rounding takes it away
        for k, loop in enumerate(loops):
            wall = _polygon(state, o, corner, loop)
            own = o.first[hosts[k]] + np.arange(o.count[hosts[k]])
            outline = _area(wall) < _area(_rounded(o, own).reshape(-1, 2)) / 2  # round a block, clockwise
            wrong = _turns(wall, middle) != (0 if outline else 1)
            wrong[k] = False
            for i in np.flatnonzero(wrong):
                state.report(
                    4,
                    f"block@{o.block[hosts[i]]} hangs in domain@{domain} by virtual contacts, but lies "
                    f"outside it, beyond the part of its boundary along block@{o.block[hosts[k]]}",
                )


def _loops(state: State, virtual: Numbers) -> dict[int, list[list[int]]]:
    """The loops around each domain with virtual contacts when these are left out.

    A loop is a list of items of the blocks' lists; a contact is in that of the block that is walked after it.
    """
    rings = state.rings
    left_out = rings.contact & np.isin(rings.row, virtual)
    contact, side, row = (values.data for values in (rings.contact, rings.side, rings.row))
    after, before, skipped = (values.data for values in (rings.after, rings.before, left_out))

    def following(i: int) -> int:
        i = after[i]
        while skipped[i]:
            i = after[i]
        return int(rings.at[1 - side[i], row[i]]) if contact[i] else i

    loops: dict[int, list[list[int]]] = defaultdict(list)
    seen: set[int] = set()
    for tie in np.flatnonzero(left_out).tolist():
        start = before[tie]
        while skipped[start]:
            start = before[start]
        loop, here = [], start
        while here >= 0 and here not in seen:
            seen.add(here)
            loop.append(here)
            here = following(here)
        if loop and here == start:
            loops[int(state.column("contact", SIDES[0])[row[tie]])].append(loop)
    return loops


def _polygon(state: State, o: Outlines, corner: Numbers, loop: list[int]) -> Numbers:
    """The loop as a polygon through its contacts and through the ends and middles of its arcs."""
    index = np.array(loop)
    points = _rounded(o, corner[index])  # a contact stands there three times
    contact = state.rings.contact[index]
    row = state.rings.row[index[contact]]
    for k, name in enumerate(("KXC", "KYC")):
        points[contact, :, k] = state.column("contact", name)[row][:, None]
    return np.asarray(points.reshape(-1, 2))


def _rounded(o: Outlines, corners: Numbers) -> Numbers:
    """Start, middle and end of the arcs of `corners` (n x 3 x 2)."""
    points = np.empty((len(corners), 3, 2))
    ROUNDED(len(corners), o, corners, points)
    return points


def _area(polygon: Numbers) -> float:
    """Area that a polygon runs around anticlockwise."""
    from_first = polygon - polygon[0]
    return float(_cross(from_first, np.roll(from_first, -1, axis=0)).sum() / 2)


def _turns(polygon: Numbers, points: Numbers) -> Numbers:
    """How often the polygon winds around each of the points, anticlockwise."""
    turns = np.zeros(len(points), int)
    in_box = ((points > polygon.min(axis=0)) & (points < polygon.max(axis=0))).all(axis=1)
    for i in np.flatnonzero(in_box):
        a = polygon - points[i]
        b = np.roll(a, -1, axis=0)
        up, down = (a[:, 1] <= 0) & (b[:, 1] > 0), (a[:, 1] > 0) & (b[:, 1] <= 0)
        left = _cross(a, b) > 0
        turns[i] = np.count_nonzero(up & left) - np.count_nonzero(down & ~left)
    return turns


def _cross(a: Numbers, b: Numbers) -> Numbers:
    """Vector products of two arrays of plane vectors."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
