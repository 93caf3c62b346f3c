"""Scaled masses: inertial masses with which all degrees of freedom are as quick as the quickest one.

A step dt is stable for a row of the stiffness matrix with the sum k and the dashpots d if its mass is at
least k dt^2/4 + d dt/2 (running.stiffness_bound). That is its scaled mass, with dt the safe bound of the true
masses. So slow parts become lighter and come to rest in fewer steps. The weight remains that of the true
mass: the state of rest is the same if it does not depend on the loading path. Time has no meaning. A part
that nothing holds keeps its mass.

A new contact makes a row stiffer. Each block and each grid-point at a corner has a reserve for one more
contact. If contacts have formed, masses are scaled again, every hundred cycles (MSCALE); if a joint has
become stiffer, at once (LSTIFF). A block that has lost its contacts then gets its true mass back. Its
velocity would be energy from nowhere, so it begins from rest.
"""

from __future__ import annotations

import math

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, integers, putr, size_of
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials
from udec_ia.kernels.constitutive.joint_stresses import allow_for_stiffness
from udec_ia.kernels.drive.critical_stiffness import greatest_stiffness
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.drive.kinetic_damping import halt_block
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.kernels.links.relaxation_groups import lose_relaxations, make_relaxations
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.running.stiffness_bound import OVERFLOWS, Array, Rows, undamped_step

SHARE = 4  # of a contact in a row over its stiffness: of both blocks, along and across, and by its lever
RESCALE = 100  # cycles
HEAVIER = 4  # ratio of new to old inertial mass above which a block begins from rest


def relaxations_due(array: MainArray) -> bool:
    """True if the next CYCLE makes relaxations or gives them back."""
    ci = array.h.ci
    return not ci[g.LREADY] and bool(ci[g.IRXPNT] or _needed(array))


def _needed(array: MainArray) -> bool:
    mode = mode_of(array.h)
    return bool((mode and "before" in mode.effects) or array.h.ci[g.LSCALE])


def renew_relaxations(array: MainArray) -> None:
    """Make one relaxation for each block or grid-point if they are needed, else none."""
    h = array.h
    if h.ci[g.IRXPNT]:
        lose_relaxations(h)
    if _needed(array):
        blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
        meshes = integers(h, blocks[integers(h, blocks, HEAD) == g.MFDEF], g.KBEX)
        points = int(integers(h, meshes, g.KFNG).sum())
        require(array, size_of(h, g.NVRX) * (int(h.ci[g.NBLK]) + points))
        make_relaxations(array.h)


def scale(array: MainArray) -> float:
    """Scale all masses; returns the time-step (s) that is safe with these."""
    rows = Rows(array.h, even=True)
    step = rows.limit().step
    if math.isfinite(step) and step > 0:
        _put_factors(array, rows, step)
    return step


def scale_anew(array: MainArray) -> None:
    """Scale all masses again for the present time-step, if there are new contacts or stiffer joints."""
    h = array.h
    if h.ci[g.LSCALE] and (h.ci[g.NMADE] != h.ci[g.MSCALE] or h.ci[g.LSTIFF]):
        allow_for_stiffness(h, False)
        step = undamped_step(h, float(h.cr[g.TDEL]) / float(h.cr[g.FRAC]))
        relaxations = addresses(h, int(h.ci[g.IRXPNT]), g.KRX)
        before = _factors(h, relaxations)
        _put_factors(array, Rows(h, even=True), step)
        slowed = (before > HEAVIER * _factors(h, relaxations)).any(axis=1)
        for ib in np.unique(integers(h, relaxations, g.KRXB)[slowed]).tolist():
            halt_block(h, ib)


def _factors(h: Memory, relaxations: Array) -> Array:
    """Mass over inertial mass along, in rotation and in strain, shape (n, 3)."""
    return np.stack([np.asarray(getr(h, relaxations, k), float) for k in (g.KRXM, g.KRXI, g.KRXE)], axis=1)


@OVERFLOWS
def _put_factors(array: MainArray, rows: Rows, step: float) -> None:
    """Set mass over inertial mass in all relaxations, so that `step` is just stable."""
    h = array.h
    relaxations = addresses(h, int(h.ci[g.IRXPNT]), g.KRX)
    blocks, points = (integers(h, relaxations, k) for k in (g.KRXB, g.KRXG))
    at = rows.row(np.where(points > 0, points, blocks))
    reach = np.where(points > 0, 0.0, np.asarray(getr(h, blocks, g.KBRO), float)) / rows.frame[at, 0]
    outside = (points == 0) | (integers(h, np.where(points > 0, points, 1), g.KCOR) > 0)
    joints = joints_of_materials(h, np.arange(NMAT) + 1)
    stiffest = max(joints.kn.max(), joints.ks.max(), greatest_stiffness(h)[0])
    contact = SHARE * float(stiffest) * outside
    more = np.stack([contact, contact, contact * reach**2, *[contact * reach**2] * 3], axis=1)
    held = (rows.sum[at] > 0) | (rows.drag[at] > 0)
    needed = (np.where(held, rows.sum[at] + more, 0.0) * step / 2 + rows.drag[at]) * step / 2
    factor = np.where(held & (rows.free[at] > 0), rows.mass[at] / needed, np.inf)
    factor = np.stack([factor[:, :2].min(axis=1), factor[:, 2], factor[:, 3:].min(axis=1)], axis=1)
    factor[~np.isfinite(factor)] = 1.0
    strained = (points == 0) & (integers(h, blocks, HEAD) == g.MSDEF)
    _put_factors_of_nodes(h, rows, step)
    for k, one, due in zip((g.KRXM, g.KRXI, g.KRXE), factor.T, (True, points == 0, strained), strict=True):
        putr(h, relaxations, k, np.where(due, one, 0.0))
    h.ci[g.MSCALE] = h.ci[g.NMADE]


def _put_factors_of_nodes(h: Memory, rows: Rows, step: float) -> None:
    """The same for nodes of structures, of which none has a reserve, as they get no new springs."""
    nodes = addresses(h, int(h.ci[g.INDPNT]), g.KN)
    at = rows.row(nodes)
    factor = rows.mass[at, :3] / (rows.sum[at, :3] * step * step / 4)
    factor[~np.isfinite(factor)] = 1.0  # a node that nothing holds keeps its mass
    putr(h, nodes, g.KNSM, factor[:, :2].min(axis=1))
    putr(h, nodes, g.KNSI, factor[:, 2])


def scaled(array: MainArray, rows: Rows) -> Rows:
    """`rows` with scaled masses."""
    h = array.h
    relaxations = addresses(h, int(h.ci[g.IRXPNT]), g.KRX)
    blocks, points = (integers(h, relaxations, k) for k in (g.KRXB, g.KRXG))
    at = rows.row(np.where(points > 0, points, blocks))
    m, i, e = _factors(h, relaxations).T
    rows.mass[at] /= np.stack([m, m, np.where(i > 0, i, 1.0), *[np.where(e > 0, e, 1.0)] * 3], axis=1)
    nodes = addresses(h, int(h.ci[g.INDPNT]), g.KN)
    along, turning = (np.asarray(getr(h, nodes, k), float) for k in (g.KNSM, g.KNSI))
    rows.mass[rows.row(nodes), :3] /= np.stack([along, along, turning], axis=1)
    return rows
