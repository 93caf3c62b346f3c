"""Removal of the corners that GENERATE has put on the edges of a block, when the block loses its zones.

Such a corner is not rounded. Its two edges become one; error 14 leaves the block unchanged if they are bent
too far. A contact of the corner with another block's arc becomes one of the edge. A contact with another
block's edge is removed with its force.
"""

from __future__ import annotations

import math

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, puti, putr
from udec_ia.kernels.contact.map_changes import update_geometry
from udec_ia.kernels.detect.third_block_in_gap import delete_contact
from udec_ia.kernels.geometry.block_shape import crad, is_edge_point
from udec_ia.kernels.links.linked_lists import (
    corner_of,
    flag,
    is_corner,
    next_corner,
    set_corner_of,
    take_out,
)
from udec_ia.kernels.links.longer_groups import lose_corner
from udec_ia.kernels.map.domain_segments import is_on_arc
from udec_ia.layout import offsets as g
from udec_ia.ops.common.block_ranges import items


def corners_of(h: Memory, ib: int) -> list[int]:
    """Corners of block `ib`, clockwise."""
    return [ip for ip in items(h, ib) if is_corner(h, ip)]


def edge_points(h: Memory, ib: int) -> list[int]:
    """The corners of GENERATE on the edges of block `ib`."""
    return [ip for ip in corners_of(h, ib) if is_edge_point(h, ip)]


def check_straight(h: Memory, ib: int) -> None:
    """Error 14 if an edge of block `ib` is bent by more than the greatest overlap."""
    ring = corners_of(h, ib)
    first = next(k for k, ip in enumerate(ring) if not is_edge_point(h, ip))
    ring = ring[first:] + ring[: first + 1]
    start, between = ring[0], list[int]()
    for ip in ring[1:]:
        if is_edge_point(h, ip):
            between.append(ip)
            continue
        for iq in between:
            off = off_line(h, iq, start, ip)
            if off > h.cr[g.DTOL2]:
                place = f"({getr(h, iq, g.KXP):g}, {getr(h, iq, g.KYP):g})"
                detail = f"the edge of block@{ib} at {place} is bent by {off:g}, more than {h.cr[g.DTOL2]:g}"
                raise UdecError(14, detail, "leave the block fully-deformable", group=ib)
        start, between = ip, []


def off_line(h: Memory, ip: int, ia: int, iz: int) -> float:
    """Distance of corner `ip` from the line through the corners `ia` and `iz`."""
    (x, y), (ax, ay), (bx, by) = ((float(getr(h, i, g.KXP)), float(getr(h, i, g.KYP))) for i in (ip, ia, iz))
    return abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / math.hypot(bx - ax, by - ay)


def straighten(h: Memory, ib: int) -> None:
    """Remove the corners of GENERATE from block `ib`, and flag the domains around it."""
    take_points_out(h, ib, edge_points(h, ib))


def take_points_out(h: Memory, ib: int, points: list[int]) -> None:
    """Remove the corners `points` on edges of block `ib`, and flag the domains around it."""
    if not points:
        return
    for ip in points:
        _take_point_out(h, ib, ip)
    crad(h, ib, False)
    renew_reach(h, ib)
    flag_around(h, ib)


def renew_reach(h: Memory, ib: int) -> None:
    """Calculate the distance of the farthest corner of block `ib` from its centroid again."""
    x, y = float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
    away = [math.hypot(getr(h, ip, g.KXP) - x, getr(h, ip, g.KYP) - y) for ip in corners_of(h, ib)]
    putr(h, ib, g.KBRO, max(away))


def _take_point_out(h: Memory, ib: int, ip: int) -> None:
    """Make the two edges at corner `ip` of block `ib` one."""
    iq = next_corner(h, ib, ip)
    for ic in [item for item in items(h, ib) if not is_corner(h, item) and corner_of(h, ib, item) == ip]:
        set_corner_of(h, ib, ic, iq)
        if iget(h, ic, g.KCCOD) == g.CORNER_CORNER:
            puti(h, ic, g.KCCOD, g.EDGE_CORNER if iget(h, ic, g.KB1) == ib else g.CORNER_EDGE)
        elif is_on_arc(h, ib, ic):
            delete_contact(h, iget(h, ic, g.KD1), ic)
    take_out(h, ib, ip)
    puti(h, iq, g.KR, iget(h, ip, g.KR))
    puti(h, ib, g.KP, iq)
    puti(h, ip, HEAD, 0)
    lose_corner(h, ip)


def flag_around(h: Memory, ib: int) -> None:
    """Bring the contacts of block `ib` up to date with its new corners, and flag the domains around it."""
    for ic in items(h, ib):
        if not is_corner(h, ic):
            if iget(h, ic, g.KCCOD) != g.VIRTUAL:
                update_geometry(h, ic)
            flag(h, iget(h, ic, g.KD1))
            flag(h, iget(h, ic, g.KD2))
