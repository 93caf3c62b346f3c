"""A point of a structure that belongs to a block: where it is, how it moves, and what a force there does.

It moves as a corner of the block would: with the rotation of a rigid block, with the uniform strain of a
simply-deformable one, and with the three grid-points of its zone in a fully-deformable one. A force and a
moment act on the same degrees of freedom, so that work is equal on both sides, and so are the forces:

    rigid                x := X + R (x - X)            force and moment to the block
    simply-deformable    x := X + (1 - G/2)^-1 (1 + G/2) (x - X), G = (w + e) dt; the force adds to the stress
    fully-deformable     x := sum N x of the grid-points, N the shape functions of the zone; the force is N F,
                         and a moment is a couple that works on the spin of the zone

Only the position is stored. Where blocks are cut, merged, deleted or divided into zones the point is found
again by it (`block_at`, `zone_at`). Numbers are calculated with 64 bits in every word scheme.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.kernels.body.fdef import gradient, putfdf, strain_rates
from udec_ia.kernels.body.sdef import putstr
from udec_ia.kernels.geometry.point_distance import distance_outside
from udec_ia.layout import offsets as g


@kernel
def block_at(h: Memory, x: float, y: float, former: int) -> int:
    """The block that holds the point (x, y): `former` if that does, else the nearest; 0 outside all blocks.

    former: address of a block that may be no more, or 0. A point on a joint may lie FTOL outside its block.
    """
    reach = np.float64(h.cr[g.FTOL])
    nearest, found = np.inf, int64(0)
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        dx, dy = x - getr(h, ib, g.KX), y - getr(h, ib, g.KY)
        radius = getr(h, ib, g.KBRO) + reach
        if dx * dx + dy * dy <= radius * radius:
            away = distance_outside(h, ib, x, y)
            if away <= reach and (away < nearest or ib == former):
                nearest, found = away, ib
            if found != 0 and found == former:
                return found
        ib = iget(h, ib, g.KB)
    return found


@kernel
def zone_at(h: Memory, ib: int, x: float, y: float) -> int:
    """The zone of block `ib` in which the point (x, y) lies, or is nearest to; 0 if it has none."""
    best, found = -np.inf, int64(0)
    iz = iget(h, iget(h, ib, g.KBEX), g.KFZ) if iget(h, ib, HEAD) == g.MFDEF else int64(0)
    while iz != 0:
        _, _, _, n1, n2, n3 = shares(h, iz, x, y, 0.0)
        smallest = min(n1, min(n2, n3))
        if smallest > best:
            best, found = smallest, iz
        iz = iget(h, iz, g.KZ)
    return found


@kernel
def shares(h: Memory, iz: int, x: float, y: float, back: float) -> tuple[int, int, int, float, float, float]:
    """Grid-points of zone `iz`, and the shape functions of the point (x, y).

    back: time by which the grid-points are moved back along their velocities.
    """
    g1, g2, g3, b1, c1, b2, c2, twice = gradient(h, iz, real(h, back))
    dx = x - (np.float64(getr(h, g3, g.KXG)) - np.float64(getr(h, g3, g.KXDG)) * back)
    dy = y - (np.float64(getr(h, g3, g.KYG)) - np.float64(getr(h, g3, g.KYDG)) * back)
    n1, n2 = (b1 * dx + c1 * dy) / twice, (b2 * dx + c2 * dy) / twice
    return g1, g2, g3, n1, n2, 1.0 - n1 - n2


@kernel
def moved_by(h: Memory, ib: int, iz: int, x: float, y: float) -> tuple[float, float, float]:
    """Displacement and rotation in the step that was calculated last of a point that was at (x, y) before it.

    ib: its block; iz: its zone, or 0. The rotation is that for which the displacements of a rigid block are
    the rotation times the mean of the two levers.
    """
    if iget(h, ib, g.KBFIX) == g.FIXED:
        return 0.0, 0.0, 0.0
    dt = np.float64(h.cr[g.TDEL])
    if iz != 0:
        g1, g2, g3, n1, n2, n3 = shares(h, iz, x, y, dt)
        u = n1 * getr(h, g1, g.KXDG) + n2 * getr(h, g2, g.KXDG) + n3 * getr(h, g3, g.KXDG)
        v = n1 * getr(h, g1, g.KYDG) + n2 * getr(h, g2, g.KYDG) + n3 * getr(h, g3, g.KYDG)
        _, _, _, spin, _ = strain_rates(h, iz)
        return u * dt, v * dt, spin * dt
    u, v = np.float64(getr(h, ib, g.KXD)) * dt, np.float64(getr(h, ib, g.KYD)) * dt
    turn = np.float64(getr(h, ib, g.KTD)) * dt
    a, d, shear = 0.0, 0.0, 0.0
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        a, d = getr(h, ie, g.KED11) * dt * 0.5, getr(h, ie, g.KED22) * dt * 0.5
        shear = getr(h, ie, g.KED12) * dt
    b, c = (shear - turn) * 0.5, (shear + turn) * 0.5
    rx, ry = x - (getr(h, ib, g.KX) - u), y - (getr(h, ib, g.KY) - v)
    det = (1.0 - a) * (1.0 - d) - b * c
    mx, my = ((1.0 - d) * rx + b * ry) / det, (c * rx + (1.0 - a) * ry) / det  # mean of the two levers
    return u + 2.0 * (a * mx + b * my), v + 2.0 * (c * mx + d * my), turn


@kernel
def push(h: Memory, ib: int, iz: int, x: float, y: float, fx: float, fy: float, moment: float) -> None:
    """Add a force at the point (x, y) and a moment to the force sums of block `ib`. iz: zone, or 0."""
    putr(h, ib, g.KBFX, getr(h, ib, g.KBFX) + fx)
    putr(h, ib, g.KBFY, getr(h, ib, g.KBFY) + fy)
    arm = (x - getr(h, ib, g.KX)) * fy - (y - getr(h, ib, g.KY)) * fx
    putr(h, ib, g.KBFT, getr(h, ib, g.KBFT) + (arm + moment))
    if iget(h, ib, HEAD) == g.MSDEF:
        putstr(h, ib, real(h, fx), real(h, fy), real(h, x), real(h, y))
    elif iz != 0:
        g1, g2, g3, n1, n2, n3 = shares(h, iz, x, y, 0.0)
        _, _, _, b1, c1, b2, c2, twice = gradient(h, iz, real(h, 0.0))
        couple = moment / (twice + twice)
        b3, c3 = -(b1 + b2), -(c1 + c2)
        putfdf(h, g1, real(h, n1 * fx - c1 * couple), real(h, n1 * fy + b1 * couple))
        putfdf(h, g2, real(h, n2 * fx - c2 * couple), real(h, n2 * fy + b2 * couple))
        putfdf(h, g3, real(h, n3 * fx - c3 * couple), real(h, n3 * fy + b3 * couple))
