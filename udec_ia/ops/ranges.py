"""Ranges: the blocks whose centroids lie in x1 < x < x2, y1 < y < y2 (RANGE)."""

from __future__ import annotations

from udec_ia.heap.array import MainArray
from udec_ia.kernels.ranges import blocks_between
from udec_ia.ops.limits import finite

Range = tuple[float, float, float, float]  # x1, x2, y1, y2


def check_range(array: MainArray, where: Range) -> None:
    """Error 28 unless the limits of the range are finite."""
    finite(array, **dict(zip(("x1", "x2", "y1", "y2"), where, strict=True)))


def blocks_in(array: MainArray, where: Range) -> list[int]:
    """Addresses of the blocks in the range, in list order."""
    check_range(array, where)
    return [int(ib) for ib in blocks_between(array.h, *map(float, where))]
