"""The memory that every kernel works on: the views of IA() and the common block."""

from __future__ import annotations

from typing import Any, NamedTuple

from udec_ia.compiling.build_choice import checked_build
from udec_ia.compiling.numba_loading import numba_form


@numba_form("udec_ia.compiling.memory_type_numba:register")
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
        return checked_build("group_kinds").shadow(self.ia).kinds

    @property
    def notes(self) -> Any:
        """In the checked build: what an access that was refused leaves behind."""
        return checked_build("group_kinds").shadow(self.ia).notes
