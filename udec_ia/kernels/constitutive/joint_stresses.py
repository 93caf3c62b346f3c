"""Forces of a contact with a joint material: its stresses times the length that is closed (report 2.4).

The stress of a joint is linear between two contacts A and B of it, at the distance p:

    both closed    the stress sA at A acts on p/2, with its resultant at p/3 from A
    B is open      on the closed part only, pc = p uA/(uA - uB): on pc/2, with its resultant at pc/3

so that A and B together carry the exact resultant and its moment (uA, uB: closures beyond those without
stress). On both sides of A this
is its length; added is the length of its own KCJOWN, on which its stress is constant
(contact/joint_lengths.py). Shear stress acts on the same length. Energy is lost to friction as the stresses
take more work than the joint stores.

Flags keep the result independent of the order of the contacts:

    cycle 1   a joint that opens, or will within four cycles, gets JOINT_OPENS and BEGINS_OPENING
    cycle 2   it waits until all others have their forces, and gives JOINT_STALE to its neighbours
    cycle 3   these wait as well: they find their lengths, and get OPENS_BESIDE1 or OPENS_BESIDE2
    from 4    they follow the closed part in each cycle, from the place of the open contact in that cycle
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.law_calls import Laws
from udec_ia.errors import TOO_STIFF
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.kernels.constitutive.joint_materials import clear_flag, has_flag, is_lumped, set_flag
from udec_ia.kernels.constitutive.joint_models import (
    JointValues,
    closed_step,
    closure_of,
    elastic_energy,
    free_closure,
    friction_under,
    greatest_stiffness_given,
    joint_stresses,
    joint_values,
    opened_by_dilation,
    opening_closure,
    opens_soon,
    stiffness_under,
)
from udec_ia.kernels.constitutive.joint_properties import (
    Joint,
    joint_by_material,
    joints_of_materials,
    materials_of,
)
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.linked_lists import is_corner
from udec_ia.kernels.links.longer_groups import contact_of, joint_at, joints_at
from udec_ia.layout import offsets as g

Pair = tuple[float, float]
SIDE1, SIDE2 = 1, 2  # of a contact: domain KD1, domain KD2
STIFFER = 1.1  # times the stiffness that the time-step allows for
JUMP = 4.0  # over the square of FRACTION: growth of a stiffness in one step that is an error


@inlined
def joint_neighbour(h: Memory, ic: int, side: int) -> int:
    """Joint of the next contact of the same blocks on that side of contact `ic`; 0 if there is none."""
    jb = iget(h, ic, g.KB2)
    item = iget(h, ic, g.KL2 if side == SIDE1 else g.KLB2)
    for _ in range(2):  # the corners on whose arcs the two contacts are may lie between them
        if is_corner(h, item):
            item = iget(h, item, g.KL if side == SIDE1 else g.KLB)
    if is_corner(h, item) or iget(h, item, g.KCCOD) == g.VIRTUAL:
        return int64(0)
    ib, one, two = iget(h, ic, g.KB1), iget(h, item, g.KB1), iget(h, item, g.KB2)
    if (one == ib and two == jb) or (one == jb and two == ib):
        return joint_at(h, item)
    return int64(0)


@inlined
def is_open(h: Memory, ix: int) -> bool:
    """True if joint `ix` is broken and carries nothing."""
    return has_flag(h, ix, g.JOINT_BROKEN) and getr(h, ix, g.KCJSN) <= 0


@kernel
def present_closure(h: Memory, ix: int) -> float:
    """Closure of joint `ix` with the blocks where they are now; KCN may still be that of the last step."""
    ic = contact_of(h, ix)
    _, _, overlap, _, _, _ = meet(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
    return overlap + getr(h, ix, g.KCJOFF)


@inlined
def opens_at_zero(h: Memory, ix: int) -> bool:
    """True if joint `ix` opens at the closure 0: it has springs alone, and no tensile strength."""
    m = iget(h, ix, g.KCJMAT) - 1
    return m >= 0 and h.ci[g.JMSHORT + m] & g.SPRINGS_ALONE != 0 and h.cr[g.JMTEN + m] == 0


@kernel
def closed_part(h: Memory, ix: int, jx: int, p: float, moving: bool) -> float:
    """Part on which stress acts of the distance `p` from contact of `ix` to that of `jx`, which may be open.

    moving: in the contact pass, where `jx` may have the closure of the last step.
    """
    there = present_closure(h, jx) if moving else closure_of(h, jx)
    if opens_at_zero(h, ix) and opens_at_zero(h, jx):
        one = closure_of(h, ix)
        return p * one / (one - there) if one > 0 and there < 0 else p
    joint_there = joint_values(h, contact_of(h, jx), jx)
    if there >= opening_closure(h, jx, joint_there):
        return p
    one = closure_of(h, ix) - free_closure(h, ix, joint_values(h, contact_of(h, ix), ix))
    two = there - free_closure(h, jx, joint_there)
    return p * one / (one - two) if one > 0 and two < 0 else p


@inlined
def part_on_side(h: Memory, ic: int, ix: int, side: int, p: float, moving: bool) -> float:
    """Part of the distance `p` to the next contact of the joint on that side on which stress acts.

    moving: as of `set_length`.
    """
    flag = g.OPENS_BESIDE1 if side == SIDE1 else g.OPENS_BESIDE2
    if moving and not has_flag(h, ix, flag):
        return p
    jx = joint_neighbour(h, ic, side) if p > 0 else int64(0)
    if jx == 0 and p > 0 and has_flag(h, ix, flag):  # it was deleted: until the lengths are found, as before
        others = getr(h, ix, g.KCJP1) + getr(h, ix, g.KCJP2) - p
        return max((getr(h, ix, g.KCJL) - getr(h, ix, g.KCJOWN)) * real(h, 2.0) - others, real(h, 0.0))
    if jx == 0 or not has_flag(h, jx, g.JOINT_OPENS):
        clear_flag(h, ix, flag)
        return p
    set_flag(h, ix, flag)
    return p if is_lumped(h, ix) else closed_part(h, ix, jx, p, moving)


@kernel
def set_length(h: Memory, ic: int, ix: int, moving: bool) -> float:
    """Set the length on which the stress of contact `ic` acts, and the place of its resultant.

    moving: in the contact pass. The neighbours that may be open are known before it, so that the result does
    not depend on the order of the contacts.
    """
    half, own = real(h, 0.5), getr(h, ix, g.KCJOWN)
    p1 = part_on_side(h, ic, ix, SIDE1, getr(h, ix, g.KCJP1), moving)
    p2 = part_on_side(h, ic, ix, SIDE2, getr(h, ix, g.KCJP2), moving)
    length = own + (p1 + p2) * half
    putr(h, ix, g.KCJL, length)
    if getr(h, ix, g.KCJP1) + getr(h, ix, g.KCJP2) > 0:  # else it is constant, at the contact or grid-point
        moment = (p2 * p2 - p1 * p1) / real(h, 6.0)
        putr(h, ix, g.KCJX, real(h, 0.0) if is_lumped(h, ix) or length == 0 else moment / length)
    return length


@kernel
def set_length_between_passes(h: Memory, ic: int, ix: int) -> float:
    """Set the length between two passes. Returns the shear energy (J/m) that the part that opens has lost."""
    before, joint = getr(h, ix, g.KCJL), joint_values(h, ic, ix)
    _, shear = elastic_energy(h, joint, getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS))
    return (before - set_length(h, ic, ix, False)) * shear


@kernel
def mark_neighbours(h: Memory, ic: int) -> None:
    """Contact `ic` opens soon: its neighbours find their lengths in the next cycle."""
    for side in (SIDE1, SIDE2):
        jx = joint_neighbour(h, ic, side)
        if jx != 0:
            set_flag(h, jx, g.JOINT_STALE)


@inlined
def whole_length(h: Memory, ix: int) -> float:
    """Length of joint `ix` with all parts closed."""
    return getr(h, ix, g.KCJOWN) + (getr(h, ix, g.KCJP1) + getr(h, ix, g.KCJP2)) * real(h, 0.5)


@kernel
def joint_of(h: Memory, ic: int) -> Joint:
    """Present properties of the joint of contact `ic`; with a joint material those of its whole length.

    Stiffnesses are the greatest that the joint has in its state.
    """
    ix = joint_at(h, ic)
    if ix == 0:
        return joint_by_material(h, ic)
    joint, length, sn = joint_values(h, ic, ix), whole_length(h, ix), getr(h, ix, g.KCJSN)
    kn, ks = stiffness_under(h, joint, sn)
    return Joint(kn * length, ks * length, joint.cohesion * length, friction_under(h, ix, joint, sn))


@kernel
def joint_in_step(h: Memory, ic: int) -> Joint:
    """The same with the stiffnesses that the time-step allows for.

    They are the greatest since it was found, and at least KNMAX and KSMAX.
    """
    joint, ix = joint_of(h, ic), joint_at(h, ic)
    if ix == 0:
        return joint
    length, (kn, ks) = whole_length(h, ix), greatest_stiffness_given(h, joint_values(h, ic, ix))
    kn = max(joint.kn, getr(h, ix, g.KCJKN), kn * length)
    ks = max(joint.ks, getr(h, ix, g.KCJKS), ks * length)
    return Joint(kn, ks, joint.cohesion, joint.friction)


@kernel
def allow_for_stiffness(h: Memory, is_new: bool) -> None:
    """The time-step that is found next allows for the present stiffness of all joints.

    is_new: it may be longer than the last one, so stiffnesses of the past do not count.
    """
    h.ci[g.LSTIFF] = 0
    ic = int64(h.ci[g.ICPNT]) if h.ci[g.LJOINT] != 0 else int64(0)
    while ic != 0:
        ix = joint_at(h, ic)
        if ix != 0:
            if is_new:
                putr(h, ix, g.KCJKN, real(h, 0.0))
                putr(h, ix, g.KCJKS, real(h, 0.0))
            joint = joint_in_step(h, ic)
            putr(h, ix, g.KCJKN, joint.kn)
            putr(h, ix, g.KCJKS, joint.ks)
        ic = iget(h, ic, g.KC)


@kernel
def check_stiffness(h: Memory, ix: int, joint: JointValues) -> bool:
    """Have the time-step found again if joint `ix` has become stiffer by a tenth than it allows for.

    Returns True if so.
    """
    kn, ks = stiffness_under(h, joint, getr(h, ix, g.KCJSN))
    length, stiffer = whole_length(h, ix), real(h, STIFFER)
    is_stiffer = kn * length > stiffer * getr(h, ix, g.KCJKN) or ks * length > stiffer * getr(h, ix, g.KCJKS)
    if is_stiffer:
        h.ci[g.LSTIFF] = 1
    return is_stiffer


@kernel
def check_jump(h: Memory, ic: int, joint: JointValues, before: float, sn: float) -> None:
    """Error 38 if contact `ic` has become so much stiffer in this step that the step was not stable.

    before, sn: normal stress before and after the step.
    """
    (was, _), (kn, _), (given, _) = (
        stiffness_under(h, joint, before),
        stiffness_under(h, joint, sn),
        greatest_stiffness_given(h, joint),
    )
    if kn * h.cr[g.FRAC] * h.cr[g.FRAC] > real(h, JUMP) * max(was, given) and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = TOO_STIFF
        h.ci[g.IERAD] = ic


@inlined
def may_lose_energy(joint: JointValues, slips: bool, sn0: float, sn: float) -> bool:
    """False if springs store all work of a step. sn0, sn: normal stress before and after."""
    return (
        joint.model != g.COULOMB_JOINT or joint.dilation > 0 or slips or (sn0 != sn and (sn <= 0 or sn0 <= 0))
    )


@kernel
def energy_lost(h: Memory, joint: JointValues, was: Pair, now: Pair, moved: Pair, lengths: Pair) -> float:
    """Work in a step (J/m) that a joint does not store.

    was, now: normal and shear stress before and after. moved: closure and shear displacement in the step.
    lengths: before and after; shear energy comes and goes with them.
    """
    half = real(h, 0.5)
    normal0, shear0 = elastic_energy(h, joint, was[0], was[1])
    normal, shear = elastic_energy(h, joint, now[0], now[1])
    done = ((was[0] + now[0]) * moved[0] + (was[1] + now[1]) * moved[1]) * half
    stored = (normal - normal0) + (shear - shear0)
    mean = (lengths[0] + lengths[1]) * half
    return mean * (done - stored) - (lengths[1] - lengths[0]) * (shear0 + shear) * half


@kernel
def lost_beside(h: Memory, ic: int, side: int, p: float, kn: float, sn: float) -> float:
    """Energy (J/m) lost on one side of contact `ic` as it breaks under the tension `sn` < 0.

    A linear stress from sn to that of the neighbour, s, stores p (sn^2 + sn s + s^2)/6 KN over their distance
    p. Afterwards p s^2/6 KN is left, or if s > 0 that of the part of p that is compressed.
    """
    jx = joint_neighbour(h, ic, side)
    beside = getr(h, jx, g.KCJSN) if jx != 0 else real(h, 0.0)
    stress = sn * sn * sn / (sn - beside) if beside > 0 else sn * (sn + beside)
    return p * stress / (kn * real(h, 6.0))


@kernel
def energy_of_break(h: Memory, ic: int, ix: int, joint: JointValues, sn: float) -> float:
    """What more than sn^2/2 KN times its length contact `ic` loses as it breaks under the tension `sn` < 0.

    In J/m; it is negative, as the stress is less than `sn` farther away.
    """
    p1, p2 = getr(h, ix, g.KCJP1), getr(h, ix, g.KCJP2)
    if is_lumped(h, ix) or p1 + p2 == 0:
        return real(h, 0.0)
    one, two = lost_beside(h, ic, SIDE1, p1, joint.kn, sn), lost_beside(h, ic, SIDE2, p2, joint.kn, sn)
    return one + two - (p1 + p2) * sn * sn / (joint.kn * real(h, 4.0))


@kernel
def shared_dilation(h: Memory, ic: int, ix: int, sn: float) -> float:
    """Work (J/m) against dilation that contact `ic` under `sn` does less than its length, per opening.

    The opening by dilation is linear between contacts, as stress is: over the distance p it does the work
    p (sn/3 + s/6) with the stress s of the neighbour, or pc/2 (1 - pc/3p) sn if only pc of it is closed.
    """
    total = real(h, 0.0)
    if is_lumped(h, ix):
        return total
    for side, p in ((SIDE1, getr(h, ix, g.KCJP1)), (SIDE2, getr(h, ix, g.KCJP2))):
        jx = joint_neighbour(h, ic, side) if p > 0 else int64(0)
        if jx == 0:
            continue
        part = part_on_side(h, ic, ix, side, p, True)
        total += part * part * sn / p if part < p else p * (sn - getr(h, jx, g.KCJSN))
    return total / real(h, 6.0)


@kernel
def with_cohesion_beside(h: Memory, ix: int, joint: JointValues) -> JointValues:
    """The joint of a contact beside an open one, whose length is half of the part that is closed there.

    The stress falls to 0 along that part, so that half of its length counts for it; cohesion acts along all
    of it.
    """
    own, length = getr(h, ix, g.KCJOWN), getr(h, ix, g.KCJL)
    parts, closed = (length - own) * real(h, 2.0), real(h, 0.0)  # on both sides, and those beside closed ones
    for p, flag in ((getr(h, ix, g.KCJP1), g.OPENS_BESIDE1), (getr(h, ix, g.KCJP2), g.OPENS_BESIDE2)):
        if not has_flag(h, ix, flag):
            closed += p
    if is_lumped(h, ix) or not parts > closed:
        return joint
    more = (own + parts - closed * real(h, 0.5)) / length
    return JointValues(
        joint.model,
        joint.m,
        joint.kn,
        joint.ks,
        joint.friction,
        joint.cohesion * more,
        joint.tension,
        joint.dilation,
        joint.critical,
        joint.residual_friction,
        joint.residual_cohesion * more,
    )


@kernel
def joint_step(h: Memory, laws: Laws, ic: int, ix: int, before: float, closure: float, dus: float) -> None:
    """Set the stresses of contact `ic` with joint `ix` after a step, by its model.

    Its length follows if a neighbour is open. before, closure: closures before and after. dus: shear
    displacement. WFRIC grows by the work that the joint does not store.
    """
    sn0, ts0, length0 = getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS), getr(h, ix, g.KCJL)
    joint, length = joint_values(h, ic, ix), length0
    was_broken, slip0 = has_flag(h, ix, g.JOINT_BROKEN), getr(h, ix, g.KCJSLIP)
    clear_flag(h, ix, g.JOINT_SLIPS)
    beside = has_flag(h, ix, g.OPENS_BESIDE1 | g.OPENS_BESIDE2)
    if beside and joint.cohesion > 0:
        joint = with_cohesion_beside(h, ix, joint)
    sn, ts = joint_stresses(h, laws, ix, joint, before, closure, dus)
    putr(h, ix, g.KCJSN, sn)
    putr(h, ix, g.KCJTS, ts)
    if joint.model != g.COULOMB_JOINT and check_stiffness(h, ix, joint):
        check_jump(h, ic, joint, sn0, sn)
    if beside:
        length = set_length(h, ic, ix, True)
    if beside or may_lose_energy(joint, has_flag(h, ix, g.JOINT_SLIPS), sn0, sn):
        h.cd[g.WFRIC] += energy_lost(
            h, joint, (sn0, ts0), (sn, ts), (closure - before, dus), (length0, length)
        )
    if joint.dilation > 0 and getr(h, ix, g.KCJSLIP) != slip0:
        opened = opened_by_dilation(joint, getr(h, ix, g.KCJSLIP)) - opened_by_dilation(joint, slip0)
        h.cd[g.WFRIC] += opened * shared_dilation(h, ic, ix, (sn0 + sn) * real(h, 0.5))
    if sn0 < 0 and not was_broken and has_flag(h, ix, g.JOINT_BROKEN):
        h.cd[g.WFRIC] += energy_of_break(h, ic, ix, joint, sn0)
    opens_at = opening_closure(h, ix, joint)
    if not opens_soon(h, before - opens_at, closure - opens_at):
        clear_flag(h, ix, g.JOINT_OPENS)
    elif not has_flag(h, ix, g.JOINT_OPENS):
        set_flag(h, ix, g.JOINT_OPENS | g.BEGINS_OPENING)


@kernel
def follow_closed_part(h: Memory, ic: int, ix: int, dus: float, ts0: float, ts: float) -> None:
    """Set the length of contact `ic` after a `closed_step` beside an open one, and add to WFRIC what is lost.

    dus: shear displacement in the step. ts0, ts: shear stress before and after.
    """
    length0, ks, half = getr(h, ix, g.KCJL), joint_values(h, ic, ix).ks, real(h, 0.5)
    length = set_length(h, ic, ix, True)
    by_slip = (length0 + length) * (ts0 + ts) * (dus - (ts - ts0) / ks)
    by_opening = (length0 - length) * (ts0 * ts0 + ts * ts) / ks
    h.cd[g.WFRIC] += (by_slip + by_opening) * half * half


@inlined
def needs_lengths(h: Memory, ic: int, ix: int) -> bool:
    """True if joint `ix` of contact `ic` has slid by HTOL, opens soon, or has a neighbour that does."""
    has_slid = abs(getr(h, ic, g.KCS) - getr(h, ix, g.KCJUSL)) > h.cr[g.HTOL]
    return has_slid or has_flag(h, ix, g.JOINT_STALE | g.BEGINS_OPENING)


@inlined
def stress_forces(
    h: Memory, laws: Laws, ic: int, ix: int, before: float, overlap: float, sliding: float
) -> tuple[float, float, float, float, float]:
    """Forces of contact `ic` with joint `ix`, as of coulomb_forces.

    before, overlap: overlaps before and after the step. sliding: relative velocity across. Stiffness damping
    is BETA times the rate of the forces.
    """
    dt, offset = h.cr[g.TDEL], getr(h, ix, g.KCJOFF)
    dus = sliding * dt
    us = getr(h, ic, g.KCS) + dus
    before, closure = before + offset, overlap + offset
    ts0 = getr(h, ix, g.KCJTS)
    is_done, sn, ts = closed_step(h, ic, ix, before, closure, dus)
    if is_done and has_flag(h, ix, g.OPENS_BESIDE1 | g.OPENS_BESIDE2):
        follow_closed_part(h, ic, ix, dus, ts0, ts)
    elif not is_done:
        joint_step(h, laws, ic, ix, before, closure, dus)
        sn, ts = getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS)
    length, zero = getr(h, ix, g.KCJL), real(h, 0.0)
    fn, fs = length * sn, length * ts
    if h.cr[g.BETA] == 0:
        return fn, fs, us, zero, zero
    rate = h.cr[g.BETA] / dt
    return fn, fs, us, rate * (fn - getr(h, ic, g.KCFN)), rate * (fs - getr(h, ic, g.KCFS))


@kernel
def shared_energy(h: Memory, ic: int, ix: int, side: int, p: float) -> float:
    """Energy (J/m) that the linear stress on one side of contact `ic` stores less than a constant one.

    Over the distance `p` a linear stress stores p (sA^2 + sA sB + sB^2)/6 KN, constant stresses on both
    halves p (sA^2 + sB^2)/4 KN, so p (sA - sB)^2/12 KN more. Each end has half of that; A all if B is open.
    """
    jx = joint_neighbour(h, ic, side)
    if jx == 0 or is_lumped(h, ix):
        return real(h, 0.0)
    sn = getr(h, ix, g.KCJSN)
    kn, _ = stiffness_under(h, joint_values(h, ic, ix), sn)
    if is_open(h, jx):
        return closed_part(h, ix, jx, p, False) * sn * sn / (kn * real(h, 12.0))
    difference = sn - getr(h, jx, g.KCJSN)
    return p * difference * difference / (kn * real(h, 24.0))


@kernel
def joint_energy(h: Memory, ic: int, ix: int) -> tuple[float, float]:
    """Elastic energy (J/m) of contact `ic` with joint `ix`, by closure and by shear."""
    normal, shear = elastic_energy(h, joint_values(h, ic, ix), getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS))
    length = getr(h, ix, g.KCJL)
    p1, p2 = getr(h, ix, g.KCJP1), getr(h, ix, g.KCJP2)
    normal *= length
    if not is_open(h, ix):
        if p1 > 0:
            normal -= shared_energy(h, ic, ix, SIDE1, p1)
        if p2 > 0:
            normal -= shared_energy(h, ic, ix, SIDE2, p2)
    return normal, shear * length


@kernel
def place_of_force(h: Memory, ic: int) -> tuple[float, float]:
    """Point (x, y) at which the force of contact `ic` acts: the contact, or the resultant of its stress."""
    x, y, ix = getr(h, ic, g.KXC), getr(h, ic, g.KYC), joint_at(h, ic)
    if ix == 0 or getr(h, ix, g.KCJX) == 0:
        return x, y
    nx, ny, _, _, _, _ = meet(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
    place = getr(h, ix, g.KCJX)
    return x + ny * place, y - nx * place


def joints_of(h: Memory, contacts: Any) -> Joint:
    """Properties of the joints of the contacts at the addresses `contacts`, as arrays; not for kernels.

    Of a contact with a joint material they are those of its whole length.
    """
    found = joints_of_materials(h, materials_of(h, contacts))
    for k in np.flatnonzero(joints_at(h, contacts)):
        for values, value in zip(found, joint_of(h, int(contacts[k])), strict=True):
            values[k] = value
    return found
