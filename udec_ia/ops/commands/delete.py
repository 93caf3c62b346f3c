"""DELETE: blocks are taken away; what is left stays one connected map."""

from __future__ import annotations

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.map.remove import delb
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.boundary import forget_blocks
from udec_ia.ops.commands.change import become
from udec_ia.ops.commands.rounding import update_flagged
from udec_ia.ops.common.forces import renew_forces
from udec_ia.ops.common.hosted import lose_hosted
from udec_ia.ops.common.ranges import Range, blocks_in


def delete(array: MainArray, where: Range) -> int:
    """Delete the blocks whose centroids lie in the range. Returns their number.

    Error 19, and nothing is deleted, if no contact would be left.
    """
    h = array.h
    blocks = blocks_in(array, where)
    if not blocks:
        return 0
    if h.ci[g.NBLK] - len(blocks) < 2:
        raise UdecError(
            19, f"only {int(h.ci[g.NBLK]) - len(blocks)} block(s) would be left", "two blocks must remain"
        )
    forget_blocks(h, blocks)
    lose_hosted(h, blocks)
    for ib in blocks:
        become(h, ib, g.MRIG)  # gives back what only a deformable block has
        delb(h, ib)
    update_flagged(array)
    if h.ci[g.MCTOT] > 0:
        renew_forces(array)
    return len(blocks)
