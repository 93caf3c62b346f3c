"""The work of a cycle: by damping, boundary conditions, contacts, yielding and changes of shape (ENERGY ON).

Each is the work over a full step: the force at the full step, times the mean of the displacements of the two
half steps around it (kernels.energy.stored_energy).

    mass damping       ALPHA dt m u u      u the mean of the velocities before and after; INTERNAL alike
    given velocities   -dt F v             F the force against them
    loads              dt L u
    stiffness damping  dt D u              D the force of a dashpot
    yielding           dt A S e less the growth of the strain energy
    change of shape    dt Fn v less Fn times the growth of the overlap; inertia that strained blocks gain

Yielding is work on a deformable block that is not stored: plastic work, and the error of linear elasticity in
the current shape, whose stress is not the derivative of an energy, at large strains. Stiffness damping in
zones is taken at the end of the step instead of around it. Changes of shape are errors of the formulation. As
a block deforms, its corners are rounded again, which changes overlaps without motion. The laws of motion of a
simply-deformable block (2.6) assume a constant moment of inertia and Euler tensor, although these change.

Two passes over the model run before and after the block pass. The contact pass calls `add_contact_work` for
each contact when its new forces are known and it still has the old ones. All are compiled after ENERGY ON.
The joint laws sum the work of sliding themselves, since the detection of energy from nowhere needs it as well
(advice/energy_monitor.py).
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, real
from udec_ia.kernels.body.boundary_conditions import load, velocity_of
from udec_ia.kernels.body.fdef import gradient, next_point_velocity
from udec_ia.kernels.body.motion import next_velocity, turns_freely
from udec_ia.kernels.body.sdef import strain
from udec_ia.kernels.constitutive.joint_properties import is_stuck, joint_by_material
from udec_ia.kernels.energy.stored_energy import block_strain_energy, twice_strain_rate_energy
from udec_ia.layout import offsets as g


@inlined
def add_work(h: Memory, given: bool, m: float, v: float, u: float, f: float) -> None:
    """Work of damping, or of a prescribed velocity, on a mass `m` of velocity `v` and then `u`.

    f: the force on it, weight and loads included.
    """
    if given:
        h.cd[g.WBOUND] -= np.float64(f) * v * h.cr[g.TDEL]
    else:
        h.cd[g.WMASS] += np.float64(h.cr[g.ALPHA]) * h.cr[g.TDEL] * 0.25 * m * (v + u) * (v + u)


@kernel
def add_block_work(h: Memory, ib: int) -> None:
    """Work on block `ib` as a rigid body."""
    fix, bm = iget(h, ib, g.KBFIX), getr(h, ib, g.KBM)
    xd, yd, td = next_velocity(h, ib)
    fx, fy = getr(h, ib, g.KBFX) + bm * h.cr[g.GRAVX], getr(h, ib, g.KBFY) + bm * h.cr[g.GRAVY]
    add_work(h, fix & g.GIVEN_X != 0, bm, getr(h, ib, g.KXD), xd, fx)
    add_work(h, fix & g.GIVEN_Y != 0, bm, getr(h, ib, g.KYD), yd, fy)
    add_work(h, not turns_freely(fix), getr(h, ib, g.KBI), getr(h, ib, g.KTD), td, getr(h, ib, g.KBFT))


@kernel
def add_point_work(h: Memory, ib: int) -> None:
    """Work on the grid-points of block `ib`."""
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        fix, m = iget(h, ig, g.KGFIX), getr(h, ig, g.KGPM)
        xd, yd = next_point_velocity(h, ig)
        add_work(h, fix & g.ALONG_X != 0, m, getr(h, ig, g.KXDG), xd, getr(h, ig, g.KGFX) + m * h.cr[g.GRAVX])
        add_work(h, fix & g.ALONG_Y != 0, m, getr(h, ig, g.KYDG), yd, getr(h, ig, g.KGFY) + m * h.cr[g.GRAVY])
        ig = iget(h, ig, g.KG)


@kernel
def add_strain_work(h: Memory, ie: int) -> None:
    """Damping of the strain rates of extension `ie`."""
    e11, e12, e22 = strain(h, ie)
    u11, u12, u22 = getr(h, ie, g.KED11) + e11, getr(h, ie, g.KED12) + e12, getr(h, ie, g.KED22) + e22
    h.cd[g.WMASS] += (
        np.float64(h.cr[g.ALPB]) * h.cr[g.TDEL] * 0.25 * twice_strain_rate_energy(h, ie, u11, u12, u22)
    )


@kernel
def spin_energy(h: Memory, ib: int, ahead: bool) -> float:
    """Kinetic energy of spin and strain rates of simply-deformable block `ib` with its present inertia.

    ahead: at the rates at the end of the step.
    """
    ie, td = iget(h, ib, g.KBEX), getr(h, ib, g.KTD)
    e11, e12, e22 = getr(h, ie, g.KED11), getr(h, ie, g.KED12), getr(h, ie, g.KED22)
    if ahead:
        _, _, td = next_velocity(h, ib)
        e11, e12, e22 = strain(h, ie)
    w = np.float64(td)
    of_strain = twice_strain_rate_energy(h, ie, np.float64(e11), np.float64(e12), np.float64(e22))
    return (of_strain + getr(h, ib, g.KBI) * w * w) * 0.5


@inlined
def power(h: Memory, ie: int, e11: float, e12: float, e22: float) -> float:
    """Power of the internal stress of extension `ie` at strain rates e."""
    shear = getr(h, ie, g.KS112) * e12
    return getr(h, ie, g.KSAREA) * (getr(h, ie, g.KS111) * e11 + shear + shear + getr(h, ie, g.KS122) * e22)


@inlined
def zone_power(h: Memory, iz: int, ahead: bool) -> float:
    """Power of the stress of zone `iz` at the present velocities; ahead: at those at the end of the step."""
    g1, g2, g3, b1, c1, b2, c2, _ = gradient(h, iz, real(h, 0.0))
    u1, v1, u2, v2 = getr(h, g1, g.KXDG), getr(h, g1, g.KYDG), getr(h, g2, g.KXDG), getr(h, g2, g.KYDG)
    u3, v3 = getr(h, g3, g.KXDG), getr(h, g3, g.KYDG)
    if ahead:
        u1, v1 = next_point_velocity(h, g1)
        u2, v2 = next_point_velocity(h, g2)
        u3, v3 = next_point_velocity(h, g3)
    u1, v1, u2, v2 = u1 - u3, v1 - v3, u2 - u3, v2 - v3
    normal = getr(h, iz, g.KZS11) * (b1 * u1 + b2 * u2) + getr(h, iz, g.KZS22) * (c1 * v1 + c2 * v2)
    return (normal + getr(h, iz, g.KZS12) * (c1 * u1 + c2 * u2 + b1 * v1 + b2 * v2)) * real(h, 0.5)


@kernel
def stress_power(h: Memory, ib: int, ahead: bool) -> float:
    """Power of the stresses in deformable block `ib`; ahead: at the velocities at the end of the step."""
    ie = iget(h, ib, g.KBEX)
    if iget(h, ib, HEAD) == g.MSDEF:
        e11, e12, e22 = getr(h, ie, g.KED11), getr(h, ie, g.KED12), getr(h, ie, g.KED22)
        if ahead:
            e11, e12, e22 = strain(h, ie)
        return power(h, ie, e11, e12, e22)
    total = real(h, 0.0)
    iz = iget(h, ie, g.KFZ)
    while iz != 0:
        total += zone_power(h, iz, ahead)
        iz = iget(h, iz, g.KZ)
    return total


@outlined
def add_load_work(h: Memory) -> bool:
    """The same for the loads of the boundary conditions."""
    iu = int64(h.ci[g.IBNPNT])
    while iu != 0:
        fx, fy, x, y = load(h, iu)
        vx, vy = velocity_of(h, iu, x, y)
        ig, ib = iget(h, iu, g.KUG), iget(h, iu, g.KUB)
        if ig != 0:
            ux, uy = next_point_velocity(h, ig)
        else:
            rx, ry = x - getr(h, ib, g.KX), y - getr(h, ib, g.KY)
            xd, yd, td = next_velocity(h, ib)
            ux, uy = xd - td * ry, yd + td * rx
            if iget(h, ib, HEAD) == g.MSDEF:
                e11, e12, e22 = strain(h, iget(h, ib, g.KBEX))
                ux, uy = ux + e11 * rx + e12 * ry, uy + e12 * rx + e22 * ry
        if iget(h, ib, g.KBFIX) != g.FIXED:
            h.cd[g.WBOUND] += (np.float64(fx) * (vx + ux) + fy * (vy + uy)) * h.cr[g.TDEL] * 0.5
        iu = iget(h, iu, g.KU)
    return True


@outlined
def add_work_before_motion(h: Memory) -> bool:
    """Before the block pass: work of the present forces."""
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            kind = iget(h, ib, HEAD)
            if kind == g.MFDEF:
                add_point_work(h, ib)
            else:
                add_block_work(h, ib)
            if kind == g.MSDEF:
                add_strain_work(h, iget(h, ib, g.KBEX))
                h.cd[g.WSHAPE] += spin_energy(h, ib, True)
            if kind != g.MRIG:
                taken = np.float64(stress_power(h, ib, True)) * h.cr[g.TDEL] * 0.5
                h.cd[g.WYIELD] += taken + block_strain_energy(h, ib)
        ib = iget(h, ib, g.KB)
    return True


@outlined
def add_rigid_work(h: Memory) -> bool:
    """The same if all blocks are rigid."""
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            add_block_work(h, ib)
        ib = iget(h, ib, g.KB)
    return True


@outlined
def add_work_after_motion(h: Memory) -> bool:
    """After the block pass, when only zones act on grid-points: work of the present stresses."""
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        kind = iget(h, ib, HEAD)
        if kind != g.MRIG and iget(h, ib, g.KBFIX) != g.FIXED:
            now = np.float64(stress_power(h, ib, False))
            h.cd[g.WYIELD] += now * h.cr[g.TDEL] * 0.5 - block_strain_energy(h, ib)
            if kind == g.MSDEF:
                h.cd[g.WSHAPE] -= spin_energy(h, ib, False)
            elif h.cr[g.BETA] != 0:
                h.cd[g.WSTIF] += (point_power(h, ib) - now) * h.cr[g.TDEL]
        ib = iget(h, ib, g.KB)
    return True


@kernel
def point_power(h: Memory, ib: int) -> float:
    """Power of the force sums of the grid-points of block `ib`, with the opposite sign."""
    total = real(h, 0.0)
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        total -= getr(h, ig, g.KGFX) * getr(h, ig, g.KXDG) + getr(h, ig, g.KGFY) * getr(h, ig, g.KYDG)
        ig = iget(h, ig, g.KG)
    return total


Pair = tuple[float, float]


@inlined
def add_shape_work(h: Memory, ic: int, fn: float, closing: float, grown: float) -> None:
    """Work against the normal force of contact `ic`, which becomes `fn`, without a change of its overlap.

    closing: velocity at which the blocks approach. grown: growth of the overlap. Rigid blocks keep their
    shape: a difference there is an error of the step.
    """
    if iget(h, iget(h, ic, g.KB1), HEAD) != g.MRIG or iget(h, iget(h, ic, g.KB2), HEAD) != g.MRIG:
        mean = (getr(h, ic, g.KCFN) + fn) * real(h, 0.5)
        h.cd[g.WSHAPE] += mean * (closing * h.cr[g.TDEL] - grown)


@inlined
def add_dashpot_work(h: Memory, ic: int, was: Pair, now: Pair, slips: bool) -> None:
    """Work of the dashpots of contact `ic` in this step.

    was: closing and sliding velocity half a step ago. now: closing and sliding velocity now. slips: True if
    the dashpot along the contact does not act now.
    """
    (closing, sliding), joint, zero = now, joint_by_material(h, ic), real(h, 0.0)
    across = (was[1] if is_stuck(h, ic) else zero) + (zero if slips else sliding)
    done = joint.kn * closing * (was[0] + closing) + joint.ks * sliding * across
    h.cd[g.WSTIF] += h.cr[g.BETA] * h.cr[g.TDEL] * real(h, 0.5) * done


@outlined
def add_contact_work(
    h: Memory, ic: int, own: bool, before: float, normal: Pair, velocity: Pair, forces: Pair, dashpots: Pair
) -> bool:
    """Work of contact `ic` in this step; it has the forces of the last step and the present overlap.

    own: True if it has a law of its own. before: its overlap before. velocity: of block KB2 relative to KB1.
    forces, dashpots: present normal and shear force.
    """
    (nx, ny), (xd, yd), (fn, _) = normal, velocity, forces
    closing, sliding = -(xd * nx + yd * ny), yd * nx - xd * ny
    zero, overlap = real(h, 0.0), getr(h, ic, g.KCN)
    if own:
        h.cd[g.WSTIF] += (dashpots[0] * closing + dashpots[1] * sliding) * h.cr[g.TDEL]
        if fn != zero and (before > zero or getr(h, ic, g.KCFN) != zero):
            add_shape_work(h, ic, fn, closing, overlap - before)
        return True
    if fn != zero and before > zero:
        add_shape_work(h, ic, fn, closing, overlap - before)
    if h.cr[g.BETA] != zero:
        was = zero, zero
        if before > zero:
            was_x, was_y = getr(h, ic, g.KXDC), getr(h, ic, g.KYDC)
            was = -(was_x * nx + was_y * ny), was_y * nx - was_x * ny
        add_dashpot_work(h, ic, was, (closing, sliding), dashpots[1] == zero)
    return True
