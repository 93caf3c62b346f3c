"""INSITU for joints: contacts get the forces that balance the initial stress of the blocks, gravity included.

The force of a contact is the integral, along its joint, of the traction times its hat function, which is 1 at
this contact and 0 at its neighbours. Nodes are the points at which contacts act: the contact, or the true
corner of a fully-deformable block. The hats of the last two nodes extend to the ends of the joint. With a
linear stress field this balances every block exactly, also between unlike meshes.

    traction     t = -S n on block KB2, n the normal from KB1 to KB2
    stresses     G s = F for each joint, F the forces at its nodes and G what unit stresses make of them

Forces are kept by the offset of each contact: closure = overlap + offset. A contact without a joint material
keeps the stiffness of its material per contact, as joint material -1. Contacts that lie on no joint get no
force.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from udec_ia.heap.accessors import Memory, getr, integers, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_materials import BY_BLOCKS, is_lumped
from udec_ia.kernels.constitutive.joint_models import friction_under, joint_values, set_stresses
from udec_ia.kernels.constitutive.joint_stresses import joints_of
from udec_ia.kernels.contact.joint_lengths import (
    END1,
    END2,
    NODE,
    NX,
    NY,
    X,
    Y,
    set_joint_material,
)
from udec_ia.kernels.links.longer_groups import joint_at
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.joint_property_command import add_joints
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.reader.joint_rows import geometry_of_joints

Field = Callable[[float, float], tuple[float, float, float]]  # stresses 11, 12, 22 at (x, y)
Reals = NDArray[np.float64]
GAUSS = (
    0.5 - 0.5 / np.sqrt(3),
    0.5 + 0.5 / np.sqrt(3),
)  # places of two points of equal weight on a length of 1


class Link(NamedTuple):
    """One contact of a joint. row: in the arrays of joint_geometry. side2: 1 if KD2 lies ahead, else -1."""

    row: int
    side2: int


def stress_joints(array: MainArray, blocks: list[int], field: Field) -> list[tuple[float, float]]:
    """Give the contacts of `blocks` the forces of a stress field. Returns places that cannot carry them.

    Error 1 without memory, and nothing is changed.
    """
    add_joints(array)
    h = array.h
    contacts = list_of(h, "contact")
    contacts = contacts[integers(h, contacts, g.KCCOD) != g.VIRTUAL]
    sides = [np.isin(integers(h, contacts, k), blocks) for k in (g.KB1, g.KB2)]
    contacts = contacts[sides[0] | sides[1]]
    springs = joints_of(h, contacts)
    contacts = contacts[(springs.kn > 0) & (springs.ks > 0)]  # others carry no force that stays
    for ic in contacts.tolist():
        if joint_at(h, ic) == 0:
            set_joint_material(h, ic, BY_BLOCKS, True)
    return stress_contacts(h, contacts, field)


def stress_contacts(h: Memory, contacts: Any, field: Field) -> list[tuple[float, float]]:
    """The same for `contacts` alone, which all have a joint material."""
    found, neighbours = geometry_of_joints(h, contacts)
    neighbours[~np.isin(neighbours, contacts)] = 0
    places: list[tuple[float, float]] = []
    for joint in _joints(contacts, neighbours):
        places += _stress_one(h, contacts, found, joint, field)
    return places


def _joints(contacts: NDArray[np.int64], neighbours: NDArray[np.int64]) -> Iterator[list[Link]]:
    """Each joint as its contacts in a row, from one end to the other; contacts on no joint are left out."""
    rows = {ic: k for k, ic in enumerate(contacts.tolist())}
    done: set[int] = set()
    for ic, (at1, at2) in zip(contacts.tolist(), neighbours.tolist(), strict=True):
        if ic in done or (at1 == 0) == (at2 == 0):
            continue
        joint, before, now = [], 0, ic
        while now:
            at1, at2 = neighbours[rows[now]].tolist()
            ahead, side2 = (at2, 1) if at1 == before else (at1, -1)
            joint.append(Link(rows[now], side2))
            done.add(now)
            before, now = now, ahead if ahead not in done else 0
        yield joint


def _hats(nodes: Reals, place: float) -> Reals:
    """Values at a place of the hat functions of nodes in increasing order.

    Beyond the ends a force goes to the first and the last node by the lever rule. Of nodes at one place the
    last one counts.
    """
    values = np.zeros(len(nodes))
    one, two = 0, len(nodes) - 1
    if nodes[0] < place < nodes[-1]:
        two = int(np.searchsorted(nodes, place))
        one = two - 1
    if nodes[two] > nodes[one]:
        values[two] = (place - nodes[one]) / (nodes[two] - nodes[one])
    values[one] = 1 - values[two]
    return values


def _stress_one(
    h: Memory, contacts: NDArray[np.int64], found: Reals, joint: list[Link], field: Field
) -> list[tuple[float, float]]:
    """Stress the contacts of one joint. Returns the places that cannot carry their stress."""
    first, last = found[joint[0].row], found[joint[-1].row]
    start, way = first[[X, Y]], last[[X, Y]] - first[[X, Y]]
    way /= np.hypot(*way)
    ends = first[END1 if joint[0].side2 > 0 else END2], last[END2 if joint[-1].side2 > 0 else END1]
    along = np.array([(found[link.row, [X, Y]] - start) @ way for link in joint])
    nodes = along + [link.side2 * found[link.row, NODE] for link in joint]
    order = np.argsort(nodes, kind="stable")
    nodes, along, joint = nodes[order], along[order], [joint[k] for k in order]
    n = first[[NX, NY]]
    across = np.array([n[1], -n[0]])
    forces = np.zeros((len(joint), 2))
    limits = [min(-ends[0], nodes[0]), *nodes, max(along.max() + ends[1], nodes[-1])]
    for a, b in pairwise(limits):
        for place in GAUSS:
            s = a + (b - a) * place
            s11, s12, s22 = field(*(start + s * way))
            traction = -np.array([s11 * n[0] + s12 * n[1], s12 * n[0] + s22 * n[1]])
            forces += np.outer(_hats(nodes, s) * (b - a) / 2, (n @ traction, across @ traction))
    of_stress = np.zeros((len(joint), len(joint)))
    for k, link in enumerate(joint):
        ix = joint_at(h, contacts[link.row])
        own, p1, p2 = (float(getr(h, ix, one)) for one in (g.KCJOWN, g.KCJP1, g.KCJP2))
        if is_lumped(h, ix) and p1 + p2 > 0:
            of_stress[k, k] = own + (p1 + p2) / 2
        elif p1 + p2 > 0:
            for length, place in ((own, 0.0), (p1 / 2, -p1 / 3), (p2 / 2, p2 / 3)):
                of_stress[:, k] += length * _hats(nodes, along[k] + link.side2 * place)
        else:  # its force is at its node
            of_stress[k, k] = own
    places = []
    for link, (sn, ts) in zip(joint, np.linalg.solve(of_stress, forces).tolist(), strict=True):
        ic = int(contacts[link.row])
        if not _put_stress(h, ic, sn, ts):
            places.append((float(found[link.row, X]), float(found[link.row, Y])))
    return places


def _put_stress(h: Memory, ic: int, sn: float, ts: float) -> bool:
    """Set the stresses of contact `ic`, and its forces. False if they exceed its strength."""
    real, ix = h.cr.dtype.type, joint_at(h, ic)
    set_stresses(h, ic, ix, real(sn), real(ts))
    length = getr(h, ix, g.KCJL)
    putr(h, ic, g.KCFN, length * real(sn))
    putr(h, ic, g.KCFS, length * real(ts))
    joint = joint_values(h, ic, ix)
    strength = joint.cohesion + friction_under(h, ix, joint, real(sn)) * sn
    return bool(sn >= -joint.tension and abs(ts) <= strength)
