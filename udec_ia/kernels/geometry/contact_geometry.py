"""Geometry of one contact: corner on edge (CE), corner on corner (CC), contact point (COORD).

Everything is measured from circle centres c with radii r (report 2.3, 2.5). Normals point from block
KB1 to block KB2; the overlap is positive when the rounded outlines overlap.

    corner/edge     overlap = r - (c - a).e        e outward normal of the edge that starts at a
    corner/corner   overlap = r1 + r2 - |c2 - c1|  normal along c2 - c1

The contact point lies on the normal through the circle's centre, in the middle of the overlap. Where
a contact passes from edge to arc, both forms give the same normal and the same overlap.

A circle continues where its arc ends. If an edge is tilted so far that it faces no place of an arc, the
circle touches it, beside the arc's end. The circle of a blunt corner would touch far away; there the end of
the arc touches.

A point of an edge (KRAD = 0: a flat corner, or one that GENERATE has put there) is a circle of radius zero
that may touch edges and arcs of others. A contact that slides past it passes from one edge to the other at
their bisector, where both give the same overlap.

A corner of a deformable block that becomes straight or concave loses its arc. Its contact with another arc
moves to one of its two edges; its contact with an edge stays until it opens.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.kernel_memory import LEAD, fetch
from udec_ia.heap.accessors import Memory, getr, iget, putr, real
from udec_ia.kernels.geometry.block_shape import is_edge_point, zcs
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.layout import offsets as g

BLUNT = 8.0  # radius over D above which the end of an arc matters: at a corner with a turn of 14 degrees


@inlined
def circle_ce(h: Memory, ip: int, iq: int) -> tuple[float, float, float, float, float]:
    """Circle of corner `ip` against the edge that ends at corner `iq`.

    Returns the edge's outward normal (x, y), the overlap, the distance of the circle's centre along the
    edge from its start, and the length of the edge.
    """
    ia = iget(h, iq, g.KR)
    z, c, s = zcs(h, iq)
    x, y = getr(h, ip, g.KXCP) - getr(h, ia, g.KXP), getr(h, ip, g.KYCP) - getr(h, ia, g.KYP)
    return -s, c, getr(h, ip, g.KRAD) - (y * c - x * s), x * c + y * s, z


@kernel
def ce(h: Memory, ip: int, iq: int) -> tuple[float, float, float, float, float]:
    """Corner `ip` against the edge that ends at corner `iq` (CE): as circle_ce, but for a blunt corner's end.

    If the edge faces no place of a blunt corner's arc, an end of the arc touches it.
    """
    ex, ey, overlap, along, z = circle_ce(h, ip, iq)
    if is_blunt(h, ip):
        by_end, x, y = touching_end(h, ip, ex, ey)
        if by_end:
            ia = iget(h, iq, g.KR)
            x, y = x - getr(h, ia, g.KXP), y - getr(h, ia, g.KYP)
            overlap, along = -(x * ex + y * ey), x * ey - y * ex
    return ex, ey, overlap, along, z


@kernel
def touching_end(h: Memory, ip: int, ex: float, ey: float) -> tuple[bool, float, float]:
    """The end (x, y) of the arc of corner `ip` that touches an edge of the outward normal (ex, ey).

    Returned before it: True if it is an end, and not a place between.
    """
    tx, ty, ux, uy = tangents(h, ip)
    d, zero = h.cr[g.DTOL], real(h, 0.0)
    x, y = getr(h, ip, g.KXP), getr(h, ip, g.KYP)
    if ex * ux + ey * uy < zero:
        return True, x + d * ux, y + d * uy
    return ex * tx + ey * ty > zero, x - d * tx, y - d * ty


@inlined
def cc(h: Memory, ip: int, iq: int) -> tuple[float, float, float]:
    """Corner `ip` of block KB1 against corner `iq` of block KB2 (CC): normal (x, y) and overlap."""
    dx, dy = getr(h, iq, g.KXCP) - getr(h, ip, g.KXCP), getr(h, iq, g.KYCP) - getr(h, ip, g.KYCP)
    z = np.sqrt(dx * dx + dy * dy)
    return dx / z, dy / z, getr(h, ip, g.KRAD) + getr(h, iq, g.KRAD) - z


@kernel
def tangents(h: Memory, ip: int) -> tuple[float, float, float, float]:
    """Unit vectors of the edges that arrive at and leave corner `ip`."""
    _, tx, ty = zcs(h, ip)
    _, ux, uy = zcs(h, next_corner(h, iget(h, ip, g.KNB), ip))
    return tx, ty, ux, uy


@kernel
def distance_past(h: Memory, iq: int, ip: int) -> float:
    """Distance of the circle of corner `ip` past corner `iq` of another block, clockwise.

    Measured along the mean direction of the two edges at `iq`, so zero on their bisector. For a blunt corner
    the end of its arc counts if it touches.
    """
    tx, ty, ux, uy = tangents(h, iq)
    mx, my = (tx + ux) * real(h, 0.5), (ty + uy) * real(h, 0.5)
    x, y = getr(h, ip, g.KXCP), getr(h, ip, g.KYCP)
    if is_blunt(h, ip):
        by_end, ax, ay = touching_end(h, ip, -my, mx)
        if by_end:
            x, y = ax, ay
    return (x - getr(h, iq, g.KXP)) * mx + (y - getr(h, iq, g.KYP)) * my


@inlined
def over_ends(h: Memory, ip: int, x: float, y: float) -> tuple[float, float]:
    """Components of the vector (x, y) beyond the two ends of the arc of corner `ip`.

    Returns its component along the edge that leaves the corner, and minus its component along the edge that
    arrives. For (x, y) from the circle's centre, both are negative or zero inside the arc. With m = centre -
    corner, t_out = (D m - R Jm)/m.m and -t_in = (D m + R Jm)/m.m.
    """
    d, r = h.cr[g.DTOL], getr(h, ip, g.KRAD)
    if r <= 0:
        tx, ty, ux, uy = tangents(h, ip)
        return x * ux + y * uy, -(x * tx + y * ty)
    mx, my = getr(h, ip, g.KXCP) - getr(h, ip, g.KXP), getr(h, ip, g.KYCP) - getr(h, ip, g.KYP)
    mm = mx * mx + my * my
    along = d * (x * mx + y * my)
    across = r * (x * my - y * mx)
    return (along - across) / mm, (along + across) / mm


@kernel
def faces(h: Memory, ip: int, x: float, y: float, slack: float) -> bool:
    """True if the unit vector (x, y) is beyond neither end of the arc of corner `ip` by more than `slack`.

    A vector in the direction opposite to a blunt arc may also be beyond its ends by little, but does not face
    the arc. An arc is at most half a circle. So for slacks up to 0.5 a vector that faces it is less than 120
    degrees from its middle, and any other is more than 150 degrees away.
    """
    ahead, behind = over_ends(h, ip, x, y)
    if getr(h, ip, g.KRAD) <= 0:  # a point of an edge: outwards is to the left of its edges
        tx, ty, ux, uy = tangents(h, ip)
        return max(ahead, behind) <= slack and y * (tx + ux) - x * (ty + uy) > 0
    mx, my = getr(h, ip, g.KXCP) - getr(h, ip, g.KXP), getr(h, ip, g.KYCP) - getr(h, ip, g.KYP)
    inwards = x * mx + y * my
    opposite = inwards > 0 and inwards * inwards > real(h, 0.25) * (mx * mx + my * my)
    return max(ahead, behind) <= slack and not opposite


@inlined
def is_blunt(h: Memory, ip: int) -> bool:
    """True if the circle of corner `ip` is so large that the ends of its arc matter."""
    return getr(h, ip, g.KRAD) > h.cr[g.DTOL] * real(h, BLUNT)


@kernel
def has_no_arc(h: Memory, ip: int) -> bool:
    """True if corner `ip` is straight or concave, and no point of an edge."""
    return getr(h, ip, g.KRAD) <= 0 and not is_edge_point(h, ip)


@inlined
def point_on(h: Memory, ip: int, nx: float, ny: float, overlap: float) -> tuple[float, float]:
    """Contact point of corner `ip`, whose circle touches something in direction (nx, ny)."""
    reach = getr(h, ip, g.KRAD) - overlap * real(h, 0.5)
    return getr(h, ip, g.KXCP) + nx * reach, getr(h, ip, g.KYCP) + ny * reach


@inlined
def meet_circles(h: Memory, code: int, ip: int, iq: int) -> tuple[float, float, float, float, float, float]:
    """As `meet`, for two corners that their circles represent."""
    if code == g.CORNER_CORNER:
        nx, ny, overlap = cc(h, ip, iq)
        x, y = point_on(h, ip, nx, ny, overlap)
        dx, dy = getr(h, iq, g.KXCP) - getr(h, ip, g.KXCP), getr(h, iq, g.KYCP) - getr(h, ip, g.KYCP)
        margin = h.cr[g.GTOL] - max(max(over_ends(h, ip, dx, dy)), max(over_ends(h, iq, -dx, -dy)))
    elif code == g.CORNER_EDGE:
        ex, ey, overlap, along, z = circle_ce(h, ip, iq)
        nx, ny = -ex, -ey
        x, y = point_on(h, ip, nx, ny, overlap)
        margin = min(along, z - along) - (h.cr[g.DTOL] - h.cr[g.GTOL])
    else:
        nx, ny, overlap, along, z = circle_ce(h, iq, ip)
        x, y = point_on(h, iq, -nx, -ny, overlap)
        margin = min(along, z - along) - (h.cr[g.DTOL] - h.cr[g.GTOL])
    return nx, ny, overlap, x, y, margin


@kernel
def meet(h: Memory, code: int, ip: int, iq: int) -> tuple[float, float, float, float, float, float]:
    """Normal (x, y), overlap and contact point of segment `ip` of KB1 and segment `iq` of KB2.

    The last number is the margin of the code: below zero, the normal has left an arc or the contact
    point has left the straight part of an edge, and the contact may have to be re-classified; or there is no
    such arc.
    """
    gone = real(h, -1.0)
    nx, ny, overlap, x, y, margin = meet_circles(h, code, ip, iq)
    if code == g.CORNER_CORNER:
        return nx, ny, overlap, x, y, gone if has_no_arc(h, ip) or has_no_arc(h, iq) else margin
    arc, edge = (ip, iq) if code == g.CORNER_EDGE else (iq, ip)
    if is_blunt(h, arc):
        ex, ey, overlap, along, z = ce(h, arc, edge)
        ia, half = iget(h, edge, g.KR), overlap * real(h, 0.5)
        x, y = getr(h, ia, g.KXP) + along * ey - half * ex, getr(h, ia, g.KYP) - along * ex - half * ey
        margin = min(along, z - along) - (h.cr[g.DTOL] - h.cr[g.GTOL])
    if overlap <= 0 and has_no_arc(h, arc):
        margin = gone
    return nx, ny, overlap, x, y, margin


@inlined
def meet_inlined(h: Memory, code: int, ip: int, iq: int) -> tuple[float, float, float, float, float, float]:
    """As `meet`, without a call for two corners that their circles represent."""
    one, two, largest = getr(h, ip, g.KRAD), getr(h, iq, g.KRAD), h.cr[g.DTOL] * real(h, BLUNT)
    if min(one, two) > 0 and max(one, two) <= largest:
        return meet_circles(h, code, ip, iq)
    return meet(h, code, ip, iq)


@inlined
def put_place(h: Memory, ic: int, x: float, y: float) -> None:
    """Place of contact `ic` := (x, y)."""
    putr(h, ic, g.KXC, x)
    putr(h, ic, g.KYC, y)


@inlined
def coord(h: Memory, ic: int) -> tuple[float, float, float, float]:
    """Update the coordinates of contact `ic` (COORD); returns normal (x, y), overlap and margin."""
    code, ip, iq = iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)
    nx, ny, overlap, x, y, margin = meet_inlined(h, code, ip, iq)
    put_place(h, ic, x, y)
    return nx, ny, overlap, margin


@kernel
def coord_called(h: Memory, ic: int) -> tuple[float, float, float, float]:
    """As `coord`, where it is not done in every cycle."""
    nx, ny, overlap, x, y, margin = meet(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
    put_place(h, ic, x, y)
    return nx, ny, overlap, margin


@kernel
def begin_contact(h: Memory, ic: int) -> None:
    """Set coordinates of contact `ic`, and its overlap as the start of force increments."""
    _, _, overlap, _ = coord_called(h, ic)
    putr(h, ic, g.KCN, overlap)


# Words that each cycle uses: those of a contact, and the first half of its joint, KCJMAT to KCJSLIP
USED_WORDS = tuple(contact + joint // 2 for contact, joint in zip(g.NVCN, g.NVJT, strict=True))


@inlined
def prefetch_corners(h: Memory, ic: int) -> None:
    """Prefetch the corners of contact `ic`."""
    fetch(h, iget(h, ic, g.KCP1), g.NVCR)
    fetch(h, iget(h, ic, g.KCP2), g.NVCR)


@inlined
def prefetch_points(h: Memory, ic: int) -> None:
    """Prefetch the grid-points of the corners of contact `ic`; without zones KGP is 0, which is allowed."""
    fetch(h, iget(h, iget(h, ic, g.KCP1), g.KGP), g.NVGP)
    fetch(h, iget(h, iget(h, ic, g.KCP2), g.KGP), g.NVGP)


@inlined
def prefetch_waiting(h: Memory, waiting: Any, n: int, k: int) -> None:
    """Prefetch what contacts after number `k` of the `n` in `waiting` need. A deleted contact is 0 there.

    First a contact itself, later its corners, then their grid-points and the items beside them.
    """
    far, near, nearest = k + 2 * LEAD, k + LEAD, k + LEAD // 2
    if far < n:
        fetch(h, abs(waiting[far]), USED_WORDS)
    if near < n and waiting[near] != 0:
        prefetch_corners(h, abs(waiting[near]))
    if nearest < n and waiting[nearest] != 0:
        ic = abs(waiting[nearest])
        prefetch_points(h, ic)
        for ip in (iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)):
            fetch(h, iget(h, ip, g.KL), g.NVCR)
            fetch(h, iget(h, ip, g.KR), g.NVCR)
