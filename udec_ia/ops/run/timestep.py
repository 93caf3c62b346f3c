"""The critical time-step: the 1980 estimate, and a bound that no mode exceeds (report 4.6).

Estimate: 2 sqrt(M/K), smallest over the blocks (least mass, greatest joint stiffness), the internal modes of
simply-deformable blocks and the grid-points (kernels.drive.timestep). It is only approximate: a mass on
several springs has a shorter period than on one.

Bound: 2 min sqrt(m_i d_i / sum_j |K_ij| d_j), by the rows of the stiffness matrix (ops.run.rows).
"""

from __future__ import annotations

import math

import numpy as np

from udec_ia.errors import ADVICE, UdecError
from udec_ia.heap.accessors import Memory, getr, iget, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials, material_of
from udec_ia.kernels.drive.damping_modes import BY_CODE
from udec_ia.kernels.drive.extremes import greatest_stiffness, smallest_mass
from udec_ia.kernels.drive.timestep import addresses, soft_step
from udec_ia.kernels.links.owner import BLOCK, GRIDPOINT, NOBODY, STRAIN, owner
from udec_ia.layout import offsets as g
from udec_ia.ops.run.damped import damped, what_damps
from udec_ia.ops.run.rows import OVERFLOWS, Array, Limit, Rows, rate_of, reals
from udec_ia.ops.run.scaling import scale, scaled


@OVERFLOWS
def bound(array: MainArray) -> Limit:
    """The safe bound of the critical time-step; infinite if no stiffness acts on anything free."""
    rows = Rows(array.h, even=bool(array.h.ci[g.LSCALE]))
    return (scaled(array, rows) if array.h.ci[g.LSCALE] else rows).limit()


@OVERFLOWS
def estimate(array: MainArray) -> Limit:
    """The 1980 estimate of the critical time-step. Errors 11 and 12 for what is not defined."""
    h = array.h
    mass, at, massless = smallest_mass(h)
    if massless:
        m = iget(h, massless, g.KMAT)
        detail = f"block@{massless} has material {m}, whose density is not set"
        advice = f"PROPERTY MATERIAL={m} DENSITY=..."
        if h.cr[g.DENS + m - 1] > 0:
            detail, advice = f"block@{massless} has the mass {getr(h, massless, g.KBM):g}", ADVICE[20]
        raise UdecError(12, detail, advice, group=int(massless))
    stiffness = np.zeros(int(h.ci[g.MFREE]) + 1, h.cr.dtype)
    joints = _stiffness(h)
    ratio = float(mass) / joints
    if h.ci[g.NSOFT]:
        smallest, soft = soft_step(h, stiffness)
        if float(smallest) < ratio:
            ratio, at = float(smallest), soft
    limit = Limit(2 * math.sqrt(max(ratio, 0.0)), int(at))  # a block squashed flat has no mass left in it
    return min(limit, _drag_limit(h, stiffness, joints), key=lambda limit: limit.step)


def _drag_limit(h: Memory, stiffness: Array, joints: float) -> Limit:
    """The least step of what viscous boundaries hold; stiffness: of the grid-points, by address."""
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    if not len(bounds):
        return Limit(math.inf, 0)
    blocks, points = integers(h, bounds, g.KUB), integers(h, bounds, g.KUG)
    at = np.where(points > 0, points, blocks)
    drag = np.zeros_like(stiffness, dtype=float)
    cxx, cxy, cyy = (np.abs(reals(h, bounds, k)) for k in (g.KUCXX, g.KUCXY, g.KUCYY))
    np.add.at(drag, at, np.maximum(cxx, cyy) + cxy)
    mass = np.where(points > 0, reals(h, points, g.KGPM), reals(h, blocks, g.KBM))
    rate = np.where(drag[at] > 0, rate_of(np.where(points > 0, stiffness[at], joints), drag[at], mass), 0.0)
    fastest = int(rate.argmax())
    return Limit(2 / float(rate[fastest]) if rate[fastest] else math.inf, int(at[fastest]))


def _stiffness(h: Memory) -> float:
    """Greatest joint stiffness of any contact; of a lone block the one that its contacts would have."""
    if h.ci[g.NCON] == 0:
        m = iget(h, int(h.ci[g.IBPNT]), g.KMAT)
        joint = joints_of_materials(h, m)
        stiffness = float(max(joint.kn, joint.ks))
        if not stiffness > 0 and not h.ci[g.NSOFT]:
            raise UdecError(11, f"material {m}", f"PROPERTY MATERIAL={m} KN=... KS=...")
        return max(stiffness, 1e-300)
    stiffness, undefined = greatest_stiffness(h)
    if undefined:
        m = material_of(h, undefined)
        detail = f"contact@{undefined} has material {m}"
        raise UdecError(11, detail, f"PROPERTY MATERIAL={m} KN=... KS=...", group=int(undefined))
    return float(stiffness)


def time_step(array: MainArray) -> float:
    """FRAC times the estimate, or times the safe bound if asked for; error 28 if reals cannot hold it."""
    critical = estimate(array).step
    if array.h.ci[g.LSAFE]:
        safe = scale(array) if array.h.ci[g.LSCALE] else bound(array).step
        critical = damped(array.h, safe) if math.isfinite(safe) else critical
    step = float(array.h.cr[g.FRAC]) * critical
    reals = np.finfo(array.scheme.real_type)
    if not reals.smallest_normal < step < reals.max:
        raise UdecError(28, f"the time-step is {step:g} s", "look at DENSITY, KN, KS and FRACTION")
    return step


NEAR = 0.8  # of the safe bound: from here on it is warned of impacts if nothing damps
IMPACTS = 0.5  # of the safe bound: what is advised then
HARDLY = 0.01  # by which a step that has become shorter is not worth a word
LAST_DIGITS = 1e-6  # by which a step in 32-bit reals may be above the bound that it was made of


def is_safe(h: Memory, safe: Limit) -> bool:
    """True if the time-step is not above what damping leaves of the bound `safe`."""
    return bool(h.cr[g.TDEL] <= damped(h, safe.step) * (1 + LAST_DIGITS))


def share_of(h: Memory) -> str:
    """What the time-step is a fraction of, and which."""
    return f"{h.cr[g.FRAC]:.3g} of the {'safe bound' if h.ci[g.LSAFE] else 'estimate'}"


def fraction_line(h: Memory, fraction: float) -> str:
    """The command FRACTION with another number, of what it is a fraction now."""
    words = " SCALED" if h.ci[g.LSCALE] else " SAFE" if h.ci[g.LSAFE] else ""
    return f"FRACTION {fraction:.2g}{words}"


def safe_fraction(array: MainArray, share: float) -> float:
    """FRACTION of a step that is safe, where the present one is `share` of the critical one.

    It is just below that, or well below it if nothing damps what impacts give.
    """
    return (0.95 if what_damps(array.h) else IMPACTS) * float(array.h.cr[g.FRAC]) / share


def instability(array: MainArray, safe: Limit) -> str:
    """A warning if the time-step is above `safe`, or above what damping leaves of it, else ""; or near it."""
    step = float(array.h.cr[g.TDEL])
    critical = damped(array.h, safe.step)
    if is_safe(array.h, safe):
        return _impacts(array, step / critical) if step > NEAR * critical else ""
    if safe.step == 0:
        place = _place(array.h, safe.address)
        return f"no time-step is safe: a mass or a stiffness of {place} is zero, infinite or no number"
    share = step / critical if critical else math.inf
    fraction = f"{fraction_line(array.h, safe_fraction(array, share))} is safe"
    if step <= safe.step:
        cause, cure = _damping(array.h)
        return f"{cause} may make the time-step of {step:.3g} s unstable: {fraction}, or {cure}"
    return (
        f"the time-step of {step:.3g} s is {share:.3g} of the safe bound, which "
        f"{_place(array.h, safe.address)} sets, and may be unstable: {fraction}"
    )


def _impacts(array: MainArray, share: float) -> str:
    """A warning of a time-step that is just below the safe bound, if nothing damps.

    The bound is that of joints that stay closed. One that closes within a step is pressed by as much as if it
    had been closed all the time, and gives back more than it took.
    """
    if what_damps(array.h):
        return ""
    return (
        f"nothing damps, and the time-step is {share:.2g} of the safe bound, which is that of joints that "
        "stay closed: those that open and close may throw blocks ever higher; take "
        f"{fraction_line(array.h, safe_fraction(array, share))}, or DAMPING"
    )


def _damping(h: Memory) -> tuple[str, str]:
    """The damping that lowers the safe time-step, and what to do instead of taking a shorter one."""
    if h.cr[g.BETA]:
        beta = float(h.cr[g.BETA])
        return f"stiffness damping BETA = {beta:.3g} s", "a smaller fcrit, or MASS damping alone"
    return (
        f"{BY_CODE[int(h.ci[g.LREST])].name} damping {float(h.cr[g.RESTF]):g}",
        "a smaller fraction of it, or ADAPTIVE damping",
    )


def shortened(array: MainArray, before: float, safe: Limit) -> str:
    """What is said of a SAFE time-step of `before` s that has become shorter in a run; "" if hardly."""
    h = array.h
    now = float(h.cr[g.TDEL])
    if now > (1 - HARDLY) * before:
        return ""
    return (
        f"the SAFE time-step is {now:.3g} s instead of {before:.3g} s from cycle "
        f"{int(h.ci[g.MCTOT])} on: {_place(h, safe.address)} "
        "is held more stiffly than when the run began; it may become shorter still"
    )


def describe(array: MainArray, safe: Limit) -> str:
    """One line: the time-step, its shares of estimate and safe bound, and which groups set these.

    The bound is what damping leaves of it, as FRACTION ... SAFE takes it.
    """
    step = float(array.h.cr[g.TDEL])
    left = Limit(damped(array.h, safe.step), safe.address) if math.isfinite(safe.step) else safe
    named = "safe bound" + (" with its damping" if left.step < safe.step else "")
    parts = [
        f"{step / limit.step if limit.step else math.inf:.3g} of the {name} {limit.step:.4g} s "
        f"({_place(array.h, limit.address)})"
        for name, limit in (("estimate", estimate(array)), (named, left))
        if math.isfinite(limit.step)
    ]
    return f"time-step {step:.4g} s, {', '.join(parts)}"


def kind_of(h: Memory, address: int) -> str:
    """What a message is about: `block@163`, or `grid-point@5917 of block@163`, or one of its zones."""
    ib, what = owner(h, address)
    if what == NOBODY:
        return f"@{address}"
    if what == BLOCK:
        return f"block@{ib}"
    if what == STRAIN:
        return f"the strain of block@{ib}"
    return f"{'grid-point' if what == GRIDPOINT else 'zone'}@{address} of block@{ib}"


def _place(h: Memory, address: int) -> str:
    """The same, with the centroid of the block."""
    ib, what = owner(h, address)
    at = f" at ({getr(h, ib, g.KX):.4g}, {getr(h, ib, g.KY):.4g})" if what != NOBODY else ""
    return kind_of(h, address) + at
