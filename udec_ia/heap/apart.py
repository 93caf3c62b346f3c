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

from udec_ia.heap.checked import CHECKED
from udec_ia.heap.interpreting import mode
from udec_ia.heap.loading import has_numba_side, load
from udec_ia.heap.views import Memory


def _kinds(*given: Any) -> tuple[Any, ...]:
    """The types of what is given, as numba names them."""
    load()
    from numba import typeof

    return tuple(typeof(one) for one in given)


def _address(made: Any) -> int:
    """Where the machine code of a compiled kernel is."""
    name = made.fndesc.llvm_func_name if CHECKED else made.fndesc.llvm_cfunc_wrapper_name
    return int(made.library.get_pointer_to_function(name))


def entry(kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """Where `kernel`, made by jit.apart, is for arguments of these types, compiled if it has not been."""
    if mode.python:
        return kernel
    kinds = _kinds(h, *others)
    whole: Any = kernel.whole  # type: ignore[attr-defined]
    whole.compile(kinds)
    return _address(whole.overloads[kinds])


def entry_if(wanted: bool, kernel: Callable[..., bool], h: Memory, *others: Any) -> Any:
    """The same if it is `wanted`, or compiled in this process; else 0."""
    if mode.python or wanted:
        return entry(kernel, h, *others)
    whole: Any = kernel.whole  # type: ignore[attr-defined]
    made = whole.overloads.get(_kinds(h, *others))
    return _address(made) if made else 0


def call_entry(where: Any, *args: Any) -> bool:
    """Call the kernel at `where` with arguments of the types for which that was asked for."""
    return bool(where(*args))


has_numba_side(__name__)
