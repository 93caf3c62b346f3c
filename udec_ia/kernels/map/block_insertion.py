"""A new block in a space between blocks, or outside all of them (BLOCK, FILL).

The block gets no contact but a virtual one, which links it to the map in the domain where it lies. The update
of that domain then finds all its contacts, each of which replaces the virtual one or cuts the domain.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, puti, putr
from udec_ia.kernels.links.linked_lists import flag_beside, insert_after
from udec_ia.kernels.map.bridge import makec
from udec_ia.kernels.map.domain_segments import loop_start
from udec_ia.kernels.map.virtual_contacts import winding
from udec_ia.layout import offsets as g

LINKED = 32  # blocks that are linked to one before the next one is linked to: lists and paths are both short


@kernel
def domain_at(h: Memory, x: float, y: float) -> int:
    """The domain in which the point (x, y) lies; it must not lie in a block."""
    idm = h.ci[g.IDPNT]
    while idm != 0:
        if idm != h.ci[g.IODPNT] and iget(h, idm, g.KDLOOP) != 0:
            item, block = loop_start(h, idm)
            if winding(h, item, block, x, y) > 0:
                return idm
        idm = iget(h, idm, g.KD)
    return h.ci[g.IODPNT]


@kernel
def link_block(h: Memory, ib: int, idm: int) -> None:
    """Link block `ib`, the latest of at least two, to the blocks around domain `idm`; flags the domain."""
    jb = iget(h, ib, g.KB)
    item = iget(h, jb, g.KP)
    if iget(h, idm, g.KDLOOP) != 0:
        item, jb = loop_start(h, idm)
    ip = iget(h, ib, g.KP)
    iv = makec(h, jb, ib, g.VIRTUAL, idm, idm)
    h.ci[g.NVIRT] += 1
    h.ci[g.NMADE] -= 1
    insert_after(h, jb, item, iv)
    insert_after(h, ib, ip, iv)
    putr(h, iv, g.KXC, getr(h, ip, g.KXP))
    putr(h, iv, g.KYC, getr(h, ip, g.KYP))
    if iget(h, idm, g.KDLOOP) == 0 or h.ci[g.NVIRT] % LINKED == 0:
        puti(h, idm, g.KDLOOP, iv)
    flag_beside(h, idm, ib)
