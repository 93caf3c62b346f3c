"""Contacts that would cross: two thin tips that have gone through each other.

Two blocks that touch in two places close a space between them: who walks round it goes along one block from
the first contact to the second, and along the other block back again. So of two contacts that lie beside each
other the second comes after the first on one block and before it on the other. Where two tips, thinner than
the overlaps that are allowed, have passed through each other, the segments on the far sides meet too, and
there a contact would come after the first on both blocks. Each of the two domains that it made would be the
outside of one block, and none the space between.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget
from udec_ia.kernels.links.lists import is_contact, is_corner, nextcp, other, prevcp
from udec_ia.layout import offsets as g

AROUND = 6  # items looked at on either side for a contact of the same two blocks
TURNS = 1  # corners passed on the way to a contact that lies beside another: the way round has two at least


@kernel
def _comes(h: Memory, ib: int, iad: int, ic: int, ahead: bool) -> bool:
    """True if contact `ic` comes soon after item `iad` of block `ib`, going ahead, or before it."""
    item = nextcp(h, ib, iad) if ahead else iad
    turns = 0
    for _ in range(AROUND):
        if item == ic:
            return True
        if is_corner(h, item):
            turns += 1
        if turns > TURNS:
            return False
        item = nextcp(h, ib, item) if ahead else prevcp(h, ib, item)
    return False


@kernel
def would_cross(h: Memory, ib: int, iad: int, jb: int, jad: int, x: float, y: float) -> bool:
    """Would a contact at (x, y) after items `iad`, `jad` of blocks `ib`, `jb` cross another of the two?"""
    near = h.cr[g.DTOL] + h.cr[g.FTOL]
    for ahead in (True, False):
        item = nextcp(h, ib, iad) if ahead else iad
        turns = 0
        for _ in range(AROUND):
            if is_corner(h, item):
                turns += 1
            if turns > TURNS:
                break
            if is_contact(h, item) and other(h, ib, item) == jb and iget(h, item, g.KCCOD) != g.VIRTUAL:
                dx, dy = getr(h, item, g.KXC) - x, getr(h, item, g.KYC) - y
                if dx * dx + dy * dy < near * near and _comes(h, jb, jad, item, ahead):
                    return True
            item = nextcp(h, ib, item) if ahead else prevcp(h, ib, item)
    return False
