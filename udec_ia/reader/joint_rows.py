"""Slip, opening and state of joints, contact by contact, and the lines on which they lie.

They are those of the joint of a contact that has a joint material, else of the contact itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.kernels.constitutive.joint_materials import BY_BLOCKS
from udec_ia.kernels.constitutive.joint_models import find_strengths
from udec_ia.kernels.constitutive.joint_properties import (
    joints_of_materials,
    materials_of,
    strength,
)
from udec_ia.kernels.contact.joint_lengths import END1, END2, NX, NY, X, Y, joint_geometry
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups

STATES = {  # of a joint, in the order of the column `state`: what they mean
    "closed": "has neither slipped nor opened",
    "slipped": "has slipped, and holds",
    "slips": "shear stress is at its strength",
    "broken": "has opened, and is closed again; or has formed without tensile strength",
    "open": "carries nothing",
}
CLOSED, SLIPPED, SLIPS, BROKEN, OPEN = range(len(STATES))
COULOMB = 1  # constitutive number whose strength is known without its law
NEARLY = 1 - 1e-6  # of the strength: a joint that slips has a shear force just there
STRESSES = ("normal", "shear", "safety")  # columns of stress_rows
STRENGTHS = InterpretWhenSmall(find_strengths, 3e4)  # joints
COLUMNS = {"contact": "i8", "slip": "f8", "opening": "f8", "state": "i8", "broken": "?"}


def joint_rows(h: Memory) -> Any:
    """All contacts but virtual ones as a structured array (n,), in list order.

    Columns are `contact` (address), `slip` and `opening` (m; negative: shear to the other side, closure),
    `state` (number in STATES) and `broken` (its joint has opened by tension, or formed without strength).
    """
    contacts = np.array(list(groups(h, "contact")), np.int64)
    contacts = contacts[integers(h, contacts, g.KCCOD) != g.VIRTUAL]
    joints = joints_at(h, contacts)
    has = joints != 0
    joints = joints[has]
    rows = np.zeros(len(contacts), [*COLUMNS.items()])
    rows["contact"] = contacts
    rows["slip"], rows["opening"] = getr(h, contacts, g.KCS), -np.float64(getr(h, contacts, g.KCN))
    rows["opening"][has] -= np.float64(getr(h, joints, g.KCJOFF))
    rows["state"] = _states_without_material(h, contacts)
    rows["state"][has] = joint_states(h, joints)
    rows["broken"][has] = integers(h, joints, g.KCJFLAG) & g.JOINT_BROKEN != 0
    return rows


def joint_states(h: Memory, joints: Any) -> Any:
    """The number in STATES of each of the `joints`, which are addresses (n,)."""
    flags = integers(h, joints, g.KCJFLAG)
    broken = flags & g.JOINT_BROKEN != 0
    state = np.where(flags & g.JOINT_SLIPPED != 0, SLIPPED, CLOSED)
    state[broken] = BROKEN
    state[flags & g.JOINT_SLIPS != 0] = SLIPS
    state[broken & (getr(h, joints, g.KCJSN) <= 0)] = OPEN
    return state


def _states_without_material(h: Memory, contacts: Any) -> Any:
    """States of contacts as of 1980, which remember no slip: closed, slips or open."""
    fn, fs = (np.float64(getr(h, contacts, k)) for k in (g.KCFN, g.KCFS))
    limit = strength(joints_of_materials(h, materials_of(h, contacts)), fn)
    slips = (fn > 0) & (np.abs(fs) >= NEARLY * limit) & (integers(h, contacts, g.KCC) == COULOMB)
    is_open = (fn == 0) & (getr(h, contacts, g.KCN) < 0)
    return np.select([is_open, slips], [OPEN, SLIPS], CLOSED)


def stress_rows(h: Memory, contacts: Any, lengths: Any) -> Any:
    """Stresses of the joints of contacts (n,) that are not virtual, as a structured array (n,).

    Columns are `normal` (Pa, compression positive), `shear` (Pa) and `safety` against slip: shear strength
    over shear stress. It is inf without shear stress, and NaN in an open joint and for a law that gives no
    strength. lengths (m): over which the forces of contacts without a joint material are spread.
    """
    fn, fs = (np.float64(getr(h, contacts, k)) for k in (g.KCFN, g.KCFS))
    rows = np.zeros(len(contacts), [(name, "f8") for name in STRESSES])
    with np.errstate(divide="ignore", invalid="ignore"):
        rows["normal"], rows["shear"] = fn / lengths, np.abs(fs) / lengths
        limit = strength(joints_of_materials(h, materials_of(h, contacts)), fn)
        rows["safety"] = np.where(fn > 0, limit / np.abs(fs), np.nan)
        joints = joints_at(h, contacts)
        rows["safety"][(joints == 0) & (integers(h, contacts, g.KCC) != COULOMB)] = np.nan
        has = np.flatnonzero(joints)
        has = has[integers(h, joints[has], g.KCJMAT) != BY_BLOCKS]
        joints, shear = joints[has], np.abs(np.float64(getr(h, joints[has], g.KCJTS)))
        limits = np.empty(len(joints))
        STRENGTHS(len(joints), h, joints, limits)
        limits[joint_states(h, joints) == OPEN] = np.nan
        rows["safety"][has] = limits / shear
        per_length = h.ci[g.JMUNIT + integers(h, joints, g.KCJMAT) - 1] != g.PER_CONTACT
        rows["normal"][has[per_length]] = getr(h, joints[per_length], g.KCJSN)
        rows["shear"][has[per_length]] = shear[per_length]
    return rows


def geometry_of_joints(h: Memory, contacts: Any) -> tuple[Any, Any]:
    """What joint_geometry finds of contacts (n,) that are not virtual: reals (n, 7) and neighbours (n, 2)."""
    found, neighbours = np.zeros((len(contacts), 7)), np.zeros((len(contacts), 2), np.int64)
    joint_geometry(h, contacts, found, neighbours)
    return found, neighbours


def normals_of_joints(h: Memory, contacts: Any) -> Any:
    """Unit normals (n, 2), from KB1 to KB2, of contacts (n,) that are not virtual."""
    return geometry_of_joints(h, contacts)[0][:, [NX, NY]]


def joint_lines(h: Memory, contacts: Any) -> Any:
    """The part of its joint that belongs to each contact, (n, 3, 2) in m: one end, the contact, other end.

    It ends half-way to the next contact of the joint or at the end of the joint, and is 2 D long for a
    contact that is on none.
    """
    found, neighbours = geometry_of_joints(h, contacts)
    place = found[:, [X, Y]]
    along = np.column_stack([-found[:, NY], found[:, NX]])  # towards side KD1
    lone = (neighbours == 0).all(axis=1)
    lines = np.stack([place, place, place], axis=1)
    order = np.argsort(contacts)
    for side, column, sign in ((0, END1, 1), (1, END2, -1)):
        beside = neighbours[:, side]
        reach = np.where(lone, h.cr[g.DTOL], found[:, column])
        lines[:, 2 * side] += sign * reach[:, None] * along
        has = beside != 0
        other = place[order[np.searchsorted(contacts, beside[has], sorter=order)]]
        lines[has, 2 * side] = (place[has] + other) / 2
    return lines
