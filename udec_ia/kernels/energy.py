"""Energy: what a model holds.

Velocities are known at half steps. Multiply a law of motion by the mean of the two velocities around a full
step, and the works of all forces follow without an error of the step: over one step the work of a force is
the mean of its values at both ends, times the displacement. So at a full step, for every degree of freedom,

    kinetic energy    m v v/2 + dt v F/2      v half a step before, F the force now without loads
    strain energy     Fn Fn/2KN + Fs Fs/2KS   of the springs of a contact
                      A S C^-1 S/2            of a zone or a simply-deformable block, C of linear elasticity

and gravity's potential balance, to rounding, the works in kernels.works, as long as forces are linear in
displacements and contacts neither open nor close.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from offsets.generated import (
    AKN,
    AKS,
    ALAM1,
    ALAM2,
    GRAVX,
    GRAVY,
    IBPNT,
    ICPNT,
    KB,
    KBEX,
    KBFIX,
    KBFT,
    KBFX,
    KBFY,
    KBI,
    KBM,
    KBRO,
    KC,
    KCFN,
    KCFS,
    KCM,
    KED11,
    KED12,
    KED22,
    KFG,
    KFZ,
    KG,
    KGFX,
    KGFY,
    KGPM,
    KMAT,
    KS111,
    KS112,
    KS122,
    KSAREA,
    KSJ11,
    KSJ12,
    KSJ22,
    KTD,
    KX,
    KXD,
    KXDG,
    KY,
    KYD,
    KYDG,
    KZ,
    KZS11,
    KZS12,
    KZS22,
    MFDEF,
    MSDEF,
    TDEL,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64
from udec_ia.heap.jit import inlined, kernel
from udec_ia.kernels.fdef import zone_area
from udec_ia.kernels.motion import FIXED
from udec_ia.kernels.sdef import straining_force


@kernel
def _kinetic_of_strain(h: Memory, ie: int) -> float:
    """Twice the kinetic energy of the strain rates of extension `ie`."""
    dt = np.float64(h.cr[TDEL])
    e11, e12, e22 = np.float64(getr(h, ie, KED11)), np.float64(getr(h, ie, KED12)), getr(h, ie, KED22)
    f11, f12, f22 = straining_force(h, ie)
    return float(inertia(h, ie, e11, e12, e22) + dt * (e11 * f11 + 2 * e12 * f12 + e22 * f22))


@inlined
def inertia(h: Memory, ie: int, e11: float, e12: float, e22: float) -> float:
    """Integral of density times the square of the velocity that the strain rates e make of the place."""
    j11, j12, j22 = getr(h, ie, KSJ11), getr(h, ie, KSJ12), getr(h, ie, KSJ22)
    across = e12 * (e11 + e22) * j12
    return (e11 * e11 + e12 * e12) * j11 + across + across + (e12 * e12 + e22 * e22) * j22


@kernel
def _kinetic_of_points(h: Memory, ib: int) -> float:
    """Twice the kinetic energy of the grid-points of block `ib`."""
    dt, gx, gy = np.float64(h.cr[TDEL]), np.float64(h.cr[GRAVX]), np.float64(h.cr[GRAVY])
    twice = 0.0
    ig = iget(h, iget(h, ib, KBEX), KFG)
    while ig != 0:
        m, xd, yd = np.float64(getr(h, ig, KGPM)), getr(h, ig, KXDG), getr(h, ig, KYDG)
        twice += xd * (m * xd + dt * (getr(h, ig, KGFX) + m * gx))
        twice += yd * (m * yd + dt * (getr(h, ig, KGFY) + m * gy))
        ig = iget(h, ig, KG)
    return twice


@kernel
def _kinetic_of_block(h: Memory, ib: int) -> float:
    """Twice the kinetic energy of block `ib` as a rigid body."""
    dt, gx, gy = np.float64(h.cr[TDEL]), np.float64(h.cr[GRAVX]), np.float64(h.cr[GRAVY])
    bm, xd, yd, td = np.float64(getr(h, ib, KBM)), getr(h, ib, KXD), getr(h, ib, KYD), getr(h, ib, KTD)
    twice = xd * (bm * xd + dt * (getr(h, ib, KBFX) + bm * gx))
    twice += yd * (bm * yd + dt * (getr(h, ib, KBFY) + bm * gy))
    return float(twice + td * (getr(h, ib, KBI) * np.float64(td) + dt * getr(h, ib, KBFT)))


@kernel
def kinetic(h: Memory, soft: Any) -> float:
    """Kinetic energy of all blocks that are not fixed, in J/m."""
    twice = 0.0
    ib = int64(h.ci[IBPNT])
    while ib != 0:
        if iget(h, ib, KBFIX) != FIXED:
            if soft is not None and iget(h, ib, HEAD) == MFDEF:
                twice += _kinetic_of_points(h, ib)
            else:
                twice += _kinetic_of_block(h, ib)
                if soft is not None and iget(h, ib, HEAD) == MSDEF:
                    twice += _kinetic_of_strain(h, iget(h, ib, KBEX))
        ib = iget(h, ib, KB)
    return twice / 2


@inlined
def _moves(h: Memory, ib: int, speed: float) -> bool:
    """True if a point of block `ib` with that speed gets anywhere in a step: if places can tell it."""
    far = abs(getr(h, ib, KX)) + abs(getr(h, ib, KY)) + getr(h, ib, KBRO)
    return far + speed * h.cr[TDEL] > far


@kernel
def _motion_of_points(h: Memory, ib: int) -> tuple[float, float, int]:
    """As `liveliest`, of the grid-points of block `ib`."""
    total, most, at = 0.0, 0.0, int64(0)
    ig = iget(h, iget(h, ib, KBEX), KFG)
    while ig != 0:
        xd, yd = np.float64(getr(h, ig, KXDG)), np.float64(getr(h, ig, KYDG))
        energy = getr(h, ig, KGPM) * (xd * xd + yd * yd) / 2
        if _moves(h, ib, abs(getr(h, ig, KXDG)) + abs(getr(h, ig, KYDG))):
            total += energy
        else:
            energy = 0.0
        if energy > most:
            most, at = energy, ig
        ig = iget(h, ig, KG)
    return total, most, at


@kernel
def _motion_of_block(h: Memory, ib: int, soft: Any) -> float:
    """Kinetic energy of block `ib`, which has no grid-points, at the velocities of the last half step."""
    xd, yd, td = np.float64(getr(h, ib, KXD)), np.float64(getr(h, ib, KYD)), np.float64(getr(h, ib, KTD))
    twice = getr(h, ib, KBM) * (xd * xd + yd * yd) + getr(h, ib, KBI) * td * td
    turning = abs(getr(h, ib, KTD))
    if soft is not None and iget(h, ib, HEAD) == MSDEF:
        ie = iget(h, ib, KBEX)
        e11, e12 = np.float64(getr(h, ie, KED11)), np.float64(getr(h, ie, KED12))
        twice += inertia(h, ie, e11, e12, np.float64(getr(h, ie, KED22)))
        turning += abs(getr(h, ie, KED11)) + abs(getr(h, ie, KED12)) + abs(getr(h, ie, KED22))
    speed = abs(getr(h, ib, KXD)) + abs(getr(h, ib, KYD)) + turning * getr(h, ib, KBRO)
    return float(twice / 2) if _moves(h, ib, speed) else 0.0


@kernel
def liveliest(h: Memory, soft: Any) -> tuple[float, float, int]:
    """Kinetic energy at the velocities of the last half step, which is never negative, in J/m.

    Then what the block or grid-point has of it that has most, and the address of that; 0 if nothing moves.
    What is so slow that a step does not change its place is at rest.
    """
    total, most, at = 0.0, 0.0, int64(0)
    ib = int64(h.ci[IBPNT])
    while ib != 0:
        if iget(h, ib, KBFIX) != FIXED:
            if soft is not None and iget(h, ib, HEAD) == MFDEF:
                energy, best, on = _motion_of_points(h, ib)
            else:
                energy = _motion_of_block(h, ib, soft)
                best, on = energy, ib
            total += energy
            if best > most:
                most, at = best, on
        ib = iget(h, ib, KB)
    return total, most, at


@kernel
def strain_of_contacts(h: Memory) -> float:
    """Energy stored in the springs of the contacts, in J/m; a stiffness of 0 stores nothing."""
    twice = 0.0
    ic = int64(h.ci[ICPNT])
    while ic != 0:
        fn, fs = np.float64(getr(h, ic, KCFN)), np.float64(getr(h, ic, KCFS))
        if fn != 0:
            m = iget(h, ic, KCM) - 1
            if h.cr[AKN + m] > 0:
                twice += fn * fn / h.cr[AKN + m]
            if h.cr[AKS + m] > 0:
                twice += fs * fs / h.cr[AKS + m]
        ic = iget(h, ic, KC)
    return twice / 2


@kernel
def elastic(h: Memory, mat: int, s11: float, s12: float, s22: float) -> float:
    """Elastic energy of a stress in material `mat`, in J/m3; a modulus of 0 stores nothing."""
    one, two = np.float64(h.cr[ALAM1 + mat - 1]), np.float64(h.cr[ALAM2 + mat - 1])
    mean, half, shear = (np.float64(s11) + s22) / 2, (np.float64(s11) - s22) / 2, np.float64(s12)
    energy = 0.0
    if one + two > 0:
        energy += mean * mean / (one + two)
    if one - two > 0:
        energy += (half * half + shear * shear) / (one - two)
    return energy


@kernel
def strain_of_block(h: Memory, ib: int) -> float:
    """Elastic energy of deformable block `ib`, in J/m."""
    ie, mat, total = iget(h, ib, KBEX), iget(h, ib, KMAT), 0.0
    if iget(h, ib, HEAD) == MSDEF:
        s11, s12, s22 = getr(h, ie, KS111), getr(h, ie, KS112), getr(h, ie, KS122)
        return float(getr(h, ie, KSAREA) * elastic(h, mat, s11, s12, s22))
    iz = iget(h, ie, KFZ) if iget(h, ib, HEAD) == MFDEF else int64(0)
    while iz != 0:
        s11, s12, s22 = getr(h, iz, KZS11), getr(h, iz, KZS12), getr(h, iz, KZS22)
        total += zone_area(h, iz) * elastic(h, mat, s11, s12, s22)
        iz = iget(h, iz, KZ)
    return total


@kernel
def strain_of_blocks(h: Memory, soft: Any) -> float:
    """Elastic energy of all deformable blocks, in J/m."""
    total = 0.0
    if soft is not None:
        ib = int64(h.ci[IBPNT])
        while ib != 0:
            total += strain_of_block(h, ib)
            ib = iget(h, ib, KB)
    return total


@kernel
def height(h: Memory) -> float:
    """Potential of gravity of all blocks that are not fixed against the origin, in J/m."""
    gx, gy = np.float64(h.cr[GRAVX]), np.float64(h.cr[GRAVY])
    total = 0.0
    ib = int64(h.ci[IBPNT])
    while ib != 0:
        if iget(h, ib, KBFIX) != FIXED:
            total -= getr(h, ib, KBM) * (gx * getr(h, ib, KX) + gy * getr(h, ib, KY))
        ib = iget(h, ib, KB)
    return total
