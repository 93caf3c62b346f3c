"""Cracks are made between two cycles, where the crack pass has found that blocks are to crack (BREAKAGE).

A crack is a cut as of SPLIT. Velocities and stresses of both parts are those that the block has there, so
that momentum, angular momentum and energy stay to rounding. Contacts stay with their forces. One at the mouth
of the crack touches a new rounded corner and overlaps less than before: its spring loses force as if it had
opened by as much, and a joint material keeps its stress. What that takes is the energy of the crack.

A fully-deformable block is cut along zone sides (zone_path.py), and all this is exact there.

With a joint material the faces of a crack through a stressed block begin with the stress that was there
before; the law of the joint decides what remains of it. Without one they begin without a force.
"""

from __future__ import annotations

import numpy as np
import shapely

from udec_ia.compiling.law_calls import FIRST
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_laws import reset_forces
from udec_ia.kernels.constitutive.joint_models import friction_under, joint_values, set_stresses
from udec_ia.kernels.constitutive.joint_properties import joint_by_material
from udec_ia.kernels.contact.joint_lengths import forces_of_stresses
from udec_ia.kernels.crack.crack_pass import crack_of, is_to_crack
from udec_ia.kernels.geometry.block_shape import geo
from udec_ia.kernels.geometry.contact_geometry import begin_contact
from udec_ia.kernels.links.linked_lists import is_contact
from udec_ia.kernels.links.longer_groups import joint_at
from udec_ia.kernels.split.split import DONE
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.energy_account import stored_energies
from udec_ia.ops.commands.initial_joint_stress import stress_contacts
from udec_ia.ops.commands.joint_property_command import update_all_joints
from udec_ia.ops.commands.joint_stress_at_cuts import stressed_parts
from udec_ia.ops.commands.water_command import update_water
from udec_ia.ops.common.array_growth import all_or_nothing, require
from udec_ia.ops.common.block_ranges import items
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.cuts.cut_blocks import cut_block_along
from udec_ia.running.mass_scaling import renew_relaxations
from udec_ia.running.zone_path import ZonePath, zone_path

CROSSINGS = 2.0  # of a block by a wave, until its parts may crack again


def make_cracks(array: MainArray) -> bool:
    """Make the cracks that the last cycle has asked for; True if there were any. Error 1."""
    if not array.h.ci[g.LCRACK]:
        return False
    with all_or_nothing(array):
        array.h.ci[g.LCRACK] = 0
        renew_forces(array)
        for ik in list_of(array.h, "breakable").tolist():
            if is_to_crack(array.h, ik):
                _crack_block(array, ik)
        if array.h.ci[g.IRXPNT]:
            renew_relaxations(array)
    return True


def _crack_block(array: MainArray, ik: int) -> None:
    """Crack one block, and record it."""
    h = array.h
    ib = iget(h, ik, g.KBKB)
    wait = h.cr.dtype.type(_time_to_wait(h, ib))
    crack = zone_path(h, ib, ik) if iget(h, ib, HEAD) == g.MFDEF else _straight(h, ib, ik)
    if crack is None:  # no path along zone sides is possible now
        putr(h, ik, g.KBKW, wait)
        return
    energy = sum(stored_energies(h))
    overlaps = {ic: getr(h, ic, g.KCN) for ic in items(h, ib) if is_contact(h, ic)}
    parts = stressed_parts(array) if h.ci[g.LJOINT] else None
    path, d = crack.points.astype(h.cr.dtype), float(h.cr[g.DTOL])
    joints, zoned = [iget(h, ik, g.KBKJ)] * (len(path) - 1), iget(h, ib, HEAD) == g.MFDEF
    status, _ = cut_block_along(array, ib, path, joints, float(h.cr[g.FTOL]), 2 * d, zoned)
    if status != DONE:  # by the last digits, as its ends are rounded to reals of the scheme
        putr(h, ik, g.KBKW, wait)
        return
    jb = int(array.h.ci[g.IBPNT])
    _adjust_forces(array.h, overlaps, (ib, jb))
    update_all_joints(array, parts)
    if iget(array.h, ib, HEAD) != g.MRIG:
        _stress_faces(array.h, ib, jb, crack)
    update_water(array)
    renew_forces(array)
    for one in (ik, iget(array.h, ik, g.KBKN)):  # the second part comes next in the list
        putr(array.h, one, g.KBKW, wait)
    _record(array, crack, energy - sum(stored_energies(array.h)))


def _straight(h: Memory, ib: int, ik: int) -> ZonePath:
    """The crack of a block without zones in the form of a path of one piece."""
    cause, *ends = crack_of(h, ik)
    stress = np.zeros((1, 3))
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        stress[0] = [getr(h, ie, k) for k in (g.KS111, g.KS112, g.KS122)]
    return ZonePath(int(cause), np.array(ends).reshape(2, 2), stress, np.zeros(1, bool))


def _adjust_forces(h: Memory, overlaps: dict[int, float], blocks: tuple[int, int]) -> None:
    """Adjust the forces of contacts whose overlaps have changed. overlaps: those before, by contact."""
    zero = h.cr.dtype.type(0)
    contacts = dict.fromkeys(ic for ib in blocks for ic in items(h, ib) if is_contact(h, ic))
    for ic in contacts:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            begin_contact(h, ic)  # the update of a domain may have moved it to another segment
    for ic in (ic for ic in contacts if ic in overlaps):
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


def _stress_faces(h: Memory, ib: int, jb: int, crack: ZonePath) -> None:
    """The contacts between both parts begin with the stress there, if they have a joint material.

    Beside zones that have failed they are broken.
    """
    contacts = [ic for ic in items(h, jb) if is_contact(h, ic) and iget(h, ic, g.KCCOD) != g.VIRTUAL]
    contacts = [ic for ic in contacts if ib in (iget(h, ic, g.KB1), iget(h, ic, g.KB2)) and joint_at(h, ic)]
    if not contacts:
        return
    lines = shapely.linestrings(np.stack([crack.points[:-1], crack.points[1:]], axis=1))

    def side_at(x: float, y: float) -> int:
        return int(np.argmin(shapely.distance(lines, shapely.Point(x, y))))

    def stress(x: float, y: float) -> tuple[float, float, float]:
        s11, s12, s22 = crack.stress[side_at(x, y)].tolist()
        return s11, s12, s22

    stress_contacts(h, np.array(contacts), stress)
    for ic in contacts:
        ix = joint_at(h, ic)
        if crack.failed[side_at(float(getr(h, ic, g.KXC)), float(getr(h, ic, g.KYC)))]:
            puti(h, ix, g.KCJFLAG, iget(h, ix, g.KCJFLAG) | g.JOINT_BROKEN)
        _limit_stress(h, ic, ix)
    forces_of_stresses(h)


def _limit_stress(h: Memory, ic: int, ix: int) -> None:
    """Limit the stress with which contact `ic` begins to its strength; in too much tension it is broken."""
    zero, joint = h.cr.dtype.type(0), joint_values(h, ic, ix)
    sn, ts = getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS)
    broken = iget(h, ix, g.KCJFLAG) & g.JOINT_BROKEN != 0
    if sn < -joint.tension or (sn <= 0 and (joint.tension == 0 or broken)):
        puti(h, ix, g.KCJFLAG, iget(h, ix, g.KCJFLAG) | g.JOINT_BROKEN)
        set_stresses(h, ic, ix, zero, zero)
        return
    limit = max((zero if broken else joint.cohesion) + friction_under(h, ix, joint, sn) * sn, zero)
    if abs(ts) > limit:
        set_stresses(h, ic, ix, sn, limit if ts > 0 else -limit)


def _time_to_wait(h: Memory, ib: int) -> float:
    """Time in which a wave crosses block `ib` and comes back; 0 for a rigid one."""
    if iget(h, ib, HEAD) == g.MRIG:
        return 0.0
    modulus = float(h.cr[g.ALAM1 + iget(h, ib, g.KMAT) - 1])
    speed = (modulus * float(geo(h, ib)[0]) / float(getr(h, ib, g.KBM))) ** 0.5
    return CROSSINGS * 2 * float(getr(h, ib, g.KBRO)) / float(speed)


def _record(array: MainArray, crack: ZonePath, energy: float) -> None:
    """Record a crack that took an energy (J/m)."""
    require(array, size_of(array.h, g.NVFR))
    h = array.h
    real, kf = h.cr.dtype.type, int(find(h, g.NVFR))
    puti(h, kf, HEAD, g.MFRC)
    puti(h, kf, g.KFRN, int(h.ci[g.IFRPNT]))
    puti(h, kf, g.KFRK, crack.cause)
    numbers = float(h.ci[g.MCTOT]), float(h.cd[g.TIME]), *crack.points[[0, -1]].ravel().tolist(), energy
    fields = g.KFRC, g.KFRT, g.KFRX1, g.KFRY1, g.KFRX2, g.KFRY2, g.KFRE
    for field, value in zip(fields, numbers, strict=True):
        putr(h, kf, field, real(value))
    h.ci[g.IFRPNT] = kf
    if h.ci[g.LENER]:
        h.cd[g.WCRACK] += energy
