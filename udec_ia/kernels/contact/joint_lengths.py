"""Lengths of joints: which domains are joints, and what length each contact of a joint has (report 2.4, 3.1d).

A domain is a joint if it has exactly two contacts, both of the same two blocks, with normals within 30 degrees;
if no true corner lies between them but those on whose arcs they are; and if every point of an edge between
them is nearer than BTOL to the line from one to the other. The outer domain is none.

The lengths of a joint add up to the overlap of the two edges, as they are without rounding:

    between two contacts     p, shared by both; their stress is linear there (constitutive/joint_stresses.py)
    ... with grid-points     half the distance to the nearest contact or grid-point, so that an opened contact
                             in the middle changes nothing for its neighbours; also at fully-deformable blocks
    at the end of a joint    the distance to the true corner where the shorter edge ends
    no joint on either side  2 D

Lengths are found when contacts were made or broken, and when blocks have slid by HTOL since. Stress is kept: a
change of length changes the forces, and the stored energy that comes or goes is part of WSHAPE.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, puti, putr, real, size_of
from udec_ia.heap.find_lose import room
from udec_ia.kernels.constitutive.joint_materials import (
    ALONG,
    clear_flag,
    has_flag,
    joint_material,
    lose_joint,
    make_joint,
)
from udec_ia.kernels.constitutive.joint_models import take_stresses
from udec_ia.kernels.constitutive.joint_stresses import SIDE1, SIDE2, closed_length, joint_energy
from udec_ia.kernels.geometry.block_shape import is_edge_point
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, nextcp, other
from udec_ia.kernels.map.domain_segments import is_on_arc
from udec_ia.layout import offsets as g


@kernel
def _normal(h: Memory, ic: int, ib: int) -> tuple[float, float]:
    """Normal of contact `ic`, away from its block `ib`."""
    nx, ny, _, _, _, _ = meet(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
    return (nx, ny) if iget(h, ic, g.KB1) == ib else (-nx, -ny)


@kernel
def _next_contact(h: Memory, ib: int, ic: int) -> int:
    """First contact after contact `ic` in the list of block `ib`; `ic` itself if it is the only one."""
    item = nextcp(h, ib, ic)
    while is_corner(h, item):
        item = nextcp(h, ib, item)
    return item


@kernel
def _nearest_point(
    h: Memory, ib: int, ic: int, jc: int, tx: float, ty: float, p: float
) -> tuple[bool, float]:
    """True if the chain of block `ib` from contact `ic` to `jc` is one side of a joint, and the nearest point.

    (tx, ty): direction from one contact to the other, which is p away. The nearest point is the least distance
    of a point of the edge from the contact at which (tx, ty) begins, `p` if there is none between.
    """
    x, y, nearest = getr(h, ic, g.KXC), getr(h, ic, g.KYC), p
    one = corner_of(h, ib, ic) if is_on_arc(h, ib, ic) else int64(0)
    two = corner_of(h, ib, jc) if is_on_arc(h, ib, jc) else int64(0)
    item = nextcp(h, ib, ic)
    while item != jc:
        if item != one and item != two:
            dx, dy = getr(h, item, g.KXP) - x, getr(h, item, g.KYP) - y
            flat = getr(h, item, g.KRAD) == 0 or is_edge_point(h, item)
            if not flat or abs(dx * ty - dy * tx) > h.cr[g.BTOL]:
                return False, nearest
            nearest = min(nearest, max(dx * tx + dy * ty, real(h, 0.0)))
        item = nextcp(h, ib, item)
    return True, nearest


@kernel
def joint_on_side(h: Memory, ic: int, side: int) -> tuple[float, float]:
    """Distance of the other contact of the joint on that side of contact `ic`, and of the nearest point.

    The nearest grid-point, or the other contact. Both are negative if the domain there is no joint.
    """
    none = real(h, -1.0)
    ib, jb = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    if side == SIDE1:
        ib, jb = jb, ib
    jc = _next_contact(h, ib, ic)
    if jc == ic or iget(h, jc, g.KCCOD) == g.VIRTUAL or other(h, ib, jc) != jb:
        return none, none
    if _next_contact(h, jb, jc) != ic or iget(h, ic, g.KD1 if side == SIDE1 else g.KD2) == h.ci[g.IODPNT]:
        return none, none
    nx, ny = _normal(h, ic, ib)
    mx, my = _normal(h, jc, ib)
    if nx * mx + ny * my < real(h, ALONG):
        return none, none
    tx, ty = getr(h, jc, g.KXC) - getr(h, ic, g.KXC), getr(h, jc, g.KYC) - getr(h, ic, g.KYC)
    p = np.sqrt(tx * tx + ty * ty)
    if not p > 0:
        return p, p
    tx, ty = tx / p, ty / p
    one, near = _nearest_point(h, ib, ic, jc, tx, ty, p)
    two, far = _nearest_point(h, jb, jc, ic, -tx, -ty, p)
    if not (one and two):
        return none, none
    return p, min(near, p - far if far < p else p)


@kernel
def end_of_joint(h: Memory, ic: int, side: int) -> float:
    """Distance from contact `ic` to the true corner at which the joint ends on that side."""
    nx, ny = _normal(h, ic, iget(h, ic, g.KB1))
    tx, ty = (-ny, nx) if side == SIDE1 else (ny, -nx)
    distance, found = real(h, np.inf), False
    for ib in (iget(h, ic, g.KB1), iget(h, ic, g.KB2)):
        if is_on_arc(h, ib, ic):
            ip, found = corner_of(h, ib, ic), True
            dx, dy = getr(h, ip, g.KXP) - getr(h, ic, g.KXC), getr(h, ip, g.KYP) - getr(h, ic, g.KYC)
            distance = min(distance, max(dx * tx + dy * ty, real(h, 0.0)))
    return distance if found else h.cr[g.DTOL]


@kernel
def find_lengths(h: Memory, ic: int, ix: int) -> None:
    """Lengths of contact `ic`; its stresses stay."""
    zero, half = real(h, 0.0), real(h, 0.5)
    meshed = iget(h, iget(h, ic, g.KB1), HEAD) == g.MFDEF or iget(h, iget(h, ic, g.KB2), HEAD) == g.MFDEF
    before, shear = joint_energy(h, ic, ix)
    before += shear
    own, linear1, linear2 = zero, zero, zero
    p1, near1 = joint_on_side(h, ic, SIDE1)
    p2, near2 = joint_on_side(h, ic, SIDE2)
    if p1 < 0 and p2 < 0:
        own = h.cr[g.DTOL] + h.cr[g.DTOL]
    else:
        if p1 < 0:
            own += end_of_joint(h, ic, SIDE1)
        elif meshed or near1 < p1:
            own += near1 * half
        else:
            linear1 = p1
        if p2 < 0:
            own += end_of_joint(h, ic, SIDE2)
        elif meshed or near2 < p2:
            own += near2 * half
        else:
            linear2 = p2
    putr(h, ix, g.KJOWN, own)
    putr(h, ix, g.KJP1, linear1)
    putr(h, ix, g.KJP2, linear2)
    length, place = closed_length(h, ic, ix)
    putr(h, ix, g.KJL, length)
    putr(h, ix, g.KJX, place)
    putr(h, ix, g.KJUSL, getr(h, ix, g.KJUS))
    clear_flag(h, ix, g.JOINT_STALE)
    after, shear = joint_energy(h, ic, ix)
    if h.ci[g.LENER] != 0:
        h.cd[g.WSHAPE] -= np.float64(after + shear - before)


@kernel
def set_joint_material(h: Memory, ic: int, mat: int, is_whole: bool) -> bool:
    """Give contact `ic` joint material `mat`, 0 for none. False without memory.

    A force that the contact has becomes stress of the joint. is_whole: as of make_joint.
    """
    ix = iget(h, ic, g.KCEX)
    if mat == 0:
        lose_joint(h, ic)
    elif ix == 0:
        if not room(h, int64(size_of(h, g.NVDE))):
            return False
        ix = make_joint(h, ic, mat, is_whole)
        find_lengths(h, ic, ix)
        if getr(h, ic, g.KCFN) != 0:
            length = getr(h, ix, g.KJL)
            take_stresses(h, ix, getr(h, ic, g.KCFN) / length, getr(h, ic, g.KCFS) / length)
    elif iget(h, ix, g.KJMAT) != mat:
        puti(h, ix, g.KJMAT, mat)
        take_stresses(h, ix, getr(h, ix, g.KJSN), getr(h, ix, g.KJTS))
    return True


@outlined
def update_joints(h: Memory, all_of_them: bool) -> bool:
    """Assign joint materials and find lengths where the map or sliding has changed them. False without memory.

    all_of_them: after a command, which may have changed the rules. New joints have their tensile strength then,
    and before the first cycle. A contact that forms later has none.
    """
    is_whole = all_of_them or h.ci[g.MCTOT] == 0
    changed = all_of_them or h.ci[g.NSEEN] != h.ci[g.NMADE] + h.ci[g.NBROKE]
    if not changed and h.ci[g.LSTALE] == 0:
        return True
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            if changed and not set_joint_material(h, ic, joint_material(h, ic), is_whole):
                return False
            ix = iget(h, ic, g.KCEX)
            if ix != 0 and (changed or has_flag(h, ix, g.JOINT_STALE)):
                find_lengths(h, ic, ix)
        ic = iget(h, ic, g.KC)
    h.ci[g.NSEEN] = h.ci[g.NMADE] + h.ci[g.NBROKE]
    h.ci[g.LSTALE] = 0
    return True
