"""Boundary conditions: given velocities, loads and non-reflecting edges (the report's further developments).

A condition acts on a grid-point, on a block at its centroid, or at a corner of a block without grid-points:

    velocity   V f takes the place of what the law of motion would give
    load       F f
    viscous    -C v, with C = rho Cp L along the normal of the edge and rho Cs L along the edge: a wave that
               arrives is absorbed, and one is put in as a load of 2 rho C v L

f is 1, a sine or a FUNCTION of time, calculated with 64 bits in every word scheme and then rounded once.
Loads keep the direction and the size that they had when they were given. The work of conditions is summed in
WBOUND if an account of the energy is kept (kernels.energy). WDRIVE sums up what they put in, and not what
they take: it tells a run that is driven from one that gains energy from nowhere (ops.runaway).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from offsets.generated import (
    GRAVX,
    GRAVY,
    IBNPNT,
    ISGPNT,
    KBEX,
    KBFIX,
    KBFT,
    KBFX,
    KBFY,
    KBI,
    KBM,
    KED11,
    KED12,
    KED22,
    KGFX,
    KGFY,
    KGPM,
    KT,
    KTBEG,
    KTD,
    KTFREQ,
    KTLAST,
    KTNOW,
    KTP,
    KTPF,
    KTPN,
    KTPT,
    KTREST,
    KU,
    KUB,
    KUCXX,
    KUCXY,
    KUCYY,
    KUFIX,
    KUFX,
    KUFY,
    KUG,
    KUP,
    KUS,
    KUVX,
    KUVY,
    KX,
    KXD,
    KXDG,
    KXP,
    KY,
    KYD,
    KYDG,
    KYP,
    MSDEF,
    TDEL,
    TIME,
    WBOUND,
    WDRIVE,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.heap.jit import inlined, kernel
from udec_ia.kernels.fdef import putfdf
from udec_ia.kernels.motion import FIXED, GIVEN_X, GIVEN_Y
from udec_ia.kernels.sdef import putstr


@kernel
def _function(h: Memory, isg: int, t: float) -> float:
    """Factor of a FUNCTION at the time `t`: linear between its points, constant before and after them."""
    it = iget(h, isg, KTP)
    t0, f0 = np.float64(getr(h, it, KTPT)), np.float64(getr(h, it, KTPF))
    while it != 0:
        t1, f1 = np.float64(getr(h, it, KTPT)), np.float64(getr(h, it, KTPF))
        if t <= t1:
            return float(f0 if t1 == t0 else f0 + (f1 - f0) * max((t - t0) / (t1 - t0), 0.0))
        t0, f0 = t1, f1
        it = iget(h, it, KTPN)
    return float(f0)


@kernel
def set_signals(h: Memory) -> None:
    """Factors of all signals for the step that begins: their values halfway through it.

    The sine is that of the C library in compiled and interpreted runs alike; NumPy has others of its own.
    """
    t = float(h.cd[TIME] + np.float64(h.cr[TDEL]) * 0.5)
    isg = h.ci[ISGPNT]
    while isg != 0:
        factor = 0.0
        passed = t - np.float64(getr(h, isg, KTBEG)) - getr(h, isg, KTREST)
        if iget(h, isg, KTP) != 0:
            factor = _function(h, isg, t)
        elif passed <= getr(h, isg, KTLAST):
            factor = math.sin(2 * math.pi * np.float64(getr(h, isg, KTFREQ)) * passed)
        putr(h, isg, KTNOW, factor)
        isg = iget(h, isg, KT)


@kernel
def velocity_of(h: Memory, iu: int, x: float, y: float) -> tuple[float, float]:
    """Velocity of what condition `iu` acts on: a grid-point, or its block at (x, y)."""
    ig, ib = iget(h, iu, KUG), iget(h, iu, KUB)
    if ig != 0:
        return getr(h, ig, KXDG), getr(h, ig, KYDG)
    rx, ry, td = x - getr(h, ib, KX), y - getr(h, ib, KY), getr(h, ib, KTD)
    xd, yd = getr(h, ib, KXD) - td * ry, getr(h, ib, KYD) + td * rx
    if iget(h, ib, HEAD) == MSDEF:
        ie = iget(h, ib, KBEX)
        e12 = getr(h, ie, KED12)
        xd, yd = xd + getr(h, ie, KED11) * rx + e12 * ry, yd + e12 * rx + getr(h, ie, KED22) * ry
    return xd, yd


@kernel
def push_load(h: Memory, iu: int, fx: float, fy: float, x: float, y: float) -> None:
    """Add a force to what condition `iu` acts on."""
    ig, ib = iget(h, iu, KUG), iget(h, iu, KUB)
    putr(h, ib, KBFX, getr(h, ib, KBFX) + fx)
    putr(h, ib, KBFY, getr(h, ib, KBFY) + fy)
    if ig != 0:
        putfdf(h, ig, fx, fy)
        return
    moment = (x - getr(h, ib, KX)) * fy - (y - getr(h, ib, KY)) * fx
    putr(h, ib, KBFT, getr(h, ib, KBFT) + moment)
    if iget(h, ib, HEAD) == MSDEF:
        putstr(h, ib, fx, fy, x, y)


@inlined
def mass_and_force(h: Memory, ig: int, ib: int) -> tuple[float, float, float]:
    """Mass of grid-point `ig`, or of block `ib` if that is 0, and the force on it, weight included."""
    if ig != 0:
        m, fx, fy = np.float64(getr(h, ig, KGPM)), getr(h, ig, KGFX), getr(h, ig, KGFY)
    else:
        m, fx, fy = np.float64(getr(h, ib, KBM)), getr(h, ib, KBFX), getr(h, ib, KBFY)
    return m, fx + m * h.cr[GRAVX], fy + m * h.cr[GRAVY]


@inlined
def gained(m: float, ux: float, uy: float, vx: float, vy: float) -> float:
    """Twice the kinetic energy that a mass gains as its velocity (ux, uy) becomes (vx, vy)."""
    faster = np.float64(vx) * vx + np.float64(vy) * vy
    return float(m * (faster - np.float64(ux) * ux - np.float64(uy) * uy))


@kernel
def note_jerk(h: Memory, iu: int, ux: float, uy: float, vx: float, vy: float) -> None:
    """Add to WBOUND what kinetic energy (kernels.energy) grows by when (ux, uy) becomes (vx, vy)."""
    ig, ib, half = iget(h, iu, KUG), iget(h, iu, KUB), 0.5
    m, fx, fy = mass_and_force(h, ig, ib)
    power = fx * (vx - ux) + fy * (vy - uy)
    h.cd[WBOUND] += (gained(m, ux, uy, vx, vy) + power * h.cr[TDEL]) * half


@kernel
def _give_velocity(h: Memory, iu: int, factor: float, energy: Any) -> None:
    """Set the velocities that condition `iu` gives; what that takes from those before is its work."""
    ig, ib, fix = iget(h, iu, KUG), iget(h, iu, KUB), iget(h, iu, KUFIX)
    if iget(h, ib, KBFIX) == FIXED:
        return
    if iget(h, ib, KBFIX) == GIVEN_X + GIVEN_Y:
        if energy is not None:
            td = np.float64(getr(h, ib, KTD))
            h.cd[WBOUND] -= td * (getr(h, ib, KBI) * td + getr(h, ib, KBFT) * h.cr[TDEL]) * 0.5
        putr(h, ib, KTD, real(h, 0.0))
    if ig != 0:
        vx, vy = getr(h, ig, KXDG), getr(h, ig, KYDG)
    else:
        vx, vy = getr(h, ib, KXD), getr(h, ib, KYD)
    ux, uy = vx, vy
    if fix & 1 != 0:
        vx = getr(h, iu, KUVX) * factor
    if fix & 2 != 0:
        vy = getr(h, iu, KUVY) * factor
    if ig != 0:
        putr(h, ig, KXDG, vx)
        putr(h, ig, KYDG, vy)
    else:
        putr(h, ib, KXD, vx)
        putr(h, ib, KYD, vy)
    m, _, _ = mass_and_force(h, ig, ib)
    h.cd[WDRIVE] += max(gained(m, ux, uy, vx, vy) * 0.5, 0.0)
    if energy is not None:
        note_jerk(h, iu, ux, uy, vx, vy)


@kernel
def load(h: Memory, iu: int) -> tuple[float, float, float, float]:
    """Force of condition `iu` at the velocities and the signal of now, and where it acts."""
    factor = real(h, 1.0)
    if iget(h, iu, KUS) != 0:
        factor = getr(h, iget(h, iu, KUS), KTNOW)
    ib, ip = iget(h, iu, KUB), iget(h, iu, KUP)
    x, y = getr(h, ib, KX), getr(h, ib, KY)
    if ip != 0:
        x, y = getr(h, ip, KXP), getr(h, ip, KYP)
    vx, vy = velocity_of(h, iu, x, y)
    cxx, cxy, cyy = getr(h, iu, KUCXX), getr(h, iu, KUCXY), getr(h, iu, KUCYY)
    fx = getr(h, iu, KUFX) * factor - cxx * vx - cxy * vy
    fy = getr(h, iu, KUFY) * factor - cxy * vx - cyy * vy
    return fx, fy, x, y


@kernel
def power_of_load(h: Memory, iu: int, fx: float, fy: float, x: float, y: float) -> float:
    """What the load (fx, fy) of condition `iu` puts in at the velocities of now; 0 if it takes."""
    if iget(h, iget(h, iu, KUB), KBFIX) == FIXED:
        return 0.0
    vx, vy = velocity_of(h, iu, x, y)
    return max(np.float64(fx) * vx + np.float64(fy) * vy, 0.0)


@kernel
def power_of_loads(h: Memory) -> float:
    """The same of all conditions."""
    power = 0.0
    iu = h.ci[IBNPNT]
    while iu != 0:
        fx, fy, x, y = load(h, iu)
        power += power_of_load(h, iu, fx, fy, x, y)
        iu = iget(h, iu, KU)
    return power


@kernel
def push_loads(h: Memory) -> None:
    """Add the loads of all boundary conditions to the force sums."""
    zero = real(h, 0.0)
    iu = h.ci[IBNPNT]
    while iu != 0:
        fx, fy, x, y = load(h, iu)
        if fx != zero or fy != zero:
            push_load(h, iu, fx, fy, x, y)
            h.cd[WDRIVE] += power_of_load(h, iu, fx, fy, x, y) * h.cr[TDEL]
        iu = iget(h, iu, KU)


@kernel
def drive(h: Memory, iu: int) -> None:
    """Add to WDRIVE what the velocities that condition `iu` gives put in during the step that begins."""
    ig, ib, fix = iget(h, iu, KUG), iget(h, iu, KUB), iget(h, iu, KUFIX)
    if iget(h, ib, KBFIX) == FIXED:
        return
    _, fx, fy = mass_and_force(h, ig, ib)
    vx, vy = (getr(h, ig, KXDG), getr(h, ig, KYDG)) if ig != 0 else (getr(h, ib, KXD), getr(h, ib, KYD))
    power = 0.0
    if fix & 1 != 0:
        power -= fx * vx
    if fix & 2 != 0:
        power -= fy * vy
    h.cd[WDRIVE] += max(power, 0.0) * h.cr[TDEL]


@kernel
def apply_bounds(h: Memory, energy: Any) -> None:
    """Apply all boundary conditions for the step that begins. energy: as in run_cycles."""
    set_signals(h)
    iu = h.ci[IBNPNT]
    while iu != 0:
        if iget(h, iu, KUFIX) != 0:
            factor = real(h, 1.0)
            if iget(h, iu, KUS) != 0:
                factor = getr(h, iget(h, iu, KUS), KTNOW)
            _give_velocity(h, iu, factor, energy)
        iu = iget(h, iu, KU)
    push_loads(h)
    iu = h.ci[IBNPNT]
    while iu != 0:
        if iget(h, iu, KUFIX) != 0:
            drive(h, iu)
        iu = iget(h, iu, KU)
