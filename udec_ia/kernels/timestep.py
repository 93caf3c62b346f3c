"""The critical time-step of deformable blocks: of their internal modes and of grid-points.

The 1980 estimate is 2 sqrt(M/K) with a mass and the stiffness that acts on it (4.6: only approximate):

    simply-deformable    M least principal value of the Euler tensor, K = A (K + 4G/3), the uniaxial mode
    fully-deformable     M mass of a grid-point, K stiffness of its zones and of the contacts that act on it
"""

from __future__ import annotations

from typing import Any

import numpy as np

from offsets.generated import (
    AKN,
    AKS,
    ALAM1,
    IBPNT,
    ICPNT,
    KB,
    KB1,
    KB2,
    KBEX,
    KBFIX,
    KC,
    KCCOD,
    KCM,
    KFG,
    KFZ,
    KG,
    KGP,
    KGPM,
    KMAT,
    KR,
    KSAREA,
    KSJ11,
    KSJ12,
    KSJ22,
    KZ,
    MFDEF,
    MSDEF,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, real
from udec_ia.heap.jit import kernel
from udec_ia.kernels.fdef import gradient
from udec_ia.kernels.lists import corner_of
from udec_ia.kernels.motion import FIXED
from udec_ia.kernels.touch import VIRTUAL


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
    ie = iget(h, ib, KBEX)
    j11, j12, j22 = getr(h, ie, KSJ11), getr(h, ie, KSJ12), getr(h, ie, KSJ22)
    half = real(h, 0.5)
    mean, diff = (j11 + j22) * half, (j11 - j22) * half
    least = mean - np.sqrt(diff * diff + j12 * j12)
    return least / (getr(h, ie, KSAREA) * h.cr[ALAM1 + iget(h, ib, KMAT) - 1])


@kernel
def zone_stiffness(h: Memory, ib: int, stiffness: Any) -> None:
    """Add the stiffness of every zone of block `ib` at its grid-points; `stiffness`: one real an address."""
    modulus = h.cr[ALAM1 + iget(h, ib, KMAT) - 1]
    iz = iget(h, iget(h, ib, KBEX), KFZ)
    while iz != 0:
        g1, g2, g3, b1, c1, b2, c2, twice = gradient(h, iz, real(h, 0.0))
        b3, c3 = -(b1 + b2), -(c1 + c2)
        scale = modulus / (twice + twice)
        stiffness[g1] += scale * (b1 * b1 + c1 * c1)
        stiffness[g2] += scale * (b2 * b2 + c2 * c2)
        stiffness[g3] += scale * (b3 * b3 + c3 * c3)
        iz = iget(h, iz, KZ)


@kernel
def contact_stiffness(h: Memory, ic: int, stiffness: Any) -> None:
    """Add the stiffness of contact `ic` at the grid-points on both its sides."""
    m = iget(h, ic, KCM) - 1
    most = max(h.cr[AKN + m], h.cr[AKS + m])
    for ib in (iget(h, ic, KB1), iget(h, ic, KB2)):
        if iget(h, ib, HEAD) == MFDEF:
            ip = corner_of(h, ib, ic)
            stiffness[iget(h, ip, KGP)] += most
            stiffness[iget(h, iget(h, ip, KR), KGP)] += most


@kernel
def soft_step(h: Memory, stiffness: Any) -> tuple[float, int]:
    """Least mass over stiffness of the internal modes and grid-points of blocks not fixed, and its address.

    A grid-point with given velocities counts as any other, lest its zones strain too much in one step.
    stiffness: one real for every word of IA() in use, all zero.
    """
    least, at = real(h, np.inf), int64(0)
    ib = h.ci[IBPNT]
    while ib != 0:
        if iget(h, ib, KBFIX) != FIXED and iget(h, ib, HEAD) == MFDEF:
            zone_stiffness(h, ib, stiffness)
        elif iget(h, ib, KBFIX) != FIXED and iget(h, ib, HEAD) == MSDEF and internal_mode(h, ib) < least:
            least, at = internal_mode(h, ib), ib
        ib = iget(h, ib, KB)
    ic = h.ci[ICPNT]
    while ic != 0:
        if iget(h, ic, KCCOD) != VIRTUAL:
            contact_stiffness(h, ic, stiffness)
        ic = iget(h, ic, KC)
    ib = h.ci[IBPNT]
    while ib != 0:
        if iget(h, ib, KBFIX) != FIXED and iget(h, ib, HEAD) == MFDEF:
            ig = iget(h, iget(h, ib, KBEX), KFG)
            while ig != 0:
                if getr(h, ig, KGPM) < least * stiffness[ig]:
                    least, at = getr(h, ig, KGPM) / stiffness[ig], ig
                ig = iget(h, ig, KG)
        ib = iget(h, ib, KB)
    return least, at
