"""Force sums anew, after something other than the cycle has changed the map or a block's type."""

from __future__ import annotations

from typing import Any

from offsets.generated import (
    IBPNT,
    ICPNT,
    KB,
    KB1,
    KB2,
    KBEX,
    KBFT,
    KBFX,
    KBFY,
    KC,
    KCFN,
    KCFS,
    KFZ,
    KXC,
    KYC,
    KZ,
    MFDEF,
    MSDEF,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.heap.jit import kernel
from udec_ia.kernels.fdef import stand_still, zone_forces
from udec_ia.kernels.points import putfce
from udec_ia.kernels.sdef import reset_applied
from udec_ia.kernels.touch import coord


@kernel
def _inner_forces(h: Memory, ib: int) -> None:
    """Applied stress of block `ib` := 0, or the force sums of its grid-points := those of its zones."""
    zero = real(h, 0.0)
    ie = iget(h, ib, KBEX)
    if iget(h, ib, HEAD) == MSDEF:
        reset_applied(h, ie)
    elif iget(h, ib, HEAD) == MFDEF:
        stand_still(h, ib)
        iz = iget(h, ie, KFZ)
        while iz != 0:
            zone_forces(h, iz, zero, zero, zero)
            iz = iget(h, iz, KZ)


@kernel
def sum_all_forces(h: Memory, soft: Any) -> None:
    """Force sums from the forces stored in the contacts and the stresses in the zones."""
    zero = real(h, 0.0)
    ib = h.ci[IBPNT]
    while ib != 0:
        putr(h, ib, KBFX, zero)
        putr(h, ib, KBFY, zero)
        putr(h, ib, KBFT, zero)
        if soft is not None:
            _inner_forces(h, ib)
        ib = iget(h, ib, KB)
    ic = h.ci[ICPNT]
    while ic != 0:
        if getr(h, ic, KCFN) != zero:
            nx, ny, _, _ = coord(h, ic)
            fn, fs = getr(h, ic, KCFN), getr(h, ic, KCFS)
            fx, fy = nx * fn + ny * fs, ny * fn - nx * fs
            x, y = getr(h, ic, KXC), getr(h, ic, KYC)
            putfce(h, iget(h, ic, KB1), ic, -fx, -fy, x, y, soft)
            putfce(h, iget(h, ic, KB2), ic, fx, fy, x, y, soft)
        ic = iget(h, ic, KC)
