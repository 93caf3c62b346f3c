"""Force sums anew, after something other than the cycle has changed the map or a block's type."""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.kernels.body.boundary_point import putfce
from udec_ia.kernels.body.fdef import stand_still, zone_forces
from udec_ia.kernels.body.sdef import reset_applied
from udec_ia.kernels.geometry.contact_geometry import coord_seldom
from udec_ia.layout import offsets as g


@kernel
def _inner_forces(h: Memory, ib: int) -> None:
    """Applied stress of block `ib` := 0, or the force sums of its grid-points := those of its zones."""
    zero = real(h, 0.0)
    ie = iget(h, ib, g.KBEX)
    if iget(h, ib, HEAD) == g.MSDEF:
        reset_applied(h, ie)
    elif iget(h, ib, HEAD) == g.MFDEF:
        stand_still(h, ib)
        iz = iget(h, ie, g.KFZ)
        while iz != 0:
            zone_forces(h, iz, zero, zero, zero)
            iz = iget(h, iz, g.KZ)


@kernel
def sum_all_forces(h: Memory, soft: Any) -> None:
    """Force sums from the forces stored in the contacts and the stresses in the zones."""
    zero = real(h, 0.0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        putr(h, ib, g.KBFX, zero)
        putr(h, ib, g.KBFY, zero)
        putr(h, ib, g.KBFT, zero)
        if soft is not None:
            _inner_forces(h, ib)
        ib = iget(h, ib, g.KB)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        if getr(h, ic, g.KCFN) != zero:
            nx, ny, _, _ = coord_seldom(h, ic)
            fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
            fx, fy = nx * fn + ny * fs, ny * fn - nx * fs
            x, y = getr(h, ic, g.KXC), getr(h, ic, g.KYC)
            putfce(h, iget(h, ic, g.KB1), ic, -fx, -fy, x, y, soft)
            putfce(h, iget(h, ic, g.KB2), ic, fx, fy, x, y, soft)
        ic = iget(h, ic, g.KC)
