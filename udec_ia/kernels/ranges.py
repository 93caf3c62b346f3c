"""What lies in a range x1 < x < x2, y1 < y < y2: blocks by their centroids (RANGE), points and edges."""

from __future__ import annotations

from typing import Any

import numpy as np

from offsets.generated import IBPNT, KB, KBEX, KFG, KG, KP, KR, KX, KXG, KXP, KY, KYG, KYP, MFDEF, NBLK
from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.heap.jit import kernel
from udec_ia.kernels.lists import next_corner


@kernel
def blocks_between(h: Memory, x1: float, x2: float, y1: float, y2: float) -> Any:
    """Addresses of the blocks with x1 < x < x2 and y1 < y < y2, in list order."""
    found = np.empty(h.ci[NBLK], np.int64)
    n = 0
    ib = h.ci[IBPNT]
    while ib != 0:
        if x1 < getr(h, ib, KX) < x2 and y1 < getr(h, ib, KY) < y2:
            found[n] = ib
            n += 1
        ib = iget(h, ib, KB)
    return found[:n].copy()


@kernel
def _within(x: float, y: float, x1: float, x2: float, y1: float, y2: float) -> bool:
    return x1 < x < x2 and y1 < y < y2


@kernel
def _points(h: Memory, x1: float, x2: float, y1: float, y2: float, found: Any) -> int:
    """Enter the points in the range in `found`, or only count them if it has no rows. Returns how many."""
    n = 0
    ib = h.ci[IBPNT]
    while ib != 0:
        if iget(h, ib, HEAD) == MFDEF:
            ig = iget(h, iget(h, ib, KBEX), KFG)
            while ig != 0:
                if _within(np.float64(getr(h, ig, KXG)), np.float64(getr(h, ig, KYG)), x1, x2, y1, y2):
                    if len(found) > 0:
                        found[n, 0], found[n, 1] = ib, ig
                    n += 1
                ig = iget(h, ig, KG)
        elif _within(np.float64(getr(h, ib, KX)), np.float64(getr(h, ib, KY)), x1, x2, y1, y2):
            if len(found) > 0:
                found[n, 0], found[n, 1] = ib, 0
            n += 1
        ib = iget(h, ib, KB)
    return n


@kernel
def points_between(h: Memory, x1: float, x2: float, y1: float, y2: float) -> Any:
    """Blocks and grid-points in the range, n x 2: the grid-point is 0 for a block that has none, which counts
    with its centroid."""
    found = np.empty((_points(h, x1, x2, y1, y2, np.empty((0, 2), np.int64)), 2), np.int64)
    _points(h, x1, x2, y1, y2, found)
    return found


@kernel
def _awaits_zones(h: Memory, ib: int) -> bool:
    """True for a fully-deformable block that GENERATE has not divided yet: no load can act on its edges."""
    return iget(h, ib, HEAD) == MFDEF and iget(h, iget(h, ib, KBEX), KFG) == 0


@kernel
def _edges(h: Memory, x1: float, x2: float, y1: float, y2: float, found: Any) -> int:
    """Enter the edges with both ends in the range in `found`, or only count them. Returns how many."""
    n = 0
    ib = h.ci[IBPNT]
    while ib != 0:
        ip0 = iget(h, ib, KP)
        ip = ip0
        while not _awaits_zones(h, ib):
            ia = iget(h, ip, KR)
            ends = _within(np.float64(getr(h, ia, KXP)), np.float64(getr(h, ia, KYP)), x1, x2, y1, y2)
            if ends and _within(np.float64(getr(h, ip, KXP)), np.float64(getr(h, ip, KYP)), x1, x2, y1, y2):
                if len(found) > 0:
                    found[n, 0], found[n, 1] = ib, ip
                n += 1
            ip = next_corner(h, ib, ip)
            if ip == ip0:
                break
        ib = iget(h, ib, KB)
    return n


@kernel
def edges_between(h: Memory, x1: float, x2: float, y1: float, y2: float) -> Any:
    """Blocks and end corners of the edges with both ends in the range, n x 2, clockwise round each block."""
    found = np.empty((_edges(h, x1, x2, y1, y2, np.empty((0, 2), np.int64)), 2), np.int64)
    _edges(h, x1, x2, y1, y2, found)
    return found
