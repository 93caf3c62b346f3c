"""Time that goes into compiling kernels: whoever waits for it is told, and the clock of a run leaves it out.

A kernel is compiled in the middle of the command that first needs it, and a run that meets its first
deformable block, SOLVE or law may stand still for half a minute. linking.py calls `compiling` whenever a
kernel was found neither in memory nor on disk, and at no other time.
"""

from __future__ import annotations

import gc
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

RARELY = 100  # numba makes much that stays: looking for garbage among all of it takes a tenth of the time
STRETCH = 2.0  # seconds without compiling after which it is told anew
log = logging.getLogger("udec_ia")


class _Account:
    """What this process has compiled. numba compiles one kernel at a time, whatever threads there are."""

    seconds = 0.0  # of all kernels that are ready
    began: float | None = None  # when the one that is being compiled was begun
    ended = float("-inf")  # when the last one was ready


@contextmanager
def compiling() -> Iterator[None]:
    """A kernel is compiled inside; the first one of a stretch is announced in the log udec_ia."""
    _Account.began = monotonic()
    if _Account.began - _Account.ended > STRETCH:
        log.warning("compiling once for this machine, up to a minute ...")
    often = gc.get_threshold()
    gc.set_threshold(*often[:2], RARELY)
    try:
        yield
    finally:
        gc.set_threshold(*often)
        _Account.ended = monotonic()
        _Account.seconds += _Account.ended - _Account.began
        _Account.began = None


def compile_seconds() -> float:
    """Time in s that this process has spent compiling kernels."""
    return _Account.seconds


def working_time() -> float:
    """Reading of a clock in s that stands still while a kernel is being compiled."""
    now = monotonic() if _Account.began is None else _Account.began
    return now - _Account.seconds
