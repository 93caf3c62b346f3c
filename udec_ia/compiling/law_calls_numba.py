"""Compiled calls of laws, and how a law is compiled for them (law_calls.py)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, overload

from udec_ia.layout.material import Material

MATERIAL_SIZE = 8 * len(Material._fields)  # bytes
STATE = (types.float64,) * 6  # compiled types of what a law is called with
MATERIAL = types.NamedUniTuple(types.float64, len(Material._fields), Material)
_INTEGER, _REAL = ir.IntType(64), ir.DoubleType()
_LAW = ir.FunctionType(ir.VoidType(), [_REAL] * 6 + [_REAL.as_pointer()] * 2)


@intrinsic
def _word_at(typing: Any, address: Any) -> Any:
    """The integer at a machine address."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(builder.inttoptr(args[0], _INTEGER.as_pointer()))

    return types.int64(types.int64), generate


@intrinsic
def _jump(typing: Any, law: Any, state: Any, material: Any) -> Any:
    """Results of the law at a machine address, with the material at another; NaN where it wrote none."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        law, state, material = args
        law = builder.inttoptr(law, _LAW.as_pointer())
        material = builder.inttoptr(material, _REAL.as_pointer())
        result = cgutils.alloca_once(builder, _REAL, size=3)
        for k in range(3):
            builder.store(_REAL(float("nan")), cgutils.gep_inbounds(builder, result, k))
        builder.call(law, [*cgutils.unpack_tuple(builder, state, 6), material, result])
        reals = [builder.load(cgutils.gep_inbounds(builder, result, k)) for k in range(3)]
        return context.make_tuple(builder, signature.return_type, reals)

    three = types.UniTuple(types.float64, 3)
    return three(types.int64, types.UniTuple(types.float64, 6), types.int64), generate


def compile_is_given(is_given: Callable[..., Any]) -> None:
    """A law that is not given has the address 0."""

    @overload(is_given)
    def _is_given(laws: Any, i: Any) -> Callable[..., Any]:
        def impl(laws: Any, i: Any) -> Any:
            return _word_at(laws.calls + 8 * i) != 0

        return impl


def compile_call(call: Callable[..., Any]) -> None:
    """The law at an address is called."""

    @overload(call)
    def _call(laws: Any, i: Any, mat: Any, state: Any) -> Callable[..., Any]:
        def impl(laws: Any, i: Any, mat: Any, state: Any) -> Any:
            a, b, c, d, e, f = state
            reals = (np.float64(a), np.float64(b), np.float64(c), np.float64(d), np.float64(e), np.float64(f))
            return _jump(_word_at(laws.calls + 8 * i), reals, laws.materials + MATERIAL_SIZE * (mat - 1))

        return impl


@intrinsic
def _record(typing: Any, place: Any, state: Any) -> Any:
    """Put the reals `state` at a machine address, unless there are numbers already."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        to = builder.inttoptr(args[0], _REAL.as_pointer())
        first = builder.load(to)
        with builder.if_then(builder.fcmp_unordered("uno", first, first)):
            for k, real in enumerate(cgutils.unpack_tuple(builder, args[1], 6)):
                builder.store(real, cgutils.gep_inbounds(builder, to, k))
        return context.get_dummy_value()

    return types.void(types.int64, types.UniTuple(types.float64, 6)), generate


def machine_code(law: Any, n: int, record: Any) -> Any:
    """A compiled law, which returns `n` numbers, in the form that kernels call: its `address` is the law.

    record: six NaN, for the arguments with which the law first raises an exception; they must live as long.
    """
    result = types.CPointer(types.UniTuple(types.float64, n))
    place = record.ctypes.data

    def entry(a: float, b: float, c: float, d: float, e: float, f: float, material: Any, result: Any) -> None:
        try:
            result[0] = law(a, b, c, d, e, f, material[0])
        except Exception:
            _record(place, (a, b, c, d, e, f))

    return numba.cfunc(types.void(*STATE, types.CPointer(MATERIAL), result))(entry)
