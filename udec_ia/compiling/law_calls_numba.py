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

from udec_ia.compiling.law_calls import JOINTS
from udec_ia.layout.material import JointMaterial, Material

MATERIAL_SIZE, JOINT_MATERIAL_SIZE = 8 * len(Material._fields), 8 * len(JointMaterial._fields)  # bytes
_INTEGER, _REAL = ir.IntType(64), ir.DoubleType()
_LAW = ir.FunctionType(ir.VoidType(), [_REAL.as_pointer()] * 3)


def compiled_types(kind: Any, n: int) -> tuple[Any, Any]:
    """Compiled types of the `n` reals that a law is called with, and of its material, of the class `kind`."""
    return types.UniTuple(types.float64, n), types.NamedUniTuple(types.float64, len(kind._fields), kind)


@intrinsic
def _word_at(typing: Any, address: Any) -> Any:
    """The integer at a machine address."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(builder.inttoptr(args[0], _INTEGER.as_pointer()))

    return types.int64(types.int64), generate


@intrinsic
def _jump(typing: Any, law: Any, state: Any, material: Any, results: Any) -> Any:
    """Results of the law at a machine address, with the material at another; NaN where it wrote none.

    results: a tuple with as many reals as the law returns.
    """
    given, n = state.count, results.count

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        law, state, material, _ = args
        law = builder.inttoptr(law, _LAW.as_pointer())
        material = builder.inttoptr(material, _REAL.as_pointer())
        called = cgutils.alloca_once(builder, _REAL, size=given)
        result = cgutils.alloca_once(builder, _REAL, size=n)
        for k, value in enumerate(cgutils.unpack_tuple(builder, state, given)):
            builder.store(value, cgutils.gep_inbounds(builder, called, k))
        for k in range(n):
            builder.store(_REAL(float("nan")), cgutils.gep_inbounds(builder, result, k))
        builder.call(law, [called, material, result])
        reals = [builder.load(cgutils.gep_inbounds(builder, result, k)) for k in range(n)]
        return context.make_tuple(builder, signature.return_type, reals)

    return results(types.int64, state, types.int64, results), generate


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
            material = laws.materials + MATERIAL_SIZE * (mat - 1)
            return _jump(_word_at(laws.calls + 8 * i), reals, material, (0.0, 0.0, 0.0))

        return impl


def compile_joint_call(call_joint: Callable[..., Any]) -> None:
    """The law at an address is called."""

    @overload(call_joint)
    def _call(laws: Any, i: Any, m: Any, state: Any) -> Callable[..., Any]:
        def impl(laws: Any, i: Any, m: Any, state: Any) -> Any:
            a, b, c, d, e, f, v1, v2, v3 = state
            first = (np.float64(a), np.float64(b), np.float64(c), np.float64(d), np.float64(e), np.float64(f))
            reals = (*first, np.float64(v1), np.float64(v2), np.float64(v3))
            material = laws.joint_materials + JOINT_MATERIAL_SIZE * m
            law = _word_at(laws.calls + 8 * (2 * JOINTS + i))
            return _jump(law, reals, material, (0.0, 0.0, 0.0, 0.0, 0.0))

        return impl


@intrinsic
def _record(typing: Any, place: Any, state: Any) -> Any:
    """Put the reals `state` at a machine address, unless there are numbers already."""
    n = state.count

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        to = builder.inttoptr(args[0], _REAL.as_pointer())
        first = builder.load(to)
        with builder.if_then(builder.fcmp_unordered("uno", first, first)):
            for k, real in enumerate(cgutils.unpack_tuple(builder, args[1], n)):
                builder.store(real, cgutils.gep_inbounds(builder, to, k))
        return context.get_dummy_value()

    return types.void(types.int64, state), generate


def machine_code(law: Any, kind: Any, n: int, record: Any) -> Any:
    """A compiled law, which returns `n` numbers, in the form that kernels call: its `address` is the law.

    kind: class of its material. record: NaN, for the arguments with which the law first raises an exception;
    they must live as long.
    """
    state, material = compiled_types(kind, len(record))
    result = types.CPointer(types.UniTuple(types.float64, n))
    place = record.ctypes.data

    def entry(state: Any, material: Any, result: Any) -> None:
        called = state[0]
        given = called + (material[0],)  # noqa: RUF005 - numba unpacks no tuple beside others
        try:
            result[0] = law(*given)
        except Exception:
            _record(place, called)

    return numba.cfunc(types.void(types.CPointer(state), types.CPointer(material), result))(entry)
