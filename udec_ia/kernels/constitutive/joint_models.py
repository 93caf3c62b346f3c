"""Joint models: stresses of a joint from its closure and its shear displacement (report 2.4; JPROPERTY).

A model is one function. It gets the joint of a contact, which has the stresses and the state before a
step, and returns the stresses after it. `joint_stresses` calls the model of the joint material:

    COULOMB_JOINT   Coulomb friction with cohesion, tensile strength, residual strength and dilation

Compression and closing are positive. The normal stress is a function of the closure, so that it does not
drift as a joint opens and closes. Shear stress is summed up by increments.

A joint material per contact has forces for stresses: its length is 1. Joint material 0 stands for a contact
with the properties of its material (PROPERTY) that INSITU has given an initial force.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.kernels.constitutive.joint_materials import has_flag, set_flag
from udec_ia.kernels.constitutive.joint_properties import joint_by_material
from udec_ia.layout import offsets as g


class JointValues(NamedTuple):
    """Properties of a joint, per length or per contact: those of JPROPERTY."""

    kn: Any
    ks: Any
    friction: Any
    cohesion: Any
    tension: Any
    dilation: Any
    critical: Any  # slip at which dilation ends; 0: never
    residual_friction: Any
    residual_cohesion: Any


@inlined
def joint_values(h: Memory, ic: int, ix: int) -> JointValues:
    """Properties of joint `ix` of contact `ic`."""
    m, zero = iget(h, ix, g.KCJMAT) - 1, real(h, 0.0)
    if m < 0:
        kn, ks, cohesion, friction = joint_by_material(h, ic)
        return JointValues(kn, ks, friction, cohesion, zero, zero, zero, friction, cohesion)
    friction, residual_friction = h.cr[g.JMMU + m], h.cr[g.JMRMU + m]
    cohesion, residual_cohesion = h.cr[g.JMCOH + m], h.cr[g.JMRCO + m]
    return JointValues(
        h.cr[g.JMKN + m],
        h.cr[g.JMKS + m],
        friction,
        cohesion,
        h.cr[g.JMTEN + m],
        h.cr[g.JMDIL + m],
        h.cr[g.JMCRIT + m],
        residual_friction if residual_friction >= zero else friction,
        residual_cohesion if residual_cohesion >= zero else cohesion,
    )


@inlined
def opened_by_dilation(joint: JointValues, slip: float) -> Any:
    """Opening of a joint by its plastic shear displacement `slip`."""
    length = abs(slip)
    return joint.dilation * (min(length, joint.critical) if joint.critical > 0 else length)


@inlined
def coulomb_strength(h: Memory, joint: JointValues, weak: bool, sn: float) -> Any:
    """Shear strength under the normal stress `sn`. weak: the joint has slipped or opened before."""
    cohesion = joint.residual_cohesion if weak else joint.cohesion
    friction = joint.residual_friction if weak else joint.friction
    return max(cohesion + friction * sn, real(h, 0.0))


@inlined
def coulomb_joint(
    h: Memory, ix: int, joint: JointValues, closure: float, sliding: float
) -> tuple[float, float]:
    """Springs, and the Coulomb strength c + f sn; peak strength until the first slip or opening.

        sn = KN (closure + opening by dilation),  at least -T until it breaks, at least 0 from then on
        ts grows by KS times the slip, up to the strength; what is more is plastic shear displacement

    A joint that breaks, or is open, has no shear stress. closure: at the end of the step. sliding: shear
    displacement in the step.
    """
    zero = real(h, 0.0)
    slip, held = getr(h, ix, g.KCJSLIP), getr(h, ix, g.KCJTS)
    sn = joint.kn * (closure + opened_by_dilation(joint, slip))
    if sn <= zero and (has_flag(h, ix, g.JOINT_BROKEN) or sn < -joint.tension):
        set_flag(h, ix, g.JOINT_BROKEN)
        putr(h, ix, g.KCJSLIP, slip + held / joint.ks)
        return zero, zero
    trial = held + joint.ks * sliding
    limit = coulomb_strength(h, joint, has_flag(h, ix, g.JOINT_SLIPPED | g.JOINT_BROKEN), sn)
    if abs(trial) <= limit:
        return sn, trial
    set_flag(h, ix, g.JOINT_SLIPPED | g.JOINT_SLIPS)
    limit = coulomb_strength(h, joint, True, sn)
    ts = limit if trial > zero else -limit
    putr(h, ix, g.KCJSLIP, slip + (trial - ts) / joint.ks)
    return sn, ts


@inlined
def joint_stresses(
    h: Memory, ix: int, joint: JointValues, closure: float, sliding: float
) -> tuple[float, float]:
    """Normal and shear stress of joint `ix` after a step, by the model of its joint material."""
    return coulomb_joint(h, ix, joint, closure, sliding)


@inlined
def elastic_energy(h: Memory, joint: JointValues, sn: float, ts: float) -> tuple[Any, Any]:
    """Energy (J/m2) that a joint with these stresses can give back, by closure and by shear."""
    half = real(h, 0.5)
    return sn * sn * half / joint.kn, ts * ts * half / joint.ks


@kernel
def take_stresses(h: Memory, ic: int, ix: int, sn: float, ts: float) -> None:
    """Set the stresses of contact `ic` with joint `ix`, and the offset that makes its closure agree."""
    putr(h, ix, g.KCJSN, sn)
    putr(h, ix, g.KCJTS, ts)
    if sn != 0:
        joint = joint_values(h, ic, ix)
        closure = sn / joint.kn - opened_by_dilation(joint, getr(h, ix, g.KCJSLIP))
        putr(h, ix, g.KCJOFF, getr(h, ix, g.KCJOFF) + (closure - getr(h, ix, g.KCJUN)))
        putr(h, ix, g.KCJUN, closure)
