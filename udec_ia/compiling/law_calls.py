"""How a compiled kernel calls a law that a user has written (Appendix IV-4).

A user's law is compiled when a session begins, long after the kernels that call it, which stay on disk. So
the kernels get addresses of machine code, which `machine_code` (law_calls_numba.py) makes, of the form

    void law(double, double, double, double, double, double, const double *material, double *result)

Laws calculate with 64-bit reals in every word scheme. Kernels that are not compiled call the Python function
itself. An exception in a law never reaches the kernel: the increments are NaN, and the arguments are
recorded.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.build_choice import numba_form

FIRST, LAST = 2, 5  # constitutive numbers of user laws
JOINTS = LAST - FIRST + 1  # place of CLJ2 among the calls of a Laws


class Laws(NamedTuple):
    """User laws, and the materials that they may be called with.

    calls: CL2 ... CL5, CLJ2 ... CLJ5, 0 for those that are not given. materials: the Material of each number.
    Compiled, both are addresses: of the table of the addresses of the laws, and of the reals of material 1.
    """

    calls: Any
    materials: Any


@numba_form("udec_ia.compiling.law_calls_numba:compile_is_given")
def is_given(laws: Laws, i: int) -> bool:
    """True if there is a law at place `i` of the calls."""
    return bool(laws.calls[i] != 0)


@numba_form("udec_ia.compiling.law_calls_numba:compile_call")
def call(laws: Laws, i: int, mat: int, state: tuple[float, ...]) -> Any:
    """What law `i` returns for material `mat` and six reals: three reals, or NaN after an exception."""
    try:
        with np.errstate(all="ignore"):
            return laws.calls[i](*map(np.float64, state), laws.materials[mat - 1])
    except Exception:
        return (np.nan, np.nan, np.nan)
