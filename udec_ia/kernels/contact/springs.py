"""Constitutive number 1: a spring normal to the contact, one along it, and Coulomb friction; report 2.6.

    dFn = KN du_n;  no tension: Fn <= 0 or a gap make Fn = Fs = 0, and what the shear spring held is lost
    dFs = KS du_s;  |Fs| <= COH + F Fn, else the contact slips

The normal displacement is the change of the geometric overlap, so that Fn and overlap cannot drift
apart however far a block rolls; the shear displacement is the relative velocity times the time-step.
Stiffness damping adds BETA times the rate of the spring forces to what the blocks feel, never to the
stored forces; it vanishes along a contact that slips and in an open one.

A law is told the contact, which holds its overlap and, still, the forces and the shear displacement before
the step, and returns those after it and the forces of the dashpots.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.layout import offsets as g


@inlined
def lose_shear(h: Memory, ic: int, fs: float) -> None:
    """Contact `ic` opens: friction takes what its shear spring held, on the way to the shear force `fs`."""
    held = getr(h, ic, g.KCFS)
    if held != 0:
        ks = h.cr[g.AKS + iget(h, ic, g.KCM) - 1]
        h.cd[g.WFRIC] += held * fs / (ks + ks)


@inlined
def by_springs(
    h: Memory, ic: int, before: float, closing: float, sliding: float
) -> tuple[float, float, float, float, float]:
    """Forces of contact `ic`, which overlaps, after one step, its shear displacement, and of its dashpots.

    Normal and shear force; displacement; normal and shear force. before: the overlap before the step; that
    after it is in the contact. closing, sliding: relative velocities along the normal and across.
    """
    zero, m = real(h, 0.0), iget(h, ic, g.KCM) - 1
    kn, ks = h.cr[g.AKN + m], h.cr[g.AKS + m]
    held, dus = getr(h, ic, g.KCFS), sliding * h.cr[g.TDEL]
    fn = getr(h, ic, g.KCFN) + kn * (getr(h, ic, g.KCN) - max(before, zero))
    fs = held + ks * dus
    if fn <= zero:
        lose_shear(h, ic, fs)
        fn, fs = zero, zero
    strength = h.cr[g.COH + m] + h.cr[g.AMU + m] * fn
    dashpot = h.cr[g.BETA] * ks * sliding
    if abs(fs) > strength:
        slip = (abs(fs) - strength) / ks
        h.cd[g.WFRIC] += slip * (strength + (held if fs > zero else -held)) * real(h, 0.5)
        fs = strength if fs > zero else -strength
        dashpot = zero
    return fn, fs, getr(h, ic, g.KCS) + dus, h.cr[g.BETA] * kn * closing, dashpot
