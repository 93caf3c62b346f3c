"""The type that the memory of a kernel (kernel_memory.py) has in compiled code.

An array of numba is seven words and a reference count, and the memory is handed to every kernel. So Memory
has a type of its own when compiled: four bare addresses, which stay in registers, and nothing to count; a
fifth would go over the stack at every call, so `ra`, the same address as `ia`, is made of that. The arrays
live while a kernel runs because its caller holds the Memory; a kernel never keeps or returns one.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

from numba import types
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    NativeValue,
    infer_getattr,
    lower_getattr,
    make_attribute_wrapper,
    models,
    register_model,
    typeof_impl,
    unbox,
)
from numba.np.numpy_support import from_dtype

from udec_ia.compiling.build_choice import CHECKED
from udec_ia.compiling.kernel_memory import Memory

BESIDE = [("kinds", types.int8), ("notes", types.int64)] if CHECKED else []  # further arrays, and their types


class MemoryType(types.Type):
    """Compiled type of Memory for one word scheme; `dtypes` are those of its five arrays."""

    def __init__(self, *dtypes: Any) -> None:
        self.dtypes = dtypes
        super().__init__(name=f"Memory{dtypes}")


def _kept(kind: MemoryType) -> list[tuple[str, Any]]:
    """The arrays whose addresses are kept, and their types."""
    kept = [(name, d) for name, d in zip(Memory._fields, kind.dtypes, strict=True) if name != "ra"]
    return kept + BESIDE


@register_model(MemoryType)
class _FourPointers(models.StructModel):
    def __init__(self, manager: Any, kind: MemoryType) -> None:
        super().__init__(manager, kind, [(name, types.CPointer(dtype)) for name, dtype in _kept(kind)])


for _name in (*Memory._fields, *(name for name, _ in BESIDE)):
    if _name != "ra":
        make_attribute_wrapper(MemoryType, _name, _name)


def _pointer_to_reals(kind: MemoryType) -> Any:
    return types.CPointer(kind.dtypes[Memory._fields.index("ra")])


@infer_getattr
class _Reals(AttributeTemplate):
    key = MemoryType

    def resolve_ra(self, kind: MemoryType) -> Any:
        return _pointer_to_reals(kind)


@lower_getattr(MemoryType, "ra")
def _reals(context: Any, builder: Any, kind: MemoryType, value: Any) -> Any:
    """The address of `ia` as that of reals."""
    pointers = context.make_helper(builder, kind, value=value)
    return builder.bitcast(pointers.ia, context.get_value_type(_pointer_to_reals(kind)))


def register(memory_class: type[Memory]) -> None:
    """Have numba give memories this type."""

    @typeof_impl.register(memory_class)
    def _type_of(memory: Memory, _: Any) -> MemoryType:
        return MemoryType(*(from_dtype(array.dtype) for array in memory))


@unbox(MemoryType)
def _addresses(kind: MemoryType, memory: Any, c: Any) -> Any:
    """Code that takes the four addresses out of the Python object `memory`."""
    pointers = c.context.make_helper(c.builder, kind)
    failed = []
    for name, dtype in _kept(kind):
        array_type = types.Array(dtype, 1, "C")
        member = c.pyapi.object_getattr_string(memory, name)
        array = c.unbox(array_type, member)
        c.pyapi.decref(member)
        setattr(pointers, name, c.context.make_array(array_type)(c.context, c.builder, array.value).data)
        c.context.nrt.decref(c.builder, array_type, array.value)
        failed.append(array.is_error)
    return NativeValue(pointers._getvalue(), is_error=reduce(c.builder.or_, failed))
