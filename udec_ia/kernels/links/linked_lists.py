"""Linked lists of the map: steps along them, insertion and removal, and the order of groups on a walk.

    clockwise list of a block    corner -> contact -> contact -> corner -> ... -> first corner
    loop of a domain             along a block's list, changing to the other block at every contact
    main lists                   blocks, contacts, domains: from a head in the common block, linked both ways

NEXTCP, NEXTP, NEXTD and DELLST of the report are here. An exposure is the piece of a block's boundary between
two successive items of its list: it is named by the block and the item before it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, Offset, iget, int64, puti, putr, real
from udec_ia.layout import offsets as g


@kernel
def is_corner(h: Memory, iad: int) -> bool:
    """True if the item at `iad` is a corner, False if it is a contact."""
    return iget(h, iad, HEAD) == g.MCOR


@kernel
def is_contact(h: Memory, iad: int) -> bool:
    """True if the item at `iad` is a contact, False if it is a corner."""
    return iget(h, iad, HEAD) == g.MCON


@kernel
def nextcp(h: Memory, ib: int, iad: int) -> int:
    """Item after `iad` in the clockwise list of block `ib` (NEXTCP)."""
    if is_corner(h, iad):
        return iget(h, iad, g.KL)
    if iget(h, iad, g.KB1) == ib:
        return iget(h, iad, g.KL1)
    return iget(h, iad, g.KL2)


@kernel
def prevcp(h: Memory, ib: int, iad: int) -> int:
    """Item before `iad` in the clockwise list of block `ib`."""
    if is_corner(h, iad):
        return iget(h, iad, g.KLB)
    if iget(h, iad, g.KB1) == ib:
        return iget(h, iad, g.KLB1)
    return iget(h, iad, g.KLB2)


@kernel
def link(h: Memory, ib: int, before: int, after: int) -> None:
    """Make `after` follow `before` in the clockwise list of block `ib`."""
    if is_corner(h, before):
        puti(h, before, g.KL, after)
    elif iget(h, before, g.KB1) == ib:
        puti(h, before, g.KL1, after)
    else:
        puti(h, before, g.KL2, after)
    if is_corner(h, after):
        puti(h, after, g.KLB, before)
    elif iget(h, after, g.KB1) == ib:
        puti(h, after, g.KLB1, before)
    else:
        puti(h, after, g.KLB2, before)


@kernel
def corner_of(h: Memory, ib: int, ic: int) -> int:
    """First corner after contact `ic` in the list of block `ib`."""
    if iget(h, ic, g.KB1) == ib:
        return iget(h, ic, g.KCP1)
    return iget(h, ic, g.KCP2)


@kernel
def set_corner_of(h: Memory, ib: int, ic: int, ip: int) -> None:
    """Store `ip` as the first corner after contact `ic` in the list of block `ib`."""
    if iget(h, ic, g.KB1) == ib:
        puti(h, ic, g.KCP1, ip)
    else:
        puti(h, ic, g.KCP2, ip)


@kernel
def nextp(h: Memory, ib: int, iad: int) -> int:
    """First corner at or after item `iad` of block `ib` (NEXTP)."""
    if is_corner(h, iad):
        return int64(iad)
    return corner_of(h, ib, iad)


@kernel
def next_corner(h: Memory, ib: int, ip: int) -> int:
    """Corner after corner `ip`, clockwise."""
    return nextp(h, ib, iget(h, ip, g.KL))


@kernel
def insert_after(h: Memory, ib: int, iad: int, ic: int) -> None:
    """Put contact `ic` into the list of block `ib`, after the item `iad`."""
    after = nextcp(h, ib, iad)
    set_corner_of(h, ib, ic, nextp(h, ib, after))
    link(h, ib, iad, ic)
    link(h, ib, ic, after)


@kernel
def take_out(h: Memory, ib: int, iad: int) -> None:
    """Take item `iad` out of the list of block `ib`."""
    link(h, ib, prevcp(h, ib, iad), nextcp(h, ib, iad))


@kernel
def other(h: Memory, ib: int, ic: int) -> int:
    """The block that meets block `ib` at contact `ic`."""
    if iget(h, ic, g.KB1) == ib:
        return iget(h, ic, g.KB2)
    return iget(h, ic, g.KB1)


@kernel
def domain_before(h: Memory, ib: int, ic: int) -> int:
    """Domain on the exposure of block `ib` that ends at contact `ic`."""
    if iget(h, ic, g.KB1) == ib:
        return iget(h, ic, g.KD1)
    return iget(h, ic, g.KD2)


@kernel
def idomp(h: Memory, ib: int, iad: int) -> int:
    """Domain on the exposure of block `ib` that follows item `iad` (IDOMP)."""
    item = nextcp(h, ib, iad)
    start = item
    while is_corner(h, item):
        item = nextcp(h, ib, item)
        if item == start:
            return int64(h.ci[g.IODPNT])  # a lone block
    return domain_before(h, ib, item)


@kernel
def to_front(h: Memory, lst: int, knext: Offset, kback: Offset, iad: int) -> None:
    """Put group `iad` at the head of the main list whose head is ci[lst]."""
    first = h.ci[lst]
    puti(h, iad, knext, first)
    puti(h, iad, kback, 0)
    if first != 0:
        puti(h, first, kback, iad)
    h.ci[lst] = iad


@kernel
def dellst(h: Memory, lst: int, knext: Offset, kback: Offset, iad: int) -> None:
    """Delete group `iad` from the main list whose head is ci[lst] (DELLST)."""
    after = iget(h, iad, knext)
    before = iget(h, iad, kback)
    if before == 0:
        h.ci[lst] = after
    else:
        puti(h, before, knext, after)
    if after != 0:
        puti(h, after, kback, before)


@kernel
def flag(h: Memory, idm: int) -> None:
    """Request an update of domain `idm`."""
    putr(h, idm, g.KUMAX, h.cr[g.ETOL] + h.cr[g.ETOL])


SEARCHED = 1.5  # ETOL: the displacement of a domain that is to be searched, with no contact to give up before


@kernel
def flag_for_search(h: Memory, idm: int) -> None:
    """Request a search of domain `idm`, whose contacts are valid walls."""
    putr(h, idm, g.KUMAX, h.cr[g.ETOL] * real(h, SEARCHED))


@kernel
def request_search(h: Memory, ib: int) -> None:
    """Block `ib` is to search the large domains around it for contacts in this cycle."""
    puti(h, ib, g.KBROOM, 0)
    h.ci[g.NDUE] = 1


@kernel
def flag_beside(h: Memory, idm: int, ib: int) -> None:
    """Request an update of domain `idm` because of block `ib`; in a large one this block alone searches."""
    if iget(h, idm, g.KDLRG) != 0:
        request_search(h, ib)
    else:
        flag(h, idm)


@kernel
def flag_all(h: Memory) -> None:
    """Request an update of every domain."""
    idm = h.ci[g.IDPNT]
    while idm != 0:
        flag(h, idm)
        idm = iget(h, idm, g.KD)


NOBODY, BLOCK, STRAIN, GRIDPOINT, ZONE = 0, 1, 2, 3, 4


@kernel
def owner(h: Memory, address: int) -> tuple[int, int]:
    """Block of the block, extension, grid-point or zone at `address`, and its kind.

    0 and NOBODY for any other group.
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


@kernel
def map_order(
    h: Memory, blocks: Any, corners: Any, contacts: Any, domains: Any, seen: Any
) -> tuple[int, int, int]:
    """Corners, contacts and domains in the order of a walk around each block.

    A contact comes with the later of its blocks, a domain with its first contact. seen: one flag per word of
    IA(), all False. Returns the numbers of corners, contacts and domains.
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


@kernel
def addresses(h: Memory, first: int, link: Any) -> Any:
    """Addresses of the groups of a chain, in its order: `first` (0: none) and those that `link` leads to."""
    n, iad = 0, int64(first)
    while iad != 0:
        n += 1
        iad = iget(h, iad, link)
    found = np.empty(n, np.int64)
    iad = int64(first)
    for i in range(n):
        found[i] = iad
        iad = iget(h, iad, link)
    return found
