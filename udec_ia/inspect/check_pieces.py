"""Invariant 4: what hangs on a virtual contact hangs in the domain in which it lies.

Virtual contacts tie blocks that have parted. Without them the boundary of a domain falls apart into several
loops, one for each piece: either all are outlines of pieces that lie side by side, or one is the wall around
a space and the others are outlines of pieces in it. So every piece lies inside the wall and outside the
outlines of all others: the wall winds once around any point of it, and an outline not at all.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from udec_ia.inspect.check_geometry import Outlines, cross
from udec_ia.inspect.check_groups import Numbers, State
from udec_ia.inspect.check_map import SIDES
from udec_ia.kernels.touch import VIRTUAL

Step = tuple[int, int]  # a corner or a real contact, and the block that is walked after it


def check_pieces(state: State, o: Outlines) -> None:
    """Invariant 4, for the pieces that virtual contacts tie."""
    virtual = state.address["contact"][state.column("contact", "KCCOD") == VIRTUAL]
    if not len(virtual) or len(o.block) < len(state.address["block"]):
        return
    index = {corner: k for k, corner in enumerate(o.corner.tolist())}
    owner = {block: k for k, block in enumerate(o.block.tolist())}
    for domain, loops in _loops(state, set(virtual.tolist())).items():
        hosts = np.array([owner[loop[0][1]] for loop in loops])
        end = o.first[hosts]
        middle = (o.p[end] + o.p[o.before[end]]) / 2  # of an edge of each piece: no rounding takes it away
        for k, loop in enumerate(loops):
            wall = _polygon(state, o, index, loop)
            own = np.flatnonzero(o.owner == hosts[k])
            outline = _area(wall) < -_area(o.p[own[::-1]]) / 2  # at least once round a block, clockwise
            wrong = _turns(wall, middle) != (0 if outline else 1)
            wrong[k] = False
            for i in np.flatnonzero(wrong):
                state.report(
                    4,
                    f"block@{o.block[hosts[i]]} hangs in domain@{domain}, but lies on the other side of the "
                    f"part of its boundary that runs along block@{o.block[hosts[k]]}",
                )


def _loops(state: State, virtual: set[int]) -> dict[int, list[list[Step]]]:
    """The loops around each domain with virtual contacts when these are left out."""
    following: dict[Step, Step] = {}
    hanging: dict[Step, int] = {}  # the domain of a virtual contact that stands after the step
    for block, ring in state.rings.items():
        last = [iad for iad in ring if iad not in virtual][-1]
        for iad in ring:
            if iad in virtual:
                hanging[last, block] = state.get(iad, SIDES[0])
                continue
            one, two = state.hosts(iad) if state.is_contact[iad] else (block, block)
            following[last, block] = (iad, two if one == block else one)
            last = iad
    loops: dict[int, list[list[Step]]] = defaultdict(list)
    seen: set[Step] = set()
    for start, domain in hanging.items():
        loop, here = [], start
        while here in following and here not in seen:
            seen.add(here)
            loop.append(here)
            here = following[here]
        if loop and here == start:
            loops[domain].append(loop)
    return loops


def _polygon(state: State, o: Outlines, index: dict[int, int], loop: list[Step]) -> Numbers:
    """The loop as a polygon through its contacts and both ends of its arcs."""
    points = []
    for iad, _ in loop:
        if state.is_contact[iad]:
            row = state.rows("contact", np.array([iad]))
            points.append([state.column("contact", name)[row[0]] for name in ("KXC", "KYC")])
        else:
            k = index[iad]
            reach = o.d if o.r[k] > 0 else 0.0
            points += [o.p[k] - reach * o.t[k], o.p[k] + reach * o.t[o.after[k]]]
    return np.array(points)


def _area(polygon: Numbers) -> float:
    """Area that a polygon runs around anticlockwise."""
    from_first = polygon - polygon[0]
    return float(cross(from_first, np.roll(from_first, -1, axis=0)).sum() / 2)


def _turns(polygon: Numbers, points: Numbers) -> Numbers:
    """How often the polygon winds around each of the points, anticlockwise."""
    turns = np.zeros(len(points), int)
    in_box = ((points > polygon.min(axis=0)) & (points < polygon.max(axis=0))).all(axis=1)
    for i in np.flatnonzero(in_box):
        a = polygon - points[i]
        b = np.roll(a, -1, axis=0)
        up, down = (a[:, 1] <= 0) & (b[:, 1] > 0), (a[:, 1] > 0) & (b[:, 1] <= 0)
        left = cross(a, b) > 0
        turns[i] = np.count_nonzero(up & left) - np.count_nonzero(down & ~left)
    return turns
