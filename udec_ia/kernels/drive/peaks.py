"""KINETIC and ADAPTIVE damping: what the course of the kinetic energy tells.

KINETIC puts all velocities to 0 when the kinetic energy has passed a peak, where the forces are nearest to
balance (Cundall 1976). ADAPTIVE is mass damping with an ALPHA that goes up or down by 2 % in each cycle, so
that its power is RESTF times the rate of change of the kinetic energy (Cundall 1982).
"""

from __future__ import annotations

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.heap.jit import kernel
from udec_ia.kernels.body.motion import carry_corners
from udec_ia.kernels.energy.inertial import energy_of_motion
from udec_ia.kernels.energy.stored import kinetic
from udec_ia.layout import offsets as g

FASTER = 1.02  # what ALPHA is multiplied or divided by in a cycle
FIRST, LOWEST, HIGHEST = 1e-2, 1e-8, 0.5  # ALPHA times the time-step: at first, and its bounds


@kernel
def halt_block(h: Memory, ib: int) -> None:
    """Velocities of block `ib` := 0, but for those that are given."""
    zero, fix = real(h, 0.0), iget(h, ib, g.KBFIX)
    if fix & g.GIVEN_X == 0:
        putr(h, ib, g.KXD, zero)
    if fix & g.GIVEN_Y == 0:
        putr(h, ib, g.KYD, zero)
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
        carry_corners(h, ib)


@kernel
def halt_all(h: Memory) -> None:
    """Velocities of all that moves freely := 0; the kinetic energy that goes is taken by damping."""
    before = kinetic(h, True) if h.ci[g.LENER] != 0 else 0.0
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            halt_block(h, ib)
        ib = iget(h, ib, g.KB)
    if h.ci[g.LENER] != 0:
        h.cd[g.WREST] += before - kinetic(h, True)


@kernel
def adapt(h: Memory, energy: float, change: float) -> None:
    """ALPHA and what follows from it, where the kinetic energy has changed by `change` to `energy`."""
    dt = np.float64(h.cr[g.TDEL])
    alpha = np.float64(h.cr[g.ALPHA])
    if alpha == 0:
        alpha = FIRST / dt
    elif 2.0 * alpha * energy * dt < np.float64(h.cr[g.RESTF]) * abs(change):
        alpha = min(alpha * FASTER, HIGHEST / dt)
    else:
        alpha = max(alpha / FASTER, LOWEST / dt)
    h.cr[g.ALPHA] = alpha
    half = alpha * dt * 0.5
    h.cr[g.CON1], h.cr[g.CON2] = 1.0 - half, 1.0 / (1.0 + half)


@kernel
def look_at_motion(h: Memory) -> None:
    """What KINETIC or ADAPTIVE does before the step that begins."""
    energy = energy_of_motion(h)
    change = energy - h.cd[g.EMOVES]
    h.cd[g.EMOVES] = energy
    if h.ci[g.LREST] == g.ADAPTIVE:
        adapt(h, energy, change)
    elif change < 0:
        halt_all(h)
        h.cd[g.EMOVES] = 0.0
