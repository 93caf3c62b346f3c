"""Timeline of a debugged run: its events, and copies of the array at some of them.

    event     0 is the beginning; the state at an event is that after it
    span      the events of one command: one, or for CYCLE and SOLVE one to prepare and one for each cycle
    copy      the words in use and the common block: after every command, and at some cycles of a run

Between two copies of a run there are so few cycles that repeating them takes no longer than GAP. Copies
cost no more than a SHARE of the time of the run. When all of them exceed the budget, those of runs go first
that leave the smallest gaps, and then the oldest: what was before can no longer be reached.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from time import perf_counter
from typing import Any, NamedTuple

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.cycle_replay import Replay

BUDGET = 200 * 2**20  # bytes of all copies
GAP = 0.1  # seconds of a run from one copy to the next
SHARE = 0.05  # of the time of a run that copying may take


class StateCopy(NamedTuple):
    """One state. words: IA() below MFREE; common: integers, reals and doubles."""

    scheme: Any
    fixed: bool
    words: Any
    common: tuple[Any, Any, Any]

    @property
    def size(self) -> int:
        """Bytes."""
        return int(self.words.nbytes + sum(part.nbytes for part in self.common))

    def array(self) -> MainArray:
        """An array of its own in that state."""
        array = MainArray(self.scheme, int(self.common[0][g.MTOP]))
        array.fixed = self.fixed
        array.h.ia[: len(self.words)] = self.words
        for part, values in zip(array.h[2:], self.common, strict=True):
            part[:] = values
        return array


def copy_state(array: MainArray) -> StateCopy:
    """The state that `array` is in."""
    h = array.h
    words = h.ia[: int(h.ci[g.MFREE]) - 1].copy()
    return StateCopy(array.scheme, array.fixed, words, (h.ci.copy(), h.cr.copy(), h.cd.copy()))


@dataclass
class CommandSpan:
    """What one command did. first: the event before it; last: its own last one, so far. line: of the deck.

    cycle: MCTOT before. runs: it is CYCLE or SOLVE, and has been prepared. ended: it is over. number: of the
    command. began: time of the model before its first cycle, s.
    """

    text: str
    line: int
    first: int
    last: int
    cycle: int
    number: int
    runs: bool = False
    ended: bool = False
    began: float = 0.0

    @property
    def done(self) -> int:
        """Cycles that it has run."""
        return self.last - self.first - 1 if self.runs else 0


class UnreachableEvent(LookupError):
    """An event that can no longer be reached; the message says which can."""


class Timeline:
    """All events up to now, of a model whose laws are `laws`.

    spans: what has happened, in order. copies: by event.
    """

    def __init__(self, array: MainArray, laws: LawBook, budget: int = BUDGET) -> None:
        self.laws = laws
        self.budget = budget
        self.spans: list[CommandSpan] = []
        self.copies: dict[int, StateCopy] = {0: copy_state(array)}
        self.now = 0
        self._size = self.copies[0].size
        self._last_copy = perf_counter()
        self._cost = 0.0

    # ---- recording

    def begin_command(self, text: str, line: int, cycle: int, number: int = 0) -> None:
        """Begin the span of a command."""
        self.spans.append(CommandSpan(text, line, self.now, self.now, cycle, number))

    def add_preparation(self, array: MainArray) -> None:
        """Add the preparation of the run that has begun: its cycles follow."""
        span = self.spans[-1]
        span.runs = True
        self._next(array, 1)
        span.cycle = int(array.h.ci[g.MCTOT])
        span.began = float(array.h.cd[g.TIME])

    def add_cycles(self, array: MainArray, cycles: int) -> None:
        """Add cycles of the run, and a copy if it is time for one."""
        self.now += cycles
        self.spans[-1].last = self.now
        if perf_counter() - self._last_copy > max(GAP, self._cost / SHARE):
            self._keep(array)

    def end_command(self, array: MainArray) -> None:
        """End the span of a command."""
        self.spans[-1].ended = True
        if self.spans[-1].runs:
            self._keep(array)
        else:
            self._next(array, 1)

    def forget(self, event: int) -> None:
        """Discard what came after `event`."""
        self.spans = [one for one in self.spans if one.first < event]
        if self.spans:
            last = self.spans[-1]
            last.last, last.ended = event, last.ended and last.last == event
        self.copies = {one: copy for one, copy in self.copies.items() if one <= event}
        self._size = sum(copy.size for copy in self.copies.values())
        self.now = event

    def restore(self, spans: list[CommandSpan], copies: dict[int, StateCopy], now: int) -> None:
        """Take the events of another timeline."""
        self.spans, self.copies, self.now = spans, copies, now
        self._size = sum(copy.size for copy in copies.values())

    def _next(self, array: MainArray, events: int) -> None:
        self.now += events
        self.spans[-1].last = self.now
        self._keep(array)

    def _keep(self, array: MainArray) -> None:
        """Copy the present state."""
        start = perf_counter()
        if self.now in self.copies:
            self._size -= self.copies[self.now].size
        self.copies[self.now] = copy_state(array)
        self._size += self.copies[self.now].size
        while self._size > self.budget and len(self.copies) > 2:
            self._drop()
        self._last_copy = perf_counter()
        self._cost = self._last_copy - start

    def _drop(self) -> None:
        """Discard a copy of a run that leaves the smallest gap, or the oldest one, but never the last one."""
        events = sorted(self.copies)
        spare = [
            (after - before, event)
            for before, event, after in zip(events, events[1:], events[2:], strict=False)
            if self._within_run(before, after)
        ]
        event = min(spare)[1] if spare else events[0]
        self._size -= self.copies.pop(event).size

    def _within_run(self, before: int, after: int) -> bool:
        """True if `after` can be reached from `before`."""
        span = self.span(after)
        return span.runs and span.first < before

    # ---- going back

    def span(self, event: int) -> CommandSpan:
        """The command that `event`, which is not 0, is a part of."""
        return self.spans[bisect_right([one.first for one in self.spans], event - 1) - 1]

    @property
    def earliest(self) -> int:
        """The first event that can be reached."""
        return min(self.copies)

    def at(self, event: int) -> MainArray:
        """The state at `event`, in an array of its own. Raises UnreachableEvent."""
        base = max((one for one in self.copies if one <= event), default=-1)
        if base == event:
            return self.copies[event].array()
        if base < 0 or not self._within_run(base, event):
            after = min(one for one in self.copies if one > event)
            raise UnreachableEvent(
                f"event {event} cannot be reached: its copy was given up to save memory; "
                f"the next one that can be is {after}"
            )
        *_, (_, array) = self.through(base, event)
        return array

    def through(self, before: int, after: int) -> Iterator[tuple[int, MainArray]]:
        """The states after `before`, of which there is a copy, to `after`: each event, and the array then.

        It is one and the same array in the midst of a run. Events that no run has made are left out if there
        is no copy of them.
        """
        if self._within_run(before, after):
            replay = Replay(self.copies[before].array(), self.laws)
            for event in range(before + 1, after + (after not in self.copies)):
                with suppress(UdecError):  # of the last cycle of a run, which that has ended with
                    replay.step()
                yield event, replay.array
        if after in self.copies:
            yield after, self.copies[after].array()

    def backwards(self, event: int) -> Iterator[tuple[int, int]]:
        """(a, b): from one copy to the next, from that before `event` back to the earliest."""
        events = sorted({one for one in self.copies if one < event} | {event})
        yield from zip(events[-2::-1], events[::-1], strict=False)

    def place(self, event: int) -> tuple[CommandSpan | None, int]:
        """The command that an event belongs to, None for the beginning, and the number of cycles then."""
        if event == 0 or not self.spans:
            return None, self.spans[0].cycle if self.spans else 0
        span = self.span(event)
        return span, span.cycle + (max(event - span.first - 1, 0) if span.runs else 0)

    def event_of(self, cycle: int) -> int:
        """The first event at which so many cycles were completed. Raises UnreachableEvent."""
        for span in self.spans:
            if span.runs and span.cycle <= cycle <= span.cycle + span.done:
                return span.first + 1 + cycle - span.cycle
        first = min((span.cycle for span in self.spans if span.runs), default=cycle)
        before = f"is before what was recorded, which begins with cycle {first}"
        raise UnreachableEvent(f"cycle {cycle} {before if cycle < first else 'has not been run yet'}")
