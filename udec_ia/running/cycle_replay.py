"""Repetition of the cycles of a prepared run, bit for bit, without preparation, warnings and recording.

A replay stops at the same errors as the run.
"""

from __future__ import annotations

from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.cycle import lacks_pass, passes, run_with_records
from udec_ia.layout import offsets as g
from udec_ia.ops.common.kernel_arguments import soft
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.between_cycles import cycles_to_update, update_between_cycles
from udec_ia.running.cycle_errors import raise_error
from udec_ia.running.history_series import NEVER, NO_MARKS, nothing_recorded


class Replay:
    """Repeats cycles of `array`, which is a state within a run. laws: of that run."""

    def __init__(self, array: MainArray, laws: LawBook) -> None:
        self.array = array
        self._bound = laws.bind(array)
        self._given = soft(array.h), self._bound.blocks, self._bound.joints
        self._recorded = nothing_recorded()
        self._passes = passes(array.h, self._given[0], (), NEVER, False, NO_MARKS)

    def step(self, n: int = 1) -> None:
        """`n` cycles. Raises the UdecError that one of them raised in the run."""
        done = 0
        while done < n:
            h = self.array.h
            cycles = cycles_to_update(self.array, n - done)
            completed, _ = run_with_records(
                h, cycles, self._given, NEVER, *self._recorded, NO_MARKS, self._passes
            )
            done += int(completed)
            raise_error(self.array, self._bound.book)
            if self.array.h.ci[g.JPHASE] == g.AT_BLOCKS:
                update_between_cycles(self.array)
            if lacks_pass(self.array.h, self._passes):
                self._passes = passes(self.array.h, self._given[0], (), NEVER, False, NO_MARKS)
