"""Ctrl-C and SIGTERM wait until they can do no harm.

Python raises KeyboardInterrupt between any two of its steps: half-way through a change of the map, and in the
midst of a library that swallows it. So while a command is being obeyed (`hold`) a signal is only noted. It is
handed to the handler that was there before, which raises, as soon as the command is done. Commands that
take long let it through on the way: a run between two pieces of its cycles (`poll`), what only looks or draws
at any time (`passing`). Who presses Ctrl-C twice does not wait: the command is taken back (transaction.py).

An exception that is raised where Python cleans up, in a `__del__` or a callback of a weak reference, is lost.
So what is let through at any time stays noted until it has ended something, else it is handed on again.

Handlers belong to the main thread of a process. In another one nothing waits, for no signal comes there. A
signal that kills or is ignored is left alone: SIGTERM waits where the command line has it raise Terminated.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from typing import Any

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Terminated(KeyboardInterrupt):
    """SIGTERM has come: the run is to end as after Ctrl-C, and at a terminal the conversation, too."""


def terminate(number: int, frame: Any) -> None:
    """Handler that has SIGTERM end a run as Ctrl-C does."""
    raise Terminated


class _Waiting:
    """What all holds of the process share.

    depth: holds that are open. passing: signals are let through all the same. firm: even the second one
    waits. former: the handlers that `_arrived` stands in for. signals: those that have come, in order.
    """

    def __init__(self) -> None:
        self.depth = 0
        self.passing = False
        self.firm = False
        self.former: dict[int, Any] = {}
        self.signals: list[int] = []


_waiting = _Waiting()


def _arrived(number: int, frame: Any) -> None:
    """Note the signal, or hand it on if nothing is held or one like it is waiting already."""
    waits = _waiting.depth > 0 and not _waiting.passing
    if waits and (_waiting.firm or number not in _waiting.signals):
        _waiting.signals.append(number)
        return
    _waiting.signals[:] = [number] if _waiting.depth > 0 else []
    _waiting.former[number](number, frame)
    _waiting.signals.clear()  # it did not raise


class hold:  # noqa: N801 - a context, which reads as a verb
    """Within, signals wait. firm: also the second one of a kind, which else does not."""

    def __init__(self, firm: bool = False) -> None:
        self.firm = firm
        self.here = current_thread() is main_thread()

    def __enter__(self) -> None:
        if not self.here:
            return
        self.before = _waiting.passing, _waiting.firm
        if _waiting.depth == 0:
            for number in SIGNALS:
                handler = signal.getsignal(number)
                if callable(handler) and handler is not _arrived:
                    _waiting.former[number] = handler
                    signal.signal(number, _arrived)
        _waiting.passing, _waiting.firm = False, self.firm or _waiting.firm
        _waiting.depth += 1

    def __exit__(self, *exception: object) -> None:
        if not self.here:
            return
        _waiting.depth -= 1
        _waiting.passing, _waiting.firm = self.before
        if isinstance(exception[1], KeyboardInterrupt):
            _waiting.signals.clear()
        if _waiting.depth == 0:
            for number, handler in _waiting.former.items():
                if signal.getsignal(number) is _arrived:
                    signal.signal(number, handler)
        if _waiting.depth == 0 or _waiting.passing:
            poll()


def poll() -> None:
    """Let through what is waiting: here an interrupt does no harm."""
    if _waiting.signals and current_thread() is main_thread():
        number = _waiting.signals[0]
        _waiting.signals.clear()
        _waiting.former[number](number, sys._getframe())


@contextmanager
def passing() -> Iterator[None]:
    """Within, signals do not wait, whatever is held around."""
    if current_thread() is not main_thread():
        yield
        return
    before, _waiting.passing = _waiting.passing, True
    try:
        poll()
        yield
    except KeyboardInterrupt:
        _waiting.signals.clear()
        raise
    finally:
        _waiting.passing = before
