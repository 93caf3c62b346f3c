"""The memory that every kernel works on: the views of IA() and the common block."""

from __future__ import annotations

from typing import Any, NamedTuple

from udec_ia.compiling.build_choice import checked_build, numba_form

LEAD = 16  # groups by which a pass looks ahead


@numba_form("udec_ia.compiling.instructions_numba:compile_memory")
class Memory(NamedTuple):
    """All that a kernel sees.

    ia: IA() as integers; ra: the same bytes as reals; ci, cr, cd: integers, reals and doubles of the common
    block, indexed by the names of `udec_ia.layout.offsets`.
    """

    ia: Any
    ra: Any
    ci: Any
    cr: Any
    cd: Any

    @property
    def kinds(self) -> Any:
        """In the checked build: the kind of the group that begins at each address, counted from 0."""
        return checked_build("access_checks").shadow(self.ia).kinds

    @property
    def notes(self) -> Any:
        """In the checked build: what an access that was refused leaves behind."""
        return checked_build("access_checks").shadow(self.ia).notes


@numba_form("udec_ia.compiling.instructions_numba:compile_fetch")
def fetch(h: Memory, iad: int, nv: tuple[int, ...], beyond: int = 0) -> None:
    """Prefetch the group of size `nv` (NVBL, NVCR, ...) that lies `beyond` such groups after address `iad`.

    In an array beyond the machine's caches, to wait for a group costs more than all its arithmetic. Any
    address will do; interpreted kernels do nothing.
    """
