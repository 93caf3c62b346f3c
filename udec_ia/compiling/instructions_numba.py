"""The memory, its accessors, prefetch and outlined calls as machine instructions, written out for numba.

The kernels have two thousand accesses. If an accessor were a compiled function, LLVM would have to inline
each of these calls, which is a tenth of the time that it takes to compile the kernels.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from inspect import signature as parameters
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing import signature
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import (
    NativeValue,
    intrinsic,
    lower_builtin,
    make_attribute_wrapper,
    models,
    overload,
    register_model,
    typeof_impl,
    unbox,
)
from numba.np.numpy_support import from_dtype

from udec_ia.compiling.build_choice import CHECKED
from udec_ia.compiling.kernel_memory import Memory

INDEX = types.uint64  # never negative: numba would look
LINE = 64  # bytes that the machine's memory hands out at a time
READ, KEEP, DATA = 0, 3, 1  # arguments of llvm.prefetch: to be read, often, no instructions
OF_CHECKED_BUILD = [("kinds", types.int8), ("notes", types.int64)] if CHECKED else []

# ---- memory


class MemoryType(types.Type):
    """Compiled type of Memory for one word scheme; `dtypes` are those of its five arrays.

    It is four bare addresses, which stay in registers, where an array of numba is seven words and a reference
    count. `ra` has the address of `ia`, and only getr and putr use it. The caller of a kernel holds the
    arrays.
    """

    def __init__(self, *dtypes: Any) -> None:
        self.dtypes = dtypes
        super().__init__(name=f"Memory{dtypes}")


def _pointers(kind: MemoryType) -> list[tuple[str, Any]]:
    """Names and element types of the arrays whose addresses are stored; the checked build has two more."""
    pointers = [(name, d) for name, d in zip(Memory._fields, kind.dtypes, strict=True) if name != "ra"]
    return pointers + OF_CHECKED_BUILD


@register_model(MemoryType)
class _FourPointers(models.StructModel):
    def __init__(self, manager: Any, kind: MemoryType) -> None:
        super().__init__(manager, kind, [(name, types.CPointer(dtype)) for name, dtype in _pointers(kind)])


for _name in (*Memory._fields, *(name for name, _ in OF_CHECKED_BUILD)):
    if _name != "ra":
        make_attribute_wrapper(MemoryType, _name, _name)


def compile_memory(memory_class: type[Memory]) -> None:
    """Have numba give memories this type."""

    @typeof_impl.register(memory_class)
    def _type_of(memory: Memory, _: Any) -> MemoryType:
        return MemoryType(*(from_dtype(array.dtype) for array in memory))


@unbox(MemoryType)
def _addresses(kind: MemoryType, memory: Any, c: Any) -> Any:
    """Code that takes the four addresses out of the Python object `memory`."""
    pointers = c.context.make_helper(c.builder, kind)
    failed = []
    for name, dtype in _pointers(kind):
        array_type = types.Array(dtype, 1, "C")
        member = c.pyapi.object_getattr_string(memory, name)
        array = c.unbox(array_type, member)
        c.pyapi.decref(member)
        setattr(pointers, name, c.context.make_array(array_type)(c.context, c.builder, array.value).data)
        c.context.nrt.decref(c.builder, array_type, array.value)
        failed.append(array.is_error)
    return NativeValue(pointers._getvalue(), is_error=reduce(c.builder.or_, failed))


# ---- accessors


def which_type(h: MemoryType) -> tuple[int, int]:
    """Index into an offset tuple for the compiled type of `h`; bits from a word's address to a real's."""
    ratio = h.dtypes[1].bitwidth // h.dtypes[0].bitwidth
    return ratio >> 1, ratio.bit_length() - 1


def _number(context: Any, builder: Any, k: Any, kind: Any, j: int) -> Any:
    """Element `j` of the offset `k`, less 1: a literal in the code, as offsets are known when it is made."""
    word = context.cast(builder, builder.extract_value(k, j), kind[j], INDEX)
    return builder.sub(word, word.type(1))


def _integer(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Address of the integer that `args`, the memory, an address, an offset and an element, are about."""
    h, iad, k, *_, i = args
    words = context.make_helper(builder, sig.args[0], value=h).ia
    j, _ = which_type(sig.args[0])
    at = builder.add(iad, _number(context, builder, k, sig.args[2], j))
    return builder.gep(words, [builder.add(at, i)])


def _real(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Address of the real that `args`, the memory, an address and an offset, are about."""
    h, iad, k, *_ = args
    j, shift = which_type(sig.args[0])
    ra = sig.args[0].dtypes[1]
    words = context.make_helper(builder, sig.args[0], value=h).ia
    reals = builder.bitcast(words, context.get_value_type(types.CPointer(ra)))
    first = builder.lshr(builder.sub(iad, iad.type(1)), iad.type(shift))
    return builder.gep(reals, [builder.add(first, _number(context, builder, k, sig.args[2], j))])


def _load_integer(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    kind = sig.args[0].dtypes[0]
    word = context.unpack_value(builder, kind, _integer(context, builder, sig, args))
    return context.cast(builder, word, kind, types.int64)


def _store_integer(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    context.pack_value(builder, sig.args[0].dtypes[0], args[3], _integer(context, builder, sig, args))
    return context.get_dummy_value()


def _load_real(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return context.unpack_value(builder, sig.return_type, _real(context, builder, sig, args))


def _store_real(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    context.pack_value(builder, sig.args[0].dtypes[1], args[3], _real(context, builder, sig, args))
    return context.get_dummy_value()


def _size(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    j, _ = which_type(sig.args[0])
    return context.cast(builder, builder.extract_value(args[1], j), sig.args[1][j], types.int64)


def _number_as_it_is(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return args[1]


ACCESSORS: dict[str, tuple[Callable[..., Any], Callable[..., Any]]] = {
    # by name: types of the result and of the arguments for those in a call, and what writes the instructions
    "iget": (lambda h, iad, k, i: (types.int64, h, INDEX, k, INDEX), _load_integer),
    "puti": (lambda h, iad, k, n, i: (types.none, h, INDEX, k, h.dtypes[0], INDEX), _store_integer),
    "getr": (lambda h, iad, k: (h.dtypes[1], h, INDEX, k), _load_real),
    "putr": (lambda h, iad, k, v: (types.none, h, INDEX, k, h.dtypes[1]), _store_real),
    "size_of": (lambda h, nv: (types.int64, h, nv), _size),
    "real": (lambda h, value: (h.dtypes[3], h, h.dtypes[3]), _number_as_it_is),
}


def compile_accessor(accessor: Callable[..., Any]) -> None:
    """Have numba compile one of ACCESSORS to its instructions."""
    (typed, write), named = ACCESSORS[accessor.__name__], parameters(accessor)

    class _Template(AbstractTemplate):
        key = accessor

        def generic(self, args: Any, kws: Any) -> Any:
            bound = named.bind(*args, **kws)
            bound.apply_defaults()
            result, *wanted = typed(*bound.args)
            return signature(result, *wanted).replace(pysig=named)

    infer_global(accessor, types.Function(_Template))
    lower_builtin(accessor, MemoryType, types.VarArg(types.Any))(write)


# ---- prefetch


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


def compile_fetch(fetch: Callable[..., Any]) -> None:
    """One instruction for each line of memory that the group touches."""

    @overload(fetch)
    def _fetch(h: Any, iad: Any, nv: Any, beyond: Any = 0) -> Callable[..., Any]:
        j, _ = which_type(h)
        step = LINE * 8 // h.dtypes[0].bitwidth

        def impl(h: Any, iad: Any, nv: Any, beyond: Any = 0) -> None:
            first = iad - 1 + beyond * nv[j]
            for word in range(0, nv[j], step):
                _prefetch(h.ia, first + word)

        return impl


# ---- kernels, and calls of them by their addresses


def type_of_kernels(kernel_class: type) -> None:
    """To the kernels that call it, a kernel has the type of what numba makes of it."""

    @typeof_impl.register(kernel_class)
    def _type_of(kernel: Any, context: Any) -> Any:
        found = typeof_impl(kernel.compiled, context)
        return found if found is not None else types.Dispatcher(kernel.compiled)


@intrinsic
def _call(typing: Any, where: Any, given: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        taken = [context.get_value_type(kind) for kind in signature.args[1]]
        function = ir.FunctionType(context.get_value_type(types.boolean), taken)
        address = builder.inttoptr(args[0], function.as_pointer())
        return builder.call(address, cgutils.unpack_tuple(builder, args[1]))

    return types.boolean(types.int64, given), generate


@intrinsic
def _call_and_raise(typing: Any, where: Any, given: Any) -> Any:
    """The same in the checked build: an exception that the kernel raises is passed on to the caller."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kinds, convention = tuple(signature.args[1]), context.call_conv
        function = convention.get_function_type(types.boolean, kinds)
        address = builder.inttoptr(args[0], function.as_pointer())
        taken = cgutils.unpack_tuple(builder, args[1])
        status, result = convention.call_function(builder, address, types.boolean, kinds, taken)
        with cgutils.if_unlikely(builder, status.is_error):
            convention.return_status_propagate(builder, status)
        return result

    return types.boolean(types.int64, given), generate


def compile_call_entry(call_entry: Callable[..., Any]) -> None:
    """A call of what lies at an address."""
    call = _call_and_raise if CHECKED else _call

    @overload(call_entry)
    def _call_entry(where: Any, *args: Any) -> Callable[..., Any]:
        def impl(where: Any, *args: Any) -> Any:
            return call(where, args)

        return impl
