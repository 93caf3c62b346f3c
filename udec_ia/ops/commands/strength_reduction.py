"""Strengths of materials and joint materials, divided by a factor or made unlimited (FOS).

Strengths are frictions (tangents), cohesions and tensile strengths, at the peak and residual. They are
numbers of materials, so all blocks or joints of a material share them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, integers, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.common.block_ranges import blocks_in, check_range, why_no_block
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.reader.group_ranges import Range, holds
from udec_ia.reader.group_tables import table


def _places(*arguments: str) -> tuple[int, ...]:
    """Places in the common block of properties of material 1."""
    return tuple(getattr(g, one.array) for one in read_table().properties if one.argument in arguments)


_CONTACT_FRICTIONS = _places("friction", "residual_friction")
OF_BLOCKS = (g.BMU, g.BCOH, g.BTEN)  # arrays of materials: strength inside blocks
OF_CONTACTS = (*_CONTACT_FRICTIONS, *_places("cohesion", "residual_cohesion"))  # without a joint material
OF_JOINTS = (g.JMMU, g.JMCOH, g.JMTEN, g.JMRMU, g.JMRCO, g.JMIMU)  # of joint materials
FRICTIONS = (*_CONTACT_FRICTIONS, g.BMU, g.JMMU, g.JMRMU, g.JMIMU)
RESIDUAL = (g.JMRMU, g.JMRCO)  # less than 0: as at the peak
UNLIMITED_FRICTION, UNLIMITED = 1e9, 1e30  # a tangent; Pa or N/m


def strengths(array: MainArray, where: Range | None, blocks: bool, joints: bool) -> list[int]:
    """Places in the common block of the strengths of blocks and joints in a range, None for all.

    Error 10 if a material in the range is also one outside it, 24 for an empty range, 26 if there is no
    strength, or one that is no number that can be divided (BARTON).
    """
    if where is not None:
        check_range(array, where)
        if not (blocks_in(array, where) or _contacts_in(array, where)[1].any()):
            raise UdecError(24, why_no_block(array, where), parameter="x1")
    found: list[int] = []
    if blocks:
        found += [k + m - 1 for m in _materials_of_blocks(array, where) for k in OF_BLOCKS]
    if joints:
        of_blocks, of_joints = _materials_of_contacts(array, where)
        for m in of_joints:
            if array.h.ci[g.JMLAW + m - 1] == g.BARTON_BANDIS:
                detail = f"joint material {m} is BARTON, whose strength depends on the stress"
                raise UdecError(26, detail, "FOS divides friction, cohesion and tension: use COULOMB")
        found += [k + m - 1 for m in of_blocks for k in OF_CONTACTS]
        found += [k + m - 1 for m in of_joints for k in OF_JOINTS]
    found = [k for k in found if array.h.cr[k] > 0]
    if not found:
        raise UdecError(26, "nothing has a strength that could be divided", "give friction or cohesion")
    return found


def _materials_of_blocks(array: MainArray, where: Range | None) -> list[int]:
    """Materials of the blocks in the range."""
    blocks = table(array, "block")
    inside = (
        np.ones(len(blocks), bool) if where is None else np.isin(blocks["address"], blocks_in(array, where))
    )
    return _own(blocks["KMAT"], inside, "material")


def _materials_of_contacts(array: MainArray, where: Range | None) -> tuple[list[int], list[int]]:
    """Materials of the first blocks of contacts in the range without a joint material; joint materials."""
    h, (contacts, inside) = array.h, _contacts_in(array, where)
    joint = joints_at(h, contacts["address"])
    number = np.where(joint != 0, integers(h, np.where(joint != 0, joint, 1), g.KCJMAT), 0)
    plain = number <= 0
    first = integers(h, contacts["KB1"], g.KMAT) if len(contacts) else np.zeros(0, np.int64)
    return (
        _own(first[plain], inside[plain], "material"),
        _own(number[~plain], inside[~plain], "joint material"),
    )


def _contacts_in(array: MainArray, where: Range | None) -> tuple[Any, Any]:
    """Rows of all contacts but virtual ones, and which of them are in the range."""
    contacts = table(array, "contact")
    contacts = contacts[contacts["KCCOD"] != g.VIRTUAL]
    if where is None:
        return contacts, np.ones(len(contacts), bool)
    places, both = (contacts["KXC"], contacts["KYC"]), (contacts["KB1"], contacts["KB2"])
    return contacts, holds(array, where, *places, *both, contacts=contacts["address"])


def _own(materials: Any, inside: Any, what: str) -> list[int]:
    """The materials of groups in a range. Error 10 for one that groups outside it have, too."""
    found = np.unique(materials[inside])
    shared = np.intersect1d(found, materials[~inside])
    if len(shared):
        detail = f"{what} {shared[0]} is also one outside the range"
        raise UdecError(10, detail, "first CHANGE what is in the range to one of its own", parameter="x1")
    return [int(m) for m in found]


def divide_strengths(array: MainArray, places: list[int], factor: float) -> None:
    """Divide the numbers at these places, and those that a FUNCTION multiplies there, by `factor`."""
    h = array.h
    h.cr[places] = np.asarray(h.cr[places], np.float64) / factor
    followers = list_of(h, "follower")
    for iw in followers[np.isin(integers(h, followers, g.KWN), places)].tolist():
        putr(h, iw, g.KWB, float(getr(h, iw, g.KWB)) / factor)


def remove_limits(array: MainArray) -> None:
    """Give all blocks and joints unlimited friction and cohesion, and joints with a tensile strength that.

    Joints without one still open. FUNCTIONs of strengths end.
    """
    h, arrays = array.h, np.array((*OF_BLOCKS, *OF_CONTACTS, *OF_JOINTS))
    followers = list_of(h, "follower")
    place = integers(h, followers, g.KWN)[:, None] - arrays
    drop(h, "follower", followers[((place >= 0) & (place < NMAT)).any(axis=1)].tolist())
    for k in arrays.tolist():
        if k in RESIDUAL:
            array.h.cr[k : k + NMAT] = -1  # as at the peak
        elif k == g.JMTEN:
            numbers = array.h.cr[k : k + NMAT]
            numbers[numbers > 0] = UNLIMITED
        else:
            array.h.cr[k : k + NMAT] = UNLIMITED_FRICTION if k in FRICTIONS else UNLIMITED
