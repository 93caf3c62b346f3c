"""A run that was prepared is gone through once more, cycle by cycle: the same words, bit for bit.

CYCLE prepares, judges, records and reports; nothing of that is done here, where what has happened is to be
seen again. Whatever the run stopped for, it stops for here.
"""

from __future__ import annotations

from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.passes import TUNNELLING, passes
from udec_ia.kernels.drive.watch import run_watched
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft
from udec_ia.ops.laws.law_book import LawBook
from udec_ia.ops.run.cycle import raise_error
from udec_ia.ops.run.renewal import ahead, renew
from udec_ia.ops.run.watch import NEVER, NO_MARKS, nothing_recorded


class Replay:
    """Cycles of `array`, which is in the midst of a run. laws: those of that run."""

    def __init__(self, array: MainArray, laws: LawBook) -> None:
        self.array = array
        self._bound = laws.bind(array)
        self._given = soft(array), self._bound.blocks, self._bound.joints
        self._recorded = nothing_recorded()
        self._passes = passes(array.h, self._given[0], (), NEVER, False, NO_MARKS)

    def step(self, n: int = 1) -> None:
        """`n` cycles. Raises the UdecError that one of them raised in the run."""
        done = 0
        while done < n:
            h = self.array.h
            cycles = ahead(self.array, n - done)
            completed, _ = run_watched(h, cycles, self._given, NEVER, *self._recorded, NO_MARKS, self._passes)
            done += int(completed)
            raise_error(self.array, self._bound.book)
            if self.array.h.ci[g.JPHASE] == g.AT_BLOCKS:
                renew(self.array)
            if self.array.h.ci[g.JPHASE] == g.AT_WAYS and self._passes[TUNNELLING] == 0:
                self._passes = passes(self.array.h, self._given[0], (), NEVER, False, NO_MARKS)
