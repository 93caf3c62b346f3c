"""The decorators that make a kernel of a routine that works on the memory."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from udec_ia.heap.checked import CHECKED, named
from udec_ia.heap.guarding import Guarded
from udec_ia.heap.kernel import Kernel
from udec_ia.heap.loading import DISABLED

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F, inline: bool = False, apart: bool = False) -> F:
    """Have `function` compiled on first use, for the word scheme of the arrays it is called with."""
    if CHECKED:
        own, number = named(function)
        return cast(F, Guarded(own if DISABLED else Kernel(own, inline, apart, False), own, number))
    return function if DISABLED else cast(F, Kernel(function, inline, apart, False))


def inlined(function: F) -> F:
    """A kernel that becomes a part of its callers: for what the cycle does once for every contact."""
    return kernel(function, inline=True)


def apart(function: F) -> F:
    """A kernel that is not taken in by others, which call it where it is: see heap/apart.py."""
    return kernel(function, apart=True)
