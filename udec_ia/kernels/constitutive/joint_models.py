"""Joint models: stresses of a joint from its closure and its shear displacement (report 2.4; JPROPERTY).

A model is one function. It gets the joint of a contact, which has the stresses and the state before a
step, and returns the stresses after it. `joint_stresses` calls the model of the joint material:

    COULOMB_JOINT          Coulomb friction with cohesion, tensile strength, residual strength and dilation
    CONTINUOUSLY_YIELDING  continuously_yielding.py
    BARTON_BANDIS          barton_bandis.py
    JOINT_LAW2 ... 5       a law of the user, jl2 to jl5

Each model also has the functions below: the closure under a stress, the stiffness in its present state, the
energy that it can give back, and its friction. Compression and closing are positive. The normal stress is a
function of the closure, so that it does not drift as a joint opens and closes. Shear stress is summed up by
increments.

A joint material per contact has forces for stresses: its length is 1. Joint material -1 stands for a contact
with the properties of its material (PROPERTY) that INSITU has given an initial force.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.law_calls import Laws, call_joint
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.kernels.constitutive.barton_bandis import (
    barton_closure,
    barton_energy,
    barton_friction,
    barton_joint,
    barton_stiffness,
    remember_stress,
)
from udec_ia.kernels.constitutive.block_laws import has_failed
from udec_ia.kernels.constitutive.continuously_yielding import (
    yielding_closure,
    yielding_energy,
    yielding_friction,
    yielding_joint,
    yielding_stiffness,
)
from udec_ia.kernels.constitutive.joint_materials import (
    MATERIALS,
    clear_flag,
    has_ends,
    has_flag,
    rounding_noise,
    set_flag,
)
from udec_ia.kernels.constitutive.joint_properties import joint_by_material
from udec_ia.kernels.links.longer_groups import contact_of
from udec_ia.layout import offsets as g

WEAK = g.JOINT_SLIPPED | g.JOINT_BROKEN


class JointValues(NamedTuple):
    """Properties of a joint, per length or per contact: those of JPROPERTY.

    model: COULOMB_JOINT ... JOINT_LAW5. m: index of its joint material; negative without one.
    """

    model: Any
    m: Any
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
def joint_model(h: Memory, ix: int) -> int:
    """The model of joint `ix`: COULOMB_JOINT ... JOINT_LAW5."""
    m = iget(h, ix, g.KCJMAT) - 1
    return int64(h.ci[g.JMLAW + m]) if m >= 0 else int64(g.COULOMB_JOINT)


@inlined
def joint_values(h: Memory, ic: int, ix: int) -> JointValues:
    """Properties of joint `ix` of contact `ic`.

    YIELDING and BARTON have no cohesion and no tensile strength.
    """
    model, m, zero = joint_model(h, ix), iget(h, ix, g.KCJMAT) - 1, real(h, 0.0)
    if m < 0:
        kn, ks, cohesion, friction = joint_by_material(h, ic)
        return JointValues(model, m, kn, ks, friction, cohesion, zero, zero, zero, friction, cohesion)
    friction, residual_friction = h.cr[g.JMMU + m], h.cr[g.JMRMU + m]
    cohesion, residual_cohesion = h.cr[g.JMCOH + m], h.cr[g.JMRCO + m]
    tension = h.cr[g.JMTEN + m]
    if model == g.CONTINUOUSLY_YIELDING or model == g.BARTON_BANDIS:
        cohesion, tension = zero, zero
    return JointValues(
        model,
        m,
        h.cr[g.JMKN + m],
        h.cr[g.JMKS + m],
        friction,
        cohesion,
        tension,
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
    """Shear strength under the normal stress `sn`. weak: the joint has slipped or opened before.

    Under tension less friction would be more strength: there the residual strength does not exceed the peak.
    """
    peak, zero = joint.cohesion + joint.friction * sn, real(h, 0.0)
    if not weak:
        return max(peak, zero)
    residual = joint.residual_cohesion + joint.residual_friction * sn
    return max(min(residual, peak) if sn < zero else residual, zero)


@kernel
def find_strengths(h: Memory, joints: Any, found: Any) -> None:
    """found (n,) := shear strengths (Pa; N/m per contact) of `joints` (n,); NaN unless of COULOMB."""
    for k in range(len(joints)):
        ix = joints[k]
        joint, sn = joint_values(h, contact_of(h, ix), ix), getr(h, ix, g.KCJSN)
        found[k] = np.nan
        if joint.model == g.COULOMB_JOINT:
            normal = average_stress(h, ix, sn) if has_ends(h, ix) else sn
            found[k] = coulomb_strength(h, joint, has_flag(h, ix, WEAK), normal)


@kernel
def average_stress(h: Memory, ix: int, sn: float) -> float:
    """Normal stress that the strength of joint `ix`, in the report's form, depends on (edge_to_edge.py).

    It is the average of the ends of its joints, and `sn` on the length of its own, or where the other end is
    open.
    """
    ic, own = contact_of(h, ix), getr(h, ix, g.KCJOWN)
    length = own + own
    total = length * sn
    for p, idm, flag in (
        (getr(h, ix, g.KCJP1), iget(h, ic, g.KD1), g.OPENS_BESIDE1),
        (getr(h, ix, g.KCJP2), iget(h, ic, g.KD2), g.OPENS_BESIDE2),
    ):
        ie = iget(h, idm, g.KDEX)
        if p > 0 and ie != 0:
            length += p
            total += p * (sn if has_flag(h, ix, flag) else getr(h, ie, g.KJSN))
    return total / length if length > 0 else sn


@inlined
def opening_tension(h: Memory, ix: int, joint: JointValues) -> Any:
    """Tension (Pa) at which joint `ix` opens; 0 once it is broken, and for YIELDING and BARTON."""
    linear = joint.model != g.CONTINUOUSLY_YIELDING and joint.model != g.BARTON_BANDIS
    if has_flag(h, ix, g.JOINT_BROKEN) or not linear:
        return real(h, 0.0)
    return joint.tension + joint.kn * rounding_noise(h)


@inlined
def plastic_slip(h: Memory, ix: int, joint: JointValues, trial: float, limit: float) -> Any:
    """Plastic shear displacement that takes the shear stress `trial` back to the strength.

    limit: strength without it. It rises as the joint dilates.
    """
    slip, gain = getr(h, ix, g.KCJSLIP), real(h, 0.0)
    if joint.dilation > 0 and not has_ends(h, ix) and (joint.critical == 0 or abs(slip) < joint.critical):
        weak = has_flag(h, ix, WEAK)
        friction = joint.residual_friction if weak else joint.friction
        gain = friction * joint.kn * joint.dilation
        if slip * trial < 0:  # slip back, which closes the joint; KS + gain stays above 0
            gain = max(-gain, real(h, -0.5) * joint.ks)
    size = (abs(trial) - limit) / (joint.ks + gain)
    return size if trial > 0 else -size


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
    if sn <= zero and (sn <= -joint.tension or has_flag(h, ix, g.JOINT_BROKEN)):
        if sn <= -opening_tension(h, ix, joint):
            set_flag(h, ix, g.JOINT_BROKEN)
        putr(h, ix, g.KCJSLIP, slip + held / joint.ks)
        return zero, zero
    trial = held + joint.ks * sliding
    normal = average_stress(h, ix, sn) if has_ends(h, ix) else sn
    limit = coulomb_strength(h, joint, has_flag(h, ix, WEAK), normal)
    if abs(trial) <= limit:
        return sn, trial
    set_flag(h, ix, g.JOINT_SLIPS)
    slipped = plastic_slip(h, ix, joint, trial, limit)
    if abs(slip + slipped) > rounding_noise(h):
        set_flag(h, ix, g.JOINT_SLIPPED)
        slipped = plastic_slip(h, ix, joint, trial, coulomb_strength(h, joint, True, normal))
    putr(h, ix, g.KCJSLIP, slip + slipped)
    return joint.kn * (closure + opened_by_dilation(joint, slip + slipped)), trial - joint.ks * slipped


SOON = 4.0  # cycles: the neighbours of a contact know two cycles later that it opens


@inlined
def opens_soon(h: Memory, before: float, closure: float) -> bool:
    """True if a joint is open, or will be soon.

    before, closure: how far it is from opening, in the last cycle and now, as a closure or as a stress.
    """
    return closure <= 0 or closure + real(h, SOON) * (closure - before) <= 0


@kernel
def find_short_steps(h: Memory) -> None:
    """Which short steps the joints of each joint material can take: `stays_open` and `closed_step`."""
    for m in range(MATERIALS):
        code = int64(0)
        if h.ci[g.JMLAW + m] == g.COULOMB_JOINT and h.cr[g.JMDIL + m] == 0:
            code |= g.SPRINGS_ALONE
        if h.ci[g.JMUNIT + m] != g.PER_LENGTH_AT_ENDS:
            code |= g.LINEAR_BETWEEN
        h.ci[g.JMSHORT + m] = code


@inlined
def stays_open(h: Memory, ic: int, ix: int, overlap: float) -> bool:
    """True if joint `ix` of contact `ic` carries nothing before and after a step, so that it keeps its state.

    This is `coulomb_joint` without dilation for a joint that is open and broken, or unloaded and without
    tensile strength. Its length can wait. overlap: after the step.
    """
    m = iget(h, ix, g.KCJMAT) - 1
    if m >= 0 and (h.ci[g.JMSHORT + m] & g.SPRINGS_ALONE == 0 or h.cr[g.JMTEN + m] != 0):
        return False
    if getr(h, ix, g.KCJSN) != 0 or getr(h, ic, g.KCFN) != 0 or has_flag(h, ix, g.JOINT_SLIPS):
        return False
    closure, state = (
        overlap + getr(h, ix, g.KCJOFF),
        iget(h, ix, g.KCJFLAG) & (g.JOINT_BROKEN | g.JOINT_OPENS),
    )
    if state == g.JOINT_BROKEN | g.JOINT_OPENS:
        return closure <= 0
    return state == 0 and -rounding_noise(h) < closure <= 0


@inlined
def closed_step(
    h: Memory, ic: int, ix: int, before: float, closure: float, sliding: float
) -> tuple[bool, float, float]:
    """True, and the stresses of joint `ix` of contact `ic` after a step, if it is closed; else False.

    This is `coulomb_joint` for a joint that is closed before and after the step and does not open soon, does
    not dilate, is linear between contacts, and has no cohesion if a neighbour is open. It holds, or has
    slipped before. Most steps are of this kind. before, closure: closures before and after the step.
    """
    zero, m, state = real(h, 0.0), iget(h, ix, g.KCJMAT) - 1, iget(h, ix, g.KCJFLAG)
    tension, weak = zero, state & WEAK != 0
    if m < 0:
        kn, ks, cohesion, friction = joint_by_material(h, ic)
    else:
        if h.ci[g.JMSHORT + m] != g.SPRINGS_ALONE | g.LINEAR_BETWEEN:
            return False, zero, zero
        kn, ks, cohesion, friction = h.cr[g.JMKN + m], h.cr[g.JMKS + m], h.cr[g.JMCOH + m], h.cr[g.JMMU + m]
        tension = h.cr[g.JMTEN + m]
        if weak:
            if h.cr[g.JMRMU + m] >= 0:
                friction = h.cr[g.JMRMU + m]
            if h.cr[g.JMRCO + m] >= 0:
                cohesion = h.cr[g.JMRCO + m]
    sn, held = kn * closure, getr(h, ix, g.KCJTS)
    had, broken = getr(h, ix, g.KCJSN), state & g.JOINT_BROKEN != 0
    if state & g.JOINT_OPENS != 0 or not is_held_closed(h, broken, had, sn, kn * before, tension):
        return False, zero, zero
    if sn < 0 and weak:  # the peak strength counts as well
        return False, zero, zero
    beside = state & (g.OPENS_BESIDE1 | g.OPENS_BESIDE2) != 0
    if beside and cohesion > 0:  # which acts along all that is closed
        return False, zero, zero
    ts, limit = held + ks * sliding, cohesion + friction * sn
    if abs(ts) > limit:
        if not weak:
            return False, zero, zero
        trial, half = ts, real(h, 0.5)
        ts = limit if trial > 0 else -limit
        putr(h, ix, g.KCJSLIP, getr(h, ix, g.KCJSLIP) + (trial - ts) / ks)
        if not beside:  # else its length changes in this step as well
            h.cd[g.WFRIC] += getr(h, ix, g.KCJL) * (held + ts) * (sliding - (ts - held) / ks) * half
        set_flag(h, ix, g.JOINT_SLIPS)
    elif state & g.JOINT_SLIPS != 0:
        clear_flag(h, ix, g.JOINT_SLIPS)
    putr(h, ix, g.KCJSN, sn)
    putr(h, ix, g.KCJTS, ts)
    return True, sn, ts


@inlined
def is_held_closed(h: Memory, broken: bool, had: float, sn: float, before: float, tension: float) -> bool:
    """True if a joint is closed and does not open soon.

    had: normal stress before. sn, before: KN times closure, now and before.
    """
    if sn > 0 and (had > 0 or not broken) and not opens_soon(h, before, sn):
        return True
    return not broken and tension > 0 and had > -tension and not opens_soon(h, before + tension, sn + tension)


@kernel
def users_joint(
    h: Memory, laws: Laws, ix: int, joint: JointValues, before: float, closure: float, sliding: float
) -> tuple[float, float]:
    """Stresses of joint `ix` by a law of the user. A normal stress of 0 is an open joint.

    The stresses stay, and error 35, if a result is not finite. before: closure before the step.
    """
    ic, sn0, ts0 = contact_of(h, ix), getr(h, ix, g.KCJSN), getr(h, ix, g.KCJTS)
    one, two, three = getr(h, ix, g.KCJV1), getr(h, ix, g.KCJV2), getr(h, ix, g.KCJV3)
    state = (sn0, ts0, closure - before, sliding, before, getr(h, ic, g.KCS), one, two, three)
    found = call_joint(laws, joint.model - g.JOINT_LAW2, joint.m, state)
    if has_failed(h, ic, found[0] + found[1] + found[2] + found[3] + found[4]):
        return sn0, ts0
    sn, ts = real(h, found[0]), real(h, found[1])
    putr(h, ix, g.KCJV1, real(h, found[2]))
    putr(h, ix, g.KCJV2, real(h, found[3]))
    putr(h, ix, g.KCJV3, real(h, found[4]))
    plastic = ts0 / joint.ks
    if sn == 0:
        ts = real(h, 0.0)
        set_flag(h, ix, g.JOINT_BROKEN)
    else:
        plastic += sliding - ts / joint.ks
        if sn < 0:
            clear_flag(h, ix, g.JOINT_BROKEN)
    putr(h, ix, g.KCJSLIP, getr(h, ix, g.KCJSLIP) + plastic)
    return sn, ts


@inlined
def joint_stresses(
    h: Memory, laws: Laws, ix: int, joint: JointValues, before: float, closure: float, sliding: float
) -> tuple[float, float]:
    """Normal and shear stress of joint `ix` after a step, by the model of its joint material."""
    if joint.model >= g.JOINT_LAW2:
        return users_joint(h, laws, ix, joint, before, closure, sliding)
    if joint.model == g.CONTINUOUSLY_YIELDING:
        return yielding_joint(h, ix, joint.m, closure, sliding)
    if joint.model == g.BARTON_BANDIS:
        return barton_joint(h, ix, joint.m, closure, sliding)
    return coulomb_joint(h, ix, joint, closure, sliding)


@inlined
def closure_under(h: Memory, ix: int, joint: JointValues, sn: float) -> Any:
    """Closure of joint `ix` under the normal stress `sn`."""
    if joint.model == g.CONTINUOUSLY_YIELDING:
        return yielding_closure(h, joint.m, sn)
    if joint.model == g.BARTON_BANDIS:
        return barton_closure(h, ix, joint.m, sn)
    if joint.model >= g.JOINT_LAW2:
        return sn / joint.kn
    return sn / joint.kn - opened_by_dilation(joint, getr(h, ix, g.KCJSLIP))


@inlined
def stiffness_under(h: Memory, joint: JointValues, sn: float) -> tuple[Any, Any]:
    """Greatest normal and shear stiffness that a joint has under the normal stress `sn`, in Pa/m."""
    if joint.model == g.CONTINUOUSLY_YIELDING:
        return yielding_stiffness(h, joint.m, sn)
    if joint.model == g.BARTON_BANDIS:
        return barton_stiffness(h, joint.m, sn), joint.ks
    return joint.kn, joint.ks


@inlined
def greatest_stiffness_given(h: Memory, joint: JointValues) -> tuple[Any, Any]:
    """KNMAX and KSMAX of a joint, Pa/m; 0 without."""
    if joint.model == g.COULOMB_JOINT:
        return real(h, 0.0), real(h, 0.0)
    return h.cr[g.JMKN2 + joint.m], h.cr[g.JMKS2 + joint.m]


@inlined
def friction_under(h: Memory, ix: int, joint: JointValues, sn: float) -> Any:
    """Friction coefficient of joint `ix` in its present state under the normal stress `sn`."""
    if joint.model == g.CONTINUOUSLY_YIELDING:
        return yielding_friction(h, ix, joint.m)
    if joint.model == g.BARTON_BANDIS:
        return barton_friction(h, joint.m, sn)
    return joint.friction


@inlined
def elastic_energy(h: Memory, joint: JointValues, sn: float, ts: float) -> tuple[Any, Any]:
    """Energy (J/m2) that a joint with these stresses can give back, by closure and by shear."""
    half = real(h, 0.5)
    if joint.model == g.CONTINUOUSLY_YIELDING:
        return yielding_energy(h, joint.m, sn, ts)
    shear = ts * ts * half / joint.ks
    if joint.model == g.BARTON_BANDIS:
        return barton_energy(h, joint.m, sn), shear
    return sn * sn * half / joint.kn, shear


@inlined
def closure_of(h: Memory, ix: int) -> float:
    """Closure of joint `ix`: the overlap of its contact, and the offset."""
    return getr(h, contact_of(h, ix), g.KCN) + getr(h, ix, g.KCJOFF)


@inlined
def free_closure(h: Memory, ix: int, joint: JointValues) -> Any:
    """Closure of joint `ix` without normal stress."""
    return closure_under(h, ix, joint, real(h, 0.0))


@inlined
def opening_closure(h: Memory, ix: int, joint: JointValues) -> Any:
    """Closure below which joint `ix` opens: at its tensile strength, or without stress if it is broken."""
    return closure_under(h, ix, joint, -opening_tension(h, ix, joint))


@kernel
def set_stresses(h: Memory, ic: int, ix: int, sn: float, ts: float) -> None:
    """Set the stresses of contact `ic` with joint `ix`, and the offset that makes its closure agree."""
    putr(h, ix, g.KCJSN, sn)
    putr(h, ix, g.KCJTS, ts)
    joint = joint_values(h, ic, ix)
    if sn != 0 or closure_of(h, ix) > closure_under(h, ix, joint, sn):
        if joint.model == g.BARTON_BANDIS:
            remember_stress(h, ix, sn)
        putr(h, ix, g.KCJOFF, closure_under(h, ix, joint, sn) - getr(h, ic, g.KCN))


@kernel
def begin_model(h: Memory, ix: int) -> None:
    """Joint `ix` gets another model: its state is that at first. Without stress it is not closed."""
    zero, closure = real(h, 0.0), closure_of(h, ix)
    putr(h, ix, g.KCJV1, zero)
    putr(h, ix, g.KCJV2, zero)
    putr(h, ix, g.KCJV3, zero)
    if getr(h, ix, g.KCJSN) == 0 and closure > 0:
        putr(h, ix, g.KCJOFF, getr(h, ix, g.KCJOFF) - closure)
