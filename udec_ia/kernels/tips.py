"""Sharp tips that slip through open contacts.

A contact stays in the map while it is open by less than BTOL, and its domains end at it like at a wall.
A rounded corner that is narrower than the gap could pass through the wall: then something is near
something else in a domain that is not its own. So a contact whose gap is blocked by a third block is no
contact: none is formed there, and one that stands there is given up, which merges its two domains.

Only corners with 2 R < BTOL (sharper than about 31 degrees) can do so; a scene without them pays nothing.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from offsets.generated import (
    BTOL,
    KB1,
    KB2,
    KCCOD,
    KCN,
    KCP1,
    KCP2,
    KD1,
    KD2,
    KR,
    KRAD,
    KXCP,
    KXP,
    KYCP,
    KYP,
    NBROKE,
)
from udec_ia.heap.accessors import Memory, getr, iget, int64, real
from udec_ia.heap.jit import kernel
from udec_ia.kernels.bridge import delc, nextd, to_virtual
from udec_ia.kernels.lists import is_corner, next_corner
from udec_ia.kernels.segments import ARC, BLOCK, CORNER, loop_start
from udec_ia.kernels.touch import VIRTUAL, meet


@kernel
def find_tips(h: Memory, seg: Any, n: int) -> Any:
    """Rows of the segments that are arcs narrower than BTOL."""
    tips = np.empty(n, np.int64)
    m = 0
    for i in range(n):
        if seg[i, ARC] == 1:
            r = getr(h, seg[i, CORNER], KRAD)
            if r > 0 and r + r < h.cr[BTOL]:
                tips[m] = i
                m += 1
    return tips[:m].copy()


@kernel
def _cross(ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float) -> bool:
    """True if the segments ab and cd cross."""
    ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
    a = ux * (cy - ay) - uy * (cx - ax)
    b = ux * (dy - ay) - uy * (dx - ax)
    c = vx * (ay - cy) - vy * (ax - cx)
    d = vx * (by - cy) - vy * (bx - cx)
    return (a > 0) != (b > 0) and (c > 0) != (d > 0)


@kernel
def _stands_in(h: Memory, ib: int, ip: int, ax: float, ay: float, bx: float, by: float) -> bool:
    """True if the rounded corner `ip` of block `ib`, or an edge at it, crosses the segment ab."""
    x, y = getr(h, ip, KXCP) - ax, getr(h, ip, KYCP) - ay
    ux, uy = bx - ax, by - ay
    part = (x * ux + y * uy) / (ux * ux + uy * uy)
    part = min(max(part, real(h, 0.0)), real(h, 1.0))
    x, y = x - part * ux, y - part * uy
    r = getr(h, ip, KRAD)
    if x * x + y * y < r * r:
        return True
    px, py = getr(h, ip, KXP), getr(h, ip, KYP)
    for iq in (iget(h, ip, KR), next_corner(h, ib, ip)):
        if _cross(ax, ay, bx, by, px, py, getr(h, iq, KXP), getr(h, iq, KYP)):
            return True
    return False


@kernel
def blocked(h: Memory, seg: Any, tips: Any, ib: int, jb: int, code: int, ip: int, jp: int) -> bool:
    """True if a tip of a third block stands in the gap between segment `ip` of `ib` and `jp` of `jb`."""
    nx, ny, overlap, x, y, _ = meet(h, code, ip, jp)
    if not overlap < 0:
        return False
    half = overlap * real(h, 0.5)
    ax, ay, bx, by = x + nx * half, y + ny * half, x - nx * half, y - ny * half
    for i in tips:
        kb = seg[i, BLOCK]
        if kb not in (ib, jb) and _stands_in(h, kb, seg[i, CORNER], ax, ay, bx, by):
            return True
    return False


@kernel
def give_up_blocked(h: Memory, idm: int, seg: Any, tips: Any) -> tuple[bool, int]:
    """Give up the first contact around domain `idm` in whose gap a tip stands.

    Returns whether one was found, and the domain that then takes the place of `idm`.
    """
    start, first = loop_start(h, idm)
    item, block = start, first
    while True:
        item, block = nextd(h, item, block)
        if not is_corner(h, item) and iget(h, item, KCCOD) != VIRTUAL and getr(h, item, KCN) < 0:
            ib, jb = iget(h, item, KB1), iget(h, item, KB2)
            code, ip, jp = iget(h, item, KCCOD), iget(h, item, KCP1), iget(h, item, KCP2)
            if blocked(h, seg, tips, ib, jb, code, ip, jp):
                h.ci[NBROKE] += 1
                if iget(h, item, KD1) == iget(h, item, KD2):
                    to_virtual(h, item)
                    return True, int64(idm)
                return True, delc(h, item)
        if item == start and block == first:
            return False, int64(idm)
