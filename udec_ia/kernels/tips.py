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
    DTOL,
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
def _crosses(ax: float, ay: float, bx: float, by: float, nx: float, ny: float, half: float) -> bool:
    """True if the segment ab crosses the one from minus to plus `half` along the unit vector (nx, ny)."""
    a, b = nx * ay - ny * ax, nx * by - ny * bx
    if (a > 0) == (b > 0):
        return False
    return abs((nx * ax + ny * ay) * b - (nx * bx + ny * by) * a) < half * abs(b - a)


@kernel
def _stands_in(h: Memory, ib: int, ip: int, x: float, y: float, nx: float, ny: float, half: float) -> bool:
    """True if corner `ip` of block `ib`, rounded, or an edge at it crosses a gap.

    The gap is 2 `half` wide along the unit vector (nx, ny), its middle is at (x, y).
    """
    dx, dy = getr(h, ip, KXCP) - x, getr(h, ip, KYCP) - y
    out = max(abs(dx * nx + dy * ny) - half, real(h, 0.0))
    across = dx * ny - dy * nx
    r = getr(h, ip, KRAD)
    if out * out + across * across < r * r:
        return True
    px, py = getr(h, ip, KXP) - x, getr(h, ip, KYP) - y
    for iq in (iget(h, ip, KR), next_corner(h, ib, ip)):
        ux, uy = getr(h, iq, KXP) - getr(h, ip, KXP), getr(h, iq, KYP) - getr(h, ip, KYP)
        part = h.cr[DTOL] / np.sqrt(ux * ux + uy * uy)  # of the edge, that its rounding takes at either end
        most = real(h, 1.0) - (part if getr(h, iq, KRAD) > 0 else real(h, 0.0))
        ax, ay = px + ux * part, py + uy * part
        bx, by = px + ux * most, py + uy * most
        if _crosses(ax, ay, bx, by, nx, ny, half):
            return True
    return False


@kernel
def blocked(h: Memory, seg: Any, tips: Any, ib: int, jb: int, code: int, ip: int, jp: int) -> bool:
    """True if a tip of a third block stands in the gap between segment `ip` of `ib` and `jp` of `jb`."""
    nx, ny, overlap, x, y, _ = meet(h, code, ip, jp)
    if not overlap < 0:
        return False
    half = -overlap * real(h, 0.5)
    for i in tips:
        kb = seg[i, BLOCK]
        if kb not in (ib, jb) and _stands_in(h, kb, seg[i, CORNER], x, y, nx, ny, half):
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
