"""Distance of a point from a segment and from a block without its roundings, in doubles."""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget
from udec_ia.layout import offsets as g


@inlined
def distance_from_segment(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance of the point (x, y) from the segment from a to b."""
    ux, uy = bx - ax, by - ay
    square = ux * ux + uy * uy
    part = min(max(((x - ax) * ux + (y - ay) * uy) / square, 0.0), 1.0) if square > 0 else 0.0
    dx, dy = x - ax - part * ux, y - ay - part * uy
    return np.sqrt(dx * dx + dy * dy)


@kernel
def distance_outside(h: Memory, ib: int, x: float, y: float) -> float:
    """Distance of the point (x, y) from block `ib`, without its roundings; 0 if it is inside."""
    inside, nearest = False, np.inf
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        ia = iget(h, ip, g.KR)
        px, py = np.float64(getr(h, ip, g.KXP)), np.float64(getr(h, ip, g.KYP))
        qx, qy = np.float64(getr(h, ia, g.KXP)), np.float64(getr(h, ia, g.KYP))
        if (py > y) != (qy > y) and ((px - x) * (qy - py) - (py - y) * (qx - px) > 0) == (qy > py):
            inside = not inside
        nearest = min(nearest, distance_from_segment(x, y, px, py, qx, qy))
        ip = ia
        if ip == ip0:
            break
    return 0.0 if inside else float(nearest)
