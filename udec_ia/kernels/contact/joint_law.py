"""Contacts that follow a law of the user's (CLJ2 to CLJ5; Appendix IV-4); number 1 is in springs.py.

Such a contact is closed as long as its normal force is positive, whatever its overlap: a joint that dilates
holds its blocks apart. It closes when blocks overlap, and it bears no tension.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined
from udec_ia.compiling.law_calls import FIRST, JOINTS, Laws, call, is_given
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.kernels.body.laws import failed
from udec_ia.layout import offsets as g


@inlined
def has_law(h: Memory, laws: Laws, ic: int) -> bool:
    """True if contact `ic` follows a law of the user's; else it has springs and Coulomb friction."""
    i = iget(h, ic, g.KCC) - FIRST
    return i >= 0 and is_given(laws, i + JOINTS)


@inlined
def force_increment(
    h: Memory, laws: Laws, ic: int, fn: float, fs: float, dun: float, dus: float, un: float, us: float
) -> tuple[float, float]:
    """Increments of normal and shear force in contact `ic` by its law; (0, 0) and error 35 if not finite.

    fn, fs, un, us: forces and displacements before the increments dun, dus; compression and closing positive.
    """
    i, mat = iget(h, ic, g.KCC) - FIRST + JOINTS, iget(h, ic, g.KCM)
    d = call(laws, i, mat, (fn, fs, dun, dus, un, us))
    if failed(h, ic, real(h, d[0]) + real(h, d[1])):
        return real(h, 0.0), real(h, 0.0)
    return real(h, d[0]), real(h, d[1])


@inlined
def is_open(h: Memory, ic: int, overlap: float) -> bool:
    """True if contact `ic` bears no force by its law, or has opened farther than a contact may."""
    return getr(h, ic, g.KCFN) == 0 or overlap < -h.cr[g.BTOL]


@inlined
def by_law(
    h: Memory, laws: Laws, ic: int, before: float, sliding: float
) -> tuple[float, float, float, float, float]:
    """As by_springs, by the law of the user's that contact `ic` follows.

    Stiffness damping is BETA times the rate of the forces. WFRIC grows by the work that the springs KN and KS
    have not kept.
    """
    zero, half = real(h, 0.0), real(h, 0.5)
    fn, fs, overlap, us = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS), getr(h, ic, g.KCN), getr(h, ic, g.KCS)
    if fn == zero:
        if overlap <= zero:
            return zero, zero, zero, zero, zero
        before = max(before, zero)
    dt = h.cr[g.TDEL]
    dun, dus = overlap - before, sliding * dt
    dfn, dfs = force_increment(h, laws, ic, fn, fs, dun, dus, before, us)
    m = iget(h, ic, g.KCM) - 1
    if fn + dfn <= zero:
        h.cd[g.WFRIC] += fs * (dus + fs / h.cr[g.AKS + m]) * half
        return zero, zero, zero, zero, zero
    lost = (fn + dfn * half) * (dun - dfn / h.cr[g.AKN + m]) + (fs + dfs * half) * (
        dus - dfs / h.cr[g.AKS + m]
    )
    h.cd[g.WFRIC] += lost
    rate = h.cr[g.BETA] / dt
    return fn + dfn, fs + dfs, us + dus, rate * dfn, rate * dfs
