"""Kernels as numba makes them by itself, without the linking of linking.py.

That builds on inner parts of numba, and a release on which it was not tried may have others. Then, or where
the environment says UDEC_LINK=plain, every kernel is a compiled function of numba's own. Runs make the same
words; compiling takes about twice as long, and a cycle about 1.3 times.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from numba import njit
from numba.core import event

from udec_ia.compiling.build_choice import plain_wanted
from udec_ia.compiling.code_cache import use_cache
from udec_ia.compiling.compile_time import compiling

KERNELS: set[Callable[..., Any]] = set()  # all that are made here; laws of the user's are compiled untold


def plain_kernel(function: Callable[..., Any], folder: Path, **flags: Any) -> Any:
    """`function` compiled. folder: where its machine code is kept; flags: as njit takes them."""
    KERNELS.add(function)
    made = njit(**flags)(function)
    use_cache(made, folder)
    return made


class _Teller(event.Listener):
    """Says what compiles: numba tells when a kernel begins to be compiled, and when that has ended."""

    def __init__(self) -> None:
        self.open: list[AbstractContextManager[None]] = []

    def on_start(self, told: Any) -> None:
        """A kernel begins, or what a kernel calls: that is a part of the same wait."""
        ours = told.data["dispatcher"].py_func in KERNELS
        first = ours and all(isinstance(one, nullcontext) for one in self.open)
        self.open.append(compiling() if first else nullcontext())
        self.open[-1].__enter__()

    def on_end(self, told: Any) -> None:
        """What began last has ended."""
        self.open.pop().__exit__(None, None, None)


if plain_wanted():
    event.register("numba:compile", _Teller())
