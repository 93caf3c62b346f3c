"""Contact re-classification: changes of code and place of a contact (report 2.5; QUERY, MVFOR, MVBAK).

As blocks slide, one and the same contact passes from the edge to the arc of a rounded corner and on to the
next edge: only its code changes and, past a corner, its place in the block's list. The force is continuous
because both forms agree where they meet; GTOL prevents the code from alternating there.

MVFOR and MVBAK of 1980 took along the contacts in between. Here a contact waits for them: each moves when its
own geometry requires it, and the order of the list stays the order of the map.

A contact on an edge keeps its corner when its block rolls over to the next one, which then has its own
contact, unless the flat between the two is shorter than FTOL. Two contacts so close are one: the contact
passes from corner to corner, and the report's ball rolls on a single contact.

Points of edges have no contact with each other; two that meet have each a contact with an edge beside the
other. Each of these blocks the other, so they pass together. This does not happen if an arc meets a point:
the point reaches the arc first.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, puti
from udec_ia.kernels.geometry.block_shape import zcs
from udec_ia.kernels.geometry.contact_geometry import (
    ce,
    coord_called,
    distance_past,
    has_no_arc,
    over_ends,
)
from udec_ia.kernels.links.linked_lists import (
    corner_of,
    domain_before,
    flag_beside,
    is_corner,
    link,
    next_corner,
    nextcp,
    nextp,
    other,
    prevcp,
    set_corner_of,
    take_out,
)
from udec_ia.layout import offsets as g

RECLASSIFICATIONS = 8  # a contact passes at most so many segments at a time


@kernel
def mvfor(h: Memory, ic: int, ib: int, code: int) -> bool:
    """Move contact `ic` forwards past its corner on block `ib`, with the new code (MVFOR).

    The corner moves to the place before the contact. False, and nothing changes, while another contact is
    between them; virtual ones do not count and are taken along.
    """
    ip = corner_of(h, ib, ic)
    item = nextcp(h, ib, ic)
    while item != ip:
        if iget(h, item, g.KCCOD) != g.VIRTUAL:
            return False
        item = nextcp(h, ib, item)
    iq = next_corner(h, ib, ip)
    take_out(h, ib, ip)
    link(h, ib, prevcp(h, ib, ic), ip)
    link(h, ib, ip, ic)
    _store_corner(h, ib, ic, iq)
    puti(h, ic, g.KCCOD, code)
    return True


@kernel
def mvbak(h: Memory, ic: int, ib: int, code: int) -> bool:
    """Move contact `ic` backwards past the corner before it on block `ib`, with the new code (MVBAK).

    As in mvfor the corner moves, to the place after the contact.
    """
    ip = prevcp(h, ib, ic)
    while not is_corner(h, ip):
        if iget(h, ip, g.KCCOD) != g.VIRTUAL:
            return False
        ip = prevcp(h, ib, ip)
    first, after = nextcp(h, ib, ip), nextcp(h, ib, ic)
    take_out(h, ib, ip)
    link(h, ib, ic, ip)
    link(h, ib, ip, after)
    _store_corner(h, ib, first, ip)
    puti(h, ic, g.KCCOD, code)
    return True


@kernel
def _store_corner(h: Memory, ib: int, iad: int, ip: int) -> None:
    """Store corner `ip` in the contacts of block `ib` from `iad` to the corner or a contact that has it."""
    item = iad
    while item != ip and corner_of(h, ib, item) != ip:
        set_corner_of(h, ib, item, ip)
        item = nextcp(h, ib, item)


@kernel
def _is_of_point(h: Memory, ic: int, ib: int, jb: int, iq: int) -> bool:
    """True if item `ic` of block `ib` is the contact of its corner `iq` with an edge of block `jb`."""
    if is_corner(h, ic) or corner_of(h, ib, ic) != iq or other(h, ib, ic) != jb:
        return False
    return iget(h, ic, g.KCCOD) == (g.CORNER_EDGE if iget(h, ic, g.KB1) == ib else g.EDGE_CORNER)


@kernel
def _link_in_a_row(h: Memory, ib: int, before: int, one: int, two: int, three: int, after: int) -> None:
    """Link the five items in this order in the list of block `ib`."""
    link(h, ib, before, one)
    link(h, ib, one, two)
    link(h, ib, two, three)
    link(h, ib, three, after)


@kernel
def _pass_forwards(h: Memory, ic: int, ib: int, iq: int, ip: int) -> bool:
    """Point `ip` passes point `iq` of block `ib`, clockwise; `ic` is its contact with the edge before `iq`.

    The contact of `iq` then passes point `ip`. False if no contact blocks the way.
    """
    jb, jc = other(h, ib, ic), nextcp(h, ib, ic)
    if not _is_of_point(h, jc, ib, jb, iq) or nextcp(h, ib, jc) != iq:
        return False
    if nextcp(h, jb, jc) != ic or nextcp(h, jb, ic) != ip:
        return False
    after, behind = nextcp(h, ib, iq), nextcp(h, jb, ip)
    _link_in_a_row(h, ib, prevcp(h, ib, ic), jc, iq, ic, after)
    _link_in_a_row(h, jb, prevcp(h, jb, jc), ic, ip, jc, behind)
    set_corner_of(h, ib, ic, nextp(h, ib, after))
    set_corner_of(h, jb, jc, nextp(h, jb, behind))
    _change_places(h, ib, ic, jc)
    return True


@kernel
def _pass_backwards(h: Memory, ic: int, ib: int, iq: int, ip: int) -> bool:
    """As _pass_forwards, anticlockwise; `ic` is the contact of point `ip` with the edge after `iq`."""
    jb, jc = other(h, ib, ic), prevcp(h, ib, iq)
    if not _is_of_point(h, jc, ib, jb, iq) or nextcp(h, ib, iq) != ic:
        return False
    if nextcp(h, jb, ic) != ip or nextcp(h, jb, ip) != jc:
        return False
    _link_in_a_row(h, ib, prevcp(h, ib, jc), ic, jc, iq, nextcp(h, ib, ic))
    _link_in_a_row(h, jb, prevcp(h, jb, ic), jc, ic, ip, nextcp(h, jb, jc))
    set_corner_of(h, ib, ic, iq)
    set_corner_of(h, jb, jc, ip)
    _change_places(h, ib, jc, ic)
    return True


@kernel
def _change_places(h: Memory, ib: int, ic: int, jc: int) -> None:
    """Exchange the domains beside contacts `ic` and `jc` of the same two blocks, which changed places."""
    jb = other(h, ib, ic)
    left, between, right = domain_before(h, ib, ic), domain_before(h, ib, jc), domain_before(h, jb, jc)
    _put_domains(h, ib, jc, left, between)
    _put_domains(h, ib, ic, between, right)
    if iget(h, left, g.KDLOOP) == ic:
        puti(h, left, g.KDLOOP, jc)
    if iget(h, right, g.KDLOOP) == jc:
        puti(h, right, g.KDLOOP, ic)


@kernel
def _put_domains(h: Memory, ib: int, ic: int, before: int, after: int) -> None:
    """Set the domains before and after contact `ic`, clockwise along block `ib`."""
    first = iget(h, ic, g.KB1) == ib
    puti(h, ic, g.KD1, before if first else after)
    puti(h, ic, g.KD2, after if first else before)


@kernel
def _off_the_edge(h: Memory, ic: int, ib: int, ip: int, iq: int, along: float, z: float) -> bool:
    """Re-classify a contact whose corner `ip` is near an end of the edge of block `ib` that ends at `iq`."""
    code, border = iget(h, ic, g.KCCOD), h.cr[g.DTOL] - h.cr[g.GTOL]
    is_point = getr(h, ip, g.KRAD) <= 0
    ia = iget(h, iq, g.KR)
    rad = getr(h, ia, g.KRAD)
    if rad > 0 and along < border:
        return mvbak(h, ic, ib, g.CORNER_CORNER)
    if rad == 0 and distance_past(h, ia, ip) < -h.cr[g.GTOL]:
        return (is_point and _pass_backwards(h, ic, ib, ia, ip)) or mvbak(h, ic, ib, code)
    rad = getr(h, iq, g.KRAD)
    if rad > 0 and z - along < border:
        puti(h, ic, g.KCCOD, g.CORNER_CORNER)
        return True
    if rad != 0 or distance_past(h, iq, ip) <= h.cr[g.GTOL]:
        return False
    return (is_point and _pass_forwards(h, ic, ib, iq, ip)) or mvfor(h, ic, ib, code)


@kernel
def _all_rounding(h: Memory, ip: int) -> bool:
    """True if the edge that ends at corner `ip` is between two arcs, and its flat is shorter than FTOL."""
    z, _, _ = zcs(h, ip)
    short = z - h.cr[g.DTOL] - h.cr[g.DTOL] < h.cr[g.FTOL]
    return short and getr(h, ip, g.KRAD) > 0 and getr(h, iget(h, ip, g.KR), g.KRAD) > 0


@kernel
def _roll(h: Memory, ic: int, ib: int, ip: int, nx: float, ny: float) -> bool:
    """Move a contact on an edge from corner `ip` of block `ib` to the next corner, over a short flat.

    (nx, ny) points from the circle's centre to the edge.
    """
    code = iget(h, ic, g.KCCOD)
    ahead, behind = over_ends(h, ip, nx, ny)
    slack = h.cr[g.GTOL] / h.cr[g.DTOL]
    if ahead > slack:
        return _all_rounding(h, next_corner(h, ib, ip)) and mvfor(h, ic, ib, code)
    return behind > slack and _all_rounding(h, ip) and mvbak(h, ic, ib, code)


@kernel
def _off_the_corner(h: Memory, ic: int) -> bool:
    """Re-classify a corner/corner contact whose line of centres has left an arc, or that has lost an arc."""
    ip, iq = iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)
    first = has_no_arc(h, ip)
    if first or has_no_arc(h, iq):  # the contact goes to the nearer of the edges at the corner without
        ib, code = (iget(h, ic, g.KB1), g.EDGE_CORNER) if first else (iget(h, ic, g.KB2), g.CORNER_EDGE)
        ahead = distance_past(h, ip, iq) > 0 if first else distance_past(h, iq, ip) > 0
        ib0 = iget(h, ic, g.KB1)  # if the corner has become concave, the other edge is touched as well
        flag_beside(h, iget(h, ic, g.KD1), ib0)
        flag_beside(h, iget(h, ic, g.KD2), ib0)
        if not (ahead and mvfor(h, ic, ib, code)):
            puti(h, ic, g.KCCOD, code)
        return True
    dx, dy = getr(h, iq, g.KXCP) - getr(h, ip, g.KXCP), getr(h, iq, g.KYCP) - getr(h, ip, g.KYCP)
    ahead1, behind1 = over_ends(h, ip, dx, dy)
    ahead2, behind2 = over_ends(h, iq, -dx, -dy)
    if max(max(ahead1, behind1), max(ahead2, behind2)) <= h.cr[g.GTOL]:
        return False
    one, two = getr(h, ip, g.KRAD), getr(h, iq, g.KRAD)  # they turn an angle into a way along the arc
    ahead1, behind1, ahead2, behind2 = ahead1 * one, behind1 * one, ahead2 * two, behind2 * two
    furthest = max(max(ahead1, behind1), max(ahead2, behind2))
    if furthest == ahead1:
        return mvfor(h, ic, iget(h, ic, g.KB1), g.EDGE_CORNER)
    if furthest == ahead2:
        return mvfor(h, ic, iget(h, ic, g.KB2), g.CORNER_EDGE)
    puti(h, ic, g.KCCOD, g.EDGE_CORNER if furthest == behind1 else g.CORNER_EDGE)
    return True


@kernel
def reclass(h: Memory, ic: int) -> bool:
    """Give contact `ic` the code that its geometry requires; True if code or place changed."""
    code = iget(h, ic, g.KCCOD)
    if code == g.CORNER_CORNER:
        return _off_the_corner(h, ic)
    if code == g.CORNER_EDGE:
        ib, jb = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
        ip, iq = iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)
    else:
        ib, jb = iget(h, ic, g.KB2), iget(h, ic, g.KB1)
        ip, iq = iget(h, ic, g.KCP2), iget(h, ic, g.KCP1)
    ex, ey, _, along, z = ce(h, ip, iq)
    border = h.cr[g.DTOL] - h.cr[g.GTOL]
    changed = (along < border or z - along < border) and _off_the_edge(h, ic, jb, ip, iq, along, z)
    return changed or (h.ci[g.LSHORT] != 0 and _roll(h, ic, ib, ip, -ex, -ey))


@inlined
def settle(h: Memory, ic: int) -> tuple[float, float, float]:
    """Set code, place and coordinates of contact `ic` by its geometry; returns normal (x, y) and overlap."""
    nx, ny, overlap, margin = coord_called(h, ic)
    for _ in range(RECLASSIFICATIONS):
        if (margin >= 0 and h.ci[g.LSHORT] == 0) or not reclass(h, ic):
            break
        nx, ny, overlap, margin = coord_called(h, ic)
    return nx, ny, overlap
