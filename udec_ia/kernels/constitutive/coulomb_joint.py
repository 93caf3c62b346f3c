"""Constitutive number 1: a spring normal to the contact, one along it, and Coulomb friction; report 2.6.

    dFn = KN du_n;  no tension: Fn <= 0 or a gap make Fn = Fs = 0, and the energy of the shear spring is lost
    dFs = KS du_s;  |Fs| <= COH + F Fn, else the contact slips

The normal displacement is the change of the geometric overlap, so that Fn and overlap stay consistent however
far a block rolls. The shear displacement is the relative velocity times the time-step. Stiffness damping adds
BETA times the rate of the spring forces to the forces on the blocks, never to the stored forces. It vanishes
along a slipping contact and in an open one.

When the law is called, the contact has its new overlap, but the forces and the shear displacement before the
step. The law returns those after the step, and the forces of the dashpots.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined
from udec_ia.heap.accessors import Memory, getr, real
from udec_ia.kernels.constitutive.joint_properties import Joint, joint_by_material, strength
from udec_ia.layout import offsets as g


@inlined
def lose_shear(h: Memory, ic: int, fs: float) -> None:
    """Contact `ic` opens: add the energy of its shear spring to the friction, at the shear force `fs`."""
    held = getr(h, ic, g.KCFS)
    if held != 0:
        ks = joint_by_material(h, ic).ks
        h.cd[g.WFRIC] += held * fs / (ks + ks)


@inlined
def coulomb_forces(
    h: Memory, ic: int, joint: Joint, before: float, closing: float, sliding: float
) -> tuple[float, float, float, float, float]:
    """Forces of closed contact `ic` after one step, its shear displacement, and the forces of its dashpots.

    Normal and shear force; displacement; normal and shear force. joint: of the contact. before: the overlap
    before the step; the contact has the one after it. closing, sliding: relative velocities along the normal
    and across.
    """
    zero, kn, ks = real(h, 0.0), joint.kn, joint.ks
    held, dus = getr(h, ic, g.KCFS), sliding * h.cr[g.TDEL]
    fn = getr(h, ic, g.KCFN) + kn * (getr(h, ic, g.KCN) - max(before, zero))
    fs = held + ks * dus
    if fn <= zero:
        lose_shear(h, ic, fs)
        fn, fs = zero, zero
    limit = strength(joint, fn)
    dashpot = h.cr[g.BETA] * ks * sliding
    if abs(fs) > limit:
        slip = (abs(fs) - limit) / ks
        h.cd[g.WFRIC] += slip * (limit + (held if fs > zero else -held)) * real(h, 0.5)
        fs = limit if fs > zero else -limit
        dashpot = zero
    return fn, fs, getr(h, ic, g.KCS) + dus, h.cr[g.BETA] * kn * closing, dashpot
