"""Invariant 7: the outlines of the blocks, taken apart once, and what holds for each alone.

All is computed in 64 bits; what the heap says may differ by as much as its own reals can.
"""

from __future__ import annotations

import numpy as np

from udec_ia.heap.interpreting import Sparing
from udec_ia.inspect.check.groups import State
from udec_ia.inspect.reading import INDEX, Numbers
from udec_ia.kernels.audit.outlines import Outlines, fill_circles, measure

ROUNDINGS = 8.0  # of the order of the roundings that one coordinate takes part in each time it is computed
MEASURE, CIRCLES = Sparing(measure, 7000), Sparing(fill_circles, 7000)  # blocks, in 0.1 s


def dot(a: Numbers, b: Numbers) -> Numbers:
    """Scalar products of two arrays of plane vectors."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1])


def length(a: Numbers) -> Numbers:
    """Lengths of plane vectors. Their squares are numbers: `outlines` sees to that."""
    return np.asarray(np.sqrt(dot(a, a)))


def cross(a: Numbers, b: Numbers) -> Numbers:
    """Vector products of two arrays of plane vectors."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def outlines(state: State) -> Outlines | None:
    """The outlines of the blocks with closed lists and finite coordinates; None if there are none."""
    rings = state.rings
    corners = rings.item[~rings.contact]
    if not len(corners):
        return None
    rows = rings.row[~rings.contact]

    def column(*fields: str) -> Numbers:
        return np.stack([state.column("corner", name)[rows] for name in fields], axis=1)

    p, c, r = column("KXP", "KYP"), column("KXCP", "KYCP"), state.column("corner", "KRAD")[rows]
    usable = (np.abs(np.column_stack((p, c, r))) < np.sqrt(np.finfo(state.h.cr.dtype).max)).all(axis=1)
    count = np.add.reduceat(~rings.contact, rings.first, dtype=INDEX)
    sound = np.logical_and.reduceat(usable, np.cumsum(count) - count) & (count > 2)
    if not sound.any():
        return None
    kept = np.repeat(sound, count)
    on_edge = np.append(state.column("gridpoint", "KGEDGE"), 0) == 1  # one more, for row -1
    grid_point = state.rows("gridpoint", state.column("corner", "KGP")[rows])
    block, count = rings.block[sound], count[sound]
    first = np.cumsum(count, dtype=INDEX) - count
    owner = np.repeat(np.arange(len(block), dtype=INDEX), count)
    here = np.arange(len(owner), dtype=INDEX)
    last = first + count - 1
    found = Outlines(
        block=block,
        first=first,
        count=count,
        low=np.empty((len(block), 2)),
        high=np.empty((len(block), 2)),
        fine=np.empty(len(block)),
        slack=np.empty(len(block)),
        corner=corners[kept],
        owner=owner,
        before=np.where(here == first[owner], last[owner], here - 1),
        after=np.where(here == last[owner], first[owner], here + 1),
        p=p[kept],
        c=c[kept],
        t=np.empty((len(owner), 2)),
        z=np.empty(len(owner)),
        r=r[kept],
        pointed=on_edge[grid_point[kept]],
        d=state.tolerance("DTOL"),
        g=state.tolerance("GTOL"),
    )
    rounding = float(np.finfo(state.h.cr.dtype).eps) * ROUNDINGS
    cycles = 1.0 + max(
        state.common("MCTOT"), 0
    )  # each rounds anew; the same way where a block spins steadily
    MEASURE(len(block), found, rounding, float(np.sqrt(cycles) + cycles / ROUNDINGS))
    return found


def check_outlines(state: State, o: Outlines) -> None:
    """Invariant 7: areas are positive, corners are rounded as DTOL says, edges hold their roundings.

    Blocks that deform may shorten their edges until the roundings overlap by FTOL: a flat part shorter than
    that is none to the program. Beyond it error 14 ends the run.
    """
    if not o.d > 0:
        state.report(7, f"DTOL is {o.d}, but there are blocks")
        return
    from_first = o.p - o.p.take(o.first[o.owner], 0)
    area = np.add.reduceat(cross(from_first, from_first[o.before]), o.first) / 2
    for i in np.flatnonzero(~(area > 0)):
        state.report(
            7, f"the area inside the corners of block@{o.block[i]}, clockwise, is {area[i]}: not positive"
        )
    rows = state.rows("block", o.block)
    roundings = 2.0 - o.pointed - o.pointed[o.before]
    room, shortest = roundings * o.d, roundings * (o.d - state.tolerance("FTOL") / 2)
    for i in np.flatnonzero(~(o.z >= shortest - 2 * o.slack[o.owner])):
        state.report(
            7,
            f"the edge from corner@{o.corner[o.before[i]]} to corner@{o.corner[i]} "
            f"of block@{o.block[o.owner[i]]} is {o.z[i]} long, "
            f"too short for its roundings, which take {room[i]}",
        )
    _check_circles(state, o)
    centroid = np.stack((state.column("block", "KX")[rows], state.column("block", "KY")[rows]), axis=1)
    far = reaches(o, centroid)
    noted = state.column("block", "KBRO")[rows]
    for i in np.flatnonzero(np.abs(far - noted) > 2 * o.slack):
        state.report(
            7, f"KBRO of block@{o.block[i]} is {noted[i]}, but a corner is {far[i]} from the centroid"
        )


def circles(o: Outlines) -> tuple[Numbers, Numbers, Numbers]:
    """Centre and radius of the circle that each corner's edges ask for; where it may as well have none."""
    centre, radius, border = np.empty_like(o.p), np.empty_like(o.r), np.empty_like(o.pointed)
    CIRCLES(len(o.block), o, centre, radius, border)
    return centre, radius, border


def reaches(o: Outlines, centroid: Numbers) -> Numbers:
    """Distance of the farthest corner of each block from its centroid."""
    return np.asarray(np.maximum.reduceat(length(o.p - centroid.take(o.owner, 0)), o.first))


def _check_circles(state: State, o: Outlines) -> None:
    """Centre and radius against those that the edges ask for.

    An edge is at least 2 D long, so an error s in its ends turns it by s/D and changes the radius by
    (1 + (R/D)^2)/2 times as much.
    """
    centre, radius, border = circles(o)
    slack = o.slack[o.owner] * (1 + (radius / o.d) ** 2)
    wrong = (np.abs(o.r - radius) > slack) | (np.abs(o.c - centre).max(axis=1) > slack)
    for i in np.flatnonzero(wrong & ~border):
        state.report(
            7,
            f"corner@{o.corner[i]} of block@{o.block[o.owner[i]]} has KXCP {o.c[i, 0]}, KYCP {o.c[i, 1]}, "
            f"KRAD {o.r[i]}, but its edges ask for {centre[i, 0]}, {centre[i, 1]}, {radius[i]}",
        )
