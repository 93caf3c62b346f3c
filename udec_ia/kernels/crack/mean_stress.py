"""Deformable blocks crack by their stress: in tension, or in shear by the law of Mohr and Coulomb.

A simply-deformable block has one stress, and cracks through its centroid. A fully-deformable block cracks
along zone sides, near the plane through the zone with the greatest stress over strength
(running/zone_path.py). With s1 and s3 the greatest and the least principal stress, tension positive:

    tension    s1 >= T                                                 normal to s1
    shear      (s1 - s3)/2 >= c cos(phi) - sin(phi) (s1 + s3)/2        at 45 - phi/2 from the direction of s3

Tension comes first where both are reached. Of the two planes of shear it takes the one on which the crack is
shorter, the less rock to break.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.kernels.crack.crack_line import Crack, crack_through, no_crack
from udec_ia.kernels.geometry.plane_tensors import first_axis
from udec_ia.layout import offsets as g


@kernel
def failure(h: Memory, ik: int, s11: float, s12: float, s22: float) -> tuple[int, float]:
    """Cause of failure at a stress, 0 for none, and stress over strength. ik: the breakable block."""
    half, one, zero = real(h, 0.5), real(h, 1.0), real(h, 0.0)
    mean, along = (s11 + s22) * half, (s11 - s22) * half
    radius = np.sqrt(along * along + s12 * s12)
    tension, cohesion, friction = getr(h, ik, g.KBKT), getr(h, ik, g.KBKC), getr(h, ik, g.KBKF)
    if tension > 0 and mean + radius >= tension:
        return g.CRACK_BY_TENSION, (mean + radius) / tension
    if cohesion > 0 or friction > 0:
        cosine = one / np.sqrt(one + friction * friction)
        strength = (cohesion - friction * mean) * cosine
        if radius > 0 and radius >= strength:
            return g.CRACK_BY_SHEAR, radius / strength if strength > 0 else real(h, np.inf)
    return 0, zero


@kernel
def plane_of_shear(h: Memory, ik: int, c: float, s: float, sign: float) -> tuple[float, float]:
    """Direction of a plane of shear, where (c, s) is that of the greatest principal stress. sign: 1 or -1."""
    one, friction = real(h, 1.0), getr(h, ik, g.KBKF)
    tangent = (np.sqrt(one + friction * friction) - friction) * sign  # of 45 - phi/2
    size = np.sqrt(one + tangent * tangent)
    return (tangent * c - s) / size, (tangent * s + c) / size


@kernel
def crack_by_stress(h: Memory, ib: int, ik: int) -> Crack:
    """The crack of simply-deformable block `ib` by its stress. ik: the breakable block."""
    ie, x, y = iget(h, ib, g.KBEX), getr(h, ib, g.KX), getr(h, ib, g.KY)
    s11, s12, s22 = getr(h, ie, g.KS111), getr(h, ie, g.KS112), getr(h, ie, g.KS122)
    cause, _ = failure(h, ik, s11, s12, s22)
    if cause == 0:
        return no_crack(h)
    smallest = getr(h, ik, g.KBKA)
    c, s = first_axis(h, s11, s12, s22)
    if cause == g.CRACK_BY_TENSION:
        return crack_through(h, ib, x, y, -s, c, smallest, cause)
    best, one, crack = real(h, np.inf), real(h, 1.0), no_crack(h)
    for sign in (-one, one):
        tx, ty = plane_of_shear(h, ik, c, s, sign)
        found = crack_through(h, ib, x, y, tx, ty, smallest, cause)
        dx, dy = found[3] - found[1], found[4] - found[2]
        if found[0] != 0 and dx * dx + dy * dy < best * real(h, 0.999):  # else last digits would decide
            best, crack = dx * dx + dy * dy, found
    return crack


@kernel
def has_failed_zone(h: Memory, ib: int, ik: int) -> bool:
    """True if a zone of fully-deformable block `ib` has failed. ik: the breakable block."""
    iz = iget(h, iget(h, ib, g.KBEX), g.KFZ)
    while iz != 0:
        if failure(h, ik, getr(h, iz, g.KZS11), getr(h, iz, g.KZS12), getr(h, iz, g.KZS22))[0] != 0:
            return True
        iz = iget(h, iz, g.KZ)
    return False
