"""Asking for memory before it is needed.

A pass of the cycle follows addresses through an array that is larger than the machine's caches. A group that
is fetched while others are still being worked on costs next to nothing, one that is waited for costs more
than all its arithmetic. A fetch has no other effect: any address will do, and interpreted kernels do nothing.
"""

from __future__ import annotations

from udec_ia.heap.accessors import Address, Offset
from udec_ia.heap.loading import has_numba_side
from udec_ia.heap.views import Memory

LEAD = 16  # groups by which a pass looks ahead


def fetch(h: Memory, iad: Address, nv: Offset, beyond: int = 0) -> None:
    """Fetch the group of size `nv` (NVBL, NVCR, ...) that lies `beyond` such groups after address `iad`."""


has_numba_side(__name__)
