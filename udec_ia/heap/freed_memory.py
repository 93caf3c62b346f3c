"""Memory that has been freed: kept for the next arrays, or given back to the system.

The C library keeps what is free between arrays that stay, for the next ones; of large models that is as much
as the arrays themselves. Between two parts of a long look it is given back. Within a part it is worth
keeping: what a look makes and frees by the thousand are arrays of megabytes, and the system clears all that
it hands out again. Where the library is not GNU's, nothing is done.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from typing import Any

TRIM_THRESHOLD, MMAP_MAX = -1, -4  # numbers of malloc.h; the second: of arrays that the system gives singly
KEPT_LIMIT = 2**30  # bytes that are kept, of all arrays together


def keep_freed() -> None:
    """From now on keep what is freed until `give_back`: for a process that does nothing but one long look."""
    for what, size in ((MMAP_MAX, 0), (TRIM_THRESHOLD, KEPT_LIMIT)):
        _routine("mallopt")(what, size)


def give_back() -> None:
    """Give back to the system what nothing uses."""
    _routine("malloc_trim")(0)


@cache
def _routine(name: str) -> Callable[..., Any]:
    """A routine of the C library; one that does nothing where there is none."""
    with suppress(OSError, AttributeError, TypeError):
        routine: Callable[..., Any] = getattr(ctypes.CDLL(None), name)
        return routine
    return lambda *_: None
