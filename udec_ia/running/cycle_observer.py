"""The interface of observers of a run: debugger, studies, monitors, diagnosis of a SOLVE.

A run asks its observers for the number of cycles until their next look, and runs these in one piece. The
division into pieces does not change a digit.
"""

from __future__ import annotations

from typing import Any

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g


class Observer:
    """Base class of observers of a run. Its methods do nothing until they are overridden."""

    def begin(self, array: MainArray, solves: bool) -> None:
        """Called before the first cycle. solves: the run is a SOLVE."""
        return

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the next look, from 1 to the `n` that follow."""
        return n

    def look(self, array: MainArray, cycles: int) -> None:
        """Called after `cycles` more cycles. The last one may have left an error: see between_cycles."""
        return

    def is_over(self) -> bool:
        """True if no cycle is to follow."""
        return False

    def renumber(self, moved: Any) -> None:
        """Called when groups have new addresses. moved: the new address of the group at each old one."""
        return

    def end(self, array: MainArray) -> None:
        """Called at the end of the run, also after an error."""
        return


def between_cycles(h: Memory) -> bool:
    """True if the last cycle is complete and has left no error."""
    return bool(h.ci[g.JPHASE] == g.AT_BLOCKS and h.ci[g.NERR] == 0)
