"""Energy stored in a model: kinetic, elastic and potential energy of gravity.

Velocities are known at half steps. Multiply a law of motion by the mean of the two velocities around a full
step, and the works of all forces follow without an error of the step: over one step the work of a force is
the mean of its values at both ends, times the displacement. So at a full step, for every degree of freedom,

    kinetic energy    m v v/2 + dt v F/2      v half a step before, F the force now without loads
    strain energy     Fn Fn/2KN + Fs Fs/2KS   of the springs of a contact, alike of structures
                      A S C^-1 S/2            of a zone or a simply-deformable block, C of linear elasticity

and gravity's potential balance, to rounding, the works in work_account.py, as long as forces are linear in
displacements and contacts neither open nor close.

The search for rest uses another kinetic energy (`energy_of_motion`): with the inertial masses, which may be
scaled, and at the velocities of the last half step, so that it is never negative.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, int64
from udec_ia.kernels.body.fdef import zone_area
from udec_ia.kernels.body.motion import velocities
from udec_ia.kernels.body.sdef import straining_force
from udec_ia.kernels.constitutive.joint_properties import twice_stored
from udec_ia.kernels.constitutive.joint_stresses import joint_energy
from udec_ia.kernels.links.longer_groups import joint_at
from udec_ia.kernels.links.relaxation_groups import next_relaxation
from udec_ia.kernels.structures.beams import element_energy, interface_energy
from udec_ia.kernels.structures.bolts import bolt_energy
from udec_ia.layout import offsets as g


@kernel
def _kinetic_of_strain(h: Memory, ie: int) -> float:
    """Twice the kinetic energy of the strain rates of extension `ie`."""
    dt = np.float64(h.cr[g.TDEL])
    e11, e12, e22 = np.float64(getr(h, ie, g.KED11)), np.float64(getr(h, ie, g.KED12)), getr(h, ie, g.KED22)
    f11, f12, f22 = straining_force(h, ie)
    twice = twice_strain_rate_energy(h, ie, e11, e12, e22)
    return float(twice + dt * (e11 * f11 + 2 * e12 * f12 + e22 * f22))


@inlined
def twice_strain_rate_energy(h: Memory, ie: int, e11: float, e12: float, e22: float) -> float:
    """Integral of density times the square of the velocity that follows from the strain rates e."""
    j11, j12, j22 = getr(h, ie, g.KSJ11), getr(h, ie, g.KSJ12), getr(h, ie, g.KSJ22)
    across = e12 * (e11 + e22) * j12
    return (e11 * e11 + e12 * e12) * j11 + across + across + (e12 * e12 + e22 * e22) * j22


@kernel
def _kinetic_of_points(h: Memory, ib: int) -> float:
    """Twice the kinetic energy of the grid-points of block `ib`."""
    dt, gx, gy = np.float64(h.cr[g.TDEL]), np.float64(h.cr[g.GRAVX]), np.float64(h.cr[g.GRAVY])
    twice = 0.0
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        m, xd, yd = np.float64(getr(h, ig, g.KGPM)), getr(h, ig, g.KXDG), getr(h, ig, g.KYDG)
        twice += xd * (m * xd + dt * (getr(h, ig, g.KGFX) + m * gx))
        twice += yd * (m * yd + dt * (getr(h, ig, g.KGFY) + m * gy))
        ig = iget(h, ig, g.KG)
    return twice


@kernel
def _kinetic_of_block(h: Memory, ib: int) -> float:
    """Twice the kinetic energy of block `ib` as a rigid body."""
    dt, gx, gy = np.float64(h.cr[g.TDEL]), np.float64(h.cr[g.GRAVX]), np.float64(h.cr[g.GRAVY])
    bm, xd, yd, td = (
        np.float64(getr(h, ib, g.KBM)),
        getr(h, ib, g.KXD),
        getr(h, ib, g.KYD),
        getr(h, ib, g.KTD),
    )
    twice = xd * (bm * xd + dt * (getr(h, ib, g.KBFX) + bm * gx))
    twice += yd * (bm * yd + dt * (getr(h, ib, g.KBFY) + bm * gy))
    return float(twice + td * (getr(h, ib, g.KBI) * np.float64(td) + dt * getr(h, ib, g.KBFT)))


@kernel
def _kinetic_of_nodes(h: Memory) -> float:
    """Twice the kinetic energy of all nodes of structures."""
    dt, gx, gy = np.float64(h.cr[g.TDEL]), np.float64(h.cr[g.GRAVX]), np.float64(h.cr[g.GRAVY])
    twice = 0.0
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        m, xd, yd = np.float64(getr(h, node, g.KNM)), getr(h, node, g.KNXD), getr(h, node, g.KNYD)
        td = np.float64(getr(h, node, g.KNTD))
        twice += xd * (m * xd + dt * (getr(h, node, g.KNFX) + m * gx))
        twice += yd * (m * yd + dt * (getr(h, node, g.KNFY) + m * gy))
        twice += td * (getr(h, node, g.KNI) * td + dt * getr(h, node, g.KNFT))
        node = iget(h, node, g.KN)
    return twice


@kernel
def kinetic_energy(h: Memory, soft: Any) -> float:
    """Kinetic energy of all blocks that are not fixed, and of nodes, in J/m."""
    twice = _kinetic_of_nodes(h)
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            if soft is not None and iget(h, ib, HEAD) == g.MFDEF:
                twice += _kinetic_of_points(h, ib)
            else:
                twice += _kinetic_of_block(h, ib)
                if soft is not None and iget(h, ib, HEAD) == g.MSDEF:
                    twice += _kinetic_of_strain(h, iget(h, ib, g.KBEX))
        ib = iget(h, ib, g.KB)
    return twice / 2


@inlined
def changes_place(h: Memory, ib: int, speed: float) -> bool:
    """True if a step with that speed changes a coordinate of a point of block `ib`."""
    far = abs(getr(h, ib, g.KX)) + abs(getr(h, ib, g.KY)) + getr(h, ib, g.KBRO)
    return far + speed * h.cr[g.TDEL] > far


@kernel
def _motion_of_points(h: Memory, ib: int) -> tuple[float, float, int]:
    """As `greatest_motion`, of the grid-points of block `ib`."""
    total, largest, at = 0.0, 0.0, int64(0)
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        xd, yd = np.float64(getr(h, ig, g.KXDG)), np.float64(getr(h, ig, g.KYDG))
        energy = getr(h, ig, g.KGPM) * (xd * xd + yd * yd) / 2
        if changes_place(h, ib, abs(getr(h, ig, g.KXDG)) + abs(getr(h, ig, g.KYDG))):
            total += energy
        else:
            energy = 0.0
        if energy > largest:
            largest, at = energy, ig
        ig = iget(h, ig, g.KG)
    return total, largest, at


@kernel
def _motion_of_block(h: Memory, ib: int, soft: Any) -> float:
    """Kinetic energy of block `ib`, which has no grid-points, at the velocities of the last half step."""
    xd, yd, td = velocities(h, ib)
    twice = getr(h, ib, g.KBM) * (xd * xd + yd * yd) + getr(h, ib, g.KBI) * td * td
    turning = abs(getr(h, ib, g.KTD))
    if soft is not None and iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        e11, e12 = np.float64(getr(h, ie, g.KED11)), np.float64(getr(h, ie, g.KED12))
        twice += twice_strain_rate_energy(h, ie, e11, e12, np.float64(getr(h, ie, g.KED22)))
        turning += abs(getr(h, ie, g.KED11)) + abs(getr(h, ie, g.KED12)) + abs(getr(h, ie, g.KED22))
    speed = abs(getr(h, ib, g.KXD)) + abs(getr(h, ib, g.KYD)) + turning * getr(h, ib, g.KBRO)
    return float(twice / 2) if changes_place(h, ib, speed) else 0.0


@kernel
def motion_of_node(h: Memory, node: int) -> float:
    """Kinetic energy of a node at the velocities of the last half step; 0 if they are too slow to move it."""
    xd, yd = np.float64(getr(h, node, g.KNXD)), np.float64(getr(h, node, g.KNYD))
    td = np.float64(getr(h, node, g.KNTD))
    far = abs(getr(h, node, g.KNX)) + abs(getr(h, node, g.KNY)) + getr(h, node, g.KNLEN)
    speed = (
        abs(getr(h, node, g.KNXD))
        + abs(getr(h, node, g.KNYD))
        + abs(getr(h, node, g.KNTD)) * getr(h, node, g.KNLEN)
    )
    if not far + speed * h.cr[g.TDEL] > far:
        return 0.0
    return float(getr(h, node, g.KNM) * (xd * xd + yd * yd) + getr(h, node, g.KNI) * td * td) * 0.5


@kernel
def greatest_motion(h: Memory, soft: Any) -> tuple[float, float, int]:
    """Kinetic energy at the velocities of the last half step, which is never negative, in J/m.

    Then the share of the block, grid-point or node with most of it, and its address; 0 if nothing moves.
    Motion too slow to change a place in a step is rest.
    """
    total, largest, at = 0.0, 0.0, int64(0)
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            if soft is not None and iget(h, ib, HEAD) == g.MFDEF:
                energy, best, on = _motion_of_points(h, ib)
            else:
                energy = _motion_of_block(h, ib, soft)
                best, on = energy, ib
            total += energy
            if best > largest:
                largest, at = best, on
        ib = iget(h, ib, g.KB)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        energy = motion_of_node(h, node)
        total += energy
        if energy > largest:
            largest, at = energy, node
        node = iget(h, node, g.KN)
    return total, largest, at


@kernel
def contact_strain_energy(h: Memory) -> float:
    """Energy stored in the springs of the contacts, in J/m; a stiffness of 0 stores nothing."""
    twice = 0.0
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        fn, fs = np.float64(getr(h, ic, g.KCFN)), np.float64(getr(h, ic, g.KCFS))
        ix = joint_at(h, ic)
        if ix != 0:
            normal, shear = joint_energy(h, ic, ix)
            twice += 2 * np.float64(normal + shear)
        elif fn != 0:
            normal, shear = twice_stored(h, ic, fn, fs)
            twice += normal
            twice += shear
        ic = iget(h, ic, g.KC)
    return twice / 2


@kernel
def elastic_energy_density(h: Memory, mat: int, s11: float, s12: float, s22: float) -> float:
    """Elastic energy of a stress in material `mat`, in J/m3; a modulus of 0 stores nothing."""
    one, two = np.float64(h.cr[g.ALAM1 + mat - 1]), np.float64(h.cr[g.ALAM2 + mat - 1])
    mean, half, shear = (np.float64(s11) + s22) / 2, (np.float64(s11) - s22) / 2, np.float64(s12)
    energy = 0.0
    if one + two > 0:
        energy += mean * mean / (one + two)
    if one - two > 0:
        energy += (half * half + shear * shear) / (one - two)
    return energy


@kernel
def block_strain_energy(h: Memory, ib: int) -> float:
    """Elastic energy of deformable block `ib`, in J/m."""
    ie, mat, total = iget(h, ib, g.KBEX), iget(h, ib, g.KMAT), 0.0
    if iget(h, ib, HEAD) == g.MSDEF:
        s11, s12, s22 = getr(h, ie, g.KS111), getr(h, ie, g.KS112), getr(h, ie, g.KS122)
        return float(getr(h, ie, g.KSAREA) * elastic_energy_density(h, mat, s11, s12, s22))
    iz = iget(h, ie, g.KFZ) if iget(h, ib, HEAD) == g.MFDEF else int64(0)
    while iz != 0:
        s11, s12, s22 = getr(h, iz, g.KZS11), getr(h, iz, g.KZS12), getr(h, iz, g.KZS22)
        total += zone_area(h, iz) * elastic_energy_density(h, mat, s11, s12, s22)
        iz = iget(h, iz, g.KZ)
    return total


@kernel
def strain_energy_of_blocks(h: Memory, soft: Any) -> float:
    """Elastic energy of all deformable blocks, in J/m."""
    total = 0.0
    if soft is not None:
        ib = int64(h.ci[g.IBPNT])
        while ib != 0:
            total += block_strain_energy(h, ib)
            ib = iget(h, ib, g.KB)
    return total


@kernel
def strain_energy_of_structures(h: Memory) -> float:
    """Energy stored in the springs of structures, in J/m."""
    total = 0.0
    ia = int64(h.ci[g.IBTPNT])
    while ia != 0:
        total += bolt_energy(h, ia)
        ia = iget(h, ia, g.KA)
    im = int64(h.ci[g.IELPNT])
    while im != 0:
        total += element_energy(h, im)
        im = iget(h, im, g.KM)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        total += interface_energy(h, node)
        node = iget(h, node, g.KN)
    return total


@kernel
def strain_energy(h: Memory, soft: Any) -> float:
    """Energy stored in contacts, deformable blocks and structures, in J/m."""
    stored = contact_strain_energy(h) + strain_energy_of_blocks(h, soft)
    return float(stored + strain_energy_of_structures(h))


@kernel
def potential_energy(h: Memory) -> float:
    """Potential energy of gravity of all blocks that are not fixed, relative to the origin, in J/m."""
    return float(potential_in(h, h.cr[g.GRAVX], h.cr[g.GRAVY]))


@kernel
def potential_in(h: Memory, gx: float, gy: float) -> float:
    """The same in the gravity (gx, gy)."""
    gx, gy = np.float64(gx), np.float64(gy)
    total = 0.0
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            total -= getr(h, ib, g.KBM) * (gx * getr(h, ib, g.KX) + gy * getr(h, ib, g.KY))
        ib = iget(h, ib, g.KB)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        total -= getr(h, node, g.KNM) * (gx * getr(h, node, g.KNX) + gy * getr(h, node, g.KNY))
        node = iget(h, node, g.KN)
    return total


@inlined
def with_inertial_mass(h: Memory, energy: float, ir: int, scale: Offset) -> float:
    """An energy of motion with the inertial mass, whose factor is `scale` in `ir`; no factor if `ir` is 0."""
    return energy / getr(h, ir, scale) if ir != 0 and h.ci[g.LSCALE] != 0 else energy


@kernel
def energy_of_body(h: Memory, ib: int, ir: int) -> float:
    """Twice the energy of motion of block `ib`, which has no grid-points."""
    xd, yd, td = velocities(h, ib)
    twice = with_inertial_mass(h, getr(h, ib, g.KBM) * (xd * xd + yd * yd), ir, g.KRXM)
    twice += with_inertial_mass(h, getr(h, ib, g.KBI) * td * td, ir, g.KRXI)
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        e11, e12 = np.float64(getr(h, ie, g.KED11)), np.float64(getr(h, ie, g.KED12))
        straining = twice_strain_rate_energy(h, ie, e11, e12, np.float64(getr(h, ie, g.KED22)))
        twice += with_inertial_mass(h, straining, ir, g.KRXE)
    return float(twice)


@kernel
def energy_of_motion(h: Memory) -> float:
    """Kinetic energy with the inertial masses, at the velocities of the last half step, in J/m."""
    twice = 0.0
    ir = int64(h.ci[g.IRXPNT])
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        free = iget(h, ib, g.KBFIX) != g.FIXED
        if iget(h, ib, HEAD) == g.MFDEF:
            ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
            while ig != 0:
                xd, yd = np.float64(getr(h, ig, g.KXDG)), np.float64(getr(h, ig, g.KYDG))
                if free:
                    twice += with_inertial_mass(h, getr(h, ig, g.KGPM) * (xd * xd + yd * yd), ir, g.KRXM)
                ir = next_relaxation(h, ir)
                ig = iget(h, ig, g.KG)
        else:
            if free:
                twice += energy_of_body(h, ib, ir)
            ir = next_relaxation(h, ir)
        ib = iget(h, ib, g.KB)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        xd, yd = np.float64(getr(h, node, g.KNXD)), np.float64(getr(h, node, g.KNYD))
        td = np.float64(getr(h, node, g.KNTD))
        twice += with_inertial_mass(h, getr(h, node, g.KNM) * (xd * xd + yd * yd), node, g.KNSM)
        twice += with_inertial_mass(h, getr(h, node, g.KNI) * td * td, node, g.KNSI)
        node = iget(h, node, g.KN)
    return twice * 0.5
