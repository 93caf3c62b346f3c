"""How a compiled kernel calls a law that a user has written (Appendix IV-4).

A user's law is compiled when a session begins, long after the kernels that call it, which stay on disk. So
the kernels get addresses of machine code, which `machine_code` (law_calls_numba.py) makes, of the form

    void law(const double *state, const double *material, double *result)

Laws calculate with 64-bit reals in every word scheme. Kernels that are not compiled call the Python function
itself. An exception in a law never reaches the kernel: the results are NaN, and the arguments are recorded.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.build_choice import numba_form

FIRST, LAST = 2, 5  # constitutive numbers of user laws
JOINTS = LAST - FIRST + 1  # place of CLJ2 among the calls of a Laws


class Laws(NamedTuple):
    """User laws, and the materials that they may be called with.

    calls: CL2 ... CL5, CLJ2 ... CLJ5, JL2 ... JL5, 0 for those that are not given. materials: the Material of
    each number. joint_materials: the JointMaterial of each number. Compiled, all are addresses: of the table
    of the addresses of the laws, and of the reals of material 1.
    """

    calls: Any
    materials: Any
    joint_materials: Any


@numba_form("udec_ia.compiling.law_calls_numba:compile_is_given")
def is_given(laws: Laws, i: int) -> bool:
    """True if there is a law at place `i` of the calls."""
    return bool(laws.calls[i] != 0)


@numba_form("udec_ia.compiling.law_calls_numba:compile_call")
def call(laws: Laws, i: int, mat: int, state: tuple[float, ...]) -> Any:
    """What law `i` returns for material `mat` and six reals: three reals, or NaN after an exception."""
    return _result(laws.calls[i], laws.materials[mat - 1], state, 3)


@numba_form("udec_ia.compiling.law_calls_numba:compile_joint_call")
def call_joint(laws: Laws, i: int, m: int, state: tuple[float, ...]) -> Any:
    """What law JL2 + `i` returns for joint material `m` + 1 and nine reals: five reals, or NaN."""
    return _result(laws.calls[2 * JOINTS + i], laws.joint_materials[m], state, 5)


def _result(law: Any, material: Any, state: tuple[float, ...], n: int) -> tuple[float, ...]:
    """The `n` reals that `law` returns, or NaN after an exception."""
    try:
        with np.errstate(all="ignore"):
            return tuple(law(*map(np.float64, state), material))
    except Exception:
        return (np.nan,) * n
