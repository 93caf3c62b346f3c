"""The crack pass: it finds the blocks that are to crack, after the contact pass (BREAKAGE).

Only blocks in the list IBRPNT can crack; a block that is fixed does not. The pass changes no block. It sets
LCRACK, the compiled loop ends there, and the cracks are made between two cycles (running/make_cracks.py), in
the order of the list, one in a block. So a run that is repeated cracks alike.

A crack unloads the rock beside it, but by a wave, and so not at once. Both parts of a deformable block wait
(KBKW) until a wave can have crossed the block and come back. So does a fully-deformable block through which
no crack is possible.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.kernels.crack.crack_line import Crack, no_crack
from udec_ia.kernels.crack.mean_stress import crack_by_stress, has_failed_zone
from udec_ia.kernels.crack.opposed_forces import crack_by_forces
from udec_ia.layout import offsets as g


@kernel
def may_crack(h: Memory, ik: int) -> bool:
    """True unless the block of strength `ik` is fixed or waits."""
    return iget(h, iget(h, ik, g.KBKB), g.KBFIX) != g.FIXED and not getr(h, ik, g.KBKW) > 0


@kernel
def crack_of(h: Memory, ik: int) -> Crack:
    """The crack of breakable block `ik`, which has no zones, in the present state."""
    ib = iget(h, ik, g.KBKB)
    crack = no_crack(h)
    if iget(h, ib, HEAD) == g.MSDEF:
        crack = crack_by_stress(h, ib, ik)
    if crack[0] == 0 and getr(h, ik, g.KBKT) > 0:
        crack = crack_by_forces(h, ib, getr(h, ik, g.KBKT), getr(h, ik, g.KBKA))
    return crack


@kernel
def is_to_crack(h: Memory, ik: int) -> bool:
    """True if breakable block `ik` is to crack in the present state."""
    ib = iget(h, ik, g.KBKB)
    if not may_crack(h, ik):
        return False
    if iget(h, ib, HEAD) == g.MFDEF:
        return has_failed_zone(h, ib, ik)
    return crack_of(h, ik)[0] != 0


@outlined
def find_cracks(h: Memory) -> bool:
    """Set LCRACK if blocks are to crack; shorten the time that blocks wait by a step."""
    ik = int64(h.ci[g.IBRPNT])
    while ik != 0:
        wait = getr(h, ik, g.KBKW)
        if wait > 0:
            putr(h, ik, g.KBKW, max(wait - h.cr[g.TDEL], real(h, 0.0)))
        elif h.ci[g.LCRACK] == 0 and is_to_crack(h, ik):
            h.ci[g.LCRACK] = 1
        ik = iget(h, ik, g.KBKN)
    return True
