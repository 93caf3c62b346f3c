"""Scaled masses: every degree of freedom gets the inertial mass that makes it as quick as the quickest.

A step dt is stable for a row of the stiffness matrix with the sum k and the dashpots d if its mass is at
least k dt^2/4 + d dt/2 (running.stiffness_bound). With dt the safe bound of the true masses, that is the mass
that it gets: all that the step would be needlessly short for becomes lighter, and comes to rest in fewer
steps. The weight stays that of the true mass. So the state of rest is the same if it does not depend on the
loading path, and time on the way has no meaning. What nothing holds keeps its mass.

A contact that is made on the way makes a row stiffer. Each block and each grid-point at a corner has room for
one contact more; when contacts have been made, masses are scaled anew, every hundred cycles (MSCALE). What
has lost its contacts gets its true mass back then; a velocity that it took up as something much lighter would
be energy from nowhere, so it begins from rest.
"""

from __future__ import annotations

import math

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, integers, putr, size_of
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.drive.kinetic_damping import halt_block
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.kernels.links.relaxation_groups import lose_relaxations, make_relaxations
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.running.stiffness_bound import OVERFLOWS, Array, Rows, undamped_step

SHARE = (
    4  # what a contact adds to a row over its stiffness: on both blocks, along and across, and by its lever
)
RESCALE = 100  # cycles
HEAVIER = 4  # inertial mass over that of before, from which on a block begins from rest


def relaxations_due(array: MainArray) -> bool:
    """True if the next CYCLE makes relaxations anew, or gives some back."""
    ci = array.h.ci
    return not ci[g.LREADY] and bool(ci[g.IRXPNT] or _needed(array))


def _needed(array: MainArray) -> bool:
    mode = mode_of(array.h)
    return bool((mode and mode.keeps_forces) or array.h.ci[g.LSCALE])


def renew_relaxations(array: MainArray) -> None:
    """Have one relaxation for each block or grid-point if something needs them, else none."""
    h = array.h
    if h.ci[g.IRXPNT]:
        lose_relaxations(h)
    if _needed(array):
        points = int(integers(h, _meshes(array), g.KFNG).sum())
        require(array, size_of(h, g.NVRX) * (int(h.ci[g.NBLK]) + points))
        make_relaxations(array.h)


def scale(array: MainArray) -> float:
    """Scale all masses from what holds them now; returns the time-step that is safe with these, in s."""
    rows = Rows(array.h, even=True)
    step = rows.limit().step
    if math.isfinite(step) and step > 0:
        _put_factors(array, rows, step)
    return step


def scale_anew(array: MainArray) -> None:
    """The same for the time-step as it is, if contacts have been made since."""
    h = array.h
    if h.ci[g.LSCALE] and h.ci[g.NMADE] != h.ci[g.MSCALE]:
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
    """Mass over inertial mass of all relaxations, for a time-step that would be just stable."""
    h = array.h
    relaxations = addresses(h, int(h.ci[g.IRXPNT]), g.KRX)
    blocks, points = (integers(h, relaxations, k) for k in (g.KRXB, g.KRXG))
    at = rows.row(np.where(points > 0, points, blocks))
    reach = np.where(points > 0, 0.0, np.asarray(getr(h, blocks, g.KBRO), float)) / rows.frame[at, 0]
    outside = (points == 0) | (integers(h, np.where(points > 0, points, 1), g.KCOR) > 0)
    joints = joints_of_materials(h, np.arange(NMAT) + 1)
    contact = SHARE * float(max(joints.kn.max(), joints.ks.max())) * outside
    more = np.stack([contact, contact, contact * reach**2, *[contact * reach**2] * 3], axis=1)
    held = (rows.sum[at] > 0) | (rows.drag[at] > 0)
    needed = (np.where(held, rows.sum[at] + more, 0.0) * step / 2 + rows.drag[at]) * step / 2
    factor = np.where(held & (rows.free[at] > 0), rows.mass[at] / needed, np.inf)
    factor = np.stack([factor[:, :2].min(axis=1), factor[:, 2], factor[:, 3:].min(axis=1)], axis=1)
    factor[~np.isfinite(factor)] = 1.0
    strained = (points == 0) & (integers(h, blocks, HEAD) == g.MSDEF)
    for k, one, due in zip((g.KRXM, g.KRXI, g.KRXE), factor.T, (True, points == 0, strained), strict=True):
        putr(h, relaxations, k, np.where(due, one, 0.0))
    h.ci[g.MSCALE] = h.ci[g.NMADE]


def scaled(array: MainArray, rows: Rows) -> Rows:
    """`rows` with the inertial masses of all that has a relaxation."""
    h = array.h
    relaxations = addresses(h, int(h.ci[g.IRXPNT]), g.KRX)
    blocks, points = (integers(h, relaxations, k) for k in (g.KRXB, g.KRXG))
    at = rows.row(np.where(points > 0, points, blocks))
    m, i, e = _factors(h, relaxations).T
    rows.mass[at] /= np.stack([m, m, np.where(i > 0, i, 1.0), *[np.where(e > 0, e, 1.0)] * 3], axis=1)
    return rows


def _meshes(array: MainArray) -> Array:
    """The extensions of all fully-deformable blocks."""
    h = array.h
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    return integers(h, blocks[integers(h, blocks, HEAD) == g.MFDEF], g.KBEX)
