"""Which of many boxes meet: a sweep along x."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.kernels.geometry.sorting import stable_order

LEFT, BELOW, RIGHT, ABOVE = 0, 1, 2, 3  # columns of the boxes


@kernel
def _sweep(boxes: Any, n: int, order: Any, pairs: Any) -> int:
    """Enter the boxes that meet in `pairs`, or, if it has no rows, only count them. Returns their number."""
    m = 0
    for u in range(n):
        i = order[u]
        v = u + 1
        while v < n and boxes[order[v], LEFT] <= boxes[i, RIGHT]:
            j = order[v]
            v += 1
            if boxes[j, BELOW] > boxes[i, ABOVE] or boxes[j, ABOVE] < boxes[i, BELOW]:
                continue
            if len(pairs) > 0:
                pairs[m, 0], pairs[m, 1] = i, j
            m += 1
    return m


@kernel
def meeting(boxes: Any, n: int) -> Any:
    """Pairs of rows of the first `n` of `boxes` that have a point in common, m x 2."""
    order = stable_order(boxes[:n, LEFT].copy())
    pairs = np.empty((_sweep(boxes, n, order, np.empty((0, 2), np.int64)), 2), np.int64)
    _sweep(boxes, n, order, pairs)
    return pairs
