"""The accessors: they turn an address and an offset into an index of the array (report 3.5).

An address counts integer words from 1; 0 is the null pointer. An integer of the group at `iad`
stands at word iad + K, K counted from 0; a real is number K, counted from 1, of the reals that start
at word iad. The four accessors keep their 1980 names:

    iget(h, iad, KB)   puti(h, iad, KB, n)   getr(h, iad, KX)   putr(h, iad, KX, v)

`h` is the whole memory of the program: the integer and the real view of IA(), and the common block.
An offset is a tuple with one element for each ratio of widths; the array types pick the element when
the kernel is compiled, so an accessor costs what a literal offset costs. Addresses are widened to 64
bits on load and narrowed on store; indices are unsigned, which spares numba's negative-index fix-up.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numpy as np

from udec_ia.compiling.build_choice import CHECKED, checked_build, numba_form, offset
from udec_ia.compiling.build_choice import at_offset as at_offset
from udec_ia.compiling.kernel_memory import Memory as Memory

Offset = tuple[int, int, int]  # and more in the checked build: checked_build/tagged_offsets.py
Address = int
ACCESSOR = "udec_ia.compiling.instructions_numba:compile_accessor"
HEAD: Offset = offset("HEAD", (0, 0, 0), "headed")  # head code of a group

# The integer that kernels calculate with. numba sees the 64-bit type; to a type checker it is an int.
int64 = cast(Callable[[Any], int], np.int64)


def _which(h: Any) -> int:
    """Index into an offset tuple: 0, 1, 2 for 1, 2, 4 integers to a real."""
    return int(h.ra.itemsize // h.ia.itemsize) >> 1


@numba_form(ACCESSOR)
def iget(h: Memory, iad: Address, k: Offset, i: int = 0) -> int:
    """Integer at IA(iad + k + i)."""
    return int(h.ia[iad + k[_which(h)] + i - 1])


def integers(h: Memory, iads: Any, k: Offset, i: int = 0) -> Any:
    """iget for an array of addresses, and not for kernels; getr takes such an array itself."""
    return h.ia[iads + k[_which(h)] + i - 1].astype(np.int64)


def gather(h: Memory, iads: Any, words: int, real: bool) -> Any:
    """What stands `words` behind each of many addresses: integers as int64, or reals; not for kernels.

    words: from the address of a group to a field, as the table lays it out for the scheme at hand.
    """
    if words > 0 and not real:
        return h.ia[words - 1 :].take(iads).astype(np.int64, copy=False)  # without an array of sums
    at = iads + (words - 1)
    return h.ra.take(at >> _which(h)) if real else h.ia.take(at).astype(np.int64, copy=False)


@numba_form(ACCESSOR)
def puti(h: Memory, iad: Address, k: Offset, n: int, i: int = 0) -> None:
    """IA(iad + k + i) := n."""
    h.ia[iad + k[_which(h)] + i - 1] = n


@numba_form(ACCESSOR)
def getr(h: Memory, iad: Address, k: Offset) -> Any:
    """Real number k of the reals that start at IA(iad)."""
    j = _which(h)
    return h.ra[((iad - 1) >> j) + k[j] - 1]


@numba_form(ACCESSOR)
def putr(h: Memory, iad: Address, k: Offset, v: Any) -> None:
    """Real number k of the reals that start at IA(iad) := v."""
    j = _which(h)
    h.ra[((iad - 1) >> j) + k[j] - 1] = v


@numba_form(ACCESSOR)
def size_of(h: Memory, nv: Offset) -> int:
    """Number of words of a group (NVBL, NVCR, ...) in the scheme at hand."""
    return nv[_which(h)]


@numba_form(ACCESSOR)
def real(h: Memory, value: float) -> Any:
    """`value` as a real of the scheme at hand: a bare literal would widen 32-bit arithmetic."""
    return h.cr.dtype.type(value)


if CHECKED:
    iget, puti, getr, putr = checked_build("access_checks").checked_accessors(iget, puti, getr, putr)
