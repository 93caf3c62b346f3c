"""How the accessors are compiled (accessors.py)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba.extending import overload, register_jitable

from udec_ia.heap.accessors import PLAIN, at_offset, getr, iget, puti, putr, real, size_of
from udec_ia.heap.checked import CHECKED

plain_iget, plain_puti, plain_getr, plain_putr = PLAIN


def which_type(h: Any) -> tuple[int, int]:
    """Index into an offset tuple for the compiled type of `h`; bits from a word's address to a real's."""
    ratio = h.dtypes[1].bitwidth // h.dtypes[0].bitwidth
    return ratio >> 1, ratio.bit_length() - 1


@overload(plain_iget)
def _iget(h, iad, k, i=0):
    j, _ = which_type(h)

    def impl(h, iad, k, i=0):
        return np.int64(h.ia[np.uint64(iad) + np.uint64(k[j] - 1) + np.uint64(i)])

    return impl


@overload(plain_puti)
def _puti(h, iad, k, n, i=0):
    j, _ = which_type(h)

    def impl(h, iad, k, n, i=0):
        h.ia[np.uint64(iad) + np.uint64(k[j] - 1) + np.uint64(i)] = n

    return impl


@overload(plain_getr)
def _getr(h, iad, k):
    j, shift = which_type(h)

    def impl(h, iad, k):
        return h.ra[(np.uint64(iad - 1) >> np.uint64(shift)) + np.uint64(k[j] - 1)]

    return impl


@overload(plain_putr)
def _putr(h, iad, k, v):
    j, shift = which_type(h)

    def impl(h, iad, k, v):
        h.ra[(np.uint64(iad - 1) >> np.uint64(shift)) + np.uint64(k[j] - 1)] = v

    return impl


@overload(size_of)
def _size_of(h, nv):
    j, _ = which_type(h)

    def impl(h, nv):
        return nv[j]

    return impl


@overload(real)
def _real(h, value):
    kind = h.dtypes[3]

    def impl(h, value):
        return kind(value)

    return impl


register_jitable(at_offset)
if CHECKED:
    for accessor in (iget, puti, getr, putr):
        register_jitable(accessor)
