"""Runs that go on in steps: a deck, or a state that so many cycles are to be run of.

A step ends before the first cycle of a CYCLE, and after at most EVERY cycles. How a run is cut into CYCLEs
changes no digit of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import StringIO
from typing import Any, NamedTuple

from udec_ia.debug.session import cycle_statement, cycles_of
from udec_ia.debug.timeline import Copy, copied
from udec_ia.deck.monitor import Monitor
from udec_ia.deck.reader import statements
from udec_ia.deck.variables import Values
from udec_ia.errors import UdecError
from udec_ia.layout import offsets as g

EVERY = 64  # cycles between two comparisons


class Step(NamedTuple):
    """The state that a run has come to. line: the line of the deck that is next, or was last, "" for none."""

    copy: Copy
    cycle: int
    line: str


class Run(NamedTuple):
    """model: what runs. steps: gives the states, as they are asked for."""

    model: Any
    steps: Iterator[Step]


def of_state(model: Any, cycles: int) -> Run:
    """So many cycles from where a model is."""
    return Run(model, _cycles(model, cycles))


def of_deck(model: Any, text: str, name: str = "deck", values: Values | None = None) -> Run:
    """The deck `text`, on a new model. values: of its variables, by name."""
    return Run(model, _deck(model, text, name, values))


def _cycles(model: Any, cycles: int) -> Iterator[Step]:
    yield _step(model)
    last = int(model.array.h.ci[g.MCTOT]) + cycles
    while (left := last - int(model.array.h.ci[g.MCTOT])) > 0:
        model.cycle(min(left, _to_next(model)))
        yield _step(model)


def _deck(model: Any, text: str, name: str, values: Values | None) -> Iterator[Step]:
    monitor = Monitor(model, StringIO(), values=values)
    monitor.variables.check(text.splitlines(), name)
    for statement in monitor.variables.filled(statements(text.splitlines(), name)):
        if not statement.tokens or monitor.ended:
            continue
        line = f"{name}:{statement.tokens[0].line.number}: {statement.tokens[0].line.shown.strip()}"
        word = statement.tokens[0].text.upper()
        if word.startswith("SOLV"):
            raise UdecError(
                26, f"{line} ends where the run says", "runs are compared in CYCLEs: give their number"
            )
        left = cycles_of(statement)
        if not left:
            monitor.obey(statement)
            continue
        monitor.obey(cycle_statement(statement, 0))
        yield _step(model, line)
        while left > 0:
            piece = min(left, _to_next(model))
            monitor.obey(cycle_statement(statement, piece))
            left -= piece
            yield _step(model, line)


def _to_next(model: Any) -> int:
    """Cycles until the next comparison."""
    return EVERY - int(model.array.h.ci[g.MCTOT]) % EVERY


def _step(model: Any, line: str = "") -> Step:
    return Step(copied(model.array), int(model.array.h.ci[g.MCTOT]), line)
