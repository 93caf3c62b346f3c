"""Cut of one block along a polyline from one point of its outline to another.

The ends of the polyline lie on the outline, at a corner or on an edge, to within some roundings of the
coordinates; between them it runs inside the block. Where SPLIT would refuse a line, the polyline is refused.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, real
from udec_ia.heap.find_lose import room
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.kernels.split.line_crossing import AT, CORNER, GRAZING, X, Y
from udec_ia.kernels.split.split import (
    DONE,
    NO_MEMORY,
    REFUSED_CLOSE,
    REFUSED_SHORT,
    cut_block,
    update_after_cuts,
    words_of_cut,
)
from udec_ia.layout import offsets as g

NOT_ON_OUTLINE = 5


@kernel
def _place_end(h: Memory, ib: int, x: float, y: float, slack: float) -> tuple[int, int, float, float]:
    """The corner of block `ib` at (x, y) and 1, or the corner that ends the edge there and 0; and its place.

    The place on an edge is exactly on it, so that contacts along the edge stay where they are. Returns 0 and
    0 if the point is farther than `slack` from the outline.
    """
    edge, ip0, px, py = int64(0), iget(h, ib, g.KP), x, y
    ip = ip0
    while True:
        ia = iget(h, ip, g.KR)
        vx, vy = x - getr(h, ip, g.KXP), y - getr(h, ip, g.KYP)
        if abs(vx) <= slack and abs(vy) <= slack:
            return ip, 1, getr(h, ip, g.KXP), getr(h, ip, g.KYP)
        ux, uy = getr(h, ip, g.KXP) - getr(h, ia, g.KXP), getr(h, ip, g.KYP) - getr(h, ia, g.KYP)
        z = np.sqrt(ux * ux + uy * uy)
        along = -(vx * ux + vy * uy) / z
        if abs(vx * uy - vy * ux) <= slack * z and along > 0 and along < z:
            edge = ip
            part = along / z
            px, py = getr(h, ip, g.KXP) - ux * part, getr(h, ip, g.KYP) - uy * part
        ip = ia
        if ip == ip0:
            return edge, 0, px, py


@kernel
def _angle_fits(h: Memory, ip: int, iq: int, dx: float, dy: float) -> bool:
    """True unless the direction (dx, dy) runs almost along the edge from corner `ip` to `iq`."""
    ux, uy = getr(h, iq, g.KXP) - getr(h, ip, g.KXP), getr(h, iq, g.KYP) - getr(h, ip, g.KYP)
    sine, cosine = ux * dy - uy * dx, ux * dx + uy * dy
    size = np.sqrt((ux * ux + uy * uy) * (dx * dx + dy * dy))
    return abs(sine) >= size * real(h, GRAZING) or cosine < 0


@kernel
def _end_fits(
    h: Memory, ib: int, which: Any, x: float, y: float, dx: float, dy: float, shortest: float
) -> int:
    """DONE if a cut in the direction (dx, dy) can begin at (x, y), or why it cannot."""
    ip = which[CORNER]
    ia = iget(h, ip, g.KR)
    if which[AT] == 1:
        iq = next_corner(h, ib, ip)
        fits = _angle_fits(h, ip, ia, dx, dy) and _angle_fits(h, ip, iq, dx, dy)
        return DONE if fits else REFUSED_CLOSE
    for iend in (ia, ip):
        vx, vy = x - getr(h, iend, g.KXP), y - getr(h, iend, g.KYP)
        if np.sqrt(vx * vx + vy * vy) < shortest:
            return REFUSED_SHORT
    fits = _angle_fits(h, ia, ip, dx, dy) and _angle_fits(h, ip, ia, dx, dy)
    return DONE if fits else REFUSED_CLOSE


@kernel
def _bends_fit(h: Memory, points: Any, shortest: float) -> int:
    """Row of the first of the `points` that is near the next one or turns too sharply; -1 for none."""
    for i in range(len(points) - 1):
        ux, uy = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
        if np.sqrt(ux * ux + uy * uy) < shortest:
            return i
        if i > 0:
            vx, vy = points[i - 1, 0] - points[i, 0], points[i - 1, 1] - points[i, 1]
            size = np.sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy))
            if ux * vx + uy * vy > 0 and abs(ux * vy - uy * vx) < size * real(h, GRAZING):
                return i
    return -1


@kernel
def place_cut(
    h: Memory, ib: int, points: Any, slack: float, shortest: float, where: Any, which: Any
) -> tuple[int, int]:
    """Test a cut of block `ib` along a polyline; returns the status and the row refused.

    points, slack, shortest: of cut_along. where, which: (2, 3) and (2, 2); they get the places of both ends
    (line_crossing).
    """
    n = len(points)
    row = _bends_fit(h, points, shortest)
    if row >= 0:
        return REFUSED_SHORT, row
    for k in range(2):
        end, after = (0, 1) if k == 0 else (n - 1, n - 2)
        ip, at, x, y = _place_end(h, ib, points[end, 0], points[end, 1], slack)
        if ip == 0:
            return NOT_ON_OUTLINE, end
        which[k, CORNER], which[k, AT] = ip, at
        where[k, X], where[k, Y] = x, y
        dx, dy = points[after, 0] - x, points[after, 1] - y
        status = _end_fits(h, ib, which[k], x, y, dx, dy, shortest)
        if status != DONE:
            return status, end
    return DONE, 0


@kernel
def cut_along(
    h: Memory, ib: int, points: Any, joints: Any, slack: float, shortest: float, passes: Any
) -> tuple[int, int]:
    """Split block `ib` along a polyline; returns the status and the block to the left, or the row refused.

    points: (n, 2), both ends included; these are moved to the outline, by less than `slack`.
    joints: (n - 1,) numbers of joints, 0 for none. slack, shortest: as of a line of SPLIT. passes: of
    split.cutting. Nothing is changed if the status is neither DONE nor NO_MEMORY with a block.
    """
    n = len(points)
    where, which = np.empty((2, 3), points.dtype), np.empty((2, 2), np.int64)
    status, row = place_cut(h, ib, points, slack, shortest, where, which)
    if status != DONE:
        return status, row
    if not room(h, words_of_cut(h, n - 2) + h.ci[g.NSPARE]):
        return NO_MEMORY, 0
    rounding_length = h.cr[g.DTOL]
    blocks = np.empty(1, np.int64)
    blocks[0] = cut_block(h, ib, where, which, 0, points[1 : n - 1], joints, passes)
    ip = iget(h, blocks[0], g.KP)  # the end of the crack in the new block
    left = blocks[0] if getr(h, ip, g.KXP) == where[0, X] and getr(h, ip, g.KYP) == where[0, Y] else int64(ib)
    updated = update_after_cuts(h, blocks, 0, 1, rounding_length, passes)
    return (DONE if updated else NO_MEMORY), left
