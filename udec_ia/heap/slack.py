"""Memory that has been freed, given back to the system.

The C library keeps what is free between arrays that stay, for the next ones; of large models that is as much
as the arrays themselves. Between two parts of a long look it is given back. Where the library is not GNU's,
nothing is done.
"""

from __future__ import annotations

import ctypes
from contextlib import suppress


def give_back() -> None:
    """Give back to the system what nothing uses."""
    with suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
