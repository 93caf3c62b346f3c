"""The block pass: law of motion (MOTION) and new corners (PVEL); report 2.6, physics of a rigid block.

Central differences, velocities at half steps:

    v := (CON1 v + (F/m + g) dt) CON2      w := (CON1 w + (M/I) dt) CON2

A velocity that a boundary condition gives stays as it is; a block that has both given does not turn.

The corners are turned with the block by the rotation whose half angle has the tangent w dt/2: it keeps
every length to rounding, so that a block does not grow while it spins.
"""

from __future__ import annotations

import numpy as np

from offsets.generated import (
    CON1,
    CON2,
    GRAVX,
    GRAVY,
    KBFIX,
    KBFT,
    KBFX,
    KBFY,
    KBI,
    KBM,
    KBRO,
    KP,
    KR,
    KTD,
    KX,
    KXCP,
    KXD,
    KXDP,
    KXP,
    KY,
    KYCP,
    KYD,
    KYDP,
    KYP,
    NVCR,
    TDEL,
)
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.heap.ahead import LEAD, fetch
from udec_ia.heap.jit import kernel

FIXED, GIVEN_X, GIVEN_Y = 1, 2, 4  # KBFIX: FIX; velocities that BOUNDARY gives


@kernel
def pvel(h: Memory, ib: int, x: float, y: float) -> None:
    """Corner velocities and coordinates of block `ib` (PVEL), whose centroid was at (x, y) before."""
    dt = h.cr[TDEL]
    one = real(h, 1.0)
    xd, yd, td = getr(h, ib, KXD), getr(h, ib, KYD), getr(h, ib, KTD)
    xn, yn = getr(h, ib, KX), getr(h, ib, KY)
    half = td * dt * real(h, 0.5)
    below = one + half * half
    c, s = (one - half * half) / below, (half + half) / below
    ip0 = iget(h, ib, KP)
    ip = ip0
    while True:
        rx, ry = getr(h, ip, KXP) - x, getr(h, ip, KYP) - y
        nx, ny = c * rx - s * ry, s * rx + c * ry
        putr(h, ip, KXP, xn + nx)
        putr(h, ip, KYP, yn + ny)
        putr(h, ip, KXDP, xd - td * ny)
        putr(h, ip, KYDP, yd + td * nx)
        rx, ry = getr(h, ip, KXCP) - x, getr(h, ip, KYCP) - y
        putr(h, ip, KXCP, xn + (c * rx - s * ry))
        putr(h, ip, KYCP, yn + (s * rx + c * ry))
        fetch(h, ip, NVCR, LEAD)
        ip = iget(h, ip, KR)
        if ip == ip0:
            return


@kernel
def carry_corners(h: Memory, ib: int) -> None:
    """Velocities of the corners of block `ib` from those of the block."""
    x, y = np.float64(getr(h, ib, KX)), np.float64(getr(h, ib, KY))
    xd, yd, td = np.float64(getr(h, ib, KXD)), np.float64(getr(h, ib, KYD)), np.float64(getr(h, ib, KTD))
    ip0 = iget(h, ib, KP)
    ip = ip0
    while True:
        putr(h, ip, KXDP, xd - td * (np.float64(getr(h, ip, KYP)) - y))
        putr(h, ip, KYDP, yd + td * (np.float64(getr(h, ip, KXP)) - x))
        ip = iget(h, ip, KR)
        if ip == ip0:
            return


@kernel
def next_velocity(h: Memory, ib: int) -> tuple[float, float, float]:
    """Velocities of block `ib`, which is not fixed, at the end of the step, from its force sums."""
    xd, yd, td, fix = getr(h, ib, KXD), getr(h, ib, KYD), getr(h, ib, KTD), iget(h, ib, KBFIX)
    dt, con1, con2 = h.cr[TDEL], h.cr[CON1], h.cr[CON2]
    bm = getr(h, ib, KBM)
    if fix & GIVEN_X == 0:
        xd = (con1 * xd + (getr(h, ib, KBFX) / bm + h.cr[GRAVX]) * dt) * con2
    if fix & GIVEN_Y == 0:
        yd = (con1 * yd + (getr(h, ib, KBFY) / bm + h.cr[GRAVY]) * dt) * con2
    if fix != GIVEN_X + GIVEN_Y:
        td = (con1 * td + getr(h, ib, KBFT) / getr(h, ib, KBI) * dt) * con2
    return xd, yd, td


@kernel
def accelerate(h: Memory, ib: int) -> None:
    """Velocities of block `ib` := those at the end of the step; its force sums are reset."""
    zero = real(h, 0.0)
    if iget(h, ib, KBFIX) != FIXED:
        xd, yd, td = next_velocity(h, ib)
        putr(h, ib, KXD, xd)
        putr(h, ib, KYD, yd)
        putr(h, ib, KTD, td)
    putr(h, ib, KBFX, zero)
    putr(h, ib, KBFY, zero)
    putr(h, ib, KBFT, zero)


@kernel
def motion(h: Memory, ib: int) -> float:
    """Law of motion for block `ib` (MOTION).

    Returns a bound on the velocity, in x or in y, of any point of the block.
    """
    accelerate(h, ib)
    if iget(h, ib, KBFIX) == FIXED:
        return real(h, 0.0)
    dt = h.cr[TDEL]
    xd, yd, td = getr(h, ib, KXD), getr(h, ib, KYD), getr(h, ib, KTD)
    x, y = getr(h, ib, KX), getr(h, ib, KY)
    putr(h, ib, KX, x + xd * dt)
    putr(h, ib, KY, y + yd * dt)
    pvel(h, ib, x, y)
    return max(abs(xd), abs(yd)) + abs(td) * getr(h, ib, KBRO)
