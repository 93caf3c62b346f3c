"""What a kernel sees of the program's memory. How compiled code sees it: views_numba.py."""

from __future__ import annotations

from typing import Any, NamedTuple

from udec_ia.heap.kinds import shadow
from udec_ia.heap.loading import has_numba_side


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
        return shadow(self.ia).kinds

    @property
    def notes(self) -> Any:
        """In the checked build: what an access that was refused leaves behind."""
        return shadow(self.ia).notes


has_numba_side(__name__)
