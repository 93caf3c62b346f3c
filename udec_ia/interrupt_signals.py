"""Ctrl-C and SIGTERM wait until they can do no harm.

Python raises KeyboardInterrupt between any two of its steps: half-way through a change of the map, and in the
midst of a library that swallows it. So while a command is executed (`defer_signals`) a signal is only
recorded. It is handed to the former handler, which raises, as soon as the command is done. Commands that take
long let it through on the way: a run between two pieces of its cycles (`poll`), a method that only shows or
draws at any time (`allow_signals`). A second Ctrl-C does not wait: the command is undone (model/undo.py).

An exception that is raised where Python cleans up, in a `__del__` or a callback of a weak reference, is lost.
So a signal that is let through stays recorded until it has ended something; otherwise it is handed on again,
and its loss is not reported. A library may also turn it into an error of its own: an error that comes while a
signal was let through and has ended nothing is that signal.

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
    """State that all `defer_signals` of the process share.

    depth: open `defer_signals`. allowed: signals do not wait all the same. also_second: even the second one
    waits. former: the handlers that `_arrived` replaces. report_lost: the hook that `_lost` replaces.
    signals: those that have come, in order. raised: what the last handler has raised.
    """

    def __init__(self) -> None:
        self.depth = 0
        self.allowed = False
        self.also_second = False
        self.former: dict[int, Any] = {}
        self.report_lost = sys.unraisablehook
        self.signals: list[int] = []
        self.raised: BaseException | None = None

    def has_raised(self, error: object) -> bool:
        """True if `error` comes from a signal."""
        return isinstance(error, KeyboardInterrupt) or (error is not None and error is self.raised)

    def ended(self, error: object) -> None:
        """Record that `error` ends something: if it comes from a signal, this is not handed on again."""
        if self.has_raised(error):
            self.signals.clear()
            self.raised = None

    def turned_into(self, error: BaseException) -> BaseException | None:
        """The exception of a signal that a library has turned into `error`, or None."""
        turned = self.signals and not self.has_raised(error)
        return self.raised if turned else None


_waiting = _Waiting()


def _arrived(number: int, frame: Any) -> None:
    """Record the signal, or hand it on outside of `defer_signals` or if one of its kind waits already."""
    waits = _waiting.depth > 0 and not _waiting.allowed
    if waits and (_waiting.also_second or number not in _waiting.signals):
        _waiting.signals.append(number)
        return
    _waiting.signals[:] = [number] if _waiting.depth > 0 else []
    try:
        _waiting.former[number](number, frame)
    except BaseException as error:
        _waiting.raised = error
        raise
    _waiting.signals.clear()


def _lost(unraisable: sys.UnraisableHookArgs) -> None:
    """Report an exception that was lost, unless it comes from a signal that is handed on again."""
    if not (_waiting.signals and _waiting.has_raised(unraisable.exc_value)):
        _waiting.report_lost(unraisable)


class defer_signals:  # noqa: N801 - a context, which reads as a verb
    """Within, signals wait. also_second: even the second one of a kind, which else does not."""

    def __init__(self, also_second: bool = False) -> None:
        self.also_second = also_second
        self.here = current_thread() is main_thread()

    def __enter__(self) -> None:
        if not self.here:
            return
        self.before = _waiting.allowed, _waiting.also_second
        if _waiting.depth == 0:
            for number in SIGNALS:
                handler = signal.getsignal(number)
                if callable(handler) and handler is not _arrived:
                    _waiting.former[number] = handler
                    signal.signal(number, _arrived)
            if sys.unraisablehook is not _lost:  # as it is after a signal has come within these lines
                _waiting.report_lost, sys.unraisablehook = sys.unraisablehook, _lost
        _waiting.allowed, _waiting.also_second = False, self.also_second or _waiting.also_second
        _waiting.depth += 1

    def __exit__(self, *exception: object) -> None:
        if not self.here:
            return
        _waiting.depth -= 1
        _waiting.allowed, _waiting.also_second = self.before
        _waiting.ended(exception[1])
        if _waiting.depth == 0:
            for number, handler in _waiting.former.items():
                if signal.getsignal(number) is _arrived:
                    signal.signal(number, handler)
            if sys.unraisablehook is _lost:
                sys.unraisablehook = _waiting.report_lost
        if _waiting.depth == 0 or _waiting.allowed:
            poll()


def poll() -> None:
    """Hand on a waiting signal: here an interrupt does no harm."""
    if _waiting.signals and current_thread() is main_thread():
        number = _waiting.signals[0]
        _waiting.signals.clear()
        _waiting.raised = None
        _waiting.former[number](number, sys._getframe())


def dealt_with(error: BaseException) -> None:
    """Record that `error` was handled: if it comes from a signal, this is not handed on again."""
    _waiting.ended(error)


@contextmanager
def allow_signals() -> Iterator[None]:
    """Within, signals do not wait, also inside `defer_signals`."""
    if current_thread() is not main_thread():
        yield
        return
    before, _waiting.allowed = _waiting.allowed, True
    try:
        poll()
        yield
    except BaseException as error:
        raised = _waiting.turned_into(error)
        _waiting.ended(raised or error)
        if raised is not None:
            raise raised from error
        raise
    finally:
        _waiting.allowed = before
