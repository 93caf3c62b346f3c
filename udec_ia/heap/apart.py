"""Kernels that are called where they are, instead of being taken in by every whole that needs them.

What is long and called seldom would be translated once more in each of them (linking.py). Such a kernel is
translated once, as a whole of its own, and only where it is needed; Python asks for the address of its
machine code (`entry`) and hands it to the kernels that need it, which call what lies there (`call_entry`). A
call costs what it costs in C. All such kernels return True or False. Kernels that are not compiled are handed
the function itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from udec_ia.heap.checked import CHECKED
from udec_ia.heap.interpreting import mode
from udec_ia.heap.loading import has_numba_side, load
from udec_ia.heap.views import Memory

_found: dict[Any, int] = {}  # by kernel and kinds of its arguments: numba takes its time to name their types


def _kind(given: Any) -> Any:
    """What decides which type numba has for what is `given`: never the same for two types."""
    if isinstance(given, tuple):
        return tuple(_kind(one) for one in given)
    if isinstance(given, np.ndarray):
        how = given.flags
        return given.dtype, given.ndim, how.c_contiguous, how.f_contiguous, how.aligned, how.writeable
    return type(given)


def _address(kernel: Any, *given: Any) -> int:
    """Where the machine code of `kernel` is for arguments of the types of `given`."""
    load()
    from numba import typeof

    kinds = tuple(typeof(one) for one in given)
    kernel.whole.compile(kinds)
    made = kernel.whole.overloads[kinds]
    name = made.fndesc.llvm_func_name if CHECKED else made.fndesc.llvm_cfunc_wrapper_name
    return int(made.library.get_pointer_to_function(name))


def entry(kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """Where `kernel`, made by jit.apart, is for arguments of these types, compiled if it has not been."""
    if mode.python:
        return kernel
    key = kernel, _kind((h, *others))
    if key not in _found:
        _found[key] = _address(kernel, h, *others)
    return _found[key]


def entry_if(wanted: bool, kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """The same if it is `wanted`, or has been in this process; else 0."""
    known = wanted or mode.python or (kernel, _kind((h, *others))) in _found
    return entry(kernel, h, *others) if known else 0


def call_entry(where: Any, *args: Any) -> bool:
    """Call the kernel at `where` with arguments of the types for which that was asked for."""
    return bool(where(*args))


has_numba_side(__name__)
