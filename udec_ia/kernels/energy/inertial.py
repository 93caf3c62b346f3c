"""Kinetic energy with inertial masses, which may be scaled: what there is to bring to rest.

It is that at the velocities of the last half step, which is never negative.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, int64
from udec_ia.kernels.body.motion import velocities
from udec_ia.kernels.energy.stored import inertia
from udec_ia.kernels.links.relaxations import following
from udec_ia.layout import offsets as g


@inlined
def over(h: Memory, energy: float, ir: int, scale: Offset) -> float:
    """An energy of motion with the inertial mass, whose factor is `scale` in `ir`; 0 stands for none."""
    return energy / getr(h, ir, scale) if ir != 0 and h.ci[g.LSCALE] != 0 else energy


@kernel
def energy_of_body(h: Memory, ib: int, ir: int) -> float:
    """Twice the energy of motion of block `ib`, which has no grid-points."""
    xd, yd, td = velocities(h, ib)
    twice = over(h, getr(h, ib, g.KBM) * (xd * xd + yd * yd), ir, g.KRXM)
    twice += over(h, getr(h, ib, g.KBI) * td * td, ir, g.KRXI)
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        e11, e12 = np.float64(getr(h, ie, g.KED11)), np.float64(getr(h, ie, g.KED12))
        twice += over(h, inertia(h, ie, e11, e12, np.float64(getr(h, ie, g.KED22))), ir, g.KRXE)
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
                    twice += over(h, getr(h, ig, g.KGPM) * (xd * xd + yd * yd), ir, g.KRXM)
                ir = following(h, ir)
                ig = iget(h, ig, g.KG)
        else:
            if free:
                twice += energy_of_body(h, ib, ir)
            ir = following(h, ir)
        ib = iget(h, ib, g.KB)
    return twice * 0.5
