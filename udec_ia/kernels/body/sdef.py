"""Simply-deformable blocks: rigid motion and one strain rate (PUTSTR, STRAIN, STRESS; report 2.6, 3.2).

Besides its three rigid degrees of freedom the block has three more, a uniform strain rate e. With J the Euler
tensor, the integral of density times r r about the centroid, A the area, S the internal stress (tension
positive) and SA the applied stress times area:

    velocity   v = V + w x r + e r             SA_ij = sum over contacts of F_i r_j
    motion     1/2 (de/dt J + J de/dt) = sym(SA) - A S
    damping    e := (C1B e + dt de/dt) C2B     DAMPING ... INTERNAL; nothing else damps e

The centrifugal force of the block's own spin is neglected, as in the report. In one step the corners move by
r := (1 - G/2)^-1 (1 + G/2) r with G = (w + e) dt. For a pure rotation that is the rotation of a rigid block,
and lengths are kept to rounding. Stress and strain rate rotate with the block, so that their invariants do
not change. The angular momentum is conserved when the moment of inertia changes.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.errors import INSIDE_OUT
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.kernels.body.motion import accelerate
from udec_ia.kernels.constitutive.block_laws import stress_increment
from udec_ia.kernels.geometry.block_shape import round_strained
from udec_ia.kernels.geometry.plane_tensors import cayley, rotated
from udec_ia.layout import offsets as g


@inlined
def putstr(h: Memory, ib: int, fx: float, fy: float, x: float, y: float) -> None:
    """Add the force (fx, fy) that acts at (x, y) to the applied stress of block `ib` (PUTSTR)."""
    ie = iget(h, ib, g.KBEX)
    rx, ry = x - getr(h, ib, g.KX), y - getr(h, ib, g.KY)
    putr(h, ie, g.KSA11, getr(h, ie, g.KSA11) + fx * rx)
    putr(h, ie, g.KSA12, getr(h, ie, g.KSA12) + fx * ry)
    putr(h, ie, g.KSA21, getr(h, ie, g.KSA21) + fy * rx)
    putr(h, ie, g.KSA22, getr(h, ie, g.KSA22) + fy * ry)


@kernel
def reset_applied(h: Memory, ie: int) -> None:
    """Applied stress of the extension `ie` := 0."""
    zero = real(h, 0.0)
    putr(h, ie, g.KSA11, zero)
    putr(h, ie, g.KSA12, zero)
    putr(h, ie, g.KSA21, zero)
    putr(h, ie, g.KSA22, zero)


@kernel
def straining_force(h: Memory, ie: int) -> tuple[float, float, float]:
    """Force that strains extension `ie`: sym(SA) - A S, components 11, 12, 22."""
    area, half = getr(h, ie, g.KSAREA), real(h, 0.5)
    f11 = getr(h, ie, g.KSA11) - area * getr(h, ie, g.KS111)
    f22 = getr(h, ie, g.KSA22) - area * getr(h, ie, g.KS122)
    f12 = (getr(h, ie, g.KSA12) + getr(h, ie, g.KSA21)) * half - area * getr(h, ie, g.KS112)
    return f11, f12, f22


@kernel
def strain(h: Memory, ie: int) -> tuple[float, float, float]:
    """New strain rates 11, 12, 22 from applied and internal stress (STRAIN)."""
    j11, j12, j22 = getr(h, ie, g.KSJ11), getr(h, ie, g.KSJ12), getr(h, ie, g.KSJ22)
    f11, f12, f22 = straining_force(h, ie)
    coupling = j12 / j11 + j12 / j22
    a12 = (f12 + f12 - f11 * (j12 / j11) - f22 * (j12 / j22)) / (j11 + j22 - j12 * coupling)
    a11, a22 = (f11 - a12 * j12) / j11, (f22 - a12 * j12) / j22
    dt, c1, c2 = h.cr[g.TDEL], h.cr[g.C1B], h.cr[g.C2B]
    e11 = (c1 * getr(h, ie, g.KED11) + dt * a11) * c2
    e12 = (c1 * getr(h, ie, g.KED12) + dt * a12) * c2
    e22 = (c1 * getr(h, ie, g.KED22) + dt * a22) * c2
    return e11, e12, e22


@kernel
def put_strain_rate(h: Memory, ie: int, e11: float, e12: float, e22: float) -> None:
    """Strain rates of the extension `ie`."""
    putr(h, ie, g.KED11, e11)
    putr(h, ie, g.KED12, e12)
    putr(h, ie, g.KED21, e12)
    putr(h, ie, g.KED22, e22)


@kernel
def put_stress(h: Memory, ie: int, s11: float, s12: float, s22: float) -> None:
    """Internal stress of the extension `ie`."""
    putr(h, ie, g.KS111, s11)
    putr(h, ie, g.KS112, s12)
    putr(h, ie, g.KS121, s12)
    putr(h, ie, g.KS122, s22)


@kernel
def stress(h: Memory, ib: int, ie: int, c: float, s: float, laws: Any) -> None:
    """Internal stress: turned with the block, then increased by the law of the material (STRESS)."""
    dt = h.cr[g.TDEL]
    s11, s12, s22 = rotated(getr(h, ie, g.KS111), getr(h, ie, g.KS112), getr(h, ie, g.KS122), c, s)
    e11, e12, e22 = getr(h, ie, g.KED11) * dt, getr(h, ie, g.KED12) * dt, getr(h, ie, g.KED22) * dt
    law, mat = iget(h, ib, g.KCONS), iget(h, ib, g.KMAT)
    d11, d12, d22 = stress_increment(h, laws, law, mat, ib, s11, s12, s22, e11, e12, e22)
    put_stress(h, ie, s11 + d11, s12 + d12, s22 + d22)


@kernel
def move_corners(h: Memory, ib: int, ie: int, x: float, y: float, td: float, new: Any) -> None:
    """Corners, Euler tensor and area of block `ib`, whose centroid was at (x, y), through one step.

    new: the strain rates of the step. The corners then have the velocities of the step. Error 32 if they turn
    the block inside out.
    """
    e11, e12, e22 = new
    dt, half, one = h.cr[g.TDEL], real(h, 0.5), real(h, 1.0)
    a, b, c, d = e11 * dt * half, (e12 - td) * dt * half, (e12 + td) * dt * half, e22 * dt * half
    det = (one - a) * (one - d) - b * c
    m11, m12 = ((one - d) * (one + a) + b * c) / det, (b + b) / det
    m21, m22 = (c + c) / det, ((one - a) * (one + d) + b * c) / det
    stretch = m11 * m22 - m12 * m21
    if not stretch > 0 and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = INSIDE_OUT
        h.ci[g.IERAD] = ib
    xd, yd, xn, yn = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KX), getr(h, ib, g.KY)
    far = real(h, 0.0)
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        rx, ry = getr(h, ip, g.KXP) - x, getr(h, ip, g.KYP) - y
        nx, ny = m11 * rx + m12 * ry, m21 * rx + m22 * ry
        putr(h, ip, g.KXP, xn + nx)
        putr(h, ip, g.KYP, yn + ny)
        putr(h, ip, g.KXDP, xd + e11 * nx + (e12 - td) * ny)
        putr(h, ip, g.KYDP, yd + (e12 + td) * nx + e22 * ny)
        far = max(far, nx * nx + ny * ny)
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            break
    putr(h, ib, g.KBRO, np.sqrt(far))
    j11, j12, j22 = getr(h, ie, g.KSJ11), getr(h, ie, g.KSJ12), getr(h, ie, g.KSJ22)
    k11, k12 = m11 * j11 + m12 * j12, m11 * j12 + m12 * j22
    k21, k22 = m21 * j11 + m22 * j12, m21 * j12 + m22 * j22
    j11, j12, j22 = k11 * m11 + k12 * m12, k11 * m21 + k12 * m22, k21 * m21 + k22 * m22
    putr(h, ie, g.KSJ11, j11)
    putr(h, ie, g.KSJ12, j12)
    putr(h, ie, g.KSJ22, j22)
    second = j11 + j22
    putr(h, ib, g.KTD, td * (getr(h, ib, g.KBI) / second))
    putr(h, ib, g.KBI, second)
    putr(h, ie, g.KSAREA, getr(h, ie, g.KSAREA) * stretch)


@kernel
def move_sdef(h: Memory, ib: int, laws: Any) -> float:
    """One step of simply-deformable block `ib`; returns a bound on the velocity of any of its points."""
    ie = iget(h, ib, g.KBEX)
    if iget(h, ib, g.KBFIX) == g.FIXED:
        accelerate(h, ib)
        reset_applied(h, ie)
        return real(h, 0.0)
    new = strain(h, ie)
    reset_applied(h, ie)
    accelerate(h, ib)
    dt = h.cr[g.TDEL]
    xd, yd, td = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KTD)
    x, y = getr(h, ib, g.KX), getr(h, ib, g.KY)
    putr(h, ib, g.KX, x + xd * dt)
    putr(h, ib, g.KY, y + yd * dt)
    move_corners(h, ib, ie, x, y, td, new)
    round_strained(h, ib)
    put_strain_rate(h, ie, new[0], new[1], new[2])
    c, s = cayley(h, td * dt)
    stress(h, ib, ie, c, s, laws)
    e11, e12, e22 = rotated(new[0], new[1], new[2], c, s)
    put_strain_rate(h, ie, e11, e12, e22)
    spread = max(abs(new[0]), abs(new[2])) + abs(new[1]) + abs(td)
    return max(abs(xd), abs(yd)) + spread * getr(h, ib, g.KBRO)
