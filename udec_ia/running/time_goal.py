"""CYCLE TIME: a run that ends when the model's time has grown by a given time."""

from __future__ import annotations

import math

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.running.cycle_observer import Observer

LIMIT_OF_CYCLES = 10**12
SLACK = 1e-6  # of a step, by which rounding may keep the time below its goal


class TimeGoal(Observer):
    """Ends a run of `array` after the cycle in which its time has grown by `time` (s).

    The array is prepared: its time-step is known. The last cycle reaches the goal or goes beyond it by less
    than its step, also where the step changes during the run. Error 28 if it takes too many cycles.
    """

    def __init__(self, array: MainArray, time: float) -> None:
        self.goal = float(array.h.cd[g.TIME]) + time
        if time / float(array.h.cr[g.TDEL]) > LIMIT_OF_CYCLES:
            detail = (
                f"{time:g} s with a step of {array.h.cr[g.TDEL]:.3g} s are more than {LIMIT_OF_CYCLES} cycles"
            )
            raise UdecError(28, detail, "take a shorter time", parameter="time")
        self.left = self.cycles_left(array)

    def cycles_left(self, array: MainArray) -> int:
        """Cycles to the goal with the present time-step."""
        steps = (self.goal - float(array.h.cd[g.TIME])) / float(array.h.cr[g.TDEL])
        return max(math.ceil(steps - SLACK), 0)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles to the goal, if these are fewer than `n`."""
        return min(n, max(self.cycles_left(array), 1))

    def look(self, array: MainArray, cycles: int) -> None:
        """Count what is left."""
        self.left = self.cycles_left(array)

    def is_over(self) -> bool:
        """True at the goal."""
        return self.left == 0
