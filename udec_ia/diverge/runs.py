"""Runs that go on in steps: a deck, or a state that so many cycles are to be run of.

A step ends before the first cycle of a CYCLE, and after at most EVERY cycles. How a run is cut into CYCLEs
changes no digit of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

from udec_ia.debug.debugged_run import count_cycles, cycle_statement
from udec_ia.debug.timeline import StateCopy, copy_state
from udec_ia.deck.command_monitor import RESTART_FILE, Monitor
from udec_ia.deck.deck_statements import Line, Statement, statements, tokens
from udec_ia.deck.deck_variables import Values
from udec_ia.deck.lines_and_calls import parse
from udec_ia.kernels.drive.unbalanced_force import at_rest
from udec_ia.layout import offsets as g
from udec_ia.running.history_series import SOLVE_LIMIT

EVERY = 60  # cycles between two comparisons; a multiple of those after which SOLVE looks for rest


class Step(NamedTuple):
    """The state that a run has come to. line: the line of the deck that is next, or was last, "" for none."""

    copy: StateCopy
    cycle: int
    line: str


class Run(NamedTuple):
    """model: what runs. steps: gives the states, as they are asked for."""

    model: Any
    steps: Iterator[Step]


def of_state(model: Any, cycles: int) -> Run:
    """So many cycles from where a model is."""
    return Run(model, _cycles(model, cycles))


def of_deck(
    model: Any, text: str, name: str = "deck", values: Values | None = None, beside: Sequence[Path] = ()
) -> Run:
    """The deck `text`, on a new model. values: of its variables, by name.

    beside: folders of files that RESTART finds if the deck wrote none.
    """
    return Run(model, _deck(_Monitor(model, values, beside), text, name))


class _Monitor(Monitor):
    """Obeys a deck whose own files are in a folder that had none."""

    def __init__(self, model: Any, values: Values | None, beside: Sequence[Path]) -> None:
        super().__init__(model, StringIO(), values=values)
        self._beside = beside

    def place(self, command: str, name: str | None) -> Path | None:
        """As Monitor.place; a restart file that is not there is looked for in the other folders."""
        if command == "restart" and not (self.model.session.out / (name or RESTART_FILE)).exists():
            for folder in self._beside:
                if (folder / (name or RESTART_FILE)).exists():
                    return folder / (name or RESTART_FILE)
        return super().place(command, name)


def _cycles(model: Any, cycles: int) -> Iterator[Step]:
    yield _step(model)
    last = int(model.array.h.ci[g.MCTOT]) + cycles
    while (left := last - int(model.array.h.ci[g.MCTOT])) > 0:
        model.cycle(min(left, _to_next(model)))
        yield _step(model)


def _deck(monitor: Monitor, text: str, name: str) -> Iterator[Step]:
    model: Any = monitor.model
    monitor.variables.check(text.splitlines(), name)
    for statement in monitor.variables.filled(statements(text.splitlines(), name)):
        if not statement.tokens or monitor.ended:
            continue
        line = f"{name}:{statement.tokens[0].line.number}: {statement.tokens[0].line.shown.strip()}"
        ratio, left = _rest_of(statement)
        if not left:
            monitor.obey(statement)
            continue
        monitor.obey(cycle_statement(statement, 0))
        yield _step(model, line)
        while left > 0:
            piece = min(left, _to_next(model))
            monitor.obey(_part(statement, ratio, piece))
            left -= piece
            yield _step(model, line)
            if ratio is not None and at_rest(model.array.h, ratio):
                break


def _rest_of(statement: Statement) -> tuple[float | None, int]:
    """The force ratio that a SOLVE asks for, and how many cycles it or a CYCLE has at most; 0 for others.

    SOLVE ... STATIC is one of the others: all stands still at its end, so it cannot be done in parts. So is
    SOLVE ... MEAN, which is seldom.
    """
    call = parse(statement)
    if call.command.name != "solve":
        return None, count_cycles(statement)
    if call.named.get("static") or call.named.get("criterion") == "mean":
        return None, 0
    return float(call.positional[0]), int(call.named.get("limit", SOLVE_LIMIT))


def _part(statement: Statement, ratio: float | None, n: int) -> Statement:
    """So many cycles of a CYCLE or SOLVE. A SOLVE in such parts ends after the same cycle as a whole one."""
    if ratio is None:
        return cycle_statement(statement, n)
    first = statement.tokens[0].line
    line = Line(first.file, first.number, f"SOLVE {ratio!r} LIMIT {n}")
    return Statement([line], tokens(line))


def _to_next(model: Any) -> int:
    """Cycles until the next comparison."""
    return EVERY - int(model.array.h.ci[g.MCTOT]) % EVERY


def _step(model: Any, line: str = "") -> Step:
    return Step(copy_state(model.array), int(model.array.h.ci[g.MCTOT]), line)
