"""Prefetch: asking for memory before it is needed.

A pass of the cycle follows addresses through an array that is larger than the machine's caches. A group that
is fetched while others are still being worked on costs next to nothing. One that is waited for costs more
than all its arithmetic. A fetch has no other effect: any address will do, and interpreted kernels do nothing.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_memory import Memory
from udec_ia.compiling.numba_loading import numba_form

LEAD = 16  # groups by which a pass looks ahead


@numba_form("udec_ia.compiling.instructions_numba:compile_fetch")
def fetch(h: Memory, iad: int, nv: tuple[int, ...], beyond: int = 0) -> None:
    """Fetch the group of size `nv` (NVBL, NVCR, ...) that lies `beyond` such groups after address `iad`."""
