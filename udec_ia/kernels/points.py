"""A point on the boundary of a block: its velocity, and a force that acts there (CVEL, PUTFCE; report 2.9).

    rigid                v = V + w x r              the force and its moment go to the block
    simply-deformable    v = V + (w + e) r          they do, and the force adds to the applied stress
    fully-deformable     on an edge v varies linearly between the two grid-points at its ends, and a force is
                         shared between them by the lever rule (CVELFD, FDE); at a corner both are those of
                         its grid-point, although the contact lies a little inside the corner (FDC)

`soft` is None in a scene that has rigid blocks only: numba then leaves all else out of the machine code.
"""

from __future__ import annotations

from typing import Any

from offsets.generated import (
    KBEX,
    KBFT,
    KBFX,
    KBFY,
    KED11,
    KED12,
    KED22,
    KGP,
    KR,
    KTD,
    KX,
    KXD,
    KXDG,
    KXP,
    KY,
    KYD,
    KYDG,
    KYP,
    MRIG,
    MSDEF,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.heap.jit import inlined, kernel
from udec_ia.kernels.fdef import putfdf
from udec_ia.kernels.lists import corner_of
from udec_ia.kernels.sdef import putstr
from udec_ia.kernels.segments import on_arc


@inlined
def lever(h: Memory, ip: int, x: float, y: float) -> float:
    """Place of the point (x, y) along the edge that ends at corner `ip`: 0 at its start, 1 at its end."""
    ia = iget(h, ip, KR)
    xa, ya = getr(h, ia, KXP), getr(h, ia, KYP)
    dx, dy = getr(h, ip, KXP) - xa, getr(h, ip, KYP) - ya
    return ((x - xa) * dx + (y - ya) * dy) / (dx * dx + dy * dy)


@kernel
def velocity_soft(h: Memory, ib: int, ic: int, x: float, y: float) -> tuple[float, float]:
    """Velocity of deformable block `ib` at the point (x, y) of its contact `ic` (CVELFD)."""
    if iget(h, ib, HEAD) == MSDEF:
        ie = iget(h, ib, KBEX)
        rx, ry, td = x - getr(h, ib, KX), y - getr(h, ib, KY), getr(h, ib, KTD)
        e11, e12, e22 = getr(h, ie, KED11), getr(h, ie, KED12), getr(h, ie, KED22)
        xd = getr(h, ib, KXD) + e11 * rx + (e12 - td) * ry
        return xd, getr(h, ib, KYD) + (e12 + td) * rx + e22 * ry
    ip = corner_of(h, ib, ic)
    ig = iget(h, ip, KGP)
    xd, yd = getr(h, ig, KXDG), getr(h, ig, KYDG)
    if not on_arc(h, ib, ic):
        rest = real(h, 1.0) - lever(h, ip, x, y)
        ig = iget(h, iget(h, ip, KR), KGP)
        xd, yd = xd + rest * (getr(h, ig, KXDG) - xd), yd + rest * (getr(h, ig, KYDG) - yd)
    return xd, yd


@inlined
def velocity_at(h: Memory, ib: int, ic: int, x: float, y: float, soft: Any) -> tuple[float, float]:
    """Velocity of block `ib` at the point (x, y) of its contact `ic`."""
    if soft is not None and iget(h, ib, HEAD) != MRIG:
        return velocity_soft(h, ib, ic, x, y)
    td = getr(h, ib, KTD)
    return getr(h, ib, KXD) - td * (y - getr(h, ib, KY)), getr(h, ib, KYD) + td * (x - getr(h, ib, KX))


@kernel
def force_soft(h: Memory, ib: int, ic: int, fx: float, fy: float, x: float, y: float) -> None:
    """Share a force on deformable block `ib` out (PUTSTR, FDC, FDE)."""
    if iget(h, ib, HEAD) == MSDEF:
        putstr(h, ib, fx, fy, x, y)
        return
    ip = corner_of(h, ib, ic)
    ig = iget(h, ip, KGP)
    if ig == 0:  # until GENERATE divides the block
        return
    if on_arc(h, ib, ic):
        putfdf(h, ig, fx, fy)
        return
    part = lever(h, ip, x, y)
    putfdf(h, ig, fx * part, fy * part)
    part = real(h, 1.0) - part
    putfdf(h, iget(h, iget(h, ip, KR), KGP), fx * part, fy * part)


@inlined
def putfce(h: Memory, ib: int, ic: int, fx: float, fy: float, x: float, y: float, soft: Any) -> None:
    """Add the force (fx, fy) at the point (x, y) of contact `ic` to the force sums of block `ib` (PUTFCE)."""
    putr(h, ib, KBFX, getr(h, ib, KBFX) + fx)
    putr(h, ib, KBFY, getr(h, ib, KBFY) + fy)
    moment = (x - getr(h, ib, KX)) * fy - (y - getr(h, ib, KY)) * fx
    putr(h, ib, KBFT, getr(h, ib, KBFT) + moment)
    if soft is not None and iget(h, ib, HEAD) != MRIG:
        force_soft(h, ib, ic, fx, fy, x, y)
