"""Asking for an update of a domain: it is told to have moved by more than the ETOL that calls for one."""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, iget, putr
from udec_ia.layout import offsets as g


@kernel
def flag(h: Memory, idm: int) -> None:
    """Ask for an update of domain `idm`."""
    putr(h, idm, g.KUMAX, h.cr[g.ETOL] + h.cr[g.ETOL])


@kernel
def flag_all(h: Memory) -> None:
    """Ask for an update of every domain."""
    idm = h.ci[g.IDPNT]
    while idm != 0:
        flag(h, idm)
        idm = iget(h, idm, g.KD)
