"""Crossings of a line with a block, and the conditions for a split there.

The line is given by its start (x1, y1), its unit vector (c, s) and its length z, by the shortest edge that a
cut may leave, and by the distance from it that counts as zero, some roundings of the coordinates. This
distance is the same for all blocks, since blocks with a common corner must agree whether the line goes
through it. The crossings are ordered along the line; between the first and the second, the third and the
fourth ... the line runs inside the block. The block is split there if both ends lie within the given line: a
line that ends inside a block leaves it whole.

A cut is never moved to a near corner. A cut that would leave an edge shorter than the smallest allowed, or
that runs almost along an edge, is refused with its coordinates.

While the rounding length is not set, the smallest edge depends on the resolution of the reals only:
EDGE_DIGITS last digits of the coordinates (common.number_limits). The end of a cut is exact to a few of them,
so the length of the edge is exact to a part in a thousand, as is the area of a piece of that width. The
rounding length of such an edge, an eighth of it, is 1250 digits, and FTOL, the least length that decides
about a contact, is 62. Later the limit is two rounding lengths, which were compared with the digits when they
were set.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.layout import offsets as g

OK, TOO_CLOSE, TOO_SHORT, TOO_MANY = 0, 1, 2, 3
GRAZING = 0.01  # sine of the smallest angle between a cut and an edge
SHORTEST, SLACK = 5, 6  # columns of a line
T, X, Y = 0, 1, 2
CORNER, AT = 0, 1


@kernel
def rounding_is_open(h: Memory) -> bool:
    """True while the rounding length follows from the edges: no ROUND and no cycle yet."""
    return h.ci[g.LROUND] == 0 and h.ci[g.MCTOT] == 0


@kernel
def side(h: Memory, ip: int, line: Any) -> int:
    """-1, 0 or 1: corner `ip` lies to the right of the line, on it, or to the left."""
    d = (getr(h, ip, g.KYP) - line[1]) * line[2] - (getr(h, ip, g.KXP) - line[0]) * line[3]
    if d > line[SLACK]:
        return 1
    if d < -line[SLACK]:
        return -1
    return 0


@kernel
def is_reflex(h: Memory, ib: int, ip: int) -> bool:
    """True if the outline turns anticlockwise at corner `ip` of block `ib`."""
    ia, iq = iget(h, ip, g.KR), next_corner(h, ib, ip)
    ux, uy = getr(h, ip, g.KXP) - getr(h, ia, g.KXP), getr(h, ip, g.KYP) - getr(h, ia, g.KYP)
    vx, vy = getr(h, iq, g.KXP) - getr(h, ip, g.KXP), getr(h, iq, g.KYP) - getr(h, ip, g.KYP)
    return ux * vy - uy * vx > 0


@kernel
def _edge_crossing(h: Memory, ip: int, line: Any) -> tuple[float, float, float]:
    """Crossing of the line with the edge that ends at `ip`: distance along the line, x and y.

    The edge is taken from the end with the smaller coordinates, so that two blocks with a common edge get the
    same point.
    """
    ia = iget(h, ip, g.KR)
    ax, ay, bx, by = getr(h, ia, g.KXP), getr(h, ia, g.KYP), getr(h, ip, g.KXP), getr(h, ip, g.KYP)
    if bx < ax or (bx == ax and by < ay):
        ax, ay, bx, by = bx, by, ax, ay
    da = (ay - line[1]) * line[2] - (ax - line[0]) * line[3]
    db = (by - line[1]) * line[2] - (bx - line[0]) * line[3]
    part = da / (da - db)
    x, y = ax + (bx - ax) * part, ay + (by - ay) * part
    return (x - line[0]) * line[2] + (y - line[1]) * line[3], x, y


@kernel
def _corner_crosses(h: Memory, ib: int, ip: int, line: Any) -> int:
    """For corner `ip` on the line: 1 if the line enters or leaves the block here.

    0 if it does not, -1 if it touches a reflex corner from inside. Where an edge along the line begins or
    ends, the line leaves the inside of the block if that is on both sides of it: at a reflex corner.
    """
    ia, iq = iget(h, ip, g.KR), next_corner(h, ib, ip)
    before, after = side(h, ia, line), side(h, iq, line)
    if before != 0 and after != 0:
        if before != after:
            return 1
        return -1 if is_reflex(h, ib, ip) else 0
    if before == 0 and after == 0:
        return 0  # a flat corner on an edge along the line
    start, end = (ia, ip) if before == 0 else (ip, iq)
    ux, uy = getr(h, end, g.KXP) - getr(h, start, g.KXP), getr(h, end, g.KYP) - getr(h, start, g.KYP)
    forwards = ux * line[2] + uy * line[3] > 0  # the inside of the block is to the right of its edge
    return 1 if (before + after > 0) == forwards else 0


@kernel
def crossings(h: Memory, ib: int, line: Any, where: Any, which: Any) -> int:
    """Crossings of the outline of block `ib` with the line, in order along the line.

    where: rows (distance along the line, x, y). which: rows (corner, 1 at that corner or 0 on the edge
    that ends at it). Returns their number, -1 if the block cannot be treated (the place is in row 0), or
    -2 if there are more of them than rows.
    """
    ip0 = iget(h, ib, g.KP)
    n = 0
    ip = ip0
    while True:
        here, before = side(h, ip, line), side(h, iget(h, ip, g.KR), line)
        at = here == 0
        hit = here * before < 0
        if at:
            what = _corner_crosses(h, ib, ip, line)
            x, y = getr(h, ip, g.KXP), getr(h, ip, g.KYP)
            if what < 0:
                where[0, X], where[0, Y] = x, y
                return -1
            hit = what == 1
            t = (x - line[0]) * line[2] + (y - line[1]) * line[3]
        elif hit:
            t, x, y = _edge_crossing(h, ip, line)
        if hit:
            if n == len(where):
                return -2
            k = n
            while k > 0 and where[k - 1, T] > t:
                for column in range(3):
                    where[k, column] = where[k - 1, column]
                for column in range(2):
                    which[k, column] = which[k - 1, column]
                k -= 1
            where[k, T], where[k, X], where[k, Y] = t, x, y
            which[k, CORNER], which[k, AT] = ip, 1 if at else 0
            n += 1
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            return n


@kernel
def is_cut(line: Any, where: Any, k: int) -> bool:
    """True if crossings `k` and `k` + 1 both lie within the line."""
    return where[k, T] >= -line[SLACK] and where[k + 1, T] <= line[4] + line[SLACK]


@kernel
def first_cut(h: Memory, ib: int, line: Any, where: Any, which: Any) -> int:
    """Row of the first of two crossings between which block `ib` is split; -1 for none, -2 if refused."""
    n = crossings(h, ib, line, where, which)
    if n < 0:
        return -2
    for k in range(0, n - 1, 2):
        if is_cut(line, where, k):
            return k
    return -1


@kernel
def _end_fits(h: Memory, ib: int, line: Any, x: float, y: float, ip: int, at: int) -> int:
    """True if a cut can end at (x, y), which is corner `ip` (at = 1) or on the edge that ends there."""
    iq = ip if at == 0 else next_corner(h, ib, ip)
    for k in range(1 + at):
        iend = ip if k == 0 else iq
        ia = iget(h, iend, g.KR)
        ux, uy = getr(h, iend, g.KXP) - getr(h, ia, g.KXP), getr(h, iend, g.KYP) - getr(h, ia, g.KYP)
        z = np.sqrt(ux * ux + uy * uy)
        along = at == 1 and abs(ux * line[3] - uy * line[2]) <= line[SLACK] + line[SLACK]
        if abs(ux * line[3] - uy * line[2]) < z * real(h, GRAZING) and not along:
            return TOO_CLOSE
        if at == 0:
            vx, vy = x - getr(h, ia, g.KXP), y - getr(h, ia, g.KYP)
            part = np.sqrt(vx * vx + vy * vy)
            if min(part, z - part) < line[SHORTEST]:
                return TOO_SHORT
    return OK


@kernel
def _fits(h: Memory, ib: int, line: Any, where: Any, which: Any, k: int) -> int:
    """True if block `ib` can be split between its crossings `k` and `k` + 1; if not, row 0 gets the place."""
    for row in range(k, k + 2):
        x, y = where[row, X], where[row, Y]
        what = _end_fits(h, ib, line, x, y, which[row, CORNER], which[row, AT])
        if what != OK:
            where[0, X], where[0, Y] = x, y
            return what
    if where[k + 1, T] - where[k, T] < line[SHORTEST]:
        where[0, X], where[0, Y] = where[k, X], where[k, Y]
        return TOO_SHORT
    return OK


@kernel
def try_cuts(h: Memory, ib: int, line: Any, where: Any, which: Any) -> tuple[int, int]:
    """Test whether block `ib` can be split at all crossings; returns status and number of cuts.

    Row 0 of `where` gets the place of a refused cut. TOO_MANY requests more rows.
    """
    n = crossings(h, ib, line, where, which)
    if n < 0:
        return TOO_CLOSE if n == -1 else TOO_MANY, 0
    cuts = 0
    for k in range(0, n - 1, 2):
        if is_cut(line, where, k):
            what = _fits(h, ib, line, where, which, k)
            if what != OK:
                return what, 0
            cuts += 1
    return OK, cuts
