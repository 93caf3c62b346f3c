"""numba, which is loaded when the first kernel is to run compiled, and not before.

To load it takes longer than to look into a restart file, and no look calls a kernel. So what numba must be
told of our functions, as how `iget` is compiled, stands in a file of its own beside each: accessors_numba.py
beside accessors.py. A file that has one says so, and `load` loads what there is.
"""

from __future__ import annotations

import os
from importlib import import_module

DISABLED = os.environ.get("NUMBA_DISABLE_JIT", "") not in ("", "0")  # as numba reads it: nothing is compiled
_beside: list[str] = []


def has_numba_side(module: str) -> None:
    """Beside `module` there is a file that tells numba of it."""
    _beside.append(f"{module}_numba")


def load() -> None:
    """Tell numba of all that is loaded."""
    while _beside:
        import_module(_beside[0])
        _beside.pop(0)  # not before: an interrupt may come between
