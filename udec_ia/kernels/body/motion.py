"""The block pass: law of motion (MOTION) and new corners (PVEL); report 2.6, physics of a rigid block.

Central differences, velocities at half steps:

    v := (CON1 v + (F/m + g) dt) CON2      w := (CON1 w + (M/I) dt) CON2

A velocity that a boundary condition prescribes stays unchanged. A block with velocities prescribed in x and y
does not rotate, unless its rotation is prescribed as well.

The corners rotate with the block by the rotation whose half angle has the tangent w dt/2. It keeps every
length to rounding, so a spinning block does not grow.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.kernel_memory import LEAD, fetch
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.layout import offsets as g


@kernel
def pvel(h: Memory, ib: int, x: float, y: float) -> None:
    """Corner velocities and coordinates of block `ib` (PVEL), whose centroid was at (x, y) before."""
    dt = h.cr[g.TDEL]
    one = real(h, 1.0)
    xd, yd, td = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KTD)
    xn, yn = getr(h, ib, g.KX), getr(h, ib, g.KY)
    half = td * dt * real(h, 0.5)
    below = one + half * half
    c, s = (one - half * half) / below, (half + half) / below
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        rx, ry = getr(h, ip, g.KXP) - x, getr(h, ip, g.KYP) - y
        nx, ny = c * rx - s * ry, s * rx + c * ry
        putr(h, ip, g.KXP, xn + nx)
        putr(h, ip, g.KYP, yn + ny)
        putr(h, ip, g.KXDP, xd - td * ny)
        putr(h, ip, g.KYDP, yd + td * nx)
        rx, ry = getr(h, ip, g.KXCP) - x, getr(h, ip, g.KYCP) - y
        putr(h, ip, g.KXCP, xn + (c * rx - s * ry))
        putr(h, ip, g.KYCP, yn + (s * rx + c * ry))
        fetch(h, ip, g.NVCR, LEAD)
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            return


@inlined
def velocities(h: Memory, ib: int) -> tuple[float, float, float]:
    """KXD, KYD and KTD of block `ib`, with 64 bits."""
    return np.float64(getr(h, ib, g.KXD)), np.float64(getr(h, ib, g.KYD)), np.float64(getr(h, ib, g.KTD))


@kernel
def set_corner_velocities(h: Memory, ib: int) -> None:
    """Velocities of the corners of block `ib` from those of the block."""
    x, y = np.float64(getr(h, ib, g.KX)), np.float64(getr(h, ib, g.KY))
    xd, yd, td = velocities(h, ib)
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        putr(h, ip, g.KXDP, xd - td * (np.float64(getr(h, ip, g.KYP)) - y))
        putr(h, ip, g.KYDP, yd + td * (np.float64(getr(h, ip, g.KXP)) - x))
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            return


@inlined
def turns_freely(fix: int) -> bool:
    """True if a block that is not fixed, with the code `fix` of KBFIX, turns by the law of motion."""
    return bool(fix & g.GIVEN_TURN == 0 and fix != g.GIVEN_X + g.GIVEN_Y)


@kernel
def next_velocity(h: Memory, ib: int) -> tuple[float, float, float]:
    """Velocities of block `ib`, which is not fixed, at the end of the step, from its force sums."""
    xd, yd, td, fix = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KTD), iget(h, ib, g.KBFIX)
    dt, con1, con2 = h.cr[g.TDEL], h.cr[g.CON1], h.cr[g.CON2]
    bm = getr(h, ib, g.KBM)
    if fix & g.GIVEN_X == 0:
        xd = (con1 * xd + (getr(h, ib, g.KBFX) / bm + h.cr[g.GRAVX]) * dt) * con2
    if fix & g.GIVEN_Y == 0:
        yd = (con1 * yd + (getr(h, ib, g.KBFY) / bm + h.cr[g.GRAVY]) * dt) * con2
    if turns_freely(fix):
        td = (con1 * td + getr(h, ib, g.KBFT) / getr(h, ib, g.KBI) * dt) * con2
    return xd, yd, td


@kernel
def accelerate(h: Memory, ib: int) -> None:
    """Velocities of block `ib` := those at the end of the step; its force sums are reset."""
    zero = real(h, 0.0)
    if iget(h, ib, g.KBFIX) != g.FIXED:
        xd, yd, td = next_velocity(h, ib)
        putr(h, ib, g.KXD, xd)
        putr(h, ib, g.KYD, yd)
        putr(h, ib, g.KTD, td)
    putr(h, ib, g.KBFX, zero)
    putr(h, ib, g.KBFY, zero)
    putr(h, ib, g.KBFT, zero)


@kernel
def motion(h: Memory, ib: int) -> float:
    """Law of motion for block `ib` (MOTION).

    Returns a bound on the velocity, in x or in y, of any point of the block.
    """
    accelerate(h, ib)
    if iget(h, ib, g.KBFIX) == g.FIXED:
        return real(h, 0.0)
    dt = h.cr[g.TDEL]
    xd, yd, td = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KTD)
    x, y = getr(h, ib, g.KX), getr(h, ib, g.KY)
    putr(h, ib, g.KX, x + xd * dt)
    putr(h, ib, g.KY, y + yd * dt)
    pvel(h, ib, x, y)
    return max(abs(xd), abs(yd)) + abs(td) * getr(h, ib, g.KBRO)
