"""The order in which the map is walked: block by block, with what belongs to each."""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, iget
from udec_ia.kernels.links.lists import is_corner, nextcp, other
from udec_ia.layout import offsets as g


@kernel
def map_order(
    h: Memory, blocks: Any, corners: Any, contacts: Any, domains: Any, seen: Any
) -> tuple[int, int, int]:
    """Corners, contacts and domains in the order in which a walk round block after block needs them.

    A contact comes with the later of its blocks, a domain with the first contact on it. seen: one flag
    a word of IA(), all False. Returns the numbers of corners, contacts and domains.
    """
    n, nc, nd = 0, 0, 0
    for ib in blocks:
        seen[ib] = True
        ip0 = iget(h, ib, g.KP)
        item = ip0
        while True:
            if is_corner(h, item):
                corners[n] = item
                n += 1
            elif seen[other(h, ib, item)] and not seen[item]:
                seen[item] = True
                contacts[nc] = item
                nc += 1
                for idm in (iget(h, item, g.KD1), iget(h, item, g.KD2)):
                    if not seen[idm]:
                        seen[idm] = True
                        domains[nd] = idm
                        nd += 1
            item = nextcp(h, ib, item)
            if item == ip0:
                break
    return n, nc, nd
