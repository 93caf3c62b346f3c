"""Creation and deletion of contacts, and with them of domains (MAKEC, BRIDGE, DELC).

A new contact across a domain cuts it in two; a deleted contact merges the two domains beside it. In both
cases the contacts around one of the two loops get a new domain. Both loops are walked in parallel until the
shorter one closes, and the shorter one is relabelled. So the cost of a contact made or broken on a large
domain is that of its smaller side.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, puti, real
from udec_ia.heap.find_lose import lose
from udec_ia.kernels.constitutive.joint_laws import reset_forces
from udec_ia.kernels.constitutive.joint_materials import lose_joint
from udec_ia.kernels.constitutive.joint_properties import assign_material
from udec_ia.kernels.geometry.block_shape import geo
from udec_ia.kernels.geometry.contact_geometry import begin_contact
from udec_ia.kernels.links.linked_lists import (
    dellst,
    flag,
    insert_after,
    is_contact,
    is_corner,
    nextcp,
    other,
    request_search,
    take_out,
    to_front,
)
from udec_ia.kernels.links.longer_groups import find_contact, find_domain, lose_contact, lose_domain
from udec_ia.kernels.map.domain_water import cut_water, merge_water
from udec_ia.layout import offsets as g


@kernel
def nextd(h: Memory, iad: int, ib: int) -> tuple[int, int]:
    """Next item around a domain and the block that is walked after it (NEXTD).

    `iad` is the current item, `ib` the block whose list continues from it.
    """
    item = nextcp(h, ib, iad)
    if is_contact(h, item):
        return item, other(h, ib, item)
    return item, int64(ib)


@kernel
def maked(h: Memory) -> int:
    """A new domain group at the head of the domain list, its loop not yet known."""
    idm = find_domain(h)
    puti(h, idm, HEAD, g.MDOM)
    to_front(h, g.IDPNT, g.KD, g.KDB, idm)
    h.ci[g.NDOM] += 1
    return idm


@kernel
def makec(h: Memory, ib: int, jb: int, icod: int, idleft: int, idright: int) -> int:
    """A new contact of blocks `ib` and `jb` at the head of the contact list (MAKEC), in no block list yet."""
    ic = find_contact(h)
    puti(h, ic, HEAD, g.MCON)
    puti(h, ic, g.KB1, ib)
    puti(h, ic, g.KB2, jb)
    puti(h, ic, g.KD1, idleft)
    puti(h, ic, g.KD2, idright)
    assign_material(h, ic)
    puti(h, ic, g.KCCOD, icod)
    to_front(h, g.ICPNT, g.KC, g.KCB, ic)
    h.ci[g.NCON] += 1
    h.ci[g.NMADE] += 1
    return ic


@kernel
def losec(h: Memory, ic: int) -> None:
    """Take contact `ic`, which is in no block's list any more, off the contact list and lose it."""
    if iget(h, ic, g.KCCOD) == g.VIRTUAL:
        h.ci[g.NVIRT] -= 1
    dellst(h, g.ICPNT, g.KC, g.KCB, ic)
    puti(h, ic, HEAD, 0)
    lose_contact(h, ic)
    h.ci[g.NCON] -= 1


@kernel
def to_virtual(h: Memory, ic: int) -> None:
    """Contact `ic`, a bridge of the map, has opened: turn it into a virtual contact."""
    reset_forces(h, ic)
    lose_joint(h, ic)
    puti(h, ic, g.KCCOD, g.VIRTUAL)
    h.ci[g.NVIRT] += 1
    if iget(h, iget(h, ic, g.KD1), g.KDLRG) != 0:
        one, two = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
        request_search(h, one if getr(h, one, g.KBRO) < getr(h, two, g.KBRO) else two)


@kernel
def relabel(h: Memory, iad: int, ib: int, idm: int) -> None:
    """Assign domain `idm` to the loop through (iad, ib), whose blocks are to search if it is large."""
    large = iget(h, idm, g.KDLRG) != 0
    item, block = int64(iad), int64(ib)
    while True:
        before = block
        item, block = nextd(h, item, block)
        if is_contact(h, item):
            if iget(h, item, g.KB1) == before:
                puti(h, item, g.KD1, idm)
            else:
                puti(h, item, g.KD2, idm)
        if large:
            request_search(h, block)
        if item == iad and block == ib:
            return


@kernel
def left_is_shorter(h: Memory, ic: int) -> bool:
    """True if the loop to the left of contact `ic` has no more items than the one to its right."""
    ib, jb = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    litem, lblock = ic, jb
    ritem, rblock = ic, ib
    while True:
        litem, lblock = nextd(h, litem, lblock)
        if litem == ic and lblock == jb:
            return True
        ritem, rblock = nextd(h, ritem, rblock)
        if ritem == ic and rblock == ib:
            return False


@kernel
def loop_area(h: Memory, iad: int, ib: int) -> float:
    """Area inside the loop through (iad, ib); negative if the loop is the outline of the whole map.

    The loop is taken through its corners and contact points; virtual contacts have no place.
    """
    twice = real(h, 0.0)
    fx, fy = twice, twice  # first corner of the loop
    ax, ay = twice, twice  # corner before the current one
    first = True
    item, block = int64(iad), int64(ib)
    while True:
        if is_corner(h, item) or iget(h, item, g.KCCOD) != g.VIRTUAL:
            if is_corner(h, item):
                bx, by = getr(h, item, g.KXP), getr(h, item, g.KYP)
            else:
                bx, by = getr(h, item, g.KXC), getr(h, item, g.KYC)
            if first:
                fx, fy, ax, ay, first = bx, by, bx, by, False
            twice += (ax - fx) * (by - fy) - (bx - fx) * (ay - fy)
            ax, ay = bx, by
        item, block = nextd(h, item, block)
        if item == iad and block == ib:
            return twice * real(h, 0.5)


@kernel
def is_outline(h: Memory, iad: int, ib: int) -> bool:
    """True if the loop through (iad, ib) runs around block `ib` and the blocks connected with it.

    False if it bounds a space between blocks. A space may be a crack whose area has either sign; an outline
    has at least the area of the block, with a negative sign.
    """
    area, _, _, _, _, _ = geo(h, ib)
    return loop_area(h, iad, ib) < -area * real(h, 0.5)


@kernel
def cut_domain(h: Memory, ic: int, idm: int) -> int:
    """Contact `ic` has just been put across domain `idm`: split it (BRIDGE). Returns the new domain."""
    idnew = maked(h)
    block = iget(h, ic, g.KB2) if left_is_shorter(h, ic) else iget(h, ic, g.KB1)
    relabel(h, ic, block, idnew)
    puti(h, idnew, g.KDLOOP, ic)
    puti(h, idm, g.KDLOOP, ic)
    if idm == h.ci[g.IODPNT] and is_outline(h, ic, block):
        h.ci[g.IODPNT] = idnew
    if h.ci[g.LWATER] != 0:
        cut_water(h, idm, idnew)
    return idnew


@kernel
def bridge(h: Memory, ib: int, iad: int, jb: int, jad: int, icod: int, idm: int) -> int:
    """Make a contact of code `icod` across domain `idm` (BRIDGE).

    It is put after item `iad` of block `ib` and after item `jad` of block `jb`; the exposures of both are on
    the domain. Returns the contact; the domain to its left or right is new.
    """
    ic = makec(h, ib, jb, icod, idm, idm)
    insert_after(h, ib, iad, ic)
    insert_after(h, jb, jad, ic)
    begin_contact(h, ic)
    cut_domain(h, ic, idm)
    return ic


@kernel
def delc(h: Memory, ic: int) -> int:
    """Delete contact `ic`, which separates two domains, and merge these (DELC); returns the merged one."""
    ib, jb = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    if left_is_shorter(h, ic):
        gone, kept = iget(h, ic, g.KD1), iget(h, ic, g.KD2)
        relabel(h, ic, jb, kept)
    else:
        gone, kept = iget(h, ic, g.KD2), iget(h, ic, g.KD1)
        relabel(h, ic, ib, kept)
    item, block = nextd(h, ic, jb)
    while is_corner(h, item) or item == ic:
        item, block = nextd(h, item, block)
    puti(h, kept, g.KDLOOP, item)
    if h.ci[g.LWATER] != 0:
        merge_water(h, gone, kept)
    if h.ci[g.IODPNT] == gone:
        h.ci[g.IODPNT] = kept
    if iget(h, kept, g.KDLRG) == 0:  # if only the other one was large, the update finds whether this one is
        flag(h, kept)
    take_out(h, ib, ic)
    take_out(h, jb, ic)
    losec(h, ic)
    dellst(h, g.IDPNT, g.KD, g.KDB, gone)
    puti(h, gone, HEAD, 0)
    if iget(h, gone, g.KDEX) != 0:
        lose(h, iget(h, gone, g.KDEX), g.NVDE)
    lose_domain(h, gone)
    h.ci[g.NDOM] -= 1
    return kept
