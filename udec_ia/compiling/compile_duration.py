"""Time that goes into compiling kernels: it is announced in the log, and left out of the rate of a run.

code_cache.py calls `begin_compiling` when a kernel was found neither in memory nor on disk. While a kernel is
compiled, Python looks for garbage less often: numba makes much that stays.
"""

from __future__ import annotations

import gc
import logging
from time import monotonic

RARELY = 100  # collections of younger objects for one of all objects
STRETCH = 2.0  # seconds without compiling after which it is announced again
log = logging.getLogger("udec_ia")


class _Account:
    """What this process has compiled. numba compiles one kernel at a time, whatever threads there are."""

    seconds = 0.0  # of all kernels that are ready
    depth = 0  # kernels that are being compiled, each for the one before
    began: float | None = None  # when the first of them was begun
    ended = float("-inf")  # when the last one was ready
    thresholds = gc.get_threshold()  # when nothing is compiled


def begin_compiling() -> None:
    """A kernel begins to be compiled; the first one of a stretch is announced in the log udec_ia."""
    _Account.depth += 1
    if _Account.depth == 1:
        _Account.began, _Account.thresholds = monotonic(), gc.get_threshold()
        gc.set_threshold(*_Account.thresholds[:2], RARELY)
        if _Account.began - _Account.ended > STRETCH:
            log.warning("compiling once for this machine, up to a minute ...", extra={"key": "compiling"})


def end_compiling() -> None:
    """The kernel is ready, or was interrupted."""
    _Account.depth -= 1
    if _Account.depth == 0 and _Account.began is not None:
        gc.set_threshold(*_Account.thresholds)
        _Account.ended = monotonic()
        _Account.seconds += _Account.ended - _Account.began
        _Account.began = None


def compile_seconds() -> float:
    """Time in s that this process has spent compiling kernels."""
    return _Account.seconds


def working_time() -> float:
    """Elapsed time in s without compilation."""
    now = monotonic() if _Account.began is None else _Account.began
    return now - _Account.seconds
