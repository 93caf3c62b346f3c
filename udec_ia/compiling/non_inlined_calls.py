"""Outlined calls: kernels that other kernels call by the address of their machine code.

A kernel that is long and seldom called is thus translated once, and only where it is needed. Python asks for
its address (`entry`) and hands it to the kernels that call it (`call_entry`). A call costs what it costs in
C. All such kernels return True or False. Kernels that are not compiled are handed the function itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from udec_ia.compiling.build_choice import CHECKED, load, numba_form
from udec_ia.compiling.interpreted_kernels import mode
from udec_ia.compiling.kernel_memory import Memory

_addresses: dict[Any, int] = {}  # by kernel and types of its arguments


def _types(*values: Any) -> tuple[Any, ...]:
    """The types that numba gives to arguments."""
    load()
    from numba import typeof

    return tuple(typeof(value) for value in values)


def _address(kernel: Any, types: tuple[Any, ...]) -> int:
    """Address of the machine code of `kernel` for arguments of some types."""
    kernel.dispatcher.compile(types)
    compiled = kernel.dispatcher.overloads[types]
    names = compiled.fndesc
    name = names.llvm_func_name if CHECKED else names.llvm_cfunc_wrapper_name
    return int(compiled.library.get_pointer_to_function(name))


def entry(kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """Address of `kernel`, an outlined one, for arguments of these types, compiled if it has not been."""
    if mode.python:
        if mode.calls is not None:
            mode.calls.append((kernel, (h, *others)))
        return kernel
    types = _types(h, *others)
    if (kernel, types) not in _addresses:
        _addresses[kernel, types] = _address(kernel, types)
    return _addresses[kernel, types]


def entry_if(wanted: bool, kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """The same if it is `wanted`, or was in this process before; else 0."""
    if mode.python and not wanted:
        return kernel
    return entry(kernel, h, *others) if wanted or (kernel, _types(h, *others)) in _addresses else 0


@numba_form("udec_ia.compiling.instructions_numba:compile_call_entry")
def call_entry(where: Any, *args: Any) -> bool:
    """Call the kernel at `where` with arguments of the types for which that was asked for."""
    return bool(where(*args))
