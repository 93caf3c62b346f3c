"""Rigid and simply-deformable blocks crack between two opposed contact forces.

Two forces P that press a block from opposite sides, at the distance d, pull it apart across the line between
them. In a disc, loaded on its diameter, the tension is the same along the line (H. Hertz 1883; the Brazilian
test):

    T = 2 P/(pi d)        it breaks along the line at P >= (pi/2) d T

A block has no stress between its contacts, and so this law is that of all shapes. P is the lesser of the two
components along the line. Each force is within 30 degrees of it. They act on different edges, or corners: the
force on a corner makes a crack begin at the corner itself. Of all pairs that break the block, the one with
the greatest P/d counts, and not with the greatest P, since the tension is 2 P/(pi d).
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.kernels.constitutive.joint_stresses import place_of_force
from udec_ia.kernels.crack.crack_line import Crack, crack_through, no_crack
from udec_ia.kernels.geometry.contact_geometry import coord_called
from udec_ia.kernels.links.linked_lists import corner_of, is_contact, nextcp
from udec_ia.kernels.map.domain_segments import is_on_arc
from udec_ia.layout import offsets as g

PER_LENGTH = np.pi / 2  # P over d T at which a disc breaks
NARROW = 0.75  # square of the cosine of 30 degrees


@inlined
def _is_strong(h: Memory, ic: int, limit: float) -> bool:
    """True if item `ic` is a contact with a force of `limit` or more."""
    if not is_contact(h, ic):
        return False
    fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
    return fn * fn + fs * fs >= limit * limit


@kernel
def _force_on(h: Memory, ib: int, ic: int) -> tuple[float, float, float, float]:
    """Force of contact `ic` on block `ib`, and the point of the outline where a crack below it begins.

    That is the corner of its arc, or the foot on its edge.
    """
    nx, ny, _, _ = coord_called(h, ic)
    fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
    fx, fy = nx * fn + ny * fs, ny * fn - nx * fs
    if iget(h, ic, g.KB1) == ib:
        fx, fy = -fx, -fy
    ip = corner_of(h, ib, ic)
    bx, by = getr(h, ip, g.KXP), getr(h, ip, g.KYP)
    if is_on_arc(h, ib, ic):
        return fx, fy, bx, by
    ia = iget(h, ip, g.KR)
    ax, ay = getr(h, ia, g.KXP), getr(h, ia, g.KYP)
    ux, uy = bx - ax, by - ay
    x, y = place_of_force(h, ic)
    part = ((x - ax) * ux + (y - ay) * uy) / (ux * ux + uy * uy)
    return fx, fy, ax + ux * part, ay + uy * part


@kernel
def _pair(h: Memory, ib: int, ic: int, jc: int, tension: float, smallest: float) -> tuple[float, Crack]:
    """P/d of contacts `ic` and `jc` of block `ib`, and the crack between them, or 0 and none."""
    zero = real(h, 0.0)
    fx, fy, x, y = _force_on(h, ib, ic)
    gx, gy, xb, yb = _force_on(h, ib, jc)
    d = np.sqrt((xb - x) * (xb - x) + (yb - y) * (yb - y))
    if d < h.cr[g.DTOL] + h.cr[g.DTOL]:
        return zero, no_crack(h)
    c, s = (xb - x) / d, (yb - y) / d
    one, two = fx * c + fy * s, -(gx * c + gy * s)
    p = min(one, two)
    if p < real(h, PER_LENGTH) * d * tension:
        return zero, no_crack(h)
    narrow = real(h, NARROW)
    if one * one < narrow * (fx * fx + fy * fy) or two * two < narrow * (gx * gx + gy * gy):
        return zero, no_crack(h)
    half = real(h, 0.5)
    crack = crack_through(h, ib, (x + xb) * half, (y + yb) * half, c, s, smallest, g.CRACK_BY_FORCES)
    off = max(max(abs(crack[1] - x), abs(crack[2] - y)), max(abs(crack[3] - xb), abs(crack[4] - yb)))
    if crack[0] == 0 or off > h.cr[g.DTOL]:  # the line leaves the block between the two
        return zero, no_crack(h)
    return p / d, crack


@kernel
def crack_by_forces(h: Memory, ib: int, tension: float, smallest: float) -> Crack:
    """The crack of block `ib` between two opposed contact forces. tension: its strength."""
    limit = real(h, np.pi) * h.cr[g.DTOL] * tension  # at the shortest line, 2 D
    best, crack = real(h, 0.0), no_crack(h)
    ip0 = iget(h, ib, g.KP)
    ic = nextcp(h, ib, ip0)
    while ic != ip0:
        if _is_strong(h, ic, limit):
            jc = nextcp(h, ib, ic)
            while jc != ip0:
                same = is_contact(h, jc) and corner_of(h, ib, ic) == corner_of(h, ib, jc)
                same = same and is_on_arc(h, ib, ic) == is_on_arc(h, ib, jc)
                if not same and _is_strong(h, jc, limit):
                    ratio, found = _pair(h, ib, ic, jc, tension, smallest)
                    if ratio > best:
                        best, crack = ratio, found
                jc = nextcp(h, ib, jc)
        ic = nextcp(h, ib, ic)
    return crack
