"""Which block a group belongs to, for messages that have an address only."""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, iget, int64
from udec_ia.layout import offsets as g

NOBODY, BLOCK, STRAIN, GRIDPOINT, ZONE = 0, 1, 2, 3, 4


@kernel
def owner(h: Memory, address: int) -> tuple[int, int]:
    """Block of the block, extension, grid-point or zone at `address`, and which of them it is.

    0 and NOBODY if it is none of them.
    """
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if ib == address:
            return ib, BLOCK
        if iget(h, ib, HEAD) == g.MSDEF and iget(h, ib, g.KBEX) == address:
            return ib, STRAIN
        if iget(h, ib, HEAD) == g.MFDEF:
            ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
            while ig != 0:
                if ig == address:
                    return ib, GRIDPOINT
                ig = iget(h, ig, g.KG)
            iz = iget(h, iget(h, ib, g.KBEX), g.KFZ)
            while iz != 0:
                if iz == address:
                    return ib, ZONE
                iz = iget(h, iz, g.KZ)
        ib = iget(h, ib, g.KB)
    return int64(0), NOBODY
