"""The states between the passes of one cycle, which is run as Python: a copy after each pass."""

from __future__ import annotations

import sys
from contextlib import suppress
from types import FrameType
from typing import Any

from udec_ia.compiling.interpreting import interpreted, observe
from udec_ia.debug.cycle_trace import ROOT, UNDER
from udec_ia.debug.timeline import StateCopy, copy_state
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft
from udec_ia.ops.laws.law_book import LawBook
from udec_ia.running.cycle_errors import raise_error
from udec_ia.running.history_series import run_unwatched

STOPS = 1000  # times that a cycle may stop for memory


class Passes:
    """The cycle that follows the state in `array`, which is changed. after: name of each pass, and a copy."""

    def __init__(self, array: MainArray, laws: LawBook) -> None:
        self.after: list[tuple[str, StateCopy]] = []
        self._array, self._name = array, ROOT
        with interpreted(), suppress(UdecError):
            bound = laws.bind(array)
            given = soft(array), bound.blocks, bound.joints
            cycle = int(array.h.ci[g.MCTOT])
            for _ in range(STOPS):
                run_unwatched(observe(array.h, self._tell), 1, given)
                raise_error(array, bound.book)
                if array.h.ci[g.MCTOT] > cycle:
                    break
        self._end()

    def _tell(self, part: str, where: Any, value: Any, written: bool) -> None:
        name = _pass_of(sys._getframe(2))
        if name != self._name:
            self._end()
            self._name = name

    def _end(self) -> None:
        """The pass is over. What the loop of the passes itself counts is no pass."""
        if self._name != ROOT:
            self.after.append((self._name, copy_state(self._array)))


def _pass_of(frame: FrameType | None) -> str:
    """The routine that the loop of the passes has called; that loop itself if it has called none."""
    name = ROOT
    while frame is not None and frame.f_code.co_name != ROOT:
        if not frame.f_globals["__name__"].startswith(UNDER):
            name = frame.f_code.co_name
        frame = frame.f_back
    return name
