"""A point on the boundary of a block: its motion, and a force that acts there (CVEL, PUTFCE; report 2.9).

    rigid                v = V + w x r              the force and its moment go to the block
    simply-deformable    v = V + (w + e) r          the same, and the force adds to the applied stress
    fully-deformable     on an edge v varies linearly between the two grid-points at its ends, and a force is
                         shared between them by the lever rule (CVELFD, FDE); at a corner both are those of
                         its grid-point, although the contact lies a little inside the corner (FDC)

`soft` is None in a scene of rigid blocks only: numba then compiles nothing for deformable blocks.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.kernels.body.fdef import putfdf
from udec_ia.kernels.body.sdef import putstr
from udec_ia.kernels.links.linked_lists import corner_of
from udec_ia.kernels.map.domain_segments import is_on_arc
from udec_ia.layout import offsets as g


@inlined
def lever(h: Memory, ip: int, x: float, y: float) -> float:
    """Place of the point (x, y) along the edge that ends at corner `ip`: 0 at its start, 1 at its end."""
    ia = iget(h, ip, g.KR)
    xa, ya = getr(h, ia, g.KXP), getr(h, ia, g.KYP)
    dx, dy = getr(h, ip, g.KXP) - xa, getr(h, ip, g.KYP) - ya
    return ((x - xa) * dx + (y - ya) * dy) / (dx * dx + dy * dy)


@kernel
def motion_soft(
    h: Memory, ib: int, ic: int, x: float, y: float, tx: float, ty: float
) -> tuple[float, float, float]:
    """Velocity of deformable block `ib` at the point (x, y) of its contact `ic` (CVELFD), and strain rate.

    The strain rate is that along the unit vector (tx, ty) of the joint there. Of a fully-deformable block it
    is that of the edge, and 0 at a corner, which is a point.
    """
    if iget(h, ib, HEAD) == g.MSDEF:
        ie, two = iget(h, ib, g.KBEX), real(h, 2.0)
        rx, ry, td = x - getr(h, ib, g.KX), y - getr(h, ib, g.KY), getr(h, ib, g.KTD)
        e11, e12, e22 = getr(h, ie, g.KED11), getr(h, ie, g.KED12), getr(h, ie, g.KED22)
        xd = getr(h, ib, g.KXD) + e11 * rx + (e12 - td) * ry
        yd = getr(h, ib, g.KYD) + (e12 + td) * rx + e22 * ry
        return xd, yd, e11 * tx * tx + two * e12 * tx * ty + e22 * ty * ty
    ip = corner_of(h, ib, ic)
    ig = iget(h, ip, g.KGP)
    xd, yd = getr(h, ig, g.KXDG), getr(h, ig, g.KYDG)
    if is_on_arc(h, ib, ic):
        return xd, yd, real(h, 0.0)
    ia, rest = iget(h, ip, g.KR), real(h, 1.0) - lever(h, ip, x, y)
    ig = iget(h, ia, g.KGP)
    dx, dy = getr(h, ip, g.KXP) - getr(h, ia, g.KXP), getr(h, ip, g.KYP) - getr(h, ia, g.KYP)
    dxd, dyd = getr(h, ig, g.KXDG) - xd, getr(h, ig, g.KYDG) - yd
    return xd + rest * dxd, yd + rest * dyd, -(dxd * dx + dyd * dy) / (dx * dx + dy * dy)


@kernel
def velocity_soft(h: Memory, ib: int, ic: int, x: float, y: float) -> tuple[float, float]:
    """Velocity of deformable block `ib` at the point (x, y) of its contact `ic` (CVELFD)."""
    xd, yd, _ = motion_soft(h, ib, ic, x, y, real(h, 0.0), real(h, 0.0))
    return xd, yd


@inlined
def velocity_at(h: Memory, ib: int, ic: int, x: float, y: float, soft: Any) -> tuple[float, float]:
    """Velocity of block `ib` at the point (x, y) of its contact `ic`."""
    if soft is not None and iget(h, ib, HEAD) != g.MRIG:
        return velocity_soft(h, ib, ic, x, y)
    td = getr(h, ib, g.KTD)
    return getr(h, ib, g.KXD) - td * (y - getr(h, ib, g.KY)), getr(h, ib, g.KYD) + td * (
        x - getr(h, ib, g.KX)
    )


@inlined
def motion_at(
    h: Memory, ib: int, ic: int, x: float, y: float, tx: float, ty: float
) -> tuple[float, float, float]:
    """Velocity and strain rate of block `ib` at the point (x, y) of its contact `ic`, as of `motion_soft`."""
    if iget(h, ib, HEAD) != g.MRIG:
        return motion_soft(h, ib, ic, x, y, tx, ty)
    xd, yd = velocity_at(h, ib, ic, x, y, None)
    return xd, yd, real(h, 0.0)


@kernel
def force_soft(h: Memory, ib: int, ic: int, fx: float, fy: float, x: float, y: float) -> None:
    """Distribute a force on deformable block `ib` (PUTSTR, FDC, FDE)."""
    if iget(h, ib, HEAD) == g.MSDEF:
        putstr(h, ib, fx, fy, x, y)
        return
    ip = corner_of(h, ib, ic)
    ig = iget(h, ip, g.KGP)
    if ig == 0:  # until GENERATE divides the block
        return
    if is_on_arc(h, ib, ic):
        putfdf(h, ig, fx, fy)
        return
    part = lever(h, ip, x, y)
    putfdf(h, ig, fx * part, fy * part)
    part = real(h, 1.0) - part
    putfdf(h, iget(h, iget(h, ip, g.KR), g.KGP), fx * part, fy * part)


@inlined
def putfce(h: Memory, ib: int, ic: int, fx: float, fy: float, x: float, y: float, soft: Any) -> None:
    """Add the force (fx, fy) at the point (x, y) of contact `ic` to the force sums of block `ib` (PUTFCE)."""
    putr(h, ib, g.KBFX, getr(h, ib, g.KBFX) + fx)
    putr(h, ib, g.KBFY, getr(h, ib, g.KBFY) + fy)
    moment = (x - getr(h, ib, g.KX)) * fy - (y - getr(h, ib, g.KY)) * fx
    putr(h, ib, g.KBFT, getr(h, ib, g.KBFT) + moment)
    if soft is not None and iget(h, ib, HEAD) != g.MRIG:
        force_soft(h, ib, ic, fx, fy, x, y)
