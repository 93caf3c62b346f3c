"""How memory is asked for in compiled kernels (ahead.py)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from udec_ia.heap.accessors_numba import which_type
from udec_ia.heap.ahead import fetch
from udec_ia.heap.array import LINE

READ, KEEP, DATA = 0, 3, 1  # what llvm.prefetch wants to know: to be read, often, no instructions


@intrinsic
def _prefetch(typing: Any, array: Any, index: Any) -> Any:
    """The machine's instruction for it, for element `index` of `array`."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        place = builder.gep(args[0], [args[1]])
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [place.type, number, number, number])
        instruction = builder.module.declare_intrinsic("llvm.prefetch", [place.type], kind)
        builder.call(instruction, [place, *(number(n) for n in (READ, KEEP, DATA))])
        return context.get_dummy_value()

    return types.void(array, types.int64), generate


@overload(fetch)
def _fetch(h: Any, iad: Any, nv: Any, beyond: Any = 0) -> Callable[..., Any]:
    j, _ = which_type(h)
    step = LINE * 8 // h.dtypes[0].bitwidth

    def impl(h: Any, iad: Any, nv: Any, beyond: Any = 0) -> None:
        first = iad - 1 + beyond * nv[j]
        for word in range(0, nv[j], step):
            _prefetch(h.ia, first + word)

    return impl
