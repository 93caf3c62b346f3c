"""How deep a point lies in a block, rounded as it is."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.kernels.geometry.contact_geometry import over_ends
from udec_ia.layout import offsets as g


@inlined
def _from(h: Memory, ip: int, x: float, y: float, back: float) -> tuple[float, float]:
    """Vector from the point (x, y) to where corner `ip` was a time `back` ago."""
    px, py = getr(h, ip, g.KXP) - getr(h, ip, g.KXDP) * back, getr(h, ip, g.KYP) - getr(h, ip, g.KYDP) * back
    return px - x, py - y


@kernel
def _under_arc(h: Memory, ip: int, x: float, y: float, back: float, depth: float) -> float:
    """The lesser of `depth` and that of the point (x, y) under the arc of corner `ip`, if it is there at all.

    Between the arc and the tip that it cuts off the depth is negative. back: as in depth_in.
    """
    rad = getr(h, ip, g.KRAD)
    cx, cy = getr(h, ip, g.KXCP), getr(h, ip, g.KYCP)
    mx, my = getr(h, ip, g.KXP) - cx, getr(h, ip, g.KYP) - cy
    fx, fy = x - cx + getr(h, ip, g.KXDP) * back, y - cy + getr(h, ip, g.KYDP) * back
    far = fx * fx + fy * fy
    if rad <= 0 or far > mx * mx + my * my:
        return depth
    ahead, behind = over_ends(h, ip, fx, fy)
    if ahead > 0 or behind > 0:
        return depth
    return min(depth, rad - np.sqrt(far))


@kernel
def depth_in(h: Memory, ib: int, x: float, y: float, back: float) -> float:
    """Distance of the point (x, y) from the rounded outline of block `ib`, negative if it lies outside.

    The block is looked at as it was a time `back` ago, when its corners moved as they do now. Outside a
    corner the distance is that from the edges that meet there.
    """
    inside = False
    nearest = real(h, np.inf)
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        ia = iget(h, ip, g.KR)
        ax, ay = _from(h, ia, x, y, back)
        bx, by = _from(h, ip, x, y, back)
        if (ay > 0) != (by > 0) and (ax * by - ay * bx > 0) == (by > ay):
            inside = not inside
        ex, ey = bx - ax, by - ay
        part = min(max(-(ax * ex + ay * ey) / (ex * ex + ey * ey), real(h, 0.0)), real(h, 1.0))
        px, py = ax + part * ex, ay + part * ey
        nearest = min(nearest, px * px + py * py)
        ip = ia
        if ip == ip0:
            break
    depth = np.sqrt(nearest)
    if not inside:
        return -depth
    while True:
        depth = _under_arc(h, ip, x, y, back, depth)
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            return depth


@kernel
def do_not_meet(h: Memory, ib: int, jb: int, gap: Any) -> bool:
    """True if two segments of blocks `ib` and `jb` overlap, but not the blocks: each lies behind a thin tip.

    gap: what `contact_geometry.meet` says of them: normal from `ib` to `jb`, overlap, and the point in its
    middle. Where blocks overlap, the end of the one lies in the other, if not both do.
    """
    nx, ny, overlap, x, y = gap
    half, slack, now = overlap * real(h, 0.5), h.cr[g.GTOL], real(h, 0.0)
    if depth_in(h, jb, x + nx * half, y + ny * half, now) > -slack:
        return False
    return depth_in(h, ib, x - nx * half, y - ny * half, now) <= -slack
