"""The pass of structures (BOLT, CABLE, BEAM): nodes move, springs are strained, forces go to blocks, nodes.

It runs after the contact pass, when blocks have moved and their force sums have begun: its forces add to
these. Nodes move by the same law as grid-points, with every damping of these; a node also turns:

    v := (CON1 v + (F/m + g) dt) CON2      w := (CON1 w + (M/I) dt) CON2
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr
from udec_ia.kernels.drive.damped_forces import relaxed
from udec_ia.kernels.energy.work_account import add_work
from udec_ia.kernels.structures.beams import forces_on_node, sum_beams
from udec_ia.kernels.structures.bolts import sum_bolts
from udec_ia.layout import offsets as g


@kernel
def damp_node(h: Memory, node: int) -> None:
    """LOCAL, COMBINED and KINETIC damping and scaled masses of a node, as damped_forces.relax_point."""
    fx, fy, ft = forces_on_node(h, node)
    xd, yd, td = getr(h, node, g.KNXD), getr(h, node, g.KNYD), getr(h, node, g.KNTD)
    dx = relaxed(h, node, g.KNLX, g.KNSM, fx, xd)
    dy = relaxed(h, node, g.KNLY, g.KNSM, fy, yd)
    dt = relaxed(h, node, g.KNLT, g.KNSI, ft, td)
    putr(h, node, g.KNFX, getr(h, node, g.KNFX) + (dx - fx))
    putr(h, node, g.KNFY, getr(h, node, g.KNFY) + (dy - fy))
    putr(h, node, g.KNFT, dt)
    if h.ci[g.LENER] != 0:
        ux, uy, ut = next_node_velocity(h, node)
        work = np.float64(fx - dx) * (xd + ux) + (fy - dy) * (yd + uy) + (ft - dt) * (td + ut)
        h.cd[g.WREST] += work * h.cr[g.TDEL] * 0.5


@kernel
def next_node_velocity(h: Memory, node: int) -> tuple[float, float, float]:
    """Velocities of a node at the end of the step, from its force sums."""
    dt, con1, con2 = h.cr[g.TDEL], h.cr[g.CON1], h.cr[g.CON2]
    fx, fy, ft = forces_on_node(h, node)
    m, inertia = getr(h, node, g.KNM), getr(h, node, g.KNI)
    xd, yd, td = getr(h, node, g.KNXD), getr(h, node, g.KNYD), getr(h, node, g.KNTD)
    xd, yd = (con1 * xd + fx / m * dt) * con2, (con1 * yd + fy / m * dt) * con2
    return xd, yd, (con1 * td + ft / inertia * dt) * con2


@kernel
def move_node(h: Memory, node: int) -> None:
    """Law of motion for a node."""
    if h.ci[g.LREST] != g.UNDAMPED or h.ci[g.LSCALE] != 0:
        damp_node(h, node)
    xd, yd, td = next_node_velocity(h, node)
    if h.ci[g.LENER] != 0:
        fx, fy, ft = forces_on_node(h, node)
        add_work(h, False, getr(h, node, g.KNM), getr(h, node, g.KNXD), xd, fx)
        add_work(h, False, getr(h, node, g.KNM), getr(h, node, g.KNYD), yd, fy)
        add_work(h, False, getr(h, node, g.KNI), getr(h, node, g.KNTD), td, ft)
    dt = h.cr[g.TDEL]
    putr(h, node, g.KNXD, xd)
    putr(h, node, g.KNYD, yd)
    putr(h, node, g.KNTD, td)
    putr(h, node, g.KNX, getr(h, node, g.KNX) + xd * dt)
    putr(h, node, g.KNY, getr(h, node, g.KNY) + yd * dt)
    putr(h, node, g.KNANG, getr(h, node, g.KNANG) + td * dt)


@outlined
def structure_pass(h: Memory) -> bool:
    """All structures, after the step of the blocks."""
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        move_node(h, node)
        node = iget(h, node, g.KN)
    sum_beams(h, True)
    sum_bolts(h, True)
    return True
