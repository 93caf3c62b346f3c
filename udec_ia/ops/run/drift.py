"""Whether what 32-bit reals have rounded on the way counts against how far blocks have gone.

Each cycle rounds the places anew. By chance the roundings of n cycles add up to about sqrt(n) last digits;
that may be much of a way that is no longer than some overlaps. It is known at the end of a run only, and of
reals of 64 bits it is never worth speaking of.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from udec_ia.heap.accessors import getr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.common.number_limits import last_digit

ENOUGH = 200  # cycles, before which nothing is said
LOST = 0.004  # of the farthest way, from which on it is said. What is more than the way has not moved at all


class Drift:
    """Knows where the blocks of one model were when it was first asked. blocks: none for 64-bit reals."""

    def __init__(self) -> None:
        self._begun = 0
        self._blocks: Any = np.zeros(0, np.int64)
        self._x: Any = np.zeros(0)
        self._y: Any = np.zeros(0)

    def begin(self, array: MainArray) -> None:
        """A run begins: it goes on with the blocks of the run before, or others are taken note of."""
        if array.scheme.real_bits > 32:
            return
        blocks, cycle = addresses(array.h, int(array.h.ci[g.IBPNT]), g.KB), int(array.h.ci[g.MCTOT])
        if cycle < self._begun or not np.array_equal(blocks, self._blocks):
            self._begun, self._blocks = cycle, blocks
            self._x, self._y = self._places(array)

    def _places(self, array: MainArray) -> tuple[Any, Any]:
        x, y = (np.asarray(getr(array.h, self._blocks, k), np.float64) for k in (g.KX, g.KY))
        return x, y

    def told(self, array: MainArray) -> Iterator[str]:
        """A run has ended: what may be lost of the places, if it is much."""
        if array.scheme.real_bits > 32 or not len(self._blocks):
            return
        many = int(array.h.ci[g.MCTOT]) - self._begun
        x, y = self._places(array)
        way = float(np.hypot(x - self._x, y - self._y).max())
        digit = last_digit(array, float((np.abs(x) + np.abs(y)).max()))
        lost = math.sqrt(many) * digit
        if many >= ENOUGH and LOST * way < lost < way:
            yield (
                f"in {many} cycles reals of {array.scheme.real_bits} bits, whose last digit is {digit:.2g} m "
                f"at these coordinates, may have moved places by {lost:.2g} m, {lost / way:.1%} of the "
                f"{way:.2g} m that the farthest block has gone: run it with reals of 64 bits, or take an "
                "origin within the model"
            )
