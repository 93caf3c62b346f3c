"""How the accessors are compiled (accessors.py): to the few instructions that they are, with no call around.

The kernels have two thousand accesses. Were an accessor a function of its own to numba, each would be a call
that is made, and then taken apart again by LLVM: a tenth of the time that it takes to compile them.
"""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature as parameters
from typing import Any

from numba import types
from numba.core.typing import signature
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import lower_builtin, register_jitable

from udec_ia.heap.accessors import PLAIN, at_offset, getr, iget, puti, putr, real, size_of
from udec_ia.heap.checked import CHECKED
from udec_ia.heap.views_numba import MemoryType

plain_iget, plain_puti, plain_getr, plain_putr = PLAIN
INDEX = types.uint64  # never negative: numba would look


def which_type(h: MemoryType) -> tuple[int, int]:
    """Index into an offset tuple for the compiled type of `h`; bits from a word's address to a real's."""
    ratio = h.dtypes[1].bitwidth // h.dtypes[0].bitwidth
    return ratio >> 1, ratio.bit_length() - 1


def _compiled(accessor: Callable[..., Any], typed: Callable[..., Any]) -> Any:
    """Decorator of what writes the instructions of `accessor`; typed: the types of its result and arguments.

    typed is called with the types of the arguments in a call.
    """
    named = parameters(accessor)

    class _Template(AbstractTemplate):
        key = accessor

        def generic(self, args: Any, kws: Any) -> Any:
            bound = named.bind(*args, **kws)
            bound.apply_defaults()
            result, *wanted = typed(*bound.args)
            return signature(result, *wanted).replace(pysig=named)

    infer_global(accessor, types.Function(_Template))
    return lower_builtin(accessor, MemoryType, types.VarArg(types.Any))


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


@_compiled(plain_iget, lambda h, iad, k, i: (types.int64, h, INDEX, k, INDEX))
def _iget(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    kind = sig.args[0].dtypes[0]
    word = context.unpack_value(builder, kind, _integer(context, builder, sig, args))
    return context.cast(builder, word, kind, types.int64)


@_compiled(plain_puti, lambda h, iad, k, n, i: (types.none, h, INDEX, k, h.dtypes[0], INDEX))
def _puti(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    context.pack_value(builder, sig.args[0].dtypes[0], args[3], _integer(context, builder, sig, args))
    return context.get_dummy_value()


@_compiled(plain_getr, lambda h, iad, k: (h.dtypes[1], h, INDEX, k))
def _getr(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return context.unpack_value(builder, sig.return_type, _real(context, builder, sig, args))


@_compiled(plain_putr, lambda h, iad, k, v: (types.none, h, INDEX, k, h.dtypes[1]))
def _putr(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    context.pack_value(builder, sig.args[0].dtypes[1], args[3], _real(context, builder, sig, args))
    return context.get_dummy_value()


@_compiled(size_of, lambda h, nv: (types.int64, h, nv))
def _size_of(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    j, _ = which_type(sig.args[0])
    return context.cast(builder, builder.extract_value(args[1], j), sig.args[1][j], types.int64)


@_compiled(real, lambda h, value: (h.dtypes[3], h, h.dtypes[3]))
def _scheme_real(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return args[1]


register_jitable(at_offset)
if CHECKED:
    for accessor in (iget, puti, getr, putr):
        register_jitable(accessor)
