"""What the time-step needs to know of the whole model, in one walk each."""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, real
from udec_ia.kernels.constitutive.joint_properties import joint_of, stiffest
from udec_ia.layout import offsets as g


@kernel
def smallest_mass(h: Memory) -> tuple[float, int, int]:
    """Least mass of a free block (of any if none is free), that block, and a block without mass or 0."""
    free, smallest = real(h, np.inf), real(h, np.inf)
    at_free, at_smallest, massless = int64(0), int64(0), int64(0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        mass = getr(h, ib, g.KBM)
        if not mass > 0:
            massless = ib
        if mass < smallest:
            smallest, at_smallest = mass, ib
        if iget(h, ib, g.KBFIX) == 0 and mass < free:
            free, at_free = mass, ib
        ib = iget(h, ib, g.KB)
    if at_free == 0:
        return smallest, at_smallest, massless
    return free, at_free, massless


@kernel
def greatest_stiffness(h: Memory) -> tuple[float, int]:
    """Greatest joint stiffness of a contact, and a contact without stiffness or 0."""
    largest = real(h, 0.0)
    undefined = int64(0)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        joint = joint_of(h, ic)
        if not min(joint.kn, joint.ks) > 0:
            undefined = ic
        largest = max(largest, stiffest(joint))
        ic = iget(h, ic, g.KC)
    return largest, undefined
