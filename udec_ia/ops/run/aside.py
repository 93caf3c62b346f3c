"""Cycles that are tried on a copy, to see what a state comes to; the state itself stays as it is."""

from __future__ import annotations

import math

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.run.cycle import cycle


def speed_after(array: MainArray, ib: int, n: int) -> float:
    """Metres that block `ib` moves by in a cycle in the second half of `n` more cycles.

    Infinite if they end in an error: that has not come to rest.
    """
    trial = array.copy()
    try:
        cycle(trial, n // 2)
        x, y = (float(getr(trial.h, ib, k)) for k in (g.KX, g.KY))
        cycle(trial, n - n // 2)
    except UdecError:
        return math.inf
    way = math.hypot(float(getr(trial.h, ib, g.KX)) - x, float(getr(trial.h, ib, g.KY)) - y)
    return way / (n - n // 2)
