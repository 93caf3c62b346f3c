"""The critical time-step of deformable blocks: of their internal modes and of grid-points.

The 1980 estimate is 2 sqrt(M/K) with a mass and the stiffness that acts on it (4.6: only approximate):

    simply-deformable    M least principal value of the Euler tensor, K = A (K + 4G/3), the uniaxial mode
    fully-deformable     M mass of a grid-point, K stiffness of its zones and of the contacts that act on it
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, real
from udec_ia.kernels.body.fdef import gradient
from udec_ia.kernels.constitutive.joint_properties import joint_of, stiffest
from udec_ia.kernels.links.lists import corner_of
from udec_ia.layout import offsets as g


@kernel
def addresses(h: Memory, first: int, link: Any) -> Any:
    """Addresses of the groups of a chain, in its order: `first` (0: none) and those that `link` leads to."""
    n, iad = 0, int64(first)
    while iad != 0:
        n += 1
        iad = iget(h, iad, link)
    found = np.empty(n, np.int64)
    iad = int64(first)
    for i in range(n):
        found[i] = iad
        iad = iget(h, iad, link)
    return found


@kernel
def internal_mode(h: Memory, ib: int) -> float:
    """Mass over stiffness of the stiffest internal mode of simply-deformable block `ib`."""
    ie = iget(h, ib, g.KBEX)
    j11, j12, j22 = getr(h, ie, g.KSJ11), getr(h, ie, g.KSJ12), getr(h, ie, g.KSJ22)
    half = real(h, 0.5)
    mean, diff = (j11 + j22) * half, (j11 - j22) * half
    smallest = mean - np.sqrt(diff * diff + j12 * j12)
    return smallest / (getr(h, ie, g.KSAREA) * h.cr[g.ALAM1 + iget(h, ib, g.KMAT) - 1])


@kernel
def zone_stiffness(h: Memory, ib: int, stiffness: Any) -> None:
    """Add the stiffness of every zone of block `ib` at its grid-points; `stiffness`: one real an address."""
    modulus = h.cr[g.ALAM1 + iget(h, ib, g.KMAT) - 1]
    iz = iget(h, iget(h, ib, g.KBEX), g.KFZ)
    while iz != 0:
        g1, g2, g3, b1, c1, b2, c2, twice = gradient(h, iz, real(h, 0.0))
        b3, c3 = -(b1 + b2), -(c1 + c2)
        scale = modulus / (twice + twice)
        stiffness[g1] += scale * (b1 * b1 + c1 * c1)
        stiffness[g2] += scale * (b2 * b2 + c2 * c2)
        stiffness[g3] += scale * (b3 * b3 + c3 * c3)
        iz = iget(h, iz, g.KZ)


@kernel
def contact_stiffness(h: Memory, ic: int, stiffness: Any) -> None:
    """Add the stiffness of contact `ic` at the grid-points on both its sides."""
    stiffer = stiffest(joint_of(h, ic))
    for ib in (iget(h, ic, g.KB1), iget(h, ic, g.KB2)):
        if iget(h, ib, HEAD) == g.MFDEF:
            ip = corner_of(h, ib, ic)
            stiffness[iget(h, ip, g.KGP)] += stiffer
            stiffness[iget(h, iget(h, ip, g.KR), g.KGP)] += stiffer


@kernel
def soft_step(h: Memory, stiffness: Any) -> tuple[float, int]:
    """Least mass over stiffness of the internal modes and grid-points of blocks not fixed, and its address.

    A grid-point with given velocities counts as any other, lest its zones strain too much in one step.
    stiffness: one real for every word of IA() in use, all zero.
    """
    smallest, at = real(h, np.inf), int64(0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        kind, fixed = iget(h, ib, HEAD), iget(h, ib, g.KBFIX) == g.FIXED
        if kind == g.MFDEF and not fixed:
            zone_stiffness(h, ib, stiffness)
        elif kind == g.MSDEF and not fixed and internal_mode(h, ib) < smallest:
            smallest, at = internal_mode(h, ib), ib
        ib = iget(h, ib, g.KB)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            contact_stiffness(h, ic, stiffness)
        ic = iget(h, ic, g.KC)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED and iget(h, ib, HEAD) == g.MFDEF:
            ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
            while ig != 0:
                if getr(h, ig, g.KGPM) < smallest * stiffness[ig]:
                    smallest, at = getr(h, ig, g.KGPM) / stiffness[ig], ig
                ig = iget(h, ig, g.KG)
        ib = iget(h, ib, g.KB)
    return smallest, at
