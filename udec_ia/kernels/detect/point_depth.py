"""Depth of a point in a rounded block, and thin tips that have passed through each other.

Two blocks that touch in two places enclose a space. A loop around it follows one block from the first contact
to the second, and the other block back. So of two adjacent contacts the second follows the first on one block
and precedes it on the other. If two tips, thinner than the allowed overlap, have passed through each other,
the segments on their far sides also meet. A contact there would follow the first on both blocks. Each of its
two domains would be the outside of one block, and neither the space between.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.kernels.geometry.contact_geometry import over_ends
from udec_ia.kernels.links.linked_lists import is_contact, is_corner, nextcp, other, prevcp
from udec_ia.layout import offsets as g


@inlined
def _vector_to_corner(h: Memory, ip: int, x: float, y: float, back: float) -> tuple[float, float]:
    """Vector from the point (x, y) to the place of corner `ip` a time `back` ago."""
    px, py = getr(h, ip, g.KXP) - getr(h, ip, g.KXDP) * back, getr(h, ip, g.KYP) - getr(h, ip, g.KYDP) * back
    return px - x, py - y


@kernel
def _under_arc(h: Memory, ip: int, x: float, y: float, back: float, depth: float) -> float:
    """The smaller of `depth` and the depth of the point (x, y) under the arc of corner `ip`, if it is there.

    Between the arc and the tip that the rounding removes, the depth is negative. back: as in depth_in.
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

    The block is taken as it was a time `back` ago, at the present velocities of its corners. Outside a corner
    the distance is that from the edges that meet there.
    """
    inside = False
    nearest = real(h, np.inf)
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        ia = iget(h, ip, g.KR)
        ax, ay = _vector_to_corner(h, ia, x, y, back)
        bx, by = _vector_to_corner(h, ip, x, y, back)
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

    gap: the result of `contact_geometry.meet`: normal from `ib` to `jb`, overlap, and the point in its
    middle. If blocks overlap, the end of at least one lies in the other.
    """
    nx, ny, overlap, x, y = gap
    half, slack, now = overlap * real(h, 0.5), h.cr[g.GTOL], real(h, 0.0)
    if depth_in(h, jb, x + nx * half, y + ny * half, now) > -slack:
        return False
    return depth_in(h, ib, x - nx * half, y - ny * half, now) <= -slack


AROUND = 6  # items searched on either side for a contact of the same two blocks
TURNS = 1  # corners between two adjacent contacts; the path around the block has at least two


@kernel
def _is_near(h: Memory, ib: int, iad: int, ic: int, ahead: bool) -> bool:
    """True if contact `ic` comes soon after item `iad` of block `ib`, or before it if not `ahead`."""
    item = nextcp(h, ib, iad) if ahead else iad
    turns = 0
    for _ in range(AROUND):
        if item == ic:
            return True
        if is_corner(h, item):
            turns += 1
        if turns > TURNS:
            return False
        item = nextcp(h, ib, item) if ahead else prevcp(h, ib, item)
    return False


@kernel
def would_cross(h: Memory, ib: int, iad: int, jb: int, jad: int, x: float, y: float) -> bool:
    """Would a contact at (x, y) after items `iad`, `jad` of blocks `ib`, `jb` cross another of the two?"""
    near = h.cr[g.DTOL] + h.cr[g.FTOL]
    for ahead in (True, False):
        item = nextcp(h, ib, iad) if ahead else iad
        turns = 0
        for _ in range(AROUND):
            if is_corner(h, item):
                turns += 1
            if turns > TURNS:
                break
            if is_contact(h, item) and other(h, ib, item) == jb and iget(h, item, g.KCCOD) != g.VIRTUAL:
                dx, dy = getr(h, item, g.KXC) - x, getr(h, item, g.KYC) - y
                if dx * dx + dy * dy < near * near and _is_near(h, jb, jad, item, ahead):
                    return True
            item = nextcp(h, ib, item) if ahead else prevcp(h, ib, item)
    return False
