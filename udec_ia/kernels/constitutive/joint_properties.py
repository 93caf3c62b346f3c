"""Joint properties of a contact: its material, stiffness, strength and stored energy, and whether it slips.

A contact belongs to a joint and has the properties of its material. `assign_material` sets the material when
a contact is created, moved to other blocks, or one of its blocks changes. Those of a contact with a joint
material are in joint_models.py; `joint_of` (joint_stresses.py) has those of both kinds.

Number 1 (coulomb_joint.py) does not use residual strength and dilation. User's laws get them, with all other
properties, from the material of `material_of`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, integers, puti, real
from udec_ia.layout import offsets as g

JOINT_ARRAYS = ("AKN", "AKS", "AMU", "COH", "JDIL", "RMU", "RCOH", "UCRIT")  # properties of joints


class Joint(NamedTuple):
    """Properties of one joint: stiffnesses (N/m2), cohesion (N/m) and friction (a tangent)."""

    kn: Any
    ks: Any
    cohesion: Any
    friction: Any


@kernel
def assign_material(h: Memory, ic: int) -> None:
    """Material and constitutive number of contact `ic`: those of its first block, KB1 (report 4.3)."""
    ib = iget(h, ic, g.KB1)
    puti(h, ic, g.KCM, iget(h, ib, g.KMAT))
    puti(h, ic, g.KCC, iget(h, ib, g.KCONS))


@inlined
def material_of(h: Memory, ic: int) -> int:
    """Material number of contact `ic`."""
    return iget(h, ic, g.KCM)


@inlined
def joint_of_material(h: Memory, mat: int) -> Joint:
    """Properties of a joint of material `mat`."""
    m = mat - 1
    return Joint(h.cr[g.AKN + m], h.cr[g.AKS + m], h.cr[g.COH + m], h.cr[g.AMU + m])


@inlined
def joint_by_material(h: Memory, ic: int) -> Joint:
    """Properties of the joint of contact `ic`, which has no joint material."""
    return joint_of_material(h, material_of(h, ic))


@inlined
def stiffest(joint: Joint) -> Any:
    """The greater one of the stiffnesses of a joint, N/m2."""
    return max(joint.kn, joint.ks)


@inlined
def strength(joint: Joint, fn: float) -> Any:
    """Shear strength (N/m) of a joint under the normal force `fn`: c + f Fn (Coulomb)."""
    return joint.cohesion + joint.friction * fn


@inlined
def is_stuck(h: Memory, ic: int) -> bool:
    """True if contact `ic` does not slip: it carries no force, or a shear force below its strength.

    Not for contacts with a joint material.
    """
    fn = getr(h, ic, g.KCFN)
    return abs(getr(h, ic, g.KCFS)) < strength(joint_by_material(h, ic), fn) or fn == 0


@inlined
def twice_stored(h: Memory, ic: int, fn: float, fs: float) -> tuple[Any, Any]:
    """Twice the elastic energy (J/m) of a normal and of a shear force in the joint of contact `ic`.

    A stiffness of 0 stores nothing. Not for contacts with a joint material (joint_stresses.joint_energy).
    """
    joint, normal, shear = joint_by_material(h, ic), real(h, 0.0), real(h, 0.0)
    if joint.kn > 0:
        normal = fn * fn / joint.kn
    if joint.ks > 0:
        shear = fs * fs / joint.ks
    return normal, shear


@inlined
def stored_energy(h: Memory, ic: int) -> float:
    """Elastic energy (J/m) of the forces of contact `ic`, which has no joint material."""
    normal, shear = twice_stored(h, ic, getr(h, ic, g.KCFN), getr(h, ic, g.KCFS))
    return (normal + shear) * real(h, 0.5)


def joints_of_materials(h: Memory, materials: Any) -> Joint:
    """Properties of the joints of material numbers, as arrays of 64-bit reals; not for kernels."""
    m = np.asarray(materials) - 1
    return Joint(*(np.asarray(h.cr[k + m], np.float64) for k in (g.AKN, g.AKS, g.COH, g.AMU)))


def materials_of(h: Memory, contacts: Any) -> Any:
    """Material numbers of the contacts at the addresses `contacts`; not for kernels."""
    return integers(h, contacts, g.KCM)
