"""Virtual contacts, which keep separated blocks in the map (report 4.6).

A contact whose removal would divide the map stays as a virtual contact when it opens. The boundary of its
domain then consists of several loops, pieces that only virtual contacts link. A virtual contact may be
anywhere on the two pieces that it links. When pieces touch, there are two cases:

- pieces linked by virtual contacts touch: the new contact replaces a virtual contact between them, wherever
  that one is (`rehook`);
- a piece touches itself and thereby cuts the domain: all virtual contacts of the domain are removed, the
  piece's own loop is cut, and every other piece is linked to the side of the cut on which it lies
  (`cut_among_pieces`).

The report calls this logic "quite straightforward" but had no time to write it. With it a block that is
thrown over others can land anywhere.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti, putr, real
from udec_ia.kernels.constitutive.joint_laws import reset_forces
from udec_ia.kernels.constitutive.joint_properties import assign_material
from udec_ia.kernels.geometry.block_shape import geo, zcs
from udec_ia.kernels.geometry.contact_geometry import begin_contact
from udec_ia.kernels.links.linked_lists import insert_after, is_corner, prevcp, take_out
from udec_ia.kernels.map.bridge import (
    cut_domain,
    is_outline,
    left_is_shorter,
    makec,
    nextd,
    relabel,
)
from udec_ia.kernels.map.domain_segments import not_virtual
from udec_ia.layout import offsets as g

MINE = 2  # column of the pieces


@kernel
def take_contact_out(h: Memory, ic: int) -> None:
    """Take contact `ic` out of the lists of both its blocks."""
    take_out(h, iget(h, ic, g.KB1), ic)
    take_out(h, iget(h, ic, g.KB2), ic)


@kernel
def put_contact(h: Memory, ic: int, ib: int, iad: int, jb: int, jad: int) -> None:
    """Put contact `ic` into the lists of blocks `ib` (after item `iad`) and `jb` (after item `jad`)."""
    puti(h, ic, g.KB1, ib)
    puti(h, ic, g.KB2, jb)
    insert_after(h, ib, iad, ic)
    insert_after(h, jb, jad, ic)


@kernel
def rehook(h: Memory, iv: int, ib: int, iad: int, jb: int, jad: int, icod: int) -> None:
    """Virtual contact `iv` becomes a contact of code `icod` of blocks `ib` and `jb`.

    It links the same two parts of the map at another place, so no domain changes.
    """
    if iad == iv:
        iad = prevcp(h, ib, iv)
    if jad == iv:
        jad = prevcp(h, jb, iv)
    take_contact_out(h, iv)
    put_contact(h, iv, ib, iad, jb, jad)
    assign_material(h, iv)
    puti(h, iv, g.KCCOD, icod)
    reset_forces(h, iv)
    begin_contact(h, iv)
    h.ci[g.NVIRT] -= 1
    h.ci[g.NMADE] += 1


@inlined
def place_of(h: Memory, item: int) -> tuple[float, float]:
    """Coordinates of a corner, or of a contact that is not virtual."""
    if is_corner(h, item):
        return getr(h, item, g.KXP), getr(h, item, g.KYP)
    return getr(h, item, g.KXC), getr(h, item, g.KYC)


@kernel
def winding(h: Memory, iad: int, ib: int, x: float, y: float) -> int:
    """Winding number of the loop through (iad, ib) around the point (x, y), anticlockwise.

    That of a loop of several pieces is the sum of theirs: virtual contacts have no place.
    """
    turns = 0
    item, block = int64(iad), int64(ib)
    start, first = item, block
    while True:
        ax, ay = place_of(h, not_virtual(h, block, item))
        item, block = nextd(h, item, block)
        if is_corner(h, item) or iget(h, item, g.KCCOD) != g.VIRTUAL:
            bx, by = place_of(h, item)
            side = (ax - x) * (by - y) - (bx - x) * (ay - y)
            if ay <= y and by > y and side > 0:
                turns += 1
            elif ay > y and by <= y and side < 0:
                turns -= 1
        if item == start and block == first:
            return turns


@kernel
def point_inside(h: Memory, ib: int) -> tuple[float, float]:
    """A point in block `ib`, as far from its outline as others may stick into it.

    It is behind the middle of its longest edge, by D or a part of its width.
    """
    half, longest, ip0 = real(h, 0.5), real(h, 0.0), iget(h, ib, g.KP)
    ip = ip0
    best = ip
    around = longest
    while True:
        z, _, _ = zcs(h, ip)
        around += z
        if z > longest:
            longest, best = z, ip
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            break
    area, _, _, _, _, _ = geo(h, ib)
    depth = min(h.cr[g.DTOL], area / around * half)
    z, c, s = zcs(h, best)
    ia = iget(h, best, g.KR)
    x, y = getr(h, best, g.KXP) + getr(h, ia, g.KXP), getr(h, best, g.KYP) + getr(h, ia, g.KYP)
    return x * half + s * depth, y * half - c * depth


@kernel
def lies_in(h: Memory, iad: int, ib: int, jb: int) -> bool:
    """True if block `jb` lies in the region bounded by the loop through (iad, ib)."""
    x, y = point_inside(h, jb)
    turns = winding(h, iad, ib, x, y)
    return turns == 0 if is_outline(h, iad, ib) else turns > 0


@kernel
def hook(h: Memory, iv: int, ib: int, iad: int, jb: int, jad: int, idm: int) -> None:
    """Put virtual contact `iv` between two pieces on the boundary of domain `idm`."""
    put_contact(h, iv, ib, iad, jb, jad)
    puti(h, iv, g.KD1, idm)
    puti(h, iv, g.KD2, idm)
    putr(h, iv, g.KXC, getr(h, iget(h, jb, g.KP), g.KXP))
    putr(h, iv, g.KYC, getr(h, iget(h, jb, g.KP), g.KYP))
    putr(h, iv, g.KCN, real(h, 0.0))


@kernel
def cut_among_pieces(
    h: Memory, ib: int, iad: int, jb: int, jad: int, icod: int, idm: int, ties: Any, pieces: Any
) -> int:
    """Make a contact that cuts domain `idm` while virtual contacts link other pieces to the domain.

    ties: the virtual contacts of the domain. pieces: one row (block, item, mine) a piece; the exposure
    after the item lies on the piece; mine is 1 for the piece that the new contact belongs to, else 0, and
    becomes 2 if the piece lies in the new domain. There is one piece more than there are ties. Returns
    the new domain.
    """
    iad = not_virtual(h, ib, iad)
    jad = not_virtual(h, jb, jad)
    for k in range(len(pieces)):
        pieces[k, 1] = not_virtual(h, pieces[k, 0], pieces[k, 1])
    for k in range(len(ties)):
        take_contact_out(h, ties[k])
    ic = makec(h, ib, jb, icod, idm, idm)
    insert_after(h, ib, iad, ic)
    insert_after(h, jb, jad, ic)
    begin_contact(h, ic)
    new_is_left = left_is_shorter(h, ic)
    idnew = cut_domain(h, ic, idm)
    inner, outer = (jb, ib) if new_is_left else (ib, jb)
    for k in range(len(pieces)):
        pieces[k, MINE] = pieces[k, MINE] or (2 if lies_in(h, ic, inner, pieces[k, 0]) else 0)
    tie = 0
    for k in range(len(pieces)):
        pb, item = pieces[k, 0], pieces[k, 1]
        if pieces[k, MINE] == 2:
            relabel(h, item, pb, idnew)
            hook(h, ties[tie], inner, ic, pb, item, idnew)
        elif pieces[k, MINE] == 0:
            hook(h, ties[tie], outer, ic, pb, item, idm)
        if pieces[k, MINE] != 1:
            tie += 1
    return idnew
