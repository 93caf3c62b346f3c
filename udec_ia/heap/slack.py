"""Memory that has been freed, given back to the system.

The C library keeps what is free between arrays that stay, for the next ones; of large models that is as much
as the arrays themselves. Between two parts of a long look it is given back. Where the library is not GNU's,
nothing is done.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from typing import Any


def give_back() -> None:
    """Give back to the system what nothing uses."""
    _trim()(0)


@cache
def _trim() -> Callable[[int], Any]:
    """The routine of the C library that does so."""
    with suppress(OSError, AttributeError, TypeError):
        return ctypes.CDLL(None).malloc_trim
    return lambda _: None
