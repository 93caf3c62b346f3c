"""Sorting: the rows of a table in the order of their keys, equal keys in the order they stand in.

np.argsort does the same, but to compile it for one caller takes as long as a dozen kernels.
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
