"""Cracks are made between two cycles, where the crack pass has found that blocks are to crack (BREAKAGE).

A crack is a cut as of SPLIT. Velocities and stresses of both parts are those that the block has there, so
that momentum, angular momentum and energy stay to rounding. Contacts stay with their forces. One at the mouth
of the crack touches a new rounded corner and overlaps less than before: its spring loses force as if it had
opened by as much, and a joint material keeps its stress. What that takes is the energy of the crack.

With a joint material the faces of a crack through a stressed block begin with the stress that was there
before; the law of the joint decides what remains of it. Without one they begin without a force.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.law_calls import FIRST
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_laws import reset_forces
from udec_ia.kernels.constitutive.joint_models import friction_under, joint_values, set_stresses
from udec_ia.kernels.constitutive.joint_properties import joint_by_material
from udec_ia.kernels.contact.joint_lengths import forces_of_stresses
from udec_ia.kernels.crack.crack_line import Crack
from udec_ia.kernels.crack.crack_pass import crack_of
from udec_ia.kernels.geometry.block_shape import geo
from udec_ia.kernels.links.linked_lists import is_contact
from udec_ia.kernels.links.longer_groups import joint_at
from udec_ia.kernels.split.polyline_cut import cut_along
from udec_ia.kernels.split.split import DONE, NO_MEMORY, cutting
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.corner_rounding import update_flagged
from udec_ia.ops.commands.energy_account import stored_energies
from udec_ia.ops.commands.initial_joint_stress import stress_contacts
from udec_ia.ops.commands.joint_property_command import update_all_joints
from udec_ia.ops.commands.joint_stress_at_cuts import stressed_parts
from udec_ia.ops.commands.water_command import update_water
from udec_ia.ops.common.array_growth import all_or_nothing, find_room, keep_spare, require
from udec_ia.ops.common.block_ranges import items
from udec_ia.ops.common.kernel_arguments import renew_forces, soft_or_loaded_in
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.running.mass_scaling import renew_relaxations

CROSSINGS = 2.0  # of a block by a wave, until its parts may crack again


def make_cracks(array: MainArray) -> bool:
    """Make the cracks that the last cycle has asked for; True if there were any. Error 1 without memory."""
    if not array.h.ci[g.LCRACK]:
        return False
    with all_or_nothing(array):
        array.h.ci[g.LCRACK] = 0
        renew_forces(array)
        for ik in list_of(array.h, "breakable").tolist():
            crack = crack_of(array.h, ik)
            if crack[0] != 0:
                _crack_block(array, ik, crack)
        if array.h.ci[g.IRXPNT]:
            renew_relaxations(array)
    return True


def _crack_block(array: MainArray, ik: int, crack: Crack) -> None:
    """Crack one block, and record it."""
    energy = sum(stored_energies(array.h))
    ib, wait = iget(array.h, ik, g.KBKB), _time_to_wait(array.h, iget(array.h, ik, g.KBKB))
    overlaps = {ic: getr(array.h, ic, g.KCN) for ic in items(array.h, ib) if is_contact(array.h, ic)}
    parts = stressed_parts(array) if array.h.ci[g.LJOINT] else None
    path = np.array(crack[1:], array.h.cr.dtype).reshape(2, 2)
    jb = _cut(array, ib, path, np.array([iget(array.h, ik, g.KBKJ)], np.int64))
    _adjust_forces(array.h, overlaps, (ib, jb))
    update_all_joints(array, parts)
    _stress_faces(array, ib, jb)
    update_water(array)
    renew_forces(array)
    for one in (ik, iget(array.h, ik, g.KBKN)):  # the second part comes next in the list
        putr(array.h, one, g.KBKW, array.h.cr.dtype.type(wait))
    _record(array, crack, energy - sum(stored_energies(array.h)))


def _cut(array: MainArray, ib: int, path: np.ndarray, joints: np.ndarray) -> int:
    """Cut block `ib` along a polyline (n, 2) that fits; returns the new block."""
    status, found = NO_MEMORY, 0
    while status == NO_MEMORY and not found:
        keep_spare(array)
        h = array.h
        d, passes = h.cr[g.DTOL], cutting(h, soft_or_loaded_in(h))
        status, found = cut_along(h, ib, path, joints, h.cr[g.FTOL], d + d, passes)
        if status == NO_MEMORY:
            find_room(array)
    if status == NO_MEMORY:  # the block is cut, and updates are left
        update_flagged(array)
    elif status != DONE:
        raise UdecError(27, f"a crack of block@{ib} at ({path[0, 0]:g}, {path[0, 1]:g})", group=ib)
    return int(array.h.ci[g.IBPNT])


def _adjust_forces(h: Memory, overlaps: dict[int, float], blocks: tuple[int, int]) -> None:
    """Adjust the forces of contacts that overlap less than before. overlaps: those before, by contact."""
    zero = h.cr.dtype.type(0)
    for ic in {ic for ib in blocks for ic in items(h, ib)} & overlaps.keys():
        before, now, ix = overlaps[ic], getr(h, ic, g.KCN), joint_at(h, ic)
        if now == before or getr(h, ic, g.KCFN) == 0:
            continue
        if ix != 0:
            putr(h, ix, g.KCJOFF, getr(h, ix, g.KCJOFF) + (before - now))
        elif iget(h, ic, g.KCC) < FIRST:
            fn = getr(h, ic, g.KCFN) + joint_by_material(h, ic).kn * (max(now, zero) - max(before, zero))
            putr(h, ic, g.KCFN, max(fn, zero))
            if now <= 0 or fn <= 0:
                reset_forces(h, ic)


def _stress_faces(array: MainArray, ib: int, jb: int) -> None:
    """The contacts between both parts begin with the stress there, if they have a joint material."""
    h = array.h
    contacts = [ic for ic in items(h, jb) if is_contact(h, ic) and iget(h, ic, g.KCCOD) != g.VIRTUAL]
    contacts = [ic for ic in contacts if ib in (iget(h, ic, g.KB1), iget(h, ic, g.KB2)) and joint_at(h, ic)]
    if iget(h, ib, HEAD) == g.MRIG or not contacts:
        return
    ie = iget(h, ib, g.KBEX)
    s11, s12, s22 = (float(getr(h, ie, k)) for k in (g.KS111, g.KS112, g.KS122))
    stress_contacts(h, np.array(contacts), lambda x, y: (s11, s12, s22))
    for ic in contacts:
        _limit_stress(h, ic, joint_at(h, ic))
    forces_of_stresses(h)


def _limit_stress(h: Memory, ic: int, ix: int) -> None:
    """Limit the stress with which contact `ic` begins to its strength; in too much tension it is broken."""
    zero, joint = h.cr.dtype.type(0), joint_values(h, ic, ix)
    sn, ts = getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS)
    if sn < -joint.tension or (sn <= 0 and joint.tension == 0):
        puti(h, ix, g.KCJFLAG, iget(h, ix, g.KCJFLAG) | g.JOINT_BROKEN)
        set_stresses(h, ic, ix, zero, zero)
        return
    limit = max(joint.cohesion + friction_under(h, ix, joint, sn) * sn, zero)
    if abs(ts) > limit:
        set_stresses(h, ic, ix, sn, limit if ts > 0 else -limit)


def _time_to_wait(h: Memory, ib: int) -> float:
    """Time in which a wave crosses block `ib` and comes back; 0 for a rigid one."""
    if iget(h, ib, HEAD) == g.MRIG:
        return 0.0
    modulus = float(h.cr[g.ALAM1 + iget(h, ib, g.KMAT) - 1])
    speed = (modulus * float(geo(h, ib)[0]) / float(getr(h, ib, g.KBM))) ** 0.5
    return CROSSINGS * 2 * float(getr(h, ib, g.KBRO)) / float(speed)


def _record(array: MainArray, crack: Crack, energy: float) -> None:
    """Record a crack that took an energy (J/m)."""
    require(array, size_of(array.h, g.NVFR))
    h = array.h
    real, kf = h.cr.dtype.type, int(find(h, g.NVFR))
    puti(h, kf, HEAD, g.MFRC)
    puti(h, kf, g.KFRN, int(h.ci[g.IFRPNT]))
    puti(h, kf, g.KFRK, int(crack[0]))
    numbers = float(h.ci[g.MCTOT]), float(h.cd[g.TIME]), *crack[1:], energy
    fields = g.KFRC, g.KFRT, g.KFRX1, g.KFRY1, g.KFRX2, g.KFRY2, g.KFRE
    for field, value in zip(fields, numbers, strict=True):
        putr(h, kf, field, real(value))
    h.ci[g.IFRPNT] = kf
    if h.ci[g.LENER]:
        h.cd[g.WCRACK] += energy
