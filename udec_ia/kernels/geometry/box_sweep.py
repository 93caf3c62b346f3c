"""Search for overlapping boxes by a sweep along x, and the stable sort that it needs.

np.argsort would take as long to compile as a dozen kernels.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel


@kernel
def _merge(key: Any, order: Any, merged: Any, low: int, middle: int, high: int) -> None:
    """Merge the sorted runs low ... middle and middle ... high of `order` into `merged`."""
    i, j = low, middle
    for k in range(low, high):
        if i < middle and (j == high or key[order[i]] <= key[order[j]]):
            merged[k] = order[i]
            i += 1
        else:
            merged[k] = order[j]
            j += 1


@kernel
def stable_order(key: Any) -> Any:
    """Rows in ascending order of `key`, by merging runs of 1, 2, 4 ... rows."""
    n = len(key)
    order, merged = np.empty(n, np.int64), np.empty(n, np.int64)
    for k in range(n):
        order[k] = k
    width = 1
    while width < n:
        for low in range(0, n, 2 * width):
            _merge(key, order, merged, low, min(low + width, n), min(low + 2 * width, n))
        order, merged = merged, order
        width *= 2
    return order


LEFT, BELOW, RIGHT, ABOVE = 0, 1, 2, 3  # columns of the boxes


@kernel
def _sweep(boxes: Any, n: int, order: Any, pairs: Any) -> int:
    """Enter overlapping boxes in `pairs`, or, if it has no rows, only count them. Returns their number."""
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
def overlapping_boxes(boxes: Any, n: int) -> Any:
    """Pairs of rows of the first `n` of `boxes` that have a point in common, m x 2."""
    order = stable_order(boxes[:n, LEFT].copy())
    pairs = np.empty((_sweep(boxes, n, order, np.empty((0, 2), np.int64)), 2), np.int64)
    _sweep(boxes, n, order, pairs)
    return pairs
