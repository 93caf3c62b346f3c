"""Stresses of contacts that a command makes within a stressed joint: those that the joint has there.

SPLIT and GENERATE make contacts between two contacts of one joint. The stresses of these are linear along it.
With the stresses between them the joint carries the same force after the command as before it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from udec_ia.heap.accessors import Memory, getr, iget, integers, puti, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_models import set_stresses
from udec_ia.kernels.contact.joint_lengths import NX, NY, X, Y
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.reader.joint_rows import geometry_of_joints

Reals = NDArray[np.float64]
PARALLEL = 0.99  # cosine of the angle between the normals of a new contact and of the joint
FLAGS = g.JOINT_SLIPPED | g.JOINT_BROKEN
STATE = (g.KCJSN, g.KCJTS, g.KCJSLIP, g.KCJV1, g.KCJV2, g.KCJV3)
LINEAR = 4  # of these; the others are those of the nearer end, as they may have the sign of the slip


class StressedParts(NamedTuple):
    """Parts of joints between two contacts with a joint material per length, n of them.

    material: (n,). ends: (n, 2, 2), points (x, y). normals: (n, 2). state: (n, 2, 6), the fields STATE at
    both ends. flags: (n,), KCJFLAG that both ends have. No end is open.
    """

    material: NDArray[np.int64]
    ends: Reals
    normals: Reals
    state: Reals
    flags: NDArray[np.int64]


def stressed_parts(array: MainArray) -> StressedParts | None:
    """The parts of all joints that carry stress at both ends; None without any."""
    h = array.h
    contacts, joints = _joints(h, list_of(h, "contact"))
    sn, material = getr(h, joints, g.KCJSN), integers(h, joints, g.KCJMAT)
    per_length = (material > 0) & (h.ci[g.JMUNIT + material - 1] != g.PER_CONTACT)
    if not (per_length & (sn != 0)).any():
        return None
    found, neighbours = geometry_of_joints(h, contacts)
    order = np.argsort(contacts)
    place = np.searchsorted(contacts, neighbours, sorter=order).clip(max=len(contacts) - 1)
    first, second = np.repeat(np.arange(len(contacts)), 2), order[place].ravel()
    is_pair = (contacts[second] == neighbours.ravel()) & (second > first)
    is_pair &= (
        per_length[first] & (material[first] == material[second]) & (sn[first] != 0) & (sn[second] != 0)
    )
    is_pair &= (found[first][:, [X, Y]] != found[second][:, [X, Y]]).any(axis=1)  # contacts at one place
    if not is_pair.any():
        return None
    both = np.stack([first, second], axis=1)[is_pair]
    flags = integers(h, joints, g.KCJFLAG)[both] & FLAGS
    state = np.stack([getr(h, joints, k) for k in STATE], axis=1)
    return StressedParts(
        material[both[:, 0]],
        found[:, [X, Y]][both],
        found[:, [NX, NY]][both[:, 0]],
        state[both].astype(np.float64),
        flags[:, 0] & flags[:, 1],
    )


def _joints(h: Memory, contacts: Any) -> tuple[Any, Any]:
    """Those of `contacts` that have a joint material, and their joints."""
    joints = joints_at(h, contacts)
    has_joint = (integers(h, contacts, g.KCCOD) != g.VIRTUAL) & (joints != 0)
    return contacts[has_joint], joints[has_joint]


def stress_new_contacts(array: MainArray, contacts: Any, parts: StressedParts) -> None:
    """Give those of the new `contacts` that have formed within `parts` the stresses there."""
    h = array.h
    contacts, joints = _joints(h, contacts)
    found, _ = geometry_of_joints(h, contacts)
    for ic, ix, row in zip(contacts.tolist(), joints.tolist(), found, strict=True):
        part = _part_at(h, row, iget(h, ix, g.KCJMAT), parts)
        if part is None:
            continue
        k, fraction = part
        state = parts.state[k, 0] * (1 - fraction) + parts.state[k, 1] * fraction
        state[LINEAR:] = parts.state[k, round(fraction), LINEAR:]
        state = state.astype(h.cr.dtype)
        puti(h, ix, g.KCJFLAG, iget(h, ix, g.KCJFLAG) & ~g.JOINT_BROKEN | int(parts.flags[k]))
        for field, value in zip(STATE[2:], state[2:], strict=True):
            putr(h, ix, field, value)
        set_stresses(h, ic, ix, state[0], state[1])


def _part_at(h: Memory, row: Reals, material: int, parts: StressedParts) -> tuple[int, float] | None:
    """The part that a contact lies within, and its place there from 0 to 1; None if it lies in none.

    row: of joint_geometry. material: joint material of the contact.
    """
    direction = parts.ends[:, 1] - parts.ends[:, 0]
    from_end = row[[X, Y]] - parts.ends[:, 0]
    fraction = (from_end * direction).sum(axis=1) / (direction * direction).sum(axis=1)
    is_parallel = abs(parts.normals @ row[[NX, NY]]) > PARALLEL
    is_near = abs((from_end * parts.normals).sum(axis=1)) < float(h.cr[g.BTOL])
    within = is_parallel & is_near & (fraction > 0) & (fraction < 1) & (parts.material == material)
    k = int(within.argmax())
    return (k, float(fraction[k])) if within[k] else None
