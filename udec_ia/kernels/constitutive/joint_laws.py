"""Joint laws by constitutive number: springs and Coulomb friction (1), the user's (2 to 5), and others.

The contact pass gets the forces of a contact from this file. Number 1, and a number without a joint law, is
coulomb_joint.py. All others have a law of their own, which returns increments of the forces. It does not
depend on the map, the energy account or the dashpots. Such a law is one function, called in
`force_increments`:

    a user's law              CLJ2 to CLJ5 (Appendix IV-4), called by its address
    a law of the program      a number above these, and one branch in `force_increments`

A contact with a law of its own is closed as long as its normal force is positive, whatever its overlap, since
dilation may hold the blocks apart. It closes when blocks overlap, and it has no tensile strength.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined
from udec_ia.compiling.law_calls import FIRST, JOINTS, Laws, call, is_given
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.kernels.constitutive.block_laws import has_failed
from udec_ia.kernels.constitutive.coulomb_joint import coulomb_forces
from udec_ia.kernels.constitutive.joint_properties import (
    Joint,
    joint_by_material,
    material_of,
    stiffest,
)
from udec_ia.kernels.constitutive.joint_stresses import joint_in_step
from udec_ia.kernels.links.longer_groups import joint_at
from udec_ia.layout import offsets as g


@inlined
def has_own_law(h: Memory, laws: Laws, ic: int) -> bool:
    """True if contact `ic`, which has no joint material, has a law of its own."""
    i = iget(h, ic, g.KCC) - FIRST
    return i >= JOINTS or (i >= 0 and is_given(laws, i + JOINTS))


@inlined
def force_increments(
    h: Memory, laws: Laws, ic: int, fn: float, fs: float, dun: float, dus: float, un: float, us: float
) -> tuple[float, float]:
    """Increments of normal and shear force in contact `ic` by the law of its number.

    fn, fs, un, us: forces and displacements before the increments dun, dus; compression and closing positive.
    """
    i = iget(h, ic, g.KCC) - FIRST + JOINTS
    d = call(laws, i, material_of(h, ic), (fn, fs, dun, dus, un, us))
    return real(h, d[0]), real(h, d[1])


@inlined
def own_forces(
    h: Memory, laws: Laws, ic: int, joint: Joint, before: float, sliding: float
) -> tuple[float, float, float, float, float]:
    """Forces as of coulomb_forces, by the law of contact `ic`.

    Increments that are not finite are 0, and error 35. Stiffness damping is BETA times the rate of the
    forces. WFRIC grows by the work that the springs KN and KS do not store.
    """
    zero, half = real(h, 0.0), real(h, 0.5)
    fn, fs, overlap, us = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS), getr(h, ic, g.KCN), getr(h, ic, g.KCS)
    if fn == zero:
        if overlap <= zero:
            return zero, zero, zero, zero, zero
        before = max(before, zero)
    dt = h.cr[g.TDEL]
    dun, dus = overlap - before, sliding * dt
    dfn, dfs = force_increments(h, laws, ic, fn, fs, dun, dus, before, us)
    if has_failed(h, ic, dfn + dfs):
        dfn, dfs = zero, zero
    if fn + dfn <= zero:
        h.cd[g.WFRIC] += fs * (dus + fs / joint.ks) * half
        return zero, zero, zero, zero, zero
    lost = (fn + dfn * half) * (dun - dfn / joint.kn) + (fs + dfs * half) * (dus - dfs / joint.ks)
    h.cd[g.WFRIC] += lost
    rate = h.cr[g.BETA] / dt
    return fn + dfn, fs + dfs, us + dus, rate * dfn, rate * dfs


@inlined
def joint_forces(
    h: Memory, laws: Laws | None, ic: int, own: bool, before: float, closing: float, sliding: float
) -> tuple[float, float, float, float, float]:
    """Normal and shear force of contact `ic` after a step, shear displacement, and forces of its dashpots.

    laws: None in a pass with number 1 only. own: of `has_own_law`. before: overlap before the step; the
    contact has the one after it. closing, sliding: relative velocities along the normal and across.
    """
    joint = joint_by_material(h, ic)
    if laws is not None and own:
        return own_forces(h, laws, ic, joint, before, sliding)
    return coulomb_forces(h, ic, joint, before, closing, sliding)


@inlined
def is_idle(h: Memory, ic: int, own: bool, overlap: float) -> bool:
    """True if contact `ic` carries no force with that overlap, or, with its own law, is open by BTOL."""
    if own:
        return getr(h, ic, g.KCFN) == 0 or overlap < -h.cr[g.BTOL]
    return overlap <= 0 or getr(h, ic, g.KCFN) == 0


@inlined
def reset_forces(h: Memory, ic: int) -> None:
    """Reset the forces of contact `ic` and the state of its law."""
    zero = real(h, 0.0)
    putr(h, ic, g.KCFN, zero)
    putr(h, ic, g.KCFS, zero)
    putr(h, ic, g.KCS, zero)


@inlined
def bounding_stiffness(h: Memory, ic: int) -> tuple[float, float]:
    """Normal and shear stiffness (N/m2) of contact `ic` that its law does not exceed.

    A joint material that later does sets LSTIFF. With a law of its own a contact may be as stiff as the
    greater one of KN and KS in every direction.
    """
    joint = joint_in_step(h, ic)
    if joint_at(h, ic) != 0 or iget(h, ic, g.KCC) < FIRST:
        return joint.kn, joint.ks
    return stiffest(joint), stiffest(joint)
