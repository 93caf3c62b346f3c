"""Fully-deformable blocks: masses at grid-points, triangles of constant strain (FDEF; report 2.9, 3.2).

    grid-points  v := (CON1 v + (F/m + g) dt) CON2                     (GPMOT)
    corners      move with their grid-points                           (PVELFD)
    zones        strain rates from the velocities of the three grid-points; the stress turns with the zone and
                 grows by the law of the material; its forces go to the grid-points (ZSTRS)

With N the shape function of a grid-point and A the area of a zone, e = 1/2 (dN/dx v + v dN/dx) summed over
the three, and F = -A S dN/dx (tension positive). Strain and spin of a step are those of the geometry halfway
through it, so a rotation of any size causes no strain. BETA times the stress rate is added to the forces on
grid-points, never to the stored stress.

The block's own words follow from its grid-points: centroid, velocity and angular velocity are those of their
total momentum.

Mixed discretisation (4.7): two successive zones that are a pair have one volumetric strain rate, the mean by
area; after the law they also share their pressure. Otherwise nearly incompressible triangles are too stiff.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.kernel_memory import LEAD, fetch
from udec_ia.errors import INSIDE_OUT
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.kernels.constitutive.block_laws import stress_increment
from udec_ia.kernels.geometry.block_shape import round_strained
from udec_ia.kernels.geometry.plane_tensors import cayley, rotated
from udec_ia.layout import offsets as g


@inlined
def putfdf(h: Memory, ig: int, fx: float, fy: float) -> None:
    """Add a force to the force sum of grid-point `ig` (PUTFDF)."""
    putr(h, ig, g.KGFX, getr(h, ig, g.KGFX) + fx)
    putr(h, ig, g.KGFY, getr(h, ig, g.KGFY) + fy)


@inlined
def next_point_velocity(h: Memory, ig: int) -> tuple[float, float]:
    """Velocity of grid-point `ig` at the end of the step, from its force sum.

    A component that KGFIX marks as prescribed stays unchanged.
    """
    dt, con1, con2, m = h.cr[g.TDEL], h.cr[g.CON1], h.cr[g.CON2], getr(h, ig, g.KGPM)
    fx, fy = getr(h, ig, g.KGFX) + m * h.cr[g.GRAVX], getr(h, ig, g.KGFY) + m * h.cr[g.GRAVY]
    xd, yd, fix = getr(h, ig, g.KXDG), getr(h, ig, g.KYDG), iget(h, ig, g.KGFIX)
    if fix & g.ALONG_X == 0:
        xd = (con1 * xd + fx / m * dt) * con2
    if fix & g.ALONG_Y == 0:
        yd = (con1 * yd + fy / m * dt) * con2
    return xd, yd


@inlined
def gpmot(h: Memory, ig: int) -> tuple[float, float]:
    """Law of motion for grid-point `ig` (GPMOT); resets its force sum; returns its velocity."""
    zero, dt = real(h, 0.0), h.cr[g.TDEL]
    xd, yd = next_point_velocity(h, ig)
    putr(h, ig, g.KGFX, zero)
    putr(h, ig, g.KGFY, zero)
    putr(h, ig, g.KXDG, xd)
    putr(h, ig, g.KYDG, yd)
    putr(h, ig, g.KXG, getr(h, ig, g.KXG) + xd * dt)
    putr(h, ig, g.KYG, getr(h, ig, g.KYG) + yd * dt)
    return xd, yd


@kernel
def pvelfd(h: Memory, ib: int) -> None:
    """Coordinates and velocities of the corners of block `ib` from those of their grid-points (PVELFD)."""
    x, y = getr(h, ib, g.KX), getr(h, ib, g.KY)
    far = real(h, 0.0)
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        fetch(h, ip, g.NVCR, LEAD)
        ig = iget(h, ip, g.KGP)
        xp, yp = getr(h, ig, g.KXG), getr(h, ig, g.KYG)
        putr(h, ip, g.KXP, xp)
        putr(h, ip, g.KYP, yp)
        putr(h, ip, g.KXDP, getr(h, ig, g.KXDG))
        putr(h, ip, g.KYDP, getr(h, ig, g.KYDG))
        far = max(far, (xp - x) * (xp - x) + (yp - y) * (yp - y))
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            break
    putr(h, ib, g.KBRO, np.sqrt(far))


@kernel
def sum_over_points(h: Memory, ib: int) -> None:
    """Centroid, velocity, angular velocity and moment of inertia of block `ib` from its grid-points.

    Sums are taken around the previous centroid, displaced with the first grid-point. However far a block
    moves in a step, this point is inside it or near, so the moment of inertia is not a difference of large
    numbers.
    """
    zero, dt = real(h, 0.0), h.cr[g.TDEL]
    mass, mx, my, px, py, turn, second = zero, zero, zero, zero, zero, zero, zero
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    x0, y0 = getr(h, ib, g.KX) + getr(h, ig, g.KXDG) * dt, getr(h, ib, g.KY) + getr(h, ig, g.KYDG) * dt
    while ig != 0:
        m, xd, yd = getr(h, ig, g.KGPM), getr(h, ig, g.KXDG), getr(h, ig, g.KYDG)
        dx, dy = getr(h, ig, g.KXG) - x0, getr(h, ig, g.KYG) - y0
        mass += m
        mx += m * dx
        my += m * dy
        px += m * xd
        py += m * yd
        turn += m * (dx * yd - dy * xd)
        second += m * (dx * dx + dy * dy)
        ig = iget(h, ig, g.KG)
    cx, cy = mx / mass, my / mass
    second -= mass * (cx * cx + cy * cy)
    putr(h, ib, g.KX, x0 + cx)
    putr(h, ib, g.KY, y0 + cy)
    putr(h, ib, g.KXD, px / mass)
    putr(h, ib, g.KYD, py / mass)
    putr(h, ib, g.KTD, (turn - (cx * py - cy * px)) / second)
    putr(h, ib, g.KBM, mass)
    putr(h, ib, g.KBI, second)


@inlined
def gradient(h: Memory, iz: int, back: float) -> tuple[int, int, int, float, float, float, float, float]:
    """Grid-points of zone `iz`, anticlockwise; shape function gradients times 2 A, and 2 A.

    back: time by which the grid-points are moved back along their velocities. The gradients are
    b1, c1, b2, c2, b3, c3, of which b and c are the derivatives to x and to y; the third is minus the sum.
    """
    g1, g2, g3 = iget(h, iz, g.KZG, 2), iget(h, iz, g.KZG, 1), iget(h, iz, g.KZG, 0)
    x1, y1 = getr(h, g1, g.KXG) - getr(h, g1, g.KXDG) * back, getr(h, g1, g.KYG) - getr(h, g1, g.KYDG) * back
    x2, y2 = getr(h, g2, g.KXG) - getr(h, g2, g.KXDG) * back, getr(h, g2, g.KYG) - getr(h, g2, g.KYDG) * back
    x3, y3 = getr(h, g3, g.KXG) - getr(h, g3, g.KXDG) * back, getr(h, g3, g.KYG) - getr(h, g3, g.KYDG) * back
    b1, c1, b2, c2 = y2 - y3, x3 - x2, y3 - y1, x1 - x3
    return g1, g2, g3, b1, c1, b2, c2, b1 * c2 - b2 * c1


@kernel
def zone_area(h: Memory, iz: int) -> float:
    """Area of zone `iz`; negative if it has turned inside out."""
    _, _, _, _, _, _, _, twice = gradient(h, iz, real(h, 0.0))
    return twice * real(h, 0.5)


@inlined
def strain_rates(h: Memory, iz: int) -> tuple[float, float, float, float, float]:
    """Strain rates 11, 12, 22, spin (anticlockwise) and twice the area of zone `iz` in mid-step."""
    half = real(h, 0.5)
    g1, g2, g3, b1, c1, b2, c2, twice = gradient(h, iz, h.cr[g.TDEL] * half)
    u3, v3 = getr(h, g3, g.KXDG), getr(h, g3, g.KYDG)
    u1, v1 = getr(h, g1, g.KXDG) - u3, getr(h, g1, g.KYDG) - v3
    u2, v2 = getr(h, g2, g.KXDG) - u3, getr(h, g2, g.KYDG) - v3
    one = real(h, 1.0) / twice
    xx, xy = (b1 * u1 + b2 * u2) * one, (c1 * u1 + c2 * u2) * one
    yx, yy = (b1 * v1 + b2 * v2) * one, (c1 * v1 + c2 * v2) * one
    return xx, (xy + yx) * half, yy, (yx - xy) * half, twice


@inlined
def zone_stress(
    h: Memory, ib: int, iz: int, laws: Any, e11: float, e12: float, e22: float, spin: float
) -> tuple[float, float, float]:
    """New stress of zone `iz` of block `ib`; returns the stress increments by the law."""
    dt = h.cr[g.TDEL]
    c, s = cayley(h, spin * dt)
    s11, s12, s22 = rotated(getr(h, iz, g.KZS11), getr(h, iz, g.KZS12), getr(h, iz, g.KZS22), c, s)
    law, mat = iget(h, ib, g.KCONS), iget(h, ib, g.KMAT)
    d11, d12, d22 = stress_increment(h, laws, law, mat, ib, s11, s12, s22, e11 * dt, e12 * dt, e22 * dt)
    putr(h, iz, g.KZS11, s11 + d11)
    putr(h, iz, g.KZS12, s12 + d12)
    putr(h, iz, g.KZS22, s22 + d22)
    return d11, d12, d22


@inlined
def zone_forces(h: Memory, iz: int, r11: float, r12: float, r22: float) -> None:
    """Forces of zone `iz` on its grid-points: of its stress and the damping stress r11, r12, r22."""
    g1, g2, g3, b1, c1, b2, c2, twice = gradient(h, iz, real(h, 0.0))
    if not twice > 0 and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = INSIDE_OUT
        h.ci[g.IERAD] = iz
    half = real(h, 0.5)
    s11, s12, s22 = getr(h, iz, g.KZS11) + r11, getr(h, iz, g.KZS12) + r12, getr(h, iz, g.KZS22) + r22
    fx1, fy1 = -(s11 * b1 + s12 * c1) * half, -(s12 * b1 + s22 * c1) * half
    fx2, fy2 = -(s11 * b2 + s12 * c2) * half, -(s12 * b2 + s22 * c2) * half
    putfdf(h, g1, fx1, fy1)
    putfdf(h, g2, fx2, fy2)
    putfdf(h, g3, -(fx1 + fx2), -(fy1 + fy2))


@inlined
def zstrs(h: Memory, ib: int, iz: int, laws: Any) -> None:
    """Strain rates, stress and grid-point forces of zone `iz` of block `ib` (ZSTRS)."""
    e11, e12, e22, spin, _ = strain_rates(h, iz)
    d11, d12, d22 = zone_stress(h, ib, iz, laws, e11, e12, e22, spin)
    rate = h.cr[g.BETA] / h.cr[g.TDEL]
    zone_forces(h, iz, d11 * rate, d12 * rate, d22 * rate)


@inlined
def pressure(h: Memory, iz: int) -> float:
    """Mean of the two normal stresses of zone `iz`."""
    return (getr(h, iz, g.KZS11) + getr(h, iz, g.KZS22)) * real(h, 0.5)


@inlined
def add_pressure(h: Memory, iz: int, p: float) -> None:
    """Add `p` to the two normal stresses of zone `iz`."""
    putr(h, iz, g.KZS11, getr(h, iz, g.KZS11) + p)
    putr(h, iz, g.KZS22, getr(h, iz, g.KZS22) + p)


@kernel
def zstrs_mixed(h: Memory, ib: int, iz: int, jz: int, laws: Any) -> None:
    """As zstrs for the two zones `iz` and `jz` of a pair, with mixed discretisation (4.7)."""
    half = real(h, 0.5)
    a11, a12, a22, aspin, aarea = strain_rates(h, iz)
    b11, b12, b22, bspin, barea = strain_rates(h, jz)
    part = aarea / (aarea + barea)
    rest = real(h, 1.0) - part
    mean = (a11 + a22) * part + (b11 + b22) * rest
    da, db = (mean - (a11 + a22)) * half, (mean - (b11 + b22)) * half
    a11, a12, a22 = zone_stress(h, ib, iz, laws, a11 + da, a12, a22 + da, aspin)
    b11, b12, b22 = zone_stress(h, ib, jz, laws, b11 + db, b12, b22 + db, bspin)
    pa, pb = pressure(h, iz), pressure(h, jz)
    mean = pa * part + pb * rest
    add_pressure(h, iz, mean - pa)
    add_pressure(h, jz, mean - pb)
    rate = h.cr[g.BETA] / h.cr[g.TDEL]
    zone_forces(h, iz, a11 * rate, a12 * rate, a22 * rate)
    zone_forces(h, jz, b11 * rate, b12 * rate, b22 * rate)


@kernel
def zone_pass(h: Memory, ib: int, laws: Any) -> None:
    """All zones of block `ib`."""
    ie = iget(h, ib, g.KBEX)
    iz = iget(h, ie, g.KFZ)
    if iget(h, ie, g.KFMIX) == 1:
        while iz != 0:
            jz = iget(h, iz, g.KZ)
            zstrs_mixed(h, ib, iz, jz, laws)
            iz = iget(h, jz, g.KZ)
        return
    while iz != 0:
        fetch(h, iz, g.NVZO, LEAD)
        zstrs(h, ib, iz, laws)
        iz = iget(h, iz, g.KZ)


@kernel
def reset_point_forces(h: Memory, ib: int) -> None:
    """Reset the forces on the grid-points of block `ib`."""
    zero = real(h, 0.0)
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        putr(h, ig, g.KGFX, zero)
        putr(h, ig, g.KGFY, zero)
        ig = iget(h, ig, g.KG)


@kernel
def move_fdef(h: Memory, ib: int, laws: Any) -> float:
    """One step of fully-deformable block `ib` (FDEF); returns a bound on the velocity of its points."""
    zero = real(h, 0.0)
    putr(h, ib, g.KBFX, zero)
    putr(h, ib, g.KBFY, zero)
    putr(h, ib, g.KBFT, zero)
    if iget(h, ib, g.KBFIX) == g.FIXED:
        reset_point_forces(h, ib)
        return zero
    fastest = zero
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        fetch(h, ig, g.NVGP, LEAD)
        xd, yd = gpmot(h, ig)
        fastest = max(fastest, max(abs(xd), abs(yd)))
        ig = iget(h, ig, g.KG)
    sum_over_points(h, ib)
    pvelfd(h, ib)
    round_strained(h, ib)
    zone_pass(h, ib, laws)
    return fastest
