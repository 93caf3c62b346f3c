"""Invariant 7: the outlines of the blocks, and what holds for each alone.

All is computed in 64 bits; what the heap says may differ by as much as its own reals can.
"""

from __future__ import annotations

import numpy as np

from udec_ia.checker.block_members import zoned
from udec_ia.checker.checked_state import State
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.kernels.audit.outline_arrays import (
    Outlines,
    fill_blocks,
    fill_circles,
    measure,
    short_edges,
    wrong_circles,
)
from udec_ia.reader.field_reading import INDEX, Numbers, kernel_rows

ROUNDINGS = 8.0  # of the order of the roundings that one coordinate takes part in each time it is computed
MEASURE, FILL_BLOCKS, FILL_CIRCLES, SHORT_EDGES, WRONG_CIRCLES = (
    InterpretWhenSmall(kernel, 7e4)  # blocks
    for kernel in (measure, fill_blocks, fill_circles, short_edges, wrong_circles)
)


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
    chosen = np.repeat(sound, count)
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
        corner=corners[chosen],
        owner=owner,
        before=np.where(here == first[owner], last[owner], here - 1),
        after=np.where(here == last[owner], first[owner], here + 1),
        p=p[chosen],
        c=c[chosen],
        t=np.empty((len(owner), 2)),
        z=np.empty(len(owner)),
        r=r[chosen],
        pointed=on_edge[grid_point[chosen]],
        d=state.tolerance("DTOL"),
        g=state.tolerance("GTOL"),
    )
    rounding = float(np.finfo(state.h.cr.dtype).eps) * ROUNDINGS
    cycles = 1.0 + max(state.common("MCTOT"), 0)  # each rounds anew, a block that spins steadily the same way
    MEASURE(len(block), found, rounding, float(np.sqrt(cycles) + cycles / ROUNDINGS))
    return found


def check_outlines(state: State, o: Outlines) -> None:
    """Invariant 7: areas are positive, corners are rounded as DTOL says, edges hold their roundings.

    Blocks that deform may shorten their edges until the roundings overlap by FTOL: the program ignores a
    shorter flat part. Beyond it error 14 ends the run.
    """
    if not o.d > 0:
        state.report(7, f"DTOL is {o.d}, but there are blocks")
        return
    rows, blocks = state.rows("block", o.block), len(o.block)
    area, far = extent(state, o, rows)
    for b in np.flatnonzero(~(area > 0)):
        state.report(7, f"the area of block@{o.block[b]}, clockwise, is {area[b]}: not positive")
    for k, length, room in kernel_rows(SHORT_EDGES, blocks, 3, o, state.tolerance("FTOL"), of=float).tolist():
        i = int(k)
        edge = f"from corner@{o.corner[o.before[i]]} to corner@{o.corner[i]} of block@{o.block[o.owner[i]]}"
        state.report(7, f"the edge {edge} is {length} long, too short for its roundings, which take {room}")
    for k, x, y, radius in kernel_rows(WRONG_CIRCLES, blocks, 4, o, of=float).tolist():
        i = int(k)
        text = f"corner@{o.corner[i]} of block@{o.block[o.owner[i]]} has KXCP {o.c[i, 0]}, KYCP {o.c[i, 1]}"
        state.report(7, f"{text}, KRAD {o.r[i]}, but its edges ask for {x}, {y}, {radius}")
    _check_inertia(state, o, rows, area, far)
    reach = state.column("block", "KBRO")[rows]
    for b in np.flatnonzero(np.abs(far - reach) > 2 * o.slack):
        text = f"KBRO of block@{o.block[b]} is {reach[b]}"
        state.report(7, f"{text}, but a corner is {far[b]} from the centroid")


def _check_inertia(state: State, o: Outlines, rows: Numbers, area: Numbers, far: Numbers) -> None:
    """Mass and moment of inertia of a block without zones are those of one density, whatever it is."""
    centroid = np.column_stack([state.column("block", name)[rows] for name in ("KX", "KY")])
    here = o.p - centroid[o.owner]
    last = here[o.before]
    cross = here[:, 0] * last[:, 1] - here[:, 1] * last[:, 0]  # clockwise: positive
    second = np.add.reduceat(cross * (here**2 + here * last + last**2).sum(axis=1), o.first) / 12
    off = np.add.reduceat(cross[:, None] * (here + last), o.first) / (6 * area[:, None])
    second -= area * (off**2).sum(axis=1)
    mass, inertia = (state.column("block", name)[rows] for name in ("KBM", "KBI"))
    due = mass * second / area
    share = 1e-3 + 20 * o.slack * far / area
    wrong = np.abs(inertia - due) > share * np.maximum(inertia, due)
    for b in np.flatnonzero(wrong & (area > 0) & ~np.isin(o.block, zoned(state))):
        text = f"KBI of block@{o.block[b]} is {inertia[b]}, but with the mass {mass[b]} (KBM)"
        state.report(7, f"{text} its outline has the moment of inertia {due[b]}")


def extent(state: State, o: Outlines, rows: Numbers) -> tuple[Numbers, Numbers]:
    """Area of each block, and distance of its farthest corner from the centroid. rows: of the blocks."""
    area, far = np.empty(len(rows)), np.empty(len(rows))
    centroid = np.column_stack([state.column("block", name)[rows] for name in ("KX", "KY")])
    FILL_BLOCKS(len(rows), o, centroid, area, far)
    return area, far


def circles(o: Outlines) -> tuple[Numbers, Numbers]:
    """Centre and radius of the circle that each corner's edges ask for."""
    centre, radius = np.empty_like(o.p), np.empty_like(o.r)
    FILL_CIRCLES(len(o.block), o, centre, radius)
    return centre, radius
