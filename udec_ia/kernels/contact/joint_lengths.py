"""Lengths of joints: which domains are joints, and the length of each contact of a joint (report 2.4, 3.1d).

A domain is a joint if it has exactly two contacts, both of the same two blocks, with normals within 30
degrees; if no true corner lies between them but those on whose arcs they are; and if every point of an edge
between them is nearer than BTOL to the line from one to the other. The outer domain is not a joint.

The lengths of a joint add up to the overlap of the two edges, as they are without rounding:

    between two contacts     p, shared by both; their stress is linear there (constitutive/joint_stresses.py)
    ... of blocks with zones half the distance to the nearest contact or grid-point, so that an opened
                             contact in the middle changes nothing for its neighbours
    at the end of a joint    the distance to the true corner where the shorter edge ends; its force acts at
                             the contact, where its closure is, so that it does the work that it stores
    alone                    2 D; the part that was closed, if an open contact beside it was deleted

Lengths are found when contacts were made or broken, and when blocks have slid by HTOL since. Stress is kept:
a change of length changes the forces, and the stored energy that comes or goes is part of WSHAPE.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, puti, putr, real
from udec_ia.kernels.constitutive.joint_materials import (
    ALONG,
    BY_BLOCKS,
    NONE,
    begin_joint,
    clear_flag,
    has_flag,
    is_lumped,
    is_per_contact,
    joint_material,
    lose_joint,
)
from udec_ia.kernels.constitutive.joint_models import (
    begin_model,
    closure_of,
    joint_model,
    joint_values,
    set_stresses,
    stiffness_under,
)
from udec_ia.kernels.constitutive.joint_stresses import (
    SIDE1,
    SIDE2,
    check_stiffness,
    is_open,
    joint_energy,
    joint_neighbour,
    mark_neighbours,
    needs_lengths,
    part_on_side,
    set_length,
    set_length_between_passes,
)
from udec_ia.kernels.contact.edge_to_edge import extend_domains, uses_ends
from udec_ia.kernels.geometry.block_shape import is_edge_point
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, nextcp, other
from udec_ia.kernels.links.longer_groups import joint_at, joint_behind
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
def _toward_corner(h: Memory, ic: int, ib: int, tx: float, ty: float) -> float:
    """Distance along (tx, ty) from contact `ic` to the corner of block `ib` on whose arc it is."""
    ip = corner_of(h, ib, ic)
    return (getr(h, ip, g.KXP) - getr(h, ic, g.KXC)) * tx + (getr(h, ip, g.KYP) - getr(h, ic, g.KYC)) * ty


@kernel
def node_offset(h: Memory, ic: int, tx: float, ty: float) -> float:
    """Distance along (tx, ty) from contact `ic` to the point at which its force acts.

    It is 0, or leads to the corner of a fully-deformable block on whose arc the contact is: its grid-point
    takes the force.
    """
    for ib in (iget(h, ic, g.KB1), iget(h, ic, g.KB2)):
        if iget(h, ib, HEAD) == g.MFDEF and is_on_arc(h, ib, ic):
            return _toward_corner(h, ic, ib, tx, ty)
    return real(h, 0.0)


@kernel
def _nearest_point(
    h: Memory, ib: int, first: int, last: int, ic: int, tx: float, ty: float, here: float, there: float
) -> tuple[bool, float]:
    """True if the chain of block `ib` from `first` to `last` is a side of a joint, and the nearest point.

    (tx, ty): direction along the joint from contact `ic`. here, there: distances of both nodes. The nearest
    point is the least distance of a point of the edge behind `here`; `there` if there is none before that. A
    point nearer than FTOL to a node is at the node.
    """
    x, y, nearest = getr(h, ic, g.KXC), getr(h, ic, g.KYC), there
    one = corner_of(h, ib, first) if is_on_arc(h, ib, first) else int64(0)
    two = corner_of(h, ib, last) if is_on_arc(h, ib, last) else int64(0)
    item = nextcp(h, ib, first)
    while item != last:
        if item != one and item != two:
            dx, dy = getr(h, item, g.KXP) - x, getr(h, item, g.KYP) - y
            flat = getr(h, item, g.KRAD) == 0 or is_edge_point(h, item)
            if not flat or abs(dx * ty - dy * tx) > h.cr[g.BTOL]:
                return False, nearest
            along = dx * tx + dy * ty
            if along > here + h.cr[g.FTOL]:
                nearest = min(nearest, along)
        item = nextcp(h, ib, item)
    return True, nearest


@kernel
def joint_on_side(h: Memory, ic: int, side: int) -> tuple[float, float]:
    """Distance of the other contact of the joint on that side of contact `ic`, and of the nearest point.

    The nearest point is the place where the force of the other contact acts, or a grid-point before it. Both
    are negative if the domain there is no joint.
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
    here, there = node_offset(h, ic, tx, ty), p + node_offset(h, jc, tx, ty)
    one, near = _nearest_point(h, ib, ic, jc, ic, tx, ty, here, there)
    two, far = _nearest_point(h, jb, jc, ic, ic, tx, ty, here, there)
    if not (one and two):
        return none, none
    return p, max(min(near, far) - here, real(h, 0.0))


@kernel
def end_of_joint(h: Memory, ic: int, side: int) -> float:
    """Distance from contact `ic` to the true corner at which the joint ends on that side."""
    nx, ny = _normal(h, ic, iget(h, ic, g.KB1))
    tx, ty = (-ny, nx) if side == SIDE1 else (ny, -nx)
    distance, found = real(h, np.inf), False
    for ib in (iget(h, ic, g.KB1), iget(h, ic, g.KB2)):
        if is_on_arc(h, ib, ic):
            distance, found = min(distance, max(_toward_corner(h, ic, ib, tx, ty), real(h, 0.0))), True
    return distance if found else h.cr[g.DTOL]


@inlined
def is_meshed(h: Memory, ic: int) -> bool:
    """True if a block of contact `ic` is fully-deformable: its force goes to grid-points."""
    return iget(h, iget(h, ic, g.KB1), HEAD) == g.MFDEF or iget(h, iget(h, ic, g.KB2), HEAD) == g.MFDEF


@kernel
def parts_of_length(h: Memory, ic: int) -> tuple[float, float, float, float]:
    """Length of its own of contact `ic`, distance of its force, and distances p of linear stress.

    The first two are KCJOWN and KCJX, the others KCJP1 and KCJP2. The force is at a grid-point, or at the
    contact if the blocks have no zones.
    """
    zero, half = real(h, 0.0), real(h, 0.5)
    p1, near1 = joint_on_side(h, ic, SIDE1)
    p2, near2 = joint_on_side(h, ic, SIDE2)
    nx, ny = _normal(h, ic, iget(h, ic, g.KB1))
    node = node_offset(h, ic, ny, -nx)
    if p1 < 0 and p2 < 0:
        return h.cr[g.DTOL] + h.cr[g.DTOL], node, zero, zero
    end1 = end_of_joint(h, ic, SIDE1) if p1 < 0 else zero
    end2 = end_of_joint(h, ic, SIDE2) if p2 < 0 else zero
    if is_meshed(h, ic):
        ends = max(end1 + node if p1 < 0 else zero, zero) + max(end2 - node if p2 < 0 else zero, zero)
        return ends + (max(near1, zero) + max(near2, zero)) * half, node, zero, zero
    return end1 + end2, zero, max(p1, zero), max(p2, zero)


@kernel
def keep_closed_part(h: Memory, ic: int, ix: int) -> float:
    """Make the part of joint `ix` beside an open neighbour that was deleted a length of its own.

    So the length does not change. Returns the additional energy (J/m), as the stress is now constant there.
    """
    part, lost = (getr(h, ix, g.KCJL) - getr(h, ix, g.KCJOWN)) * real(h, 2.0), False
    for side, flag, p in ((SIDE1, g.OPENS_BESIDE1, g.KCJP1), (SIDE2, g.OPENS_BESIDE2, g.KCJP2)):
        if has_flag(h, ix, flag) and joint_neighbour(h, ic, side) == 0:
            putr(h, ix, p, real(h, 0.0))
            clear_flag(h, ix, flag)
            lost = True
        else:
            part -= part_on_side(h, ic, ix, side, getr(h, ix, p), False)
    if not lost:
        return real(h, 0.0)
    putr(h, ix, g.KCJOWN, getr(h, ix, g.KCJOWN) + part * real(h, 0.5))
    sn = getr(h, ix, g.KCJSN)
    kn, _ = stiffness_under(h, joint_values(h, ic, ix), sn)
    return real(h, 0.0) if is_lumped(h, ix) else part * sn * sn / (kn * real(h, 12.0))


@kernel
def find_lengths(h: Memory, ic: int, ix: int, in_cycle: bool) -> None:
    """Lengths of contact `ic` with joint `ix`; its stresses stay.

    in_cycle: WSHAPE gets the energy by which the new parts of the length differ from the old ones, in the
    same state, and WFRIC that of parts that open. In a command it is part of what the command puts in.
    """
    added = keep_closed_part(h, ic, ix)
    lost = set_length_between_passes(h, ic, ix)
    before, shear = joint_energy(h, ic, ix)
    before += shear - added
    own, place, p1, p2 = parts_of_length(h, ic)
    if p1 == 0 and p2 == 0 and not (is_meshed(h, ic) or is_open(h, ix)):
        own = max(own, getr(h, ix, g.KCJOWN))
    if is_per_contact(h, ix):
        own, p1, p2 = real(h, 1.0), real(h, 0.0), real(h, 0.0)
    putr(h, ix, g.KCJOWN, own)
    putr(h, ix, g.KCJX, place)
    putr(h, ix, g.KCJP1, p1)
    putr(h, ix, g.KCJP2, p2)
    set_length(h, ic, ix, False)
    putr(h, ix, g.KCJUSL, getr(h, ic, g.KCS))
    clear_flag(h, ix, g.JOINT_STALE)
    if getr(h, ix, g.KCJKN) > 0:
        check_stiffness(h, ix, joint_values(h, ic, ix))
    after, shear = joint_energy(h, ic, ix)
    if in_cycle:
        h.cd[g.WFRIC] += lost
        if h.ci[g.LENER] != 0:
            h.cd[g.WSHAPE] -= np.float64(after + shear - before)


@inlined
def waits_for_length(h: Memory, ic: int) -> bool:
    """True if contact `ic` has a joint whose lengths are to be found."""
    ix = joint_at(h, ic)
    return ix != 0 and needs_lengths(h, ic, ix)


@kernel
def renew_lengths(h: Memory, waiting: Any, n: int) -> None:
    """Find the lengths of joints that have slid by HTOL, open soon, or have a neighbour that does.

    waiting, n: as of change_map. In each cycle lengths follow from the state after the others have moved, so
    that they do not depend on the order of the contacts.
    """
    for k in range(n):
        if waiting[k] < 0 and waits_for_length(h, -waiting[k]):
            find_lengths(h, -waiting[k], joint_behind(h, -waiting[k]), True)
    for k in range(n):
        ix = joint_at(h, -waiting[k]) if waiting[k] < 0 else int64(0)
        if ix != 0 and has_flag(h, ix, g.BEGINS_OPENING):
            clear_flag(h, ix, g.BEGINS_OPENING)
            mark_neighbours(h, -waiting[k])


X, Y, NX, NY, NODE, END1, END2 = range(7)  # columns of what joint_geometry finds


@kernel
def joint_geometry(h: Memory, contacts: Any, found: Any, neighbours: Any) -> None:
    """Place and normal of contacts, distances of their nodes and of the ends of joints.

    contacts: (n,) addresses, not of virtual ones. found: (n, 7) reals; NODE is towards side KD2. neighbours:
    (n, 2) addresses of the contacts with which each forms a joint on its two sides, 0 for none.
    """
    for k in range(len(contacts)):
        ic = contacts[k]
        nx, ny = _normal(h, ic, iget(h, ic, g.KB1))
        p1, _ = joint_on_side(h, ic, SIDE1)
        p2, _ = joint_on_side(h, ic, SIDE2)
        found[k, X], found[k, Y] = getr(h, ic, g.KXC), getr(h, ic, g.KYC)
        found[k, NX], found[k, NY], found[k, NODE] = nx, ny, node_offset(h, ic, ny, -nx)
        found[k, END1], found[k, END2] = end_of_joint(h, ic, SIDE1), end_of_joint(h, ic, SIDE2)
        neighbours[k, 0] = _next_contact(h, iget(h, ic, g.KB2), ic) if p1 >= 0 else 0
        neighbours[k, 1] = _next_contact(h, iget(h, ic, g.KB1), ic) if p2 >= 0 else 0


@kernel
def keep_force(h: Memory, ic: int, ix: int) -> None:
    """The stresses of contact `ic` become forces (CONTACT) or the other way round; its force stays."""
    fn, fs = getr(h, ix, g.KCJL) * getr(h, ix, g.KCJSN), getr(h, ix, g.KCJL) * getr(h, ix, g.KCJTS)
    putr(h, ix, g.KCJOWN, real(h, 0.0))
    find_lengths(h, ic, ix, False)
    length = getr(h, ix, g.KCJL)
    if length > 0:
        putr(h, ix, g.KCJSN, fn / length)
        putr(h, ix, g.KCJTS, fs / length)


@kernel
def keep_stress(h: Memory, ic: int, ix: int) -> None:
    """Keep the stresses of contact `ic` with joint material -1 if its material has another stiffness now."""
    sn, kn = getr(h, ix, g.KCJSN), joint_values(h, ic, ix).kn
    if abs(kn * closure_of(h, ix) - sn) > abs(sn) * real(h, 1e-5):
        set_stresses(h, ic, ix, sn, getr(h, ix, g.KCJTS))


@kernel
def close_rounding_gap(h: Memory, ic: int, ix: int) -> None:
    """Without stress a joint with tensile strength is closed: a gap between two roundings is its offset."""
    if has_flag(h, ix, g.JOINT_BROKEN) or getr(h, ix, g.KCJSN) != 0:
        return
    if joint_values(h, ic, ix).tension > 0:
        putr(h, ix, g.KCJOFF, max(-getr(h, ic, g.KCN), real(h, 0.0)))


@kernel
def set_joint_material(h: Memory, ic: int, mat: int, is_whole: bool) -> None:
    """Give contact `ic` joint material `mat`, or NONE.

    A force that the contact has becomes stress of the joint. is_whole: as of begin_joint, for a contact that
    is not open.
    """
    ix = joint_at(h, ic)
    if mat == NONE:
        lose_joint(h, ic)
    elif ix == 0:
        ix = begin_joint(h, ic, mat, is_whole and getr(h, ic, g.KCN) >= -h.cr[g.FTOL])
        close_rounding_gap(h, ic, ix)
        find_lengths(h, ic, ix, False)
        if getr(h, ic, g.KCFN) != 0:
            length = getr(h, ix, g.KCJL)
            set_stresses(h, ic, ix, getr(h, ic, g.KCFN) / length, getr(h, ic, g.KCFS) / length)
    elif iget(h, ix, g.KCJMAT) != mat:
        model, per_contact = joint_model(h, ix), is_per_contact(h, ix)
        puti(h, ix, g.KCJMAT, mat)
        if joint_model(h, ix) != model:
            begin_model(h, ix)
        if is_per_contact(h, ix) != per_contact:
            keep_force(h, ic, ix)
        set_stresses(h, ic, ix, getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS))


@kernel
def forces_of_stresses(h: Memory) -> bool:
    """Forces of all joints from their stresses and lengths, between two cycles. True if one has changed."""
    changed = False
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        ix = joint_at(h, ic)
        if ix != 0:
            fn, fs = getr(h, ix, g.KCJL) * getr(h, ix, g.KCJSN), getr(h, ix, g.KCJL) * getr(h, ix, g.KCJTS)
            changed = changed or fn != getr(h, ic, g.KCFN) or fs != getr(h, ic, g.KCFS)
            putr(h, ic, g.KCFN, fn)
            putr(h, ic, g.KCFS, fs)
        ic = iget(h, ic, g.KC)
    return changed


@outlined
def update_joints(h: Memory, all_of_them: bool) -> bool:
    """Assign joint materials and find all lengths if contacts were made or broken since.

    all_of_them: always, after a command, which may have changed the rules. New joints have their tensile
    strength then, and before the first cycle. A contact that forms later has none.
    False if there is no memory; then it is to be called again.
    """
    made = h.ci[g.NMADE] + h.ci[g.NBROKE]
    if not all_of_them and h.ci[g.NSEEN] == made:
        return True
    is_whole = all_of_them or h.ci[g.MCTOT] == 0
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            set_joint_material(h, ic, joint_material(h, ic), is_whole)
        ic = iget(h, ic, g.KC)
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        ix = joint_at(h, ic)
        if ix != 0 and iget(h, ic, g.KCCOD) != g.VIRTUAL:
            find_lengths(h, ic, ix, not all_of_them)
            if all_of_them and h.ci[g.MCTOT] == 0:  # corners may have got another rounding
                close_rounding_gap(h, ic, ix)
            if all_of_them and iget(h, ix, g.KCJMAT) == BY_BLOCKS:
                keep_stress(h, ic, ix)
        ic = iget(h, ic, g.KC)
    if (all_of_them or uses_ends(h)) and not extend_domains(h):
        return False
    h.ci[g.NSEEN] = made
    return True
