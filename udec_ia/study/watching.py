"""A run of a study is watched: where things are at first, whether it is to stop, what it came to.

That changes no digit of the run: how a CYCLE is cut into pieces has no influence on what it does.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TextIO

from udec_ia.deck.command_monitor import Monitor
from udec_ia.deck.deck_statements import Statement
from udec_ia.deck.lines_and_calls import command_of
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.model import Model
from udec_ia.running import observer as running
from udec_ia.study.clock import Clock
from udec_ia.study.observed import NoValue, Start, State
from udec_ia.study.reading import read, read_rule
from udec_ia.study.runs import DECK, LATE, STOPPED, Run


class Observer:
    """Watches `run`, which is run on `model`.

    rehearsal: a CYCLE or SOLVE has one cycle. over: status with which the run is to end, "" while it is not;
    why: in words.
    """

    def __init__(self, run: Run, model: Model, rehearsal: bool = False) -> None:
        self.run, self.model, self.rehearsal = run, model, rehearsal
        self.over = self.why = ""
        self._named, self._rules = read(run.quantities), [read_rule(text) for text in run.stop]
        asked = [one.quantity for one in self._named] + [rule.quantity for rule in self._rules]
        self._start = Start(frozenset(one.place for one in asked if one.place is not None))
        self._observers = () if rehearsal else run.observers(model)
        self._unknown: dict[str, str] = {}  # rules without a value, and why; "" for those that have had one
        self._clock = Clock()

    def obey(self, out: TextIO) -> None:
        """Obey the deck of the run, whose output goes to `out`."""
        name, text = self.run.file or DECK, self.run.deck
        monitor = _Monitor(self, out)
        monitor.variables.check(text.splitlines(), name)
        self.model.session.observers = (*self._observers, _Eye(self))
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
        """What is asked for, by name, with NaN for what has no value; and why it has none."""
        found, remarks, state = dict[str, float](), list[str](), self._state()
        for name, quantity in self._named:
            try:
                found[name] = quantity.value(state)
            except (NoValue, UdecError) as reason:
                found[name] = float("nan")
                remarks.append(f"{name} has no value: {_said(reason)}")
        never = (f"{rule} has never had a value: {why}" for rule, why in self._unknown.items() if why)
        return found, [*remarks, *never]

    # ---- what happens on the way

    def obeyed(self) -> None:
        """A command was obeyed."""
        self._start.look(self.model.array)

    def is_over(self) -> bool:
        """True if nothing more is to be done: a rule holds, or the time is up."""
        limit = math.inf if self.run.limit is None else self.run.limit
        if self.seconds > limit and not self.over:
            self.over, self.why = LATE, f"after {limit:g} s"
        return bool(self.over)

    def begin(self) -> None:
        """A CYCLE or SOLVE begins."""
        self._start.begin(self.model.array)

    def piece(self, n: int) -> int:
        """Cycles until the next look, of `n` to come."""
        if self.rehearsal:
            return min(n, 1)
        every = self.run.every
        return min(n, every - int(self.model.array.h.ci[g.MCTOT]) % every) if self._rules else n

    def ran(self) -> None:
        """A piece of a CYCLE or SOLVE is over."""
        h = self.model.array.h
        whole = h.ci[g.JPHASE] == g.AT_BLOCKS and h.ci[g.NERR] == 0
        if self._rules and whole and h.ci[g.MCTOT] % self.run.every == 0:
            self._look_at_rules()

    def _look_at_rules(self) -> None:
        state = self._state()
        for rule in self._rules:
            try:
                holds = rule.holds(state)
            except (NoValue, UdecError) as reason:
                self._unknown.setdefault(rule.text, _said(reason))
                continue
            self._unknown[rule.text] = ""
            if holds and not self.over:
                self.over, self.why = STOPPED, rule.text

    def _state(self) -> State:
        return State(self.model.array, self._start, self.model.histories(), self.model.solutions())


def _said(reason: Exception) -> str:
    return reason.detail if isinstance(reason, UdecError) else str(reason)


class Heard(Model):
    """A model that has `hear` hear each of its warnings, whoever takes them besides."""

    def __init__(self, hear: Callable[[str], None], *args: Any, **named: Any) -> None:
        self.hear = hear
        super().__init__(*args, **named)

    def __setattr__(self, name: str, value: Any) -> None:
        """A monitor, and whoever takes back a command, sets `tell` to what takes warnings from then on."""
        heard = name == "tell" and not isinstance(value, _Ear)
        super().__setattr__(name, _Ear(self.hear, value) if heard else value)


class _Ear:
    def __init__(self, hear: Callable[[str], None], tell: Callable[[str], None]) -> None:
        self.hear, self.tell = hear, tell

    def __call__(self, warning: str) -> None:
        self.hear(warning)
        self.tell(warning)


class _Monitor(Monitor):
    """Tells the observer of every command, and ends when it says so."""

    def __init__(self, observer: Observer, out: TextIO) -> None:
        super().__init__(observer.model, out, values=observer.run.values)
        self._observer = observer

    def obey(self, statement: Statement) -> None:
        """As Monitor.obey, but nothing that takes long is begun when the time is up."""
        command = command_of(statement)
        if statement.tokens and (command is None or command.is_work):
            self.ended = self._observer.is_over()
        if self.ended:
            return
        super().obey(statement)
        self._observer.obeyed()
        if self._observer.over:
            self.ended = True


class _Eye(running.Observer):
    """Ends a CYCLE or SOLVE when the observer of the study says so."""

    def __init__(self, observer: Observer) -> None:
        self.observer, self.done = observer, 0

    def begin(self, array: MainArray, solves: bool) -> None:
        """See running.Observer."""
        self.done = 0
        self.observer.begin()

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """See running.Observer."""
        return self.observer.piece(n)

    def look(self, array: MainArray, cycles: int) -> None:
        """See running.Observer."""
        self.done += cycles
        self.observer.ran()

    def is_over(self) -> bool:
        """See running.Observer."""
        return (self.observer.rehearsal and self.done > 0) or self.observer.is_over()
