"""The joint that a cut belongs to: given, the next free number for a joint material, or the glue.

A glued cut is a joint of great strength and stiffness, such as the slit from a tunnel to the next joint, or
the outline of an excavation before it is dug. All are joint GLUE, which has joint material GLUE_MATERIAL. A
later cut along it ends the glue there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, integers, puti
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_materials import JOINTS
from udec_ia.kernels.constitutive.joint_properties import joint_of_material
from udec_ia.kernels.links.longer_groups import edges_at
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.joint_property_command import jmaterial_number, joint_number, set_joint_property
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.common.number_limits import NMAT, last_digit
from udec_ia.reader.group_tables import addresses, table

GLUE, GLUE_MATERIAL = JOINTS, NMAT  # the last numbers
STRENGTH = 1e30  # Pa: no joint reaches it
STIFFER = 10.0  # times the stiffness of the rock beside it
DIGITS = 256  # last digits by which a glued edge may lie beside a cut along it


def joint_of_cut(
    array: MainArray, joint: int | None, jmaterial: int | None, glued: bool, length: float
) -> int:
    """Number of the joint of a cut, 0 for none; error 4, 7 or 10 for what does not fit together.

    joint, jmaterial: as of SPLIT; without a number a free one is taken. glued: length (m) of the pieces of
    the cut, from which the stiffness of the glue follows.
    """
    if glued:
        if joint is not None or jmaterial is not None:
            raise UdecError(10, "GLUED with JOINT or JMATERIAL", "give one of them", parameter="glued")
        return glue(array, length)
    if jmaterial is not None and joint is None:
        jmaterial_number(array, jmaterial)
        return free_joint(array)
    number = joint_number(joint)
    if number == GLUE and _has_glue(array):
        raise UdecError(4, f"joint {GLUE} is that of glued cuts", "take another number", parameter="joint")
    return number


def free_joint(array: MainArray, besides: Sequence[int] = ()) -> int:
    """The first number of a joint that no cut has, and that is not one of `besides`. Error 4 for none."""
    used = {0, GLUE, *besides, *(np.flatnonzero(array.h.ci[g.JLINE : g.JLINE + JOINTS]) + 1).tolist()}
    used |= _used_joints(array)
    number = next((n for n in range(1, JOINTS + 1) if n not in used), 0)
    if not number:
        raise UdecError(
            4, f"all {JOINTS} numbers of joints are in use", "give JOINT=n", parameter="jmaterial"
        )
    return number


def _has_glue(array: MainArray) -> bool:
    """True if there is a glued cut."""
    return bool(array.h.ci[g.JLINE + GLUE - 1] == GLUE_MATERIAL)


def _used_joints(array: MainArray) -> set[int]:
    """Numbers of the joints of all edges, and of cracks that are kept."""
    h = array.h
    used = {*integers(h, list_of(h, "crack"), g.KKJ).tolist()}
    return used | ({*integers(h, addresses(array, "edge"), g.KEJ).tolist()} if h.ci[g.LJOINT] else set())


def glue(array: MainArray, length: float) -> int:
    """Number of the glued joint, whose joint material is made if need be. Error 4 or 7.

    KN = KS = 10 M/length with M = K + 4 G/3 of the stiffest material in use, or 20 KN/length of contacts of
    rigid blocks, two of which a joint has.
    """
    h = array.h
    if _has_glue(array):
        return GLUE
    if h.ci[g.JLINE + GLUE - 1] or h.ci[g.JMLAW + GLUE_MATERIAL - 1] or GLUE in _used_joints(array):
        detail = f"joint {GLUE} or joint material {GLUE_MATERIAL} is in use"
        raise UdecError(4, detail, "glued cuts need them: give yours other numbers", parameter="glued")
    used = np.unique(table(array, "block")["KMAT"])
    rock = float((h.cr[g.BULK + used - 1] + 4 / 3 * h.cr[g.SHEAR + used - 1]).max())
    contacts = 2 * max(float(joint_of_material(h, mat).kn) for mat in used.tolist())
    stiffness = STIFFER * max(rock, contacts) / length
    if not stiffness > 0:
        advice = "the stiffness of glued cuts follows from them: give PROPERTY before the cut"
        raise UdecError(7, "BULK and G, or KN, of the blocks", advice, parameter="glued")
    set_joint_property(array, GLUE_MATERIAL, kn=stiffness, ks=stiffness, cohesion=STRENGTH, tension=STRENGTH)
    h.ci[g.JLINE + GLUE - 1] = GLUE_MATERIAL
    return GLUE


def end_glue_along(array: MainArray, lines: Sequence[Any], joints: Sequence[int], size: float) -> None:
    """Glued edges that lie along one of `lines`, each (k, 2), belong to the joint of that line.

    joints: the number of the joint of each, 0 for none. size: greatest |x| + |y| of a corner.
    """
    h = array.h
    if not _has_glue(array):
        return
    corners = addresses(array, "corner")
    edges = edges_at(h, corners)
    glued = integers(h, edges, g.KEJ) == GLUE
    cuts = [k for k, joint in enumerate(joints) if joint != GLUE]
    if not cuts or not glued.any():
        return
    ends, edges = corners[glued], edges[glued]
    here, there = (
        np.stack([np.asarray(getr(h, ip, k), np.float64) for k in (g.KXP, g.KYP)], axis=1)
        for ip in (ends, integers(h, ends, g.KR))
    )
    slack = DIGITS * last_digit(array, size)
    along = np.array([shapely.LineString(lines[k]) for k in cuts])
    edge, cut = shapely.STRtree(along).query(shapely.points(here), predicate="dwithin", distance=slack)
    for places in (there, (here + there) / 2):
        near = shapely.dwithin(along[cut], shapely.points(places[edge]), slack)
        edge, cut = edge[near], cut[near]
    for one, k in zip(edges[edge].tolist(), cut.tolist(), strict=True):
        puti(h, one, g.KEJ, joints[cuts[k]])
