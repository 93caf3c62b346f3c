"""Observes a run of a study: where things are at first, whether the run is to stop, what its quantities are.

That changes no digit of the run: how a CYCLE is cut into pieces has no influence on its result.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Protocol, TextIO

from udec_ia.deck.command_monitor import Monitor
from udec_ia.deck.deck_statements import Statement
from udec_ia.deck.lines_and_calls import command_of
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.model import Model
from udec_ia.running.observer import Observer, between_cycles
from udec_ia.studies.quantities import InitialState, NoValue, State
from udec_ia.studies.quantity_syntax import read_quantities, read_rule
from udec_ia.studies.study_run import DECK, LATE, STOPPED, StudyRun


class Clock(Protocol):
    """Measures seconds."""

    @property
    def seconds(self) -> float:
        """Seconds until now."""


class RunObserver(Observer):
    """An observer of cycles that looks on between commands as well."""

    def command_obeyed(self, array: MainArray) -> None:
        """A command was obeyed."""


class StudyObserver(RunObserver):
    """Observes `run`, which is executed on `model`.

    clock: its processor time. rehearsal: each CYCLE or SOLVE has one cycle. over: status with which the run
    is to end, "" to go on; why: in words.
    """

    def __init__(self, run: StudyRun, model: Model, clock: Clock, rehearsal: bool = False) -> None:
        self.run, self.model, self.rehearsal = run, model, rehearsal
        self.over = self.why = ""
        self._named, self._rules = read_quantities(run.quantities), [read_rule(text) for text in run.stop]
        asked = [one.quantity for one in self._named] + [rule.quantity for rule in self._rules]
        self._start = InitialState(frozenset(one.place for one in asked if one.place is not None))
        self._done = 0  # cycles of this CYCLE or SOLVE
        self._others: list[RunObserver] = [] if rehearsal else run.observers(model)
        self._unknown: dict[str, str] = {}  # rules without a value, and why; "" for those that have had one
        self._clock = clock

    def obey(self, out: TextIO) -> None:
        """Obey the deck of the run, whose output goes to `out`."""
        name, text = self.run.file or DECK, self.run.deck
        monitor = _Monitor(self, out)
        monitor.variables.check(text.splitlines(), name)
        self.model.session.observers = (*self._others, self)
        monitor.run(text.splitlines(), name)
        monitor.stop()

    @property
    def seconds(self) -> float:
        """Processor seconds until now, without compiling."""
        return self._clock.seconds

    @property
    def size(self) -> tuple[int, float, int]:
        """Cycles and time of the model, and words in use."""
        h = self.model.array.h
        return int(h.ci[g.MCTOT]), float(h.cd[g.TIME]), int(h.ci[g.MFREE]) - 1

    def quantities(self) -> tuple[dict[str, float], list[str]]:
        """The quantities of the run, by name, with NaN for those without a value; and why they have none."""
        found, remarks, state = dict[str, float](), list[str](), self._state()
        for name, quantity in self._named:
            try:
                found[name] = quantity.value(state)
            except (NoValue, UdecError) as reason:
                found[name] = float("nan")
                remarks.append(f"{name} has no value: {_reason(reason)}")
        never = (f"{rule} has never had a value: {why}" for rule, why in self._unknown.items() if why)
        return found, [*remarks, *never]

    # ---- during the run

    def command_obeyed(self, array: MainArray) -> None:
        """See RunObserver."""
        self._start.look(array)
        for one in self._others:
            one.command_obeyed(array)

    def is_ended(self) -> bool:
        """True if the run is to end: a rule holds, or the time is up."""
        limit = math.inf if self.run.limit is None else self.run.limit
        if self.seconds > limit and not self.over:
            self.over, self.why = LATE, f"after {limit:g} s"
        return bool(self.over)

    def begin(self, array: MainArray, solves: bool) -> None:
        """See RunObserver."""
        self._done = 0
        self._start.begin(array)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """See RunObserver: until the next check of the rules."""
        if self.rehearsal:
            return min(n, 1)
        every = self.run.every
        return min(n, every - int(array.h.ci[g.MCTOT]) % every) if self._rules else n

    def look(self, array: MainArray, cycles: int) -> None:
        """See RunObserver."""
        self._done += cycles
        if self._rules and between_cycles(array.h) and array.h.ci[g.MCTOT] % self.run.every == 0:
            self._check_rules()

    def is_over(self) -> bool:
        """True if the run is to end: a rule holds, or the time is up; or if the rehearsed cycle is done."""
        return self.is_ended() or (self.rehearsal and self._done > 0)

    def _check_rules(self) -> None:
        state = self._state()
        for rule in self._rules:
            try:
                holds = rule.holds(state)
            except (NoValue, UdecError) as reason:
                self._unknown.setdefault(rule.text, _reason(reason))
                continue
            self._unknown[rule.text] = ""
            if holds and not self.over:
                self.over, self.why = STOPPED, rule.text

    def _state(self) -> State:
        return State(self.model.array, self._start, self.model.histories(), self.model.solutions())


def _reason(error: Exception) -> str:
    return error.detail if isinstance(error, UdecError) else str(error)


class ModelWithWarnings(Model):
    """A model that gives each of its warnings to `hear` as well, wherever else they go."""

    def __init__(self, hear: Callable[[str], None], *args: Any, **named: Any) -> None:
        self.hear = hear
        super().__init__(*args, **named)

    def __setattr__(self, name: str, value: Any) -> None:
        """A monitor, and a command that is undone, set `tell` to what takes warnings from then on."""
        to_wrap = name == "tell" and not isinstance(value, _TellBoth)
        super().__setattr__(name, _TellBoth(self.hear, value) if to_wrap else value)


class _TellBoth:
    def __init__(self, hear: Callable[[str], None], tell: Callable[[str], None]) -> None:
        self.hear, self.tell = hear, tell

    def __call__(self, warning: str) -> None:
        self.hear(warning)
        self.tell(warning)


class _Monitor(Monitor):
    """Reports every command to the observer, and ends when the observer does."""

    def __init__(self, observer: StudyObserver, out: TextIO) -> None:
        super().__init__(observer.model, out, values=observer.run.values)
        self._observer = observer

    def obey(self, statement: Statement) -> None:
        """As Monitor.obey, but nothing that takes long is begun when the time is up."""
        command = command_of(statement)
        if statement.tokens and (command is None or command.is_work):
            self.ended = self._observer.is_ended()
        if self.ended:
            return
        super().obey(statement)
        self._observer.command_obeyed(self._observer.model.array)
        if self._observer.over:
            self.ended = True
