"""Cycles that are tried on a copy, to see what a state comes to; the state itself stays as it is."""

from __future__ import annotations

import math

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr
from udec_ia.heap.array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.run.cycle import cycle

AS_FAST = 0.5  # of the speed before


def goes_on(array: MainArray, ib: int, speed: float, n: int) -> bool:
    """True if block `ib` moves by `speed` or more metres in a cycle, or half of it, after `n` more cycles.

    It is measured in the second half of them. What ends in an error has not come to rest.
    """
    trial = array.copy()
    try:
        cycle(trial, n // 2)
        x, y = (float(getr(trial.h, ib, k)) for k in (g.KX, g.KY))
        cycle(trial, n - n // 2)
    except UdecError:
        return True
    way = math.hypot(float(getr(trial.h, ib, g.KX)) - x, float(getr(trial.h, ib, g.KY)) - y)
    return way > AS_FAST * speed * (n - n // 2)
