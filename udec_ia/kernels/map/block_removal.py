"""Removal of a block from the map (DELB).

First the contacts that separate two domains are deleted, each merging its two. The remaining ones link the
block to its neighbours as bridges of the map. All but one of these are then moved from the block to the first
neighbour, as virtual contacts, so that the map stays connected. The last one is deleted with the block.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, iget, int64, puti
from udec_ia.kernels.links.linked_lists import (
    dellst,
    flag,
    insert_after,
    is_contact,
    is_corner,
    nextcp,
    other,
    take_out,
)
from udec_ia.kernels.links.longer_groups import lose_block, lose_corner
from udec_ia.kernels.map.bridge import delc, losec, to_virtual
from udec_ia.kernels.map.domain_water import drain_domain
from udec_ia.layout import offsets as g


@kernel
def _delete_separating(h: Memory, ib: int) -> None:
    """Delete the contacts of block `ib` that have two different domains on their sides."""
    ip = iget(h, ib, g.KP)
    item = iget(h, ip, g.KL)
    while item != ip:
        following = nextcp(h, ib, item)
        if is_contact(h, item) and iget(h, item, g.KD1) != iget(h, item, g.KD2):
            delc(h, item)
        item = following


@kernel
def _move_bridge(h: Memory, ib: int, ic: int, jb: int, after: int) -> None:
    """Move bridge `ic` of block `ib` to block `jb`, after its item `after`, as a virtual contact."""
    take_out(h, ib, ic)
    puti(h, ic, g.KB1 if iget(h, ic, g.KB1) == ib else g.KB2, jb)
    insert_after(h, jb, after, ic)
    if iget(h, ic, g.KCCOD) != g.VIRTUAL:
        to_virtual(h, ic)


@kernel
def _next_contact(h: Memory, ib: int, ic: int) -> int:
    """Next contact after contact `ic` in the list of block `ib`; `ic` itself if there is no other."""
    item = nextcp(h, ib, ic)
    while is_corner(h, item):
        item = nextcp(h, ib, item)
    return item


@kernel
def delb(h: Memory, ib: int) -> None:
    """Delete block `ib` (DELB). There must be another one."""
    _delete_separating(h, ib)
    ip = iget(h, ib, g.KP)
    first = int64(0)
    jb = int64(0)
    item = iget(h, ip, g.KL)
    while item != ip:
        following = nextcp(h, ib, item)
        if is_contact(h, item):
            if first == 0:
                first, jb = item, other(h, ib, item)
            else:
                _move_bridge(h, ib, item, jb, first)
        item = following
    idm = iget(h, first, g.KD1)
    following = _next_contact(h, jb, first)
    puti(h, idm, g.KDLOOP, following if following != first else 0)  # 0: block `jb` is alone now
    flag(h, idm)
    drain_domain(h, idm)
    take_out(h, jb, first)
    losec(h, first)
    _lose_corners(h, ip)
    dellst(h, g.IBPNT, g.KB, g.KBB, ib)
    puti(h, ib, HEAD, 0)
    lose_block(h, ib)
    h.ci[g.NBLK] -= 1


@kernel
def _lose_corners(h: Memory, ip0: int) -> None:
    ip = ip0
    while True:
        before = iget(h, ip, g.KR)
        puti(h, ip, HEAD, 0)
        lose_corner(h, ip)
        if before == ip0:
            return
        ip = before
