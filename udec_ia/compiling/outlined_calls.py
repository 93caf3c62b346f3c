"""Outlined calls: kernels that other kernels call by the address of their machine code.

A kernel that is long and seldom called would be translated once more in each kernel that calls it
(linking.py). An outlined kernel is translated once, and only where it is needed. Python asks for the address
of its machine code (`entry`) and hands it to the kernels that need it, which call what lies there
(`call_entry`). A call costs what it costs in C. All such kernels return True or False. Kernels that are not
compiled are handed the function itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from udec_ia.compiling.build_choice import CHECKED
from udec_ia.compiling.interpreting import mode
from udec_ia.compiling.kernel_memory import Memory
from udec_ia.compiling.numba_loading import load, numba_form

_found: dict[Any, int] = {}  # by kernel and types of its arguments: numba takes its time to name their types


def _type(given: Any) -> Any:
    """What decides which type numba has for what is `given`: never the same for two types."""
    if isinstance(given, tuple):
        return tuple(_type(one) for one in given)
    if isinstance(given, np.ndarray):
        how = given.flags
        return given.dtype, given.ndim, how.c_contiguous, how.f_contiguous, how.aligned, how.writeable
    return type(given)


def _address(kernel: Any, *given: Any) -> int:
    """Where the machine code of `kernel` is for arguments of the types of `given`."""
    load()
    from numba import typeof

    types = tuple(typeof(one) for one in given)
    kernel.whole.compile(types)
    made = kernel.whole.overloads[types]
    name = made.fndesc.llvm_func_name if CHECKED else made.fndesc.llvm_cfunc_wrapper_name
    return int(made.library.get_pointer_to_function(name))


def entry(kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """Where `kernel`, an outlined one, is for arguments of these types, compiled if it has not been."""
    if mode.python:
        return kernel
    key = kernel, _type((h, *others))
    if key not in _found:
        _found[key] = _address(kernel, h, *others)
    return _found[key]


def entry_if(wanted: bool, kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """The same if it is `wanted`, or has been in this process; else 0."""
    known = wanted or mode.python or (kernel, _type((h, *others))) in _found
    return entry(kernel, h, *others) if known else 0


@numba_form("udec_ia.compiling.instructions_numba:compile_call_entry")
def call_entry(where: Any, *args: Any) -> bool:
    """Call the kernel at `where` with arguments of the types for which that was asked for."""
    return bool(where(*args))
