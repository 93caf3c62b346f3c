"""Joint models: stresses of a joint from its closure and its shear displacement (report 2.4; JPROPERTY).

A model is one function. It gets the extension of a contact, which has the stresses and the state before a
step, and returns the stresses after it. `joint_stresses` calls the model of the joint material:

    COULOMB_JOINT   Coulomb friction with cohesion, tensile strength, residual strength and dilation

Compression and closing are positive. The normal stress is a function of the closure, so that it does not drift
as a joint opens and closes. Shear stress is summed up by increments.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.kernels.constitutive.joint_materials import has_flag, set_flag
from udec_ia.layout import offsets as g


@inlined
def opened_by_dilation(h: Memory, m: int, slip: float) -> float:
    """Opening of a joint of material `m` + 1 by its plastic shear displacement `slip`."""
    critical, length = h.cr[g.JMCRIT + m], abs(slip)
    return h.cr[g.JMDIL + m] * (min(length, critical) if critical > 0 else length)


@inlined
def coulomb_strength(h: Memory, m: int, weak: bool, sn: float) -> float:
    """Shear strength under the normal stress `sn`. weak: the joint has slipped or opened before."""
    cohesion, friction = h.cr[g.JMCOH + m], h.cr[g.JMMU + m]
    if weak:
        cohesion = h.cr[g.JMRCO + m]
        friction = h.cr[g.JMRMU + m] if h.cr[g.JMRMU + m] >= 0 else friction
    return max(cohesion + friction * sn, real(h, 0.0))


@kernel
def coulomb_joint(h: Memory, ix: int, m: int, closure: float, sliding: float) -> tuple[float, float]:
    """Springs, and the Coulomb strength c + f sn; peak strength until the first slip or opening.

        sn = KN (closure + opening by dilation),  at least -T until it breaks, at least 0 from then on
        ts grows by KS times the slip, up to the strength; what is more is plastic shear displacement

    A joint that breaks, or is open, has no shear stress. closure: at the end of the step. sliding: shear
    displacement in the step.
    """
    zero, kn, ks = real(h, 0.0), h.cr[g.JMKN + m], h.cr[g.JMKS + m]
    slip, held = getr(h, ix, g.KJSLIP), getr(h, ix, g.KJTS)
    sn = kn * (closure + opened_by_dilation(h, m, slip))
    if sn <= zero and (has_flag(h, ix, g.JOINT_BROKEN) or sn < -h.cr[g.JMTEN + m]):
        set_flag(h, ix, g.JOINT_BROKEN)
        putr(h, ix, g.KJSLIP, slip + held / ks)
        return zero, zero
    trial = held + ks * sliding
    limit = coulomb_strength(h, m, has_flag(h, ix, g.JOINT_SLIPPED | g.JOINT_BROKEN), sn)
    if abs(trial) <= limit:
        return sn, trial
    set_flag(h, ix, g.JOINT_SLIPPED | g.JOINT_SLIPS)
    limit = coulomb_strength(h, m, True, sn)
    ts = limit if trial > zero else -limit
    putr(h, ix, g.KJSLIP, slip + (trial - ts) / ks)
    return sn, ts


@inlined
def joint_stresses(h: Memory, ix: int, closure: float, sliding: float) -> tuple[float, float]:
    """Normal and shear stress of extension `ix` after a step, by the model of its joint material."""
    m = iget(h, ix, g.KJMAT) - 1
    return coulomb_joint(h, ix, m, closure, sliding)


@kernel
def take_stresses(h: Memory, ix: int, sn: float, ts: float) -> None:
    """Set the stresses of extension `ix`, and the offset with which its closure goes with them."""
    m = iget(h, ix, g.KJMAT) - 1
    putr(h, ix, g.KJSN, sn)
    putr(h, ix, g.KJTS, ts)
    if sn != 0:
        closure = sn / h.cr[g.JMKN + m] - opened_by_dilation(h, m, getr(h, ix, g.KJSLIP))
        putr(h, ix, g.KJOFF, getr(h, ix, g.KJOFF) + (closure - getr(h, ix, g.KJUN)))
        putr(h, ix, g.KJUN, closure)


@inlined
def elastic_energy(h: Memory, ix: int, sn: float, ts: float) -> tuple[float, float]:
    """Energy (J/m2) that a joint with these stresses can give back, by closure and by shear."""
    m, half = iget(h, ix, g.KJMAT) - 1, real(h, 0.5)
    return sn * sn * half / h.cr[g.JMKN + m], ts * ts * half / h.cr[g.JMKS + m]
