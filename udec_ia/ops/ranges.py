"""Ranges: the blocks whose centroids lie in x1 < x < x2, y1 < y < y2 (RANGE)."""

from __future__ import annotations

from udec_ia.heap.array import MainArray
from udec_ia.kernels.ranges import blocks_between
from udec_ia.ops.limits import finite

Range = tuple[float, float, float, float]  # x1, x2, y1, y2


def blocks_in(array: MainArray, where: Range) -> list[int]:
    """Addresses of the blocks in the range, in list order."""
    x1, x2, y1, y2 = map(float, where)
    finite(array, x1=x1, x2=x2, y1=y1, y2=y2)
    return [int(ib) for ib in blocks_between(array.h, x1, x2, y1, y2)]
