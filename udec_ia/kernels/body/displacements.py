"""The displacement pass: displacements of blocks and grid-points since DISPLACEMENTS, or since a RESET.

They are sums of velocity times dt, as places are, and so exact to rounding. The displacement of a block is
that of its centroid; a block with zones has a mean rotation, and each grid-point a displacement of its own.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.kernels.links.longer_groups import displacement_at, point_displacement_at
from udec_ia.layout import offsets as g


@kernel
def _add_to_points(h: Memory, ib: int) -> None:
    """Add the displacements in this step to those of the grid-points of block `ib`."""
    dt = h.cr[g.TDEL]
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        iu = point_displacement_at(h, ig)
        putr(h, iu, g.KGDX, getr(h, iu, g.KGDX) + getr(h, ig, g.KXDG) * dt)
        putr(h, iu, g.KGDY, getr(h, iu, g.KGDY) + getr(h, ig, g.KYDG) * dt)
        ig = iget(h, ig, g.KG)


@outlined
def add_displacements(h: Memory) -> bool:
    """Add the displacements in this step to those of all blocks and grid-points, after the motion."""
    dt = h.cr[g.TDEL]
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED:
            iu = displacement_at(h, ib)
            putr(h, iu, g.KBDX, getr(h, iu, g.KBDX) + getr(h, ib, g.KXD) * dt)
            putr(h, iu, g.KBDY, getr(h, iu, g.KBDY) + getr(h, ib, g.KYD) * dt)
            putr(h, iu, g.KBDT, getr(h, iu, g.KBDT) + getr(h, ib, g.KTD) * dt)
            if iget(h, ib, HEAD) == g.MFDEF:
                _add_to_points(h, ib)
        ib = iget(h, ib, g.KB)
    return True


@kernel
def put_mean_displacement(h: Memory, ib: int) -> None:
    """Displacement of zoned block `ib` := the mean of its grid-points, by mass; its rotation stays."""
    mass, x, y = real(h, 0.0), real(h, 0.0), real(h, 0.0)
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        iu, m = point_displacement_at(h, ig), getr(h, ig, g.KGPM)
        mass += m
        x += m * getr(h, iu, g.KGDX)
        y += m * getr(h, iu, g.KGDY)
        ig = iget(h, ig, g.KG)
    putr(h, displacement_at(h, ib), g.KBDX, x / mass)
    putr(h, displacement_at(h, ib), g.KBDY, y / mass)


@kernel
def displacement_of_point(h: Memory, ib: int, rx: float, ry: float) -> tuple[float, float]:
    """Displacement of the point of block `ib` that is now (rx, ry) from its centroid, as of a rigid body.

    It was at (rx, ry), turned back, from where the centroid was.
    """
    iu = displacement_at(h, ib)
    turned = getr(h, iu, g.KBDT)
    c, s = np.cos(turned), np.sin(turned)
    ux = getr(h, iu, g.KBDX) + rx - (c * rx + s * ry)
    uy = getr(h, iu, g.KBDY) + ry - (c * ry - s * rx)
    return ux, uy


@kernel
def put_displacement(h: Memory, ib: int, ux: float, uy: float, turned: float) -> None:
    """Displacement of block `ib` := (ux, uy), and its rotation := `turned`."""
    iu = displacement_at(h, ib)
    putr(h, iu, g.KBDX, ux)
    putr(h, iu, g.KBDY, uy)
    putr(h, iu, g.KBDT, turned)
