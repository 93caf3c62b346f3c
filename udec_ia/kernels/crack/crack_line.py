"""The straight crack of a block: a line through it from edge to edge, and whether the block can break there.

A crack is a cut as of SPLIT, under the conditions of SPLIT: no edge shorter than two rounding lengths, no
part along an edge. Both parts have at least the smallest area, and are no slivers: their area over the
length of the crack, a mean thickness, is at least two rounding lengths. A corner nearer to the line than FTOL
is on it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.kernels.geometry.block_shape import geo
from udec_ia.kernels.split.line_crossing import AT, CORNER, T, X, Y, crossings
from udec_ia.kernels.split.polyline_cut import place_cut
from udec_ia.kernels.split.split import DONE
from udec_ia.layout import offsets as g

ROWS = 64  # crossings of one line with one block; a block with more does not crack
Crack = tuple[int, float, float, float, float]  # cause, or 0 for none, and the ends x1, y1, x2, y2


@kernel
def no_crack(h: Memory) -> Crack:
    """The value that stands for no crack."""
    zero = real(h, 0.0)
    return 0, zero, zero, zero, zero


@kernel
def _area_beside(h: Memory, points: Any, which: Any) -> float:
    """Area of the part of a block that a cut leaves on one side. which: as of place_cut."""
    n = len(points)
    x0, y0 = points[0, 0], points[0, 1]
    x, y, twice = real(h, 0.0), real(h, 0.0), real(h, 0.0)
    for k in range(1, n):
        nx, ny = points[k, 0] - x0, points[k, 1] - y0
        twice += x * ny - nx * y
        x, y = nx, ny
    ip = which[1, CORNER]
    while True:
        ip = iget(h, ip, g.KR)
        if ip == which[0, CORNER] and which[0, AT] == 1:
            break
        nx, ny = getr(h, ip, g.KXP) - x0, getr(h, ip, g.KYP) - y0
        twice += x * ny - nx * y
        x, y = nx, ny
        if ip == which[0, CORNER]:
            break
    return abs(twice) * real(h, 0.5)


@kernel
def parts_fit(h: Memory, ib: int, points: Any, smallest: float) -> bool:
    """True if block `ib` can be cut along the polyline `points` and both parts are large and thick enough."""
    where, which = np.empty((2, 3)), np.empty((2, 2), np.int64)
    d, tolerance = h.cr[g.DTOL], h.cr[g.FTOL]
    if place_cut(h, ib, points, tolerance, d + d, where, which)[0] != DONE:
        return False
    x, y = points[len(points) - 1, 0] - points[0, 0], points[len(points) - 1, 1] - points[0, 1]
    limit = max(smallest, (d + d) * np.sqrt(x * x + y * y))
    area = _area_beside(h, points, which)
    return area >= limit and geo(h, ib)[0] - area >= limit


@kernel
def crack_through(
    h: Memory, ib: int, x: float, y: float, c: float, s: float, smallest: float, cause: int
) -> Crack:
    """The crack of block `ib` along the line through (x, y) in the direction (c, s), if it can break there.

    Of several parts of the line in the block the crack is that with (x, y).
    """
    d = h.cr[g.DTOL]
    line = np.empty(7)
    line[0], line[1], line[2], line[3], line[4], line[5], line[6] = x, y, c, s, d, d + d, h.cr[g.FTOL]
    where, which = np.empty((ROWS, 3)), np.empty((ROWS, 2), np.int64)
    n = crossings(h, ib, line, where, which)
    for k in range(0, n - 1, 2):
        if where[k, T] <= 0 and where[k + 1, T] >= 0:
            ends = np.empty((2, 2))
            for end in range(2):
                ends[end, 0], ends[end, 1] = where[k + end, X], where[k + end, Y]
            if not parts_fit(h, ib, ends, smallest):
                return no_crack(h)
            one, two = (real(h, ends[0, 0]), real(h, ends[0, 1])), (real(h, ends[1, 0]), real(h, ends[1, 1]))
            return cause, one[0], one[1], two[0], two[1]
    return no_crack(h)
