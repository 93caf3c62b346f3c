"""What looks on while cycles run: a debugger, a study, the monitors of a run, the diagnosis of a SOLVE.

A run asks each of its observers how far it may go, runs as many cycles in one piece, and shows them what it
has come to. How a run is cut into pieces changes no digit of it.
"""

from __future__ import annotations

from typing import Protocol

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g


class Observer(Protocol):
    """Looks on at a run. By itself it asks for nothing and does nothing."""

    def begin(self, array: MainArray, solves: bool) -> None:
        """The run is prepared, and its first cycle follows. solves: it is a SOLVE."""
        return

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the observer has to look, from 1 to the `n` that are to come."""
        return n

    def look(self, array: MainArray, cycles: int) -> None:
        """`cycles` more have been completed. The last cycle may have left an error: see between_cycles."""
        return

    def is_over(self) -> bool:
        """True if no cycle is to follow."""
        return False

    def end(self, array: MainArray) -> None:
        """The run has ended, whatever ended it."""
        return


def between_cycles(h: Memory) -> bool:
    """True if the last cycle is complete and has left no error."""
    return bool(h.ci[g.JPHASE] == g.AT_BLOCKS and h.ci[g.NERR] == 0)
