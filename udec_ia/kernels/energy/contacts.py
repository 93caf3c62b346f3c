"""Works of a contact in a step (ENERGY ON): what springs lose, dashpots take, and the blocks' shapes give.

The contact pass tells of a contact when all that it is going to feel is known and it still holds what it felt
before. What sliding takes is summed by the laws themselves: a run that gains energy from nowhere is found by
it, too (advice/energy_monitor.py).
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, real
from udec_ia.kernels.constitutive.joint_properties import is_stuck, joint_of
from udec_ia.layout import offsets as g

Pair = tuple[float, float]


@inlined
def note_corners(h: Memory, ic: int, fn: float, closing: float, grown: float) -> None:
    """Work against the normal force of contact `ic`, which becomes `fn`, that its overlap does not show.

    closing: velocity at which the blocks approach. grown: what the overlap has grown by. Rigid blocks keep
    their shape: what differs there is an error of the step.
    """
    if iget(h, iget(h, ic, g.KB1), HEAD) != g.MRIG or iget(h, iget(h, ic, g.KB2), HEAD) != g.MRIG:
        mean = (getr(h, ic, g.KCFN) + fn) * real(h, 0.5)
        h.cd[g.WSHAPE] += mean * (closing * h.cr[g.TDEL] - grown)


@inlined
def note_damping(h: Memory, ic: int, was: Pair, now: Pair, slips: bool) -> None:
    """What the dashpots of contact `ic` take in this step.

    was: closing and sliding velocity that they answered to half a step ago. now: closing and sliding
    velocity now. slips: whether the dashpot along the contact answers to nothing now.
    """
    (closing, sliding), joint, zero = now, joint_of(h, ic), real(h, 0.0)
    across = (was[1] if is_stuck(h, ic) else zero) + (zero if slips else sliding)
    done = joint.kn * closing * (was[0] + closing) + joint.ks * sliding * across
    h.cd[g.WSTIF] += h.cr[g.BETA] * h.cr[g.TDEL] * real(h, 0.5) * done


@outlined
def note_contact(
    h: Memory, ic: int, own: bool, before: float, normal: Pair, velocity: Pair, forces: Pair, dashpots: Pair
) -> bool:
    """What contact `ic` takes and gives in this step; it holds what it felt before, and its overlap of now.

    own: whether it follows a law of the user's. before: its overlap before. velocity: of block KB2 relative
    to KB1. forces, dashpots: normal and shear force of now.
    """
    (nx, ny), (xd, yd), (fn, _) = normal, velocity, forces
    closing, sliding = -(xd * nx + yd * ny), yd * nx - xd * ny
    zero, overlap = real(h, 0.0), getr(h, ic, g.KCN)
    if own:
        h.cd[g.WSTIF] += (dashpots[0] * closing + dashpots[1] * sliding) * h.cr[g.TDEL]
        if fn != zero and (before > zero or getr(h, ic, g.KCFN) != zero):
            note_corners(h, ic, fn, closing, overlap - before)
        return True
    if fn != zero and before > zero:
        note_corners(h, ic, fn, closing, overlap - before)
    if h.cr[g.BETA] != zero:
        was = zero, zero
        if before > zero:
            was_x, was_y = getr(h, ic, g.KXDC), getr(h, ic, g.KYDC)
            was = -(was_x * nx + was_y * ny), was_y * nx - was_x * ny
        note_damping(h, ic, was, (closing, sliding), dashpots[1] == zero)
    return True
