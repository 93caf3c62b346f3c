"""The decorators that make kernels: functions that are compiled when they are first called."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, update_wrapper
from pathlib import Path
from typing import Any, TypeVar, cast

from udec_ia.compiling.build_choice import CHECKED, DISABLED, checked_build, load, numba_form, plain_wanted
from udec_ia.compiling.interpreted_kernels import ObservedMemory, interpreted, mode

F = TypeVar("F", bound=Callable[..., Any])


@numba_form("udec_ia.compiling.instructions_numba:type_of_kernels")
class Kernel:
    """A kernel: compiled when it is first called, or run as Python (interpreted_kernels.py).

    inline, outlined, counted: as the decorators below set them.
    """

    def __init__(self, function: Callable[..., Any], inline: bool, outlined: bool, counted: bool) -> None:
        update_wrapper(self, function)
        self.py_func, self.inline, self.outlined, self.counted = function, inline, outlined, counted

    def __call__(self, *args: Any) -> Any:
        if mode.python:
            if mode.calls is None:
                return self.py_func(*args)
            mode.calls.append((self, args))
            with interpreted():  # what it calls is compiled with it
                return self.py_func(*args)
        if args and args[0].__class__ is ObservedMemory:
            with interpreted():
                return self.py_func(*args)
        return self.dispatcher(*args)

    @cached_property
    def compiled(self) -> Any:
        """The compiled function: a LinkedKernel, or numba's own dispatcher on the plain path.

        Without fastmath, contraction and exceptions for divisions, so that interpreted runs agree bit for
        bit.
        """
        load()
        from udec_ia.compiling.cache_folder import cache_folder
        from udec_ia.compiling.code_cache import use_cache

        layer = Path(self.py_func.__code__.co_filename).parent.name  # two may have a file of the same name
        folder = cache_folder() / layer
        flags = {"error_model": "numpy", "forceinline": self.inline, "_nrt": self.counted}
        if plain_wanted():
            from numba import njit

            plain = njit(**flags)(self.py_func)
            use_cache(plain, folder)
            return plain
        from udec_ia.compiling.kernel_linking import LinkedKernel

        return LinkedKernel(self.py_func, folder, self.outlined, **flags)

    @cached_property
    def dispatcher(self) -> Any:
        """What Python calls."""
        return getattr(self.compiled, "dispatcher", self.compiled)


def kernel(function: F, inline: bool = False, outlined: bool = False) -> F:
    """Have `function` compiled on first use, for the word scheme of the arrays it is called with."""
    if CHECKED:
        return cast(F, checked_build("access_checks").CheckedKernel(function, inline, outlined))
    return function if DISABLED else cast(F, Kernel(function, inline, outlined, True))


def inlined(function: F) -> F:
    """A kernel that becomes a part of its callers: for what the cycle does once for every contact."""
    return kernel(function, inline=True)


def outlined(function: F) -> F:
    """A kernel that other kernels call by its address (non_inlined_calls.py)."""
    return kernel(function, outlined=True)


def over_arrays(function: F) -> F:
    """A kernel over arrays that its caller keeps: it makes none, and references to them are not counted.

    To count takes ten times as long as to look at a corner, where arrays come by the dozen.
    """
    return function if DISABLED else cast(F, Kernel(function, False, False, False))
