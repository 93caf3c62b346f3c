"""Dynamic relaxation: LOCAL, COMBINED and KINETIC damping and scaled masses, in a pass before the block pass.

With F the unbalanced force on a degree of freedom, weight and loads included, F' that of the previous cycle,
v its velocity and f the fraction RESTF, the law of motion gets, instead of F,

    LOCAL     F - f |F| sign(v)                               Cundall (1987)
    COMBINED  F - f |F| (sign(v) - sign(F - F'))/2
    KINETIC   F/2 in the step that begins at rest, else F
    SCALED    s F, and so the inertial mass m/s, while the weight stays m g

LOCAL does not act where forces are balanced. It slows down motion in one direction under a steady force.
There COMBINED is better: it damps oscillations, half as strongly. KINETIC and ADAPTIVE:
drive.kinetic_damping.

KINETIC sets present velocities to 0, while all other velocities are those of half a step ago. So the next
step uses half of the force. With the full force the amplitude would grow, and steps above 0.4 of the critical
one were unstable.

The motion is not physical. Only the state of rest is valid, and only if it does not depend on the loading
path. The factors s are in relaxations (links.relaxations); running/mass_scaling.py calculates them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, int64, putr, real
from udec_ia.kernels.body.fdef import next_point_velocity
from udec_ia.kernels.body.motion import next_velocity, turns_freely
from udec_ia.kernels.body.sdef import strain, straining_force
from udec_ia.kernels.geometry.plane_tensors import first_axis, rotated
from udec_ia.kernels.links.relaxation_groups import next_relaxation
from udec_ia.layout import offsets as g


@inlined
def sign(h: Memory, v: float) -> float:
    """1, 0 or -1."""
    if v > 0:
        return real(h, 1.0)
    return real(h, -1.0) if v < 0 else real(h, 0.0)


@inlined
def damped(h: Memory, f: float, v: float, before: float) -> float:
    """Damped force for the force `f` on a degree of freedom of velocity `v`; before: f of the last cycle."""
    part = h.cr[g.RESTF] * abs(f)
    if h.ci[g.LREST] == g.LOCAL:
        return f - part * sign(h, v)
    if h.ci[g.LREST] == g.COMBINED:
        return f - part * (sign(h, v) - sign(h, f - before)) * real(h, 0.5)
    if h.ci[g.LREST] == g.KINETIC and h.cd[g.EMOVES] == 0:
        return f * real(h, 0.5)
    return f


@kernel
def relaxed(h: Memory, ir: int, before: Offset, scale: Offset, f: float, v: float) -> float:
    """Damped and scaled force for the force `f` on a degree of freedom of velocity `v`.

    ir: its relaxation, 0 if there is none; before, scale: fields of it, of the force of the previous cycle
    and of the factor.
    """
    last = f
    if h.ci[g.LREST] == g.COMBINED:
        last = getr(h, ir, before)
        putr(h, ir, before, f)
    left = damped(h, f, v, last)
    return left * getr(h, ir, scale) if h.ci[g.LSCALE] != 0 else left


@kernel
def relax_point(h: Memory, ig: int, ir: int) -> None:
    """Damp the force sums of grid-point `ig`; the work of damping goes to WREST."""
    m, fix = getr(h, ig, g.KGPM), iget(h, ig, g.KGFIX)
    wx, wy = m * h.cr[g.GRAVX], m * h.cr[g.GRAVY]
    xd, yd = getr(h, ig, g.KXDG), getr(h, ig, g.KYDG)
    fx, fy = getr(h, ig, g.KGFX) + wx, getr(h, ig, g.KGFY) + wy
    if fix & g.ALONG_X == 0:
        putr(h, ig, g.KGFX, relaxed(h, ir, g.KRXFX, g.KRXM, fx, xd) - wx)
    if fix & g.ALONG_Y == 0:
        putr(h, ig, g.KGFY, relaxed(h, ir, g.KRXFY, g.KRXM, fy, yd) - wy)
    if h.ci[g.LENER] != 0:
        lx, ly = fx - wx - getr(h, ig, g.KGFX), fy - wy - getr(h, ig, g.KGFY)
        ux, uy = next_point_velocity(h, ig)
        h.cd[g.WREST] += (np.float64(lx) * (xd + ux) + ly * (yd + uy)) * h.cr[g.TDEL] * 0.5


@kernel
def relax_body(h: Memory, ib: int, ir: int) -> None:
    """Damp the force sums of block `ib` as a rigid body; the work of damping goes to WREST."""
    bm, fix = getr(h, ib, g.KBM), iget(h, ib, g.KBFIX)
    wx, wy = bm * h.cr[g.GRAVX], bm * h.cr[g.GRAVY]
    xd, yd, td = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KTD)
    fx, fy, ft = getr(h, ib, g.KBFX) + wx, getr(h, ib, g.KBFY) + wy, getr(h, ib, g.KBFT)
    if fix & g.GIVEN_X == 0:
        putr(h, ib, g.KBFX, relaxed(h, ir, g.KRXFX, g.KRXM, fx, xd) - wx)
    if fix & g.GIVEN_Y == 0:
        putr(h, ib, g.KBFY, relaxed(h, ir, g.KRXFY, g.KRXM, fy, yd) - wy)
    if turns_freely(fix):
        putr(h, ib, g.KBFT, relaxed(h, ir, g.KRXFT, g.KRXI, ft, td))
    if h.ci[g.LENER] != 0:
        lx, ly = fx - wx - getr(h, ib, g.KBFX), fy - wy - getr(h, ib, g.KBFY)
        ux, uy, ut = next_velocity(h, ib)
        work = np.float64(lx) * (xd + ux) + ly * (yd + uy) + (ft - getr(h, ib, g.KBFT)) * (td + ut)
        h.cd[g.WREST] += work * h.cr[g.TDEL] * 0.5


@kernel
def forces_before(h: Memory, ir: int, force: Any) -> Any:
    """Straining force of the last cycle, which COMBINED reads from relaxation `ir`; `force` replaces it."""
    if h.ci[g.LREST] != g.COMBINED:
        return force
    last = getr(h, ir, g.KRXS11), getr(h, ir, g.KRXS12), getr(h, ir, g.KRXS22)
    putr(h, ir, g.KRXS11, force[0])
    putr(h, ir, g.KRXS12, force[1])
    putr(h, ir, g.KRXS22, force[2])
    return last


@kernel
def relaxed_strain(h: Memory, ie: int, ir: int, force: Any, rate: Any) -> tuple[float, float, float]:
    """Damped and scaled force for the `force` that strains extension `ie` at the `rate`.

    Its degrees of freedom are the strains along the axes of the Euler tensor. Along other axes the inertias
    of the strains are coupled, and damping of each one alone could make a safe step unstable.
    """
    c, s = first_axis(h, getr(h, ie, g.KSJ11), getr(h, ie, g.KSJ12), getr(h, ie, g.KSJ22))
    last = forces_before(h, ir, force)
    b11, b12, b22 = rotated(last[0], last[1], last[2], c, -s)
    f11, f12, f22 = rotated(force[0], force[1], force[2], c, -s)
    e11, e12, e22 = rotated(rate[0], rate[1], rate[2], c, -s)
    f11, f12, f22 = damped(h, f11, e11, b11), damped(h, f12, e12, b12), damped(h, f22, e22, b22)
    f11, f12, f22 = rotated(f11, f12, f22, c, s)
    if h.ci[g.LSCALE] == 0:
        return f11, f12, f22
    scale = getr(h, ir, g.KRXE)
    return f11 * scale, f12 * scale, f22 * scale


@kernel
def relax_strain(h: Memory, ie: int, ir: int) -> None:
    """Damp the force that strains extension `ie`; the work of damping goes to WREST."""
    f11, f12, f22 = straining_force(h, ie)
    e11, e12, e22 = getr(h, ie, g.KED11), getr(h, ie, g.KED12), getr(h, ie, g.KED22)
    r11, r12, r22 = relaxed_strain(h, ie, ir, (f11, f12, f22), (e11, e12, e22))
    l11, l12, l22 = f11 - r11, f12 - r12, f22 - r22
    putr(h, ie, g.KSA11, getr(h, ie, g.KSA11) - l11)
    putr(h, ie, g.KSA12, getr(h, ie, g.KSA12) - l12)
    putr(h, ie, g.KSA21, getr(h, ie, g.KSA21) - l12)
    putr(h, ie, g.KSA22, getr(h, ie, g.KSA22) - l22)
    if h.ci[g.LENER] != 0:
        u11, u12, u22 = strain(h, ie)
        work = np.float64(l11) * (e11 + u11) + l12 * (e12 + u12) * 2.0 + l22 * (e22 + u22)
        h.cd[g.WREST] += work * h.cr[g.TDEL] * 0.5


@outlined
def relax(h: Memory) -> bool:
    """Apply LOCAL, COMBINED and KINETIC damping and scaled masses for the step that begins."""
    if h.ci[g.LREST] == g.KINETIC and h.cd[g.EMOVES] != 0 and h.ci[g.LSCALE] == 0:
        return True
    ir = int64(h.ci[g.IRXPNT])
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        free, kind = iget(h, ib, g.KBFIX) != g.FIXED, iget(h, ib, HEAD)
        if kind == g.MFDEF:
            ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
            while ig != 0:
                if free:
                    relax_point(h, ig, ir)
                ir = next_relaxation(h, ir)
                ig = iget(h, ig, g.KG)
        else:
            if free:
                relax_body(h, ib, ir)
                if kind == g.MSDEF:
                    relax_strain(h, iget(h, ib, g.KBEX), ir)
            ir = next_relaxation(h, ir)
        ib = iget(h, ib, g.KB)
    return True
