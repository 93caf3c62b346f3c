"""Selection in a range x1 < x < x2, y1 < y < y2: blocks by their centroids (RANGE), points and edges."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.layout import offsets as g


@kernel
def blocks_between(h: Memory, x1: float, x2: float, y1: float, y2: float) -> Any:
    """Addresses of the blocks with x1 < x < x2 and y1 < y < y2, in list order."""
    found = np.empty(h.ci[g.NBLK], np.int64)
    n = 0
    ib = h.ci[g.IBPNT]
    while ib != 0:
        if x1 < getr(h, ib, g.KX) < x2 and y1 < getr(h, ib, g.KY) < y2:
            found[n] = ib
            n += 1
        ib = iget(h, ib, g.KB)
    return found[:n].copy()


@kernel
def _within(x: float, y: float, x1: float, x2: float, y1: float, y2: float) -> bool:
    return x1 < x < x2 and y1 < y < y2


@kernel
def _points(h: Memory, x1: float, x2: float, y1: float, y2: float, found: Any) -> int:
    """Enter the points in the range in `found`, or only count them if it has no rows. Returns how many."""
    n = 0
    ib = h.ci[g.IBPNT]
    while ib != 0:
        if iget(h, ib, HEAD) == g.MFDEF:
            ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
            while ig != 0:
                if _within(np.float64(getr(h, ig, g.KXG)), np.float64(getr(h, ig, g.KYG)), x1, x2, y1, y2):
                    if len(found) > 0:
                        found[n, 0], found[n, 1] = ib, ig
                    n += 1
                ig = iget(h, ig, g.KG)
        elif _within(np.float64(getr(h, ib, g.KX)), np.float64(getr(h, ib, g.KY)), x1, x2, y1, y2):
            if len(found) > 0:
                found[n, 0], found[n, 1] = ib, 0
            n += 1
        ib = iget(h, ib, g.KB)
    return n


@kernel
def points_between(h: Memory, x1: float, x2: float, y1: float, y2: float) -> Any:
    """Blocks and grid-points in the range, n x 2: the grid-point is 0 for a block that has none, which counts
    with its centroid."""
    found = np.empty((_points(h, x1, x2, y1, y2, np.empty((0, 2), np.int64)), 2), np.int64)
    _points(h, x1, x2, y1, y2, found)
    return found


@kernel
def _has_no_zones_yet(h: Memory, ib: int) -> bool:
    """True for a fully-deformable block without zones: no load can act on its edges."""
    return iget(h, ib, HEAD) == g.MFDEF and iget(h, iget(h, ib, g.KBEX), g.KFG) == 0


@kernel
def _edges(h: Memory, x1: float, x2: float, y1: float, y2: float, found: Any) -> int:
    """Enter the edges with both ends in the range in `found`, or only count them. Returns how many."""
    n = 0
    ib = h.ci[g.IBPNT]
    while ib != 0:
        ip0 = iget(h, ib, g.KP)
        ip = ip0
        while not _has_no_zones_yet(h, ib):
            ia = iget(h, ip, g.KR)
            ends = _within(np.float64(getr(h, ia, g.KXP)), np.float64(getr(h, ia, g.KYP)), x1, x2, y1, y2)
            if ends and _within(
                np.float64(getr(h, ip, g.KXP)), np.float64(getr(h, ip, g.KYP)), x1, x2, y1, y2
            ):
                if len(found) > 0:
                    found[n, 0], found[n, 1] = ib, ip
                n += 1
            ip = next_corner(h, ib, ip)
            if ip == ip0:
                break
        ib = iget(h, ib, g.KB)
    return n


@kernel
def edges_between(h: Memory, x1: float, x2: float, y1: float, y2: float) -> Any:
    """Blocks and end corners of the edges with both ends in the range, n x 2, clockwise round each block."""
    found = np.empty((_edges(h, x1, x2, y1, y2, np.empty((0, 2), np.int64)), 2), np.int64)
    _edges(h, x1, x2, y1, y2, found)
    return found
