"""A deck that is run under the debugger: where it stops, and which of its states is shown.

The model itself runs, by the same machine code as without a debugger. Its cycles run in pieces that end where
the run may have to stop. `timeline.now` is the present. Any earlier `event` can be shown, from a copy, which
leaves the run alone. Before a cycle the state between two of its writes can be shown (`trace`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from time import perf_counter
from typing import Any

from udec_ia.debug.cycle_snapshots import BUDGET, Timeline
from udec_ia.debug.cycle_trace import CycleTrace
from udec_ia.debug.stop_conditions import StopCondition
from udec_ia.debug.word_history import describe_event, find_last_hit, is_cycle
from udec_ia.deck.command_monitor import Monitor
from udec_ia.deck.deck_statements import Line, Statement, tokens
from udec_ia.deck.lines_and_calls import parse
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import poll
from udec_ia.layout import offsets as g
from udec_ia.reader.word_map import Atlas
from udec_ia.running.cycle_observer import Observer

PIECE_SECONDS = 0.02
FIRST_PIECE = 16  # cycles
Stopped = Callable[[Sequence[str]], None]
NumberedStatement = tuple[int, Statement]  # number: of the command of the deck, or of the one before it


class LeaveDebugger(BaseException):
    """The debugger is left; the run is not continued."""


class ResumeRun(BaseException):
    """The run continues from an earlier event. command: what is executed first, or ""."""

    def __init__(self, event: int, command: str = "") -> None:
        self.event, self.command = event, command


class Debugger:
    """Runs decks on `model` and stops them. out: takes what the deck prints.

    stopped: called with the reasons when a run stops; it returns when that is to go on. budget: bytes for
    copies.
    """

    def __init__(self, model: Any, out: Any, stopped: Stopped, budget: int = BUDGET) -> None:
        self.model = model
        self.monitor = Monitor(model, out)
        self.stopped = stopped
        self.timeline = Timeline(model.array, model.session.laws, budget)
        self.conditions: dict[int, StopCondition] = {}
        self.goal: int | None = None  # event to stop at, the next one where it can
        self.goal_cycle: int | None = None
        self.goal_line: int | None = None
        self.interrupted = False
        self.event = 0
        self.trace: CycleTrace | None = None
        self._atlas: tuple[Any, Atlas] | None = None
        self._array: tuple[int, MainArray] | None = None
        self._numbered = 0
        self._piece = FIRST_PIECE
        self.ended = ""  # how, in words, once it has
        self.recorded = False  # what is shown comes from a recording, and no deck is run

    # ---- running

    def run(self, statements: Sequence[Statement]) -> None:
        """Execute a deck. Raises the UdecError that ends it, after the debugger has stopped at it."""
        observers, self.model.session.observers = self.model.session.observers, [_CycleWatcher(self)]
        self._deck = [statement for statement in statements if statement.tokens]
        self._commands = [*enumerate(self._deck)]
        self._before = list(self.model.session.log.lines)
        number = 0
        try:
            while True:
                try:
                    self._execute_all(number)
                    return
                except ResumeRun as back:
                    number = self._resume(back.event, back.command)
        finally:
            self.model.session.observers = observers

    def replay(self, timeline: Timeline) -> None:
        """Show the events of a recording, in place of a run."""
        self.timeline, self.recorded, self.ended = timeline, True, "this is a recording"
        self.model.session.array = timeline.at(timeline.now)
        while True:
            self.stop([self.ended])

    def _execute_all(self, number: int) -> None:
        """The commands from `number` on."""
        self.ended = ""
        for k, (_, statement) in enumerate(self._commands[number:], number):
            self._execute(statement, k)
            if self.monitor.ended:
                break
        self.ended = "the deck has ended"
        self.stop([self.ended])

    def _resume(self, event: int, command: str) -> int:
        """Make `event` the present, followed by `command`, if it is not "". Returns the next number."""
        array = self.timeline.at(event)
        self.timeline.forget(event)
        done, rest = self._split_deck(float(array.h.cd[g.TIME]))
        place = done[-1][0] if done else 0
        inserted = [(place, self._typed_statement(command))] if command else []
        self._commands = [*done, *inserted, *rest]
        lines = [line.shown for _, statement in done for line in statement.lines]
        self.model.session.return_to(array, [*self._before, *lines])
        self.monitor.ended = False
        self.goal, self.goal_cycle, self.goal_line = event + len(inserted), None, None
        self._atlas = self._array = None  # an event of the discarded timeline may have the same number
        self.begin_conditions()
        self.show(event)
        return len(done)

    def _split_deck(self, time: float) -> tuple[list[NumberedStatement], list[NumberedStatement]]:
        """The commands that were executed, and those to come. A run that is not over is in both.

        time: of the model, s.
        """
        spans = self.timeline.spans
        if not spans:
            return [], [*enumerate(self._deck)]
        last = spans[-1]
        done = self._commands[: last.number + 1]
        place = done[-1][0]
        whole, rest = self._deck[place], [*enumerate(self._deck)][place + 1 :]
        runs = [one for one in spans if one.runs and self._commands[one.number][0] == place]
        left = count_cycles(whole) - sum(one.done for one in runs)
        if runs and left > 0:
            rest.insert(0, (place, cycle_statement(whole, left)))
        elif runs and count_cycles(whole) == 0 and not runs[-1].ended:  # it ends by its ratio or its time
            rest.insert(0, (place, rest_of_run(whole, time - runs[0].began)))
        if last.runs and rest and rest[0][0] == place:
            done[-1] = place, cycle_statement(whole, last.done)
        return done, rest

    def _typed_statement(self, command: str) -> Statement:
        """A command that is typed after the last one of the deck that was executed, at the place of that."""
        spans = self.timeline.spans
        first = self._commands[spans[-1].number if spans else 0][1].tokens[0].line
        line = Line(first.file, first.number, command)
        return Statement([line], tokens(line))

    def _execute(self, statement: Statement, number: int) -> None:
        line, timeline = statement.tokens[0].line, self.timeline
        if self.goal_line is not None and line.number >= self.goal_line:
            self.stop([f"line {line.number} comes next"])
        elif self.goal is not None and timeline.now >= self.goal:
            self.stop([])
        timeline.begin_command(line.shown.strip(), line.number, int(self.model.array.h.ci[g.MCTOT]), number)
        try:
            self.monitor.execute(statement)
        except UdecError as error:
            timeline.end_command(self.model.array)
            self.ended = "the deck has ended in an error"
            self.stop([str(error)])
            raise
        timeline.end_command(self.model.array)
        self._look()

    def cycles_ahead(self, n: int) -> int:
        """Cycles until the next look, of `n` to come."""
        if self.conditions:
            return 1
        if self.goal is not None:
            n = min(n, max(self.goal - self.timeline.now, 1))
        if self.goal_cycle is not None:
            n = min(n, max(self.goal_cycle - int(self.model.array.h.ci[g.MCTOT]), 1))
        return min(n, self._piece)

    def record_cycles(self, cycles: int, seconds: float) -> None:
        """Record the cycles of one piece of the run, and stop if a condition is met."""
        if seconds < PIECE_SECONDS:
            self._piece = 2 * max(self._piece, cycles)
        elif self._piece > 1:
            self._piece //= 2
        self.timeline.add_cycles(self.model.array, cycles)
        poll()
        self._look()

    def _look(self) -> None:
        """Stop if a condition is met, if the goal is reached, or after Ctrl-C."""
        hits = [
            f"{n}: {what}"
            for n, condition in self.conditions.items()
            if (what := condition.hit(self.model.array))
        ]
        if self.interrupted:
            hits.append("interrupted")
        there = self.goal is not None and self.timeline.now >= self.goal
        cycles = int(self.model.array.h.ci[g.MCTOT])
        if hits or there or (self.goal_cycle is not None and cycles >= self.goal_cycle):
            self.stop(hits)

    def stop(self, reasons: Sequence[str]) -> None:
        """Stop, and show the present."""
        self.goal = self.goal_cycle = self.goal_line = None
        self.interrupted = False
        self.show(self.timeline.now)
        self.stopped(reasons)

    # ---- the state that is shown

    @property
    def array(self) -> MainArray:
        """The state that is shown; it must not be changed."""
        if self.trace is not None:
            return self.trace.state
        if self.event == self.timeline.now:
            array: MainArray = self.model.array
            return array
        if self._array is None or self._array[0] != self.event:
            self._array = self.event, self.timeline.at(self.event)
        return self._array[1]

    @property
    def atlas(self) -> Atlas:
        """The words of that state, by group and field."""
        mark = self.event, self.trace.done if self.trace else -1, self.timeline.now
        if self._atlas is None or self._atlas[0] != mark:
            self._atlas = mark, Atlas(self.array.h)
        return self._atlas[1]

    @property
    def in_past(self) -> bool:
        """True if the state that is shown is not the present one."""
        return self.trace is not None or self.event < self.timeline.now

    def show(self, event: int) -> None:
        """Show the state after an `event` of the past or present. Raises UnreachableEvent."""
        if event != self.timeline.now:
            self._array = event, self.timeline.at(event)
        self.event, self.trace = event, None

    def place(self) -> str:
        """The event that is shown, as text."""
        text = describe_event(self.timeline, self.event)
        if self.trace is not None:
            text += f", within the next cycle after {self.trace.done} of {len(self.trace.writes)} writes"
        return text

    # ---- moving about

    def forward(self, events: int | None) -> tuple[bool, list[str]]:
        """Show what comes `events` later, or the next event where a condition is met.

        True if that has not been run yet: it is, when `stopped` returns. Else what has happened.
        """
        now = self.timeline.now
        if events is not None:
            self.goal = self.event + events
            if self.goal <= now:
                self.show(self.goal)
                self.goal = None
                return False, []
            return True, []
        if self.event == now:
            return True, []
        found = self._first_hit()
        self.show(found[0] if found else now)
        return (False, found[1]) if found else (not self.ended, [])

    def _first_hit(self) -> tuple[int, list[str]] | None:
        """The first event after the shown one where a condition is met, and what has happened."""
        timeline, start = self.timeline, self.event
        with self._conditions_in_past():
            for a, b in [*timeline.backwards(timeline.now)][::-1]:
                if b <= start:
                    continue
                first = timeline.at(max(a, start))
                for condition in self.conditions.values():
                    condition.begin(first)
                for event, array in timeline.through(a, b):
                    if event > start:
                        hits = [
                            what for condition in self.conditions.values() if (what := condition.hit(array))
                        ]
                        if hits:
                            return event, hits
        return None

    @contextmanager
    def _conditions_in_past(self) -> Iterator[None]:
        """Conditions may compare past states within this; afterwards they compare with the present again."""
        try:
            yield
        finally:
            self.begin_conditions()

    def begin_conditions(self) -> None:
        """Compare with the present state from now on."""
        for condition in self.conditions.values():
            condition.begin(self.model.array)

    def back(self, events: int) -> None:
        """Show the state `events` before. Raises UnreachableEvent."""
        self.show(max(self.event - events, self.timeline.earliest))

    def back_to(self, conditions: Sequence[StopCondition]) -> str:
        """Show the last event before this one where a condition is met: what happened, "" if nothing.

        From within a cycle that is the event before it, if a condition is met there.
        """
        before = self.trace is None
        with self._conditions_in_past():
            hits = [find_last_hit(self.timeline, self.event, condition, before) for condition in conditions]
        event, hit = max(hits, default=(0, ""))
        if hit:
            self.show(event)
        return hit

    def within(self, by: str, step: int) -> bool:
        """Go to the next pass, group or write of the cycle that follows, or back; False at its border.

        Raises ValueError if the event that follows, or the last one, is not a cycle.
        """
        if self.trace is None:
            event = self.event if step > 0 else self.event - 1
            self._require_cycle(event + 1, step)
            trace = CycleTrace(self.timeline.at(event), self.timeline.laws)
            self.show(event)
            self.trace = trace
            trace.go(0 if step > 0 else len(trace.writes))
        at = self.trace.next_stop(by, step)
        self.trace.go(at)
        if at in (0, len(self.trace.writes)):
            self.show(self.event + (at > 0))
            return False
        return True

    def _require_cycle(self, event: int, step: int) -> None:
        """Raise ValueError, with what can be done instead, unless `event` is a cycle that has been run."""
        if event > self.timeline.now:
            raise ValueError("the next cycle has not been run yet: step over it, then reverse-step into it")
        if event < 1:
            raise ValueError("this is the beginning, and not a cycle: nothing comes before it")
        if not is_cycle(self.timeline, event):
            span = self.timeline.span(event)
            command = f"{'the preparation of ' if span.runs else ''}line {span.line}: {span.text}"
            which, over = ("next", "step") if step > 0 else ("last", "reverse-step")
            raise ValueError(f"the {which} event is not a cycle but {command}\n{over} passes over it")

    # ---- stop conditions

    def add(self, condition: StopCondition) -> int:
        """Stop at `condition` from now on; its number."""
        self._numbered += 1
        condition.begin(self.model.array)
        self.conditions[self._numbered] = condition
        return self._numbered


class _CycleWatcher(Observer):
    """Shows the debugger a CYCLE or SOLVE in the pieces that it asks for."""

    def __init__(self, debugger: Debugger) -> None:
        self.debugger = debugger
        self._start = 0.0

    def begin(self, array: MainArray, solves: bool) -> None:
        """Add the preparation of the run to the timeline."""
        self.debugger.timeline.add_preparation(array)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the debugger is called again."""
        self._start = perf_counter()
        return self.debugger.cycles_ahead(n)

    def renumber(self, moved: Any) -> None:
        """Groups have new addresses: conditions compare with these from now on."""
        self.debugger.begin_conditions()

    def look(self, array: MainArray, cycles: int) -> None:
        """Add the cycles to the timeline."""
        self.debugger.record_cycles(cycles, perf_counter() - self._start)


def count_cycles(statement: Statement) -> int:
    """How many cycles a CYCLE asks for; 0 if it is CYCLE TIME or another command."""
    call = parse(statement)
    return int(call.positional[0]) if call.command.name == "cycle" and call.positional else 0


def cycled_time(statement: Statement) -> float | None:
    """The time t of CYCLE TIME t; None for other commands."""
    call = parse(statement)
    return float(call.named["time"]) if call.command.name == "cycle" and "time" in call.named else None


def rest_of_run(statement: Statement, passed: float) -> Statement:
    """What is left of a run without a number of cycles, of which the time `passed` (s) is over."""
    time = cycled_time(statement)
    if time is None:
        return statement
    first = statement.tokens[0].line
    line = Line(first.file, first.number, f"CYCLE TIME {max(time - passed, 0.0)!r}")
    return Statement([line], tokens(line))


def cycle_statement(statement: Statement, n: int) -> Statement:
    """A CYCLE in the place of `statement`."""
    first = statement.tokens[0].line
    line = Line(first.file, first.number, f"CYCLE {n}")
    return Statement([line], tokens(line))
