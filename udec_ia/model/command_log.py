"""The log of a session: the commands that were executed, which can be written as the lines of a deck.

The log has the calls of commands given in Python, which become lines on request, and the lines of decks.
Successive CYCLEs of so many cycles are one line.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from udec_ia.deck.calls_as_lines import spell

PLAIN = (bool, int, float, str, np.generic, type(None))


class Step(NamedTuple):
    """A call of a command, which can be repeated."""

    method: Callable[..., object]
    args: tuple[Any, ...]
    named: dict[str, Any]

    @property
    def lines(self) -> list[str]:
        """The command as lines of a deck."""
        return spell(*self)

    @property
    def has_constants_only(self) -> bool:
        """True if its arguments cannot be changed from outside."""
        return all(map(_is_plain, (*self.args, *self.named.values())))


def _is_plain(value: Any) -> bool:
    return isinstance(value, PLAIN) or (type(value) is tuple and all(map(_is_plain, value)))


class CommandLog:
    """steps: commands, or lines of a deck. cycles: number of cycles of the CYCLEs at the end, or None."""

    def __init__(self, lines: Sequence[str] = ()) -> None:
        self.steps: list[str | Step] = [*lines]
        self.cycles: int | None = None

    def add(self, method: Callable[..., object], args: Sequence[Any], named: dict[str, Any]) -> None:
        """Add a command that was executed."""
        if method.__name__ == "cycle" and named.get("time") is None:
            self.cycles = (self.cycles or 0) + int(args[0] if args else named["n"])
            return
        step = Step(method, tuple(args), named)
        self.add_lines([step] if step.has_constants_only else step.lines)

    def add_lines(self, lines: Sequence[str | Step]) -> None:
        """Add lines of a deck that were executed."""
        if self.cycles is not None:
            self.steps.append(f"CYCLE {self.cycles}")
        self.steps += lines
        self.cycles = None

    @property
    def lines(self) -> list[str]:
        """All commands as lines of a deck."""
        last = [] if self.cycles is None else [f"CYCLE {self.cycles}"]
        return [*self._step_lines(), *last]

    def __getstate__(self) -> dict[str, Any]:
        """For pickle and copy: commands become lines."""
        return {"steps": self._step_lines(), "cycles": self.cycles}

    def _step_lines(self) -> list[str]:
        steps = ([one] if isinstance(one, str) else one.lines for one in self.steps)
        return list(chain.from_iterable(steps))
