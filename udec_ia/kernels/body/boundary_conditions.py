"""Boundary conditions: prescribed velocities, loads and viscous edges (the report's further developments).

A condition acts on a grid-point, on a block at its centroid, or at a corner of a block without grid-points:

    velocity   V f replaces the result of the law of motion
    load       F f
    viscous    -C v, with C = rho Cp L along the normal of the edge and rho Cs L along the edge: a wave that
               arrives is absorbed; a load of 2 rho C v L sends a wave in

f is 1, a sine or a FUNCTION of time, calculated with 64 bits in every word scheme and then rounded once.
Loads keep their initial direction and size. The work of conditions is summed in WBOUND if an account of the
energy is kept (kernels.energy.stored_energy). WDRIVE sums up the energy that they put in, without subtracting
what they absorb. It distinguishes a driven run from one that gains energy from nowhere
(advice.energy_monitor).
"""

from __future__ import annotations

import math

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.kernels.body.fdef import putfdf
from udec_ia.kernels.body.sdef import putstr
from udec_ia.layout import offsets as g


@kernel
def _function(h: Memory, isg: int, t: float) -> float:
    """Factor of a FUNCTION at the time `t`: linear between its points, constant before and after them."""
    it = iget(h, isg, g.KTP)
    t0, f0 = np.float64(getr(h, it, g.KTPT)), np.float64(getr(h, it, g.KTPF))
    while it != 0:
        t1, f1 = np.float64(getr(h, it, g.KTPT)), np.float64(getr(h, it, g.KTPF))
        if t <= t1:
            return float(f0 if t1 == t0 else f0 + (f1 - f0) * max((t - t0) / (t1 - t0), 0.0))
        t0, f0 = t1, f1
        it = iget(h, it, g.KTPN)
    return float(f0)


@kernel
def set_signals(h: Memory) -> None:
    """Factors of all signals for the step that begins: their values halfway through it.

    Compiled and interpreted runs use the sine of the C library; NumPy's may differ in the last digit.
    """
    t = float(h.cd[g.TIME] + np.float64(h.cr[g.TDEL]) * 0.5)
    isg = h.ci[g.ISGPNT]
    while isg != 0:
        factor = 0.0
        passed = t - np.float64(getr(h, isg, g.KTBEG)) - getr(h, isg, g.KTREST)
        if iget(h, isg, g.KTP) != 0:
            factor = _function(h, isg, t)
        elif passed <= getr(h, isg, g.KTLAST):
            factor = math.sin(2 * math.pi * np.float64(getr(h, isg, g.KTFREQ)) * passed)
        putr(h, isg, g.KTNOW, factor)
        isg = iget(h, isg, g.KT)


@kernel
def velocity_of(h: Memory, iu: int, x: float, y: float) -> tuple[float, float]:
    """Velocity of the grid-point, or of the block at (x, y), on which condition `iu` acts."""
    ig, ib = iget(h, iu, g.KUG), iget(h, iu, g.KUB)
    if ig != 0:
        return getr(h, ig, g.KXDG), getr(h, ig, g.KYDG)
    rx, ry, td = x - getr(h, ib, g.KX), y - getr(h, ib, g.KY), getr(h, ib, g.KTD)
    xd, yd = getr(h, ib, g.KXD) - td * ry, getr(h, ib, g.KYD) + td * rx
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        e12 = getr(h, ie, g.KED12)
        xd, yd = xd + getr(h, ie, g.KED11) * rx + e12 * ry, yd + e12 * rx + getr(h, ie, g.KED22) * ry
    return xd, yd


@kernel
def add_load(h: Memory, iu: int, fx: float, fy: float, x: float, y: float) -> None:
    """Add a force to the grid-point or block on which condition `iu` acts."""
    ig, ib = iget(h, iu, g.KUG), iget(h, iu, g.KUB)
    putr(h, ib, g.KBFX, getr(h, ib, g.KBFX) + fx)
    putr(h, ib, g.KBFY, getr(h, ib, g.KBFY) + fy)
    if ig != 0:
        putfdf(h, ig, fx, fy)
        return
    moment = (x - getr(h, ib, g.KX)) * fy - (y - getr(h, ib, g.KY)) * fx
    putr(h, ib, g.KBFT, getr(h, ib, g.KBFT) + moment)
    if iget(h, ib, HEAD) == g.MSDEF:
        putstr(h, ib, fx, fy, x, y)


@inlined
def mass_and_force(h: Memory, ig: int, ib: int) -> tuple[float, float, float]:
    """Mass of grid-point `ig`, or of block `ib` if that is 0, and the force on it, weight included."""
    if ig != 0:
        m, fx, fy = np.float64(getr(h, ig, g.KGPM)), getr(h, ig, g.KGFX), getr(h, ig, g.KGFY)
    else:
        m, fx, fy = np.float64(getr(h, ib, g.KBM)), getr(h, ib, g.KBFX), getr(h, ib, g.KBFY)
    return m, fx + m * h.cr[g.GRAVX], fy + m * h.cr[g.GRAVY]


@inlined
def twice_energy_gained(m: float, ux: float, uy: float, vx: float, vy: float) -> float:
    """Twice the kinetic energy that a mass gains as its velocity (ux, uy) becomes (vx, vy)."""
    faster = np.float64(vx) * vx + np.float64(vy) * vy
    return float(m * (faster - np.float64(ux) * ux - np.float64(uy) * uy))


@kernel
def add_velocity_work(h: Memory, iu: int, ux: float, uy: float, vx: float, vy: float) -> None:
    """Add to WBOUND the growth of kinetic energy (energy.stored_energy) when (ux, uy) becomes (vx, vy)."""
    ig, ib, half = iget(h, iu, g.KUG), iget(h, iu, g.KUB), 0.5
    m, fx, fy = mass_and_force(h, ig, ib)
    power = fx * (vx - ux) + fy * (vy - uy)
    h.cd[g.WBOUND] += (twice_energy_gained(m, ux, uy, vx, vy) + power * h.cr[g.TDEL]) * half


@kernel
def _give_velocity(h: Memory, iu: int, factor: float) -> None:
    """Set the velocities that condition `iu` prescribes; the change of kinetic energy is its work."""
    ig, ib, fix = iget(h, iu, g.KUG), iget(h, iu, g.KUB), iget(h, iu, g.KUFIX)
    if iget(h, ib, g.KBFIX) == g.FIXED:
        return
    if iget(h, ib, g.KBFIX) == g.GIVEN_X + g.GIVEN_Y:
        if h.ci[g.LENER] != 0:
            td = np.float64(getr(h, ib, g.KTD))
            h.cd[g.WBOUND] -= td * (getr(h, ib, g.KBI) * td + getr(h, ib, g.KBFT) * h.cr[g.TDEL]) * 0.5
        putr(h, ib, g.KTD, real(h, 0.0))
    if ig != 0:
        vx, vy = getr(h, ig, g.KXDG), getr(h, ig, g.KYDG)
    else:
        vx, vy = getr(h, ib, g.KXD), getr(h, ib, g.KYD)
    ux, uy = vx, vy
    if fix & g.ALONG_X != 0:
        vx = getr(h, iu, g.KUVX) * factor
    if fix & g.ALONG_Y != 0:
        vy = getr(h, iu, g.KUVY) * factor
    if ig != 0:
        putr(h, ig, g.KXDG, vx)
        putr(h, ig, g.KYDG, vy)
    else:
        putr(h, ib, g.KXD, vx)
        putr(h, ib, g.KYD, vy)
    m, _, _ = mass_and_force(h, ig, ib)
    h.cd[g.WDRIVE] += max(twice_energy_gained(m, ux, uy, vx, vy) * 0.5, 0.0)
    if h.ci[g.LENER] != 0:
        add_velocity_work(h, iu, ux, uy, vx, vy)


@kernel
def load(h: Memory, iu: int) -> tuple[float, float, float, float]:
    """Force of condition `iu` at the present velocities and signal, and the point where it acts."""
    factor = real(h, 1.0)
    if iget(h, iu, g.KUS) != 0:
        factor = getr(h, iget(h, iu, g.KUS), g.KTNOW)
    ib, ip = iget(h, iu, g.KUB), iget(h, iu, g.KUP)
    x, y = getr(h, ib, g.KX), getr(h, ib, g.KY)
    if ip != 0:
        x, y = getr(h, ip, g.KXP), getr(h, ip, g.KYP)
    vx, vy = velocity_of(h, iu, x, y)
    cxx, cxy, cyy = getr(h, iu, g.KUCXX), getr(h, iu, g.KUCXY), getr(h, iu, g.KUCYY)
    fx = getr(h, iu, g.KUFX) * factor - cxx * vx - cxy * vy
    fy = getr(h, iu, g.KUFY) * factor - cxy * vx - cyy * vy
    return fx, fy, x, y


@kernel
def power_of_load(h: Memory, iu: int, fx: float, fy: float, x: float, y: float) -> float:
    """Power of the load (fx, fy) of condition `iu` at the present velocities; 0 if it is negative."""
    if iget(h, iget(h, iu, g.KUB), g.KBFIX) == g.FIXED:
        return 0.0
    vx, vy = velocity_of(h, iu, x, y)
    return max(np.float64(fx) * vx + np.float64(fy) * vy, 0.0)


@kernel
def power_of_loads(h: Memory) -> float:
    """The same of all conditions."""
    power = 0.0
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        fx, fy, x, y = load(h, iu)
        power += power_of_load(h, iu, fx, fy, x, y)
        iu = iget(h, iu, g.KU)
    return power


@kernel
def add_loads(h: Memory, dt: float) -> None:
    """Add the loads of all boundary conditions to the force sums, and their work during `dt` to WDRIVE.

    dt: the time-step that begins, 0 between two cycles.
    """
    zero = real(h, 0.0)
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        fx, fy, x, y = load(h, iu)
        if fx != zero or fy != zero:
            add_load(h, iu, fx, fy, x, y)
            h.cd[g.WDRIVE] += power_of_load(h, iu, fx, fy, x, y) * dt
        iu = iget(h, iu, g.KU)


@kernel
def add_driving_work(h: Memory, iu: int) -> None:
    """Add to WDRIVE the work of the velocities of condition `iu` during the step that begins."""
    ig, ib, fix = iget(h, iu, g.KUG), iget(h, iu, g.KUB), iget(h, iu, g.KUFIX)
    if iget(h, ib, g.KBFIX) == g.FIXED:
        return
    _, fx, fy = mass_and_force(h, ig, ib)
    vx, vy = (
        (getr(h, ig, g.KXDG), getr(h, ig, g.KYDG)) if ig != 0 else (getr(h, ib, g.KXD), getr(h, ib, g.KYD))
    )
    power = 0.0
    if fix & g.ALONG_X != 0:
        power -= fx * vx
    if fix & g.ALONG_Y != 0:
        power -= fy * vy
    h.cd[g.WDRIVE] += max(power, 0.0) * h.cr[g.TDEL]


@outlined
def apply_boundary_conditions(h: Memory) -> bool:
    """Apply all boundary conditions for the step that begins."""
    set_signals(h)
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        if iget(h, iu, g.KUFIX) != 0:
            factor = real(h, 1.0)
            if iget(h, iu, g.KUS) != 0:
                factor = getr(h, iget(h, iu, g.KUS), g.KTNOW)
            _give_velocity(h, iu, factor)
        iu = iget(h, iu, g.KU)
    add_loads(h, h.cr[g.TDEL])
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        if iget(h, iu, g.KUFIX) != 0:
            add_driving_work(h, iu)
        iu = iget(h, iu, g.KU)
    return True
