"""KINETIC and ADAPTIVE damping, which follow from the motion of the whole model.

KINETIC sets all velocities to 0 when the kinetic energy has passed a peak, where the forces are nearest to
balance (Cundall 1976). ADAPTIVE is mass damping that is critical for the present motion. With v the
velocities, m the inertial masses and F' the forces of the previous cycle, its frequency is Rayleigh's
quotient,

    w w = - sum v (F - F')/dt / sum m v v          ALPHA = 2 f w          (Underwood 1983)

Both sums include previous cycles with decreasing weight. Otherwise stick-slip motion would be damped as a
fast oscillation whenever little else moves.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, int64, putr, real
from udec_ia.kernels.body.motion import set_corner_velocities
from udec_ia.kernels.body.sdef import straining_force
from udec_ia.kernels.energy.stored_energy import energy_of_motion, kinetic_energy
from udec_ia.kernels.links.relaxation_groups import next_relaxation
from udec_ia.layout import offsets as g

LOWEST, HIGHEST = 1e-3, 1.0  # ALPHA times the time-step
FADING = 0.93  # weight of the sums of the previous cycle: about fourteen cycles count


@kernel
def halt_block(h: Memory, ib: int) -> None:
    """Velocities of block `ib` := 0, except prescribed ones."""
    zero, fix = real(h, 0.0), iget(h, ib, g.KBFIX)
    if fix & g.GIVEN_X == 0:
        putr(h, ib, g.KXD, zero)
    if fix & g.GIVEN_Y == 0:
        putr(h, ib, g.KYD, zero)
    if fix & g.GIVEN_TURN == 0:
        putr(h, ib, g.KTD, zero)
    ie = iget(h, ib, g.KBEX)
    if iget(h, ib, HEAD) == g.MSDEF:
        putr(h, ie, g.KED11, zero)
        putr(h, ie, g.KED12, zero)
        putr(h, ie, g.KED21, zero)
        putr(h, ie, g.KED22, zero)
    ig = iget(h, ie, g.KFG) if iget(h, ib, HEAD) == g.MFDEF else int64(0)
    while ig != 0:
        if iget(h, ig, g.KGFIX) & g.ALONG_X == 0:
            putr(h, ig, g.KXDG, zero)
        if iget(h, ig, g.KGFIX) & g.ALONG_Y == 0:
            putr(h, ig, g.KYDG, zero)
        ip = iget(h, ig, g.KCOR)
        if ip != 0:
            putr(h, ip, g.KXDP, getr(h, ig, g.KXDG))
            putr(h, ip, g.KYDP, getr(h, ig, g.KYDG))
        ig = iget(h, ig, g.KG)
    if iget(h, ib, HEAD) != g.MFDEF:
        set_corner_velocities(h, ib)


@kernel
def halt_all(h: Memory) -> None:
    """Velocities of everything free := 0; the lost kinetic energy counts as damping."""
    before = kinetic_energy(h, True) if h.ci[g.LENER] != 0 else 0.0
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            halt_block(h, ib)
        ib = iget(h, ib, g.KB)
    node, zero = int64(h.ci[g.INDPNT]), real(h, 0.0)
    while node != 0:
        putr(h, node, g.KNXD, zero)
        putr(h, node, g.KNYD, zero)
        putr(h, node, g.KNTD, zero)
        node = iget(h, node, g.KN)
    if h.ci[g.LENER] != 0:
        h.cd[g.WREST] += before - kinetic_energy(h, True)


@inlined
def power_of_growth(h: Memory, ir: int, before: Offset, f: float, v: float) -> float:
    """Velocity `v` times the growth of the force `f` since the last cycle, which is at `before` in `ir`."""
    grown = np.float64(f - getr(h, ir, before)) * v
    putr(h, ir, before, f)
    return float(grown)


@kernel
def power_of_growth_in_body(h: Memory, ib: int, ir: int) -> float:
    """The same of all degrees of freedom of block `ib`, which has no grid-points."""
    total = power_of_growth(h, ir, g.KRXFX, getr(h, ib, g.KBFX), getr(h, ib, g.KXD))
    total += power_of_growth(h, ir, g.KRXFY, getr(h, ib, g.KBFY), getr(h, ib, g.KYD))
    total += power_of_growth(h, ir, g.KRXFT, getr(h, ib, g.KBFT), getr(h, ib, g.KTD))
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        f11, f12, f22 = straining_force(h, ie)
        total += power_of_growth(h, ir, g.KRXS11, f11, getr(h, ie, g.KED11))
        total += power_of_growth(h, ir, g.KRXS12, f12, getr(h, ie, g.KED12)) * 2.0
        total += power_of_growth(h, ir, g.KRXS22, f22, getr(h, ie, g.KED22))
    return total


@kernel
def power_of_growth_in_points(h: Memory, ib: int, first: int, before: float) -> tuple[float, int]:
    """The same of the grid-points of block `ib`, added to `before`, and the relaxation after theirs.

    first: the relaxation of its first grid-point.
    """
    total, ir = before, int64(first)
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            total += power_of_growth(h, ir, g.KRXFX, getr(h, ig, g.KGFX), getr(h, ig, g.KXDG))
            total += power_of_growth(h, ir, g.KRXFY, getr(h, ig, g.KGFY), getr(h, ig, g.KYDG))
        ir = next_relaxation(h, ir)
        ig = iget(h, ig, g.KG)
    return total, ir


@kernel
def power_of_growth_in_model(h: Memory) -> float:
    """The same for the whole model."""
    total = 0.0
    ir = int64(h.ci[g.IRXPNT])
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, HEAD) == g.MFDEF:
            total, ir = power_of_growth_in_points(h, ib, ir, total)
        else:
            if iget(h, ib, g.KBFIX) != g.FIXED:
                total += power_of_growth_in_body(h, ib, ir)
            ir = next_relaxation(h, ir)
        ib = iget(h, ib, g.KB)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        total += power_of_growth(h, node, g.KNLX, getr(h, node, g.KNFX), getr(h, node, g.KNXD))
        total += power_of_growth(h, node, g.KNLY, getr(h, node, g.KNFY), getr(h, node, g.KNYD))
        total += power_of_growth(h, node, g.KNLT, getr(h, node, g.KNFT), getr(h, node, g.KNTD))
        node = iget(h, node, g.KN)
    return total


@kernel
def set_adaptive_damping(h: Memory) -> None:
    """Calculate ALPHA and its factors from velocities and the growth of forces.

    EMOVES is half of the second sum. The first one is not stored: it is the second times w w, which follows
    from ALPHA.
    """
    dt, f = np.float64(h.cr[g.TDEL]), np.float64(h.cr[g.RESTF])
    before, grown = FADING * h.cd[g.EMOVES], power_of_growth_in_model(h)
    h.cd[g.EMOVES] = before + energy_of_motion(h)
    alpha = LOWEST / dt
    if h.cd[g.EMOVES] > 0 and f > 0:
        w = np.float64(h.cr[g.ALPHA]) / (2.0 * f)
        square = (w * w * before - grown / (2.0 * dt)) / h.cd[g.EMOVES]
        alpha = max(2.0 * f * np.sqrt(max(square, 0.0)), alpha)
    alpha = min(alpha, HIGHEST / dt)
    h.cr[g.ALPHA] = h.cr[g.ALPB] = alpha
    half = alpha * dt * 0.5
    h.cr[g.CON1] = h.cr[g.C1B] = 1.0 - half
    h.cr[g.CON2] = h.cr[g.C2B] = 1.0 / (1.0 + half)


@outlined
def damp_by_motion(h: Memory) -> bool:
    """Apply KINETIC or ADAPTIVE damping before the step that begins."""
    if h.ci[g.LREST] == g.ADAPTIVE:
        set_adaptive_damping(h)
        return True
    energy = energy_of_motion(h)
    fallen = energy < h.cd[g.EMOVES]
    h.cd[g.EMOVES] = energy
    if fallen:
        halt_all(h)
        h.cd[g.EMOVES] = 0.0
    return True
