"""Trace of one cycle: every word that is read or written, in order, with routine and line.

The cycle is run as Python on a memory that reports each access. The accesses are recorded: so the state
between any two writes can be shown, forwards and backwards, without running anything again.

    pass    what run_cycles calls: move_blocks, accumulate, ford_all ...
    work    one call by a pass: of motion for a block, of ford for a contact
"""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.interpreted_kernels import interpreted, observe
from udec_ia.debug.value_sources import Calls
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.common.kernel_arguments import soft
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.cycle_errors import raise_error
from udec_ia.running.history_series import run_unwatched

UNDER = "udec_ia.compiling.", "udec_ia.checked_build.", "udec_ia.heap.accessors"  # no routines of the program
MEMORY_LIMIT = 1_000  # times that a cycle may stop for memory
ROOT = "run_cycles"


class RoutineCall(NamedTuple):
    """One call by a pass. group: the address that it is about, 0 if there is none."""

    number: int
    of: str
    routine: str
    group: int


class Access(NamedTuple):
    """One number read or written. part, at: where; before, after: what was and is there.

    calls: the pass and the routines that it has called one in the other, each with its line.
    """

    written: bool
    part: str
    at: int
    before: Any
    after: Any
    work: RoutineCall
    calls: Calls

    @property
    def place(self) -> str:
        """Routine, file and line."""
        code, line = self.calls[-1]
        return f"{code.co_name} ({Path(code.co_filename).name}:{line})"


class CycleTrace:
    """The cycle that follows the state in `array`, access by access.

    accesses: in order. writes: which of them are writes. state: the array after `done` writes.
    """

    def __init__(self, array: MainArray, laws: LawBook) -> None:
        self.accesses: list[Access] = []
        self._pass: FrameType | None = None
        self._frame: FrameType | None = None
        self._work = RoutineCall(0, ROOT, ROOT, 0)
        self._calls: Calls = ()
        self._known: dict[Calls, Calls] = {}
        self._run(array, laws)
        self.writes = [k for k, one in enumerate(self.accesses) if one.written]
        self.done = len(self.writes)

    def _run(self, array: MainArray, laws: LawBook) -> None:
        """The cycle, with room beforehand: an array that grows is another one."""
        array.h.ci[g.NWANT] = max(int(array.h.ci[g.NSPARE]), 1)
        array.grow()
        array.h.ci[g.NWANT] = 0
        self.state, seen = array.copy(), array
        with interpreted(), suppress(UdecError):
            bound = laws.bind(seen)
            given = soft(seen.h), bound.blocks, bound.joints
            for _ in range(MEMORY_LIMIT):
                memory = seen.h
                done = run_unwatched(observe(memory, self._record), 1, given)
                raise_error(seen, bound.book)
                if seen.h is not memory:
                    self.state.h.ci[g.NWANT] = len(seen.h.ia) - int(self.state.h.ci[g.MFREE])
                    self.state.grow()
                if done:
                    break
        self._pass = self._frame = None
        self._known.clear()

    # ---- recording

    def _record(self, part: str, at: Any, value: Any, written: bool) -> None:
        frame = sys._getframe(2)
        while frame.f_globals["__name__"].startswith(UNDER):
            assert frame.f_back is not None
            frame = frame.f_back
        self._place(frame)
        words = getattr(self.state.h, part)
        before = words[at]
        if isinstance(at, slice | np.ndarray):
            indices = np.arange(len(words))[at]
            values = np.broadcast_to(value, indices.shape)
            for index, old, new in zip(indices.tolist(), before.tolist(), values.tolist(), strict=True):
                self._add(written, part, index, old, new)
        else:
            self._add(written, part, int(at), before, value)
        if written:
            words[at] = value

    def _add(self, written: bool, part: str, index: int, before: Any, after: Any) -> None:
        kind = getattr(self.state.h, part).dtype.type
        self.accesses.append(Access(written, part, index, kind(before), kind(after), self._work, self._calls))

    def _place(self, frame: FrameType) -> None:
        """Find the pass and the work that `frame` is in, and the calls between."""
        chain: list[FrameType] = []
        above: FrameType | None = frame
        while above is not None and above.f_code.co_name != ROOT:
            if not above.f_globals["__name__"].startswith(UNDER):
                chain.append(above)
            above = above.f_back
        calls = tuple((one.f_code, one.f_lineno) for one in chain[::-1]) or ((frame.f_code, frame.f_lineno),)
        self._calls = self._known.setdefault(calls, calls)  # one object for all accesses from there
        now = chain[-1] if chain else None
        work = chain[-2] if len(chain) > 1 else now
        if now is self._pass and work is self._frame:
            return
        self._pass, self._frame = now, work
        of, routine = (one.f_code.co_name if one else ROOT for one in (now, work))
        self._work = RoutineCall(self._work.number + 1, of, routine, _group(work))

    # ---- the state between two writes

    def go(self, done: int) -> None:
        """Have the state after `done` writes."""
        done = min(max(done, 0), len(self.writes))
        while self.done < done:
            one = self.accesses[self.writes[self.done]]
            getattr(self.state.h, one.part)[one.at] = one.after
            self.done += 1
        while self.done > done:
            self.done -= 1
            one = self.accesses[self.writes[self.done]]
            getattr(self.state.h, one.part)[one.at] = one.before

    def next_stop(self, by: str, step: int) -> int:
        """Where the next pass, group or write begins, from here on (step 1) or back (step -1)."""
        at = self.done + step
        if by != "write":
            while 0 < at < len(self.writes) and self._same(by, at - 1, at):
                at += step
        return min(max(at, 0), len(self.writes))

    def _same(self, by: str, one: int, other: int) -> bool:
        """True if two writes are of one pass, or of the work on one group."""
        a, b = (self.accesses[self.writes[k]].work for k in (one, other))
        return a.of == b.of and (by == "pass" or a.group == b.group)

    def here(self) -> Access | None:
        """The write that comes next; None at the end."""
        return self.accesses[self.writes[self.done]] if self.done < len(self.writes) else None

    def writes_to(self, h: Memory, part: str, index: int) -> list[int]:
        """Numbers of the accesses that write to a number of the memory, through whichever view of IA()."""
        if part not in ("ia", "ra"):
            return [k for k in self.writes if self.accesses[k][1:3] == (part, index)]
        ratio = int(h.ra.itemsize // h.ia.itemsize)
        first, last = (index, index) if part == "ia" else (index * ratio, index * ratio + ratio - 1)
        found = []
        for k in self.writes:
            one = self.accesses[k]
            if (one.part == "ia" and first <= one.at <= last) or (
                one.part == "ra" and first // ratio <= one.at <= last // ratio
            ):
                found.append(k)
        return found

    def origins(self, number: int) -> list[Access]:
        """What was read before access `number` in the same work, each number once: the last reading."""
        work = self.accesses[number].work
        found: dict[tuple[str, int], Access] = {}
        for k in range(number - 1, -1, -1):
            one = self.accesses[k]
            if one.work.number != work.number:
                break
            if not one.written:
                found.setdefault((one.part, one.at), one)
        return [*found.values()][::-1]


def _group(frame: FrameType | None) -> int:
    """The address that a routine is called with, the second of its arguments."""
    if frame is None or frame.f_code.co_argcount < 2:
        return 0
    value = frame.f_locals.get(frame.f_code.co_varnames[1], 0)
    return int(value) if isinstance(value, int | np.integer) and not isinstance(value, bool) else 0
