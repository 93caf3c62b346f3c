"""What happens between two cycles of a run: blocks are deleted or crack, and the time-step is shortened.

FRACTION f SAFE uses f of a bound for the present contacts. The bound is calculated again in the cycle in
which contacts form, while they are open (in large models a few cycles later: kernels.drive.cycle), and every
1000 cycles, as blocks turn, slide and strain. A step above f of it is reduced to f of it for the rest of the
run: it never grows, so it does not vary as contacts come and go. Updates depend only on the number of the
cycle and the state, not on the division of a run into CYCLEs.

A joint material may become stiffer as it closes or as its length grows. When a joint has a tenth more
stiffness than the step allows for, the step is found again, also without SAFE: it then is a fraction of the
estimate. From then on it allows for the greatest stiffness that each joint has had in the run.

A crack makes masses smaller: the step is found again after each.

Scaled masses are scaled again instead, every hundred cycles and for stiffer joints (running.mass_scaling).
"""

from __future__ import annotations

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_stresses import allow_for_stiffness
from udec_ia.kernels.drive.critical_stiffness import allow_for_volumes
from udec_ia.kernels.drive.cycle import step_check_is_due
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.free_blocks import LOOK_OUTSIDE, delete_departed_blocks
from udec_ia.running.critical_step import bound, estimate
from udec_ia.running.make_cracks import make_cracks
from udec_ia.running.mass_scaling import RESCALE, scale_anew
from udec_ia.running.stiffness_bound import damped_step

JUDGE = 1000  # cycles


def cycles_to_update(array: MainArray, n: int) -> int:
    """Cycles, at most `n`, until the next possible update of the step or the masses."""
    ci = array.h.ci
    every = RESCALE if ci[g.LSCALE] else JUDGE if ci[g.LSAFE] else n
    done = int(ci[g.MCTOT])
    until_look = LOOK_OUTSIDE - done % LOOK_OUTSIDE if ci[g.LOUTS] else n
    return min(n, every - done % every, until_look)


def update_between_cycles(array: MainArray) -> bool:
    """Delete blocks that have left, make cracks, and shorten the time-step or scale masses, if it is due.

    Returns True if blocks were deleted. Errors 1 without memory for cracks, and those of `estimate`.
    """
    deleted = delete_departed_blocks(array)
    due = make_cracks(array) or step_check_is_due(array.h)
    h = array.h
    if h.ci[g.LSCALE]:
        if due or h.ci[g.MCTOT] % RESCALE == 0:
            scale_anew(array)
    elif due or (h.ci[g.LSAFE] and h.ci[g.MCTOT] % JUDGE == 0):
        h.ci[g.MSCALE] = h.ci[g.NMADE]
        allow_for_stiffness(h, False)
        allow_for_volumes(h)
        critical = damped_step(h, bound(array).step) if h.ci[g.LSAFE] else estimate(array).step
        step = float(h.cr[g.FRAC]) * critical
        if np.finfo(array.scheme.real_type).smallest_normal < step < float(h.cr[g.TDEL]):
            put_step(array, step)
    return deleted


def put_step(array: MainArray, step: float) -> None:
    """Set the time-step and the factors of damping. Errors 13 and 16 if damping is too strong for it."""
    h = array.h
    h.cr[g.TDEL] = step
    for alpha, con1, con2, number in ((g.ALPHA, g.CON1, g.CON2, 13), (g.ALPB, g.C1B, g.C2B, 16)):
        half = h.cr[alpha] * h.cr[g.TDEL] / 2
        if half >= 1:
            detail = f"damping coefficient {h.cr[alpha]:g} times time-step {h.cr[g.TDEL]:g} is not below 2"
            raise UdecError(number, detail, "take less damping, a lower frequency or a smaller FRACTION")
        h.cr[con1] = 1 - half
        h.cr[con2] = 1 / (1 + half)
