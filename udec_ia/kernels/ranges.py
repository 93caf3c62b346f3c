"""The blocks whose centroids lie in a range (RANGE)."""

from __future__ import annotations

from typing import Any

import numpy as np

from offsets.generated import IBPNT, KB, KX, KY, NBLK
from udec_ia.heap.accessors import Memory, getr, iget
from udec_ia.heap.jit import kernel


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
