"""Block laws by constitutive number: linear elasticity (1, CL1) and the user's (2 to 5; IV-4).

`laws` is None in a pass without user's laws. numba then does not compile the branches `if laws is not None`,
so such a pass has no extra cost. Otherwise it is a Laws (compiling/law_calls.py).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.law_calls import FIRST, JOINTS, Laws, call, is_given
from udec_ia.errors import LAW_FAILED
from udec_ia.heap.accessors import HEAD, Memory, iget, real
from udec_ia.layout import offsets as g

IN_BLOCKS, AT_JOINTS = 0, 1  # rows of the array that numbers_in_use fills


@kernel
def numbers_in_use(h: Memory, user: Any) -> None:
    """Set user[IN_BLOCKS, n] to a deformable block of constitutive number n; 0 if there is none.

    user[AT_JOINTS, n]: a contact of number n, or a block of number n, which later contacts will have.
    """
    ib = h.ci[g.IBPNT]
    while ib != 0:
        n = iget(h, ib, g.KCONS)
        if iget(h, ib, HEAD) != g.MRIG:
            user[IN_BLOCKS, n] = ib
        user[AT_JOINTS, n] = ib
        ib = iget(h, ib, g.KB)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        user[AT_JOINTS, iget(h, ic, g.KCC)] = ic
        ic = iget(h, ic, g.KC)


@inlined
def has_failed(h: Memory, group: int, total: float) -> bool:
    """True, and error 35, if the sum of a law's results for block or contact `group` is not finite."""
    if np.isfinite(total):
        return False
    if h.ci[g.NERR] == 0:
        h.ci[g.NERR] = LAW_FAILED
        h.ci[g.IERAD] = group
    return True


@inlined
def cl1(h: Memory, mat: int, e11: float, e12: float, e22: float) -> tuple[float, float, float]:
    """Stress increments of isotropic elasticity in plane strain (CL1), of material `mat`."""
    one, two, shear = h.cr[g.ALAM1 + mat - 1], h.cr[g.ALAM2 + mat - 1], h.cr[g.SHEAR + mat - 1]
    return one * e11 + two * e22, (shear + shear) * e12, two * e11 + one * e22


@inlined
def stress_increment(
    h: Memory,
    laws: Laws | None,
    number: int,
    mat: int,
    group: int,
    s11: float,
    s12: float,
    s22: float,
    e11: float,
    e12: float,
    e22: float,
) -> tuple[float, float, float]:
    """Stress increments 11, 12, 22 of material `mat` for strain increments, by constitutive number `number`.

    s11, s12, s22: stress before the increment, tension positive. e11, e12, e22: components of the strain
    tensor. group: the block, which error 35 names if the law returns no finite numbers; the increments are 0
    then. A number without a block law is linear elasticity.
    """
    if laws is not None:
        i = number - FIRST
        if 0 <= i < JOINTS and is_given(laws, i):
            d11, d12, d22 = call(laws, i, mat, (s11, s12, s22, e11, e12, e22))
            if has_failed(h, group, real(h, d11) + real(h, d12) + real(h, d22)):
                return real(h, 0.0), real(h, 0.0), real(h, 0.0)
            return real(h, d11), real(h, d12), real(h, d22)
    return cl1(h, mat, e11, e12, e22)
