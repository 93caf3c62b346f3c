"""Contacts of a corner that slides into a notch or out of it.

In a notch a corner touches both edges: it gets its contact with the second from ETOL before that on
(detect/search.py), and for a while it holds both. Out of the notch, by more than D, the contact with the edge
that it has left has no place. It goes if it carries nothing; or its force goes over to the other contact.

In a slight notch the places at which a corner touches the two edges may be nearer than FTOL. Then it has one
contact, which goes from edge to edge where their bisector is, as at a straight corner.

What follows a law of the user's, whose memory only that law knows, stays until it opens.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.kernels.constitutive.joint_laws import no_force
from udec_ia.kernels.constitutive.joint_properties import twice_stored
from udec_ia.kernels.geometry.contact_geometry import ce, has_no_arc, meet, past
from udec_ia.kernels.links.lists import corner_of, is_contact, nextcp, other, prevcp
from udec_ia.kernels.map.reclass import mvbak, mvfor
from udec_ia.layout import offsets as g


@kernel
def arc_and_edge(h: Memory, ic: int) -> tuple[int, int]:
    """The corner whose arc is at contact `ic` on an edge, and the corner at which that edge ends."""
    ip, iq = iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)
    if iget(h, ic, g.KCCOD) == g.EDGE_CORNER:
        return iq, ip
    return ip, iq


@kernel
def out_of_notch(h: Memory, ic: int) -> bool:
    """True if contact `ic`, on an edge, is more than D beyond a notch at one end of it."""
    arc, edge = arc_and_edge(h, ic)
    notched, before = getr(h, edge, g.KRAD) < 0, getr(h, iget(h, edge, g.KR), g.KRAD) < 0
    if not (notched or before):
        return False
    _, _, _, along, z = ce(h, arc, edge)
    return (notched and along > z + h.cr[g.DTOL]) or (before and along < -h.cr[g.DTOL])


@kernel
def has_no_place(h: Memory, ic: int) -> bool:
    """True if the corner of a contact on an edge has no arc any more, or has slid out of a notch."""
    if iget(h, ic, g.KCCOD) == g.CORNER_CORNER:
        return False
    arc, _ = arc_and_edge(h, ic)
    if has_no_arc(h, arc):
        return getr(h, ic, g.KCFN) == 0
    return out_of_notch(h, ic)


@inlined
def is_heir(h: Memory, jc: int, ib: int, jb: int, arc: int) -> bool:
    """True if item `jc` of block `ib` is a contact of its corner `arc` with block `jb`."""
    if not is_contact(h, jc) or iget(h, jc, g.KCCOD) == g.VIRTUAL or other(h, ib, jc) != jb:
        return False
    on_edge = iget(h, jc, g.KCCOD) == (g.EDGE_CORNER if iget(h, jc, g.KB1) == ib else g.CORNER_EDGE)
    return corner_of(h, ib, jc) == arc and not on_edge


@kernel
def heir(h: Memory, ic: int) -> int:
    """A contact of the same corner beside contact `ic`, which has left a notch; 0 if there is none."""
    arc, edge = arc_and_edge(h, ic)
    ib, jb = iget(h, arc, g.KNB), iget(h, edge, g.KNB)
    after, before = nextcp(h, ib, ic), prevcp(h, ib, ic)
    if is_heir(h, after, ib, jb, arc):
        return after
    return before if is_heir(h, before, ib, jb, arc) else int64(0)


@inlined
def held(h: Memory, ic: int) -> float:
    """Energy in the springs of contact `ic`."""
    normal, shear = twice_stored(h, ic, getr(h, ic, g.KCFN), getr(h, ic, g.KCFS))
    return (normal + shear) * real(h, 0.5)


@kernel
def hand_over(h: Memory, ic: int, jc: int, nx: float, ny: float) -> None:
    """Contact `jc` takes the force of contact `ic`, of the normal (nx, ny); ENERGY notes what is lost."""
    fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
    fx, fy = nx * fn + ny * fs, ny * fn - nx * fs
    if iget(h, ic, g.KB1) != iget(h, jc, g.KB1):
        fx, fy = -fx, -fy
    before = held(h, ic) + held(h, jc)
    mx, my, _, _, _, _ = meet(h, iget(h, jc, g.KCCOD), iget(h, jc, g.KCP1), iget(h, jc, g.KCP2))
    putr(h, jc, g.KCFN, getr(h, jc, g.KCFN) + (fx * mx + fy * my))
    putr(h, jc, g.KCFS, getr(h, jc, g.KCFS) + (fx * my - fy * mx))
    no_force(h, ic)
    h.cd[g.WFRIC] += before - held(h, jc)


@kernel
def over_bisector(h: Memory, ic: int, ib: int) -> bool:
    """Let contact `ic` go on to the next edge of block `ib`, if its corner is past a bisector there."""
    arc, edge = arc_and_edge(h, ic)
    code, ia = iget(h, ic, g.KCCOD), iget(h, edge, g.KR)
    if getr(h, edge, g.KRAD) < 0 and past(h, edge, arc) > h.cr[g.GTOL]:
        return mvfor(h, ic, ib, code)
    return getr(h, ia, g.KRAD) < 0 and past(h, ia, arc) < -h.cr[g.GTOL] and mvbak(h, ic, ib, code)


@kernel
def leave_notch(h: Memory, ic: int, nx: float, ny: float) -> bool:
    """Contact `ic`, of the normal (nx, ny), has a force; if it is out of a notch, that goes where it belongs.

    True if the contact is on another edge now.
    """
    if iget(h, ic, g.KCCOD) == g.CORNER_CORNER:
        return False
    jc = heir(h, ic)
    if jc == 0:
        _, edge = arc_and_edge(h, ic)
        return over_bisector(h, ic, iget(h, edge, g.KNB))
    if out_of_notch(h, ic):
        hand_over(h, ic, jc, nx, ny)
    return False
