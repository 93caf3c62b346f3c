"""The critical time-step: the 1980 estimate, and a bound that no mode exceeds (report 4.6).

Estimate: the smallest 2 sqrt(M/K) of the blocks (least mass, greatest joint stiffness), the internal modes of
simply-deformable blocks and the grid-points (kernels.drive.critical_stiffness). It is approximate: a mass on
several springs has a shorter period than on one.

Bound: 2 min sqrt(m_i d_i / sum_j |K_ij| d_j), by the rows of the stiffness matrix (running.stiffness_bound).
"""

from __future__ import annotations

import math

import numpy as np

from udec_ia.errors import ADVICE, UdecError
from udec_ia.heap.accessors import Memory, getr, iget, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_materials import MATERIALS
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials, material_of
from udec_ia.kernels.drive.critical_stiffness import greatest_stiffness, smallest_mass, soft_step
from udec_ia.kernels.drive.structure_stiffness import greatest_stiffness_of_structures, node_step
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.common.attached_structures import has_structures
from udec_ia.running.mass_scaling import scale, scaled
from udec_ia.running.stiffness_bound import OVERFLOWS, Array, Rows, StepLimit, damped_step, rate_of, reals


@OVERFLOWS
def bound(array: MainArray) -> StepLimit:
    """The safe bound of the critical time-step; infinite if no stiffness acts on anything free."""
    rows = Rows(array.h, even=bool(array.h.ci[g.LSCALE]))
    return (scaled(array, rows) if array.h.ci[g.LSCALE] else rows).limit()


@OVERFLOWS
def estimate(array: MainArray) -> StepLimit:
    """The 1980 estimate of the critical time-step. Errors 11 and 12 for undefined properties."""
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
    if has_structures(h):
        joints = max(joints, float(greatest_stiffness_of_structures(h, stiffness)))
        node_ratio, node = node_step(h, stiffness)
    ratio = float(mass) / joints
    if h.ci[g.NSOFT]:
        smallest, soft = soft_step(h, stiffness)
        if float(smallest) < ratio:
            ratio, at = float(smallest), soft
    if has_structures(h) and float(node_ratio) < ratio:
        ratio, at = float(node_ratio), node
    limit = StepLimit(2 * math.sqrt(max(ratio, 0.0)), int(at))  # the inertia of a flat block may be below 0
    return min(limit, _drag_limit(h, stiffness, joints), key=lambda limit: limit.step)


def _drag_limit(h: Memory, stiffness: Array, joints: float) -> StepLimit:
    """The least step of blocks and points on viscous boundaries; stiffness: of grid-points, by address."""
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    if not len(bounds):
        return StepLimit(math.inf, 0)
    blocks, points = integers(h, bounds, g.KUB), integers(h, bounds, g.KUG)
    at = np.where(points > 0, points, blocks)
    drag = np.zeros_like(stiffness, dtype=float)
    cxx, cxy, cyy = (np.abs(reals(h, bounds, k)) for k in (g.KUCXX, g.KUCXY, g.KUCYY))
    np.add.at(drag, at, np.maximum(cxx, cyy) + cxy)
    mass = np.where(points > 0, reals(h, points, g.KGPM), reals(h, blocks, g.KBM))
    rate = np.where(drag[at] > 0, rate_of(np.where(points > 0, stiffness[at], joints), drag[at], mass), 0.0)
    fastest = int(rate.argmax())
    return StepLimit(2 / float(rate[fastest]) if rate[fastest] else math.inf, int(at[fastest]))


def _stiffness(h: Memory) -> float:
    """Greatest joint stiffness of all contacts. Error 11 if one has none."""
    stiffness, undefined = greatest_stiffness(h)
    if undefined:
        m = material_of(h, undefined)
        detail = f"contact@{undefined} has material {m}"
        raise UdecError(11, detail, f"PROPERTY MATERIAL={m} KN=... KS=...", group=int(undefined))
    return float(stiffness) if stiffness > 0 else _stiffness_of_materials(h)


def _stiffness_of_materials(h: Memory) -> float:
    """Greatest stiffness of joint materials and of the first block's material, where no contact has one.

    Error 11 if these have none, unless a block is deformable.
    """
    m = iget(h, int(h.ci[g.IBPNT]), g.KMAT)
    joint = joints_of_materials(h, m)
    given = (h.cr[k : k + MATERIALS].max() for k in (g.JMKN, g.JMKS))
    stiffness = float(max(joint.kn, joint.ks, *given))
    if not stiffness > 0 and not h.ci[g.NSOFT]:
        raise UdecError(11, f"material {m}", f"PROPERTY MATERIAL={m} KN=... KS=...")
    return max(stiffness, 1e-300)


def time_step(array: MainArray) -> float:
    """FRAC times the estimate or, with SAFE, the bound. Error 28 if reals cannot hold it."""
    critical = estimate(array).step
    if array.h.ci[g.LSAFE]:
        safe = scale(array) if array.h.ci[g.LSCALE] else bound(array).step
        critical = damped_step(array.h, safe) if math.isfinite(safe) else critical
    step = float(array.h.cr[g.FRAC]) * critical
    reals = np.finfo(array.scheme.real_type)
    if not reals.smallest_normal < step < reals.max:
        raise UdecError(28, f"the time-step is {step:g} s", "look at DENSITY, KN, KS and FRACTION")
    return step


def fraction_in_words(h: Memory) -> str:
    """The fraction of the estimate or of the safe bound, in words."""
    return f"{h.cr[g.FRAC]:.3g} of the {'safe bound' if h.ci[g.LSAFE] else 'estimate'}"
