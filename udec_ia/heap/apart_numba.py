"""How a kernel that is compiled calls one at an address (apart.py)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, overload

from udec_ia.heap.apart import call_entry
from udec_ia.heap.checked import CHECKED


@intrinsic
def _jump(typing: Any, where: Any, given: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        taken = [context.get_value_type(kind) for kind in signature.args[1]]
        function = ir.FunctionType(context.get_value_type(types.boolean), taken)
        address = builder.inttoptr(args[0], function.as_pointer())
        return builder.call(address, cgutils.unpack_tuple(builder, args[1]))

    return types.boolean(types.int64, given), generate


@intrinsic
def _jump_and_look(typing: Any, where: Any, given: Any) -> Any:
    """The same in the checked build: what the kernel raises goes on to whoever calls it."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kinds, way = tuple(signature.args[1]), context.call_conv
        function = way.get_function_type(types.boolean, kinds)
        address = builder.inttoptr(args[0], function.as_pointer())
        taken = cgutils.unpack_tuple(builder, args[1])
        status, result = way.call_function(builder, address, types.boolean, kinds, taken)
        with cgutils.if_unlikely(builder, status.is_error):
            way.return_status_propagate(builder, status)
        return result

    return types.boolean(types.int64, given), generate


@overload(call_entry)
def _call_entry(where: Any, *args: Any) -> Callable[..., Any]:
    jump = _jump_and_look if CHECKED else _jump

    def impl(where: Any, *args: Any) -> Any:
        return jump(where, args)

    return impl
