"""Changes of the map in the contact pass: contacts get another code or place, and contacts are deleted.

The force of a contact depends on the contact, its two blocks and its material. Work that depends on
neighbours, or changes the map, waits until all others have their forces (ford.py). The contacts that wait are
then updated here in list order, and get their forces last. So the forces of all others do not depend on the
order of the list.

A contact waits if its code and corners do not fit its place any more, if its corner has lost its arc, if it
has no force and must be compared with its neighbours (domain_pass.py) or is open too far, if it overlaps so
much that its tip may have been squeezed through, or if the lengths of its joint are to be found.

In a notch a corner touches both edges: it gets its contact with the second from ETOL before that on
(detect/contact_search.py), and for a while it holds both. When it has left the notch by more than D, the
contact with the edge behind it has no place. It is deleted if it carries no force; otherwise its force is
transferred to the other contact. In a slight notch the places at which a corner touches the two edges may be
nearer than FTOL. Then it has one contact, which passes from edge to edge at their bisector, as at a straight
corner. A contact with a law of its own, which may have a memory, stays until it opens.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.errors import OVERLAP_TOO_GREAT
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.kernels.constitutive.coulomb_joint import lose_shear
from udec_ia.kernels.constitutive.joint_laws import is_idle, reset_forces
from udec_ia.kernels.constitutive.joint_properties import stored_energy, twice_stored
from udec_ia.kernels.contact.joint_lengths import renew_lengths, waits_for_length
from udec_ia.kernels.detect.point_depth import do_not_meet
from udec_ia.kernels.detect.third_block_in_gap import gap_is_occupied
from udec_ia.kernels.geometry.contact_geometry import (
    ce,
    distance_past,
    faces,
    has_no_arc,
    meet,
    prefetch_waiting,
)
from udec_ia.kernels.links.linked_lists import corner_of, is_contact, nextcp, other, prevcp
from udec_ia.kernels.links.longer_groups import joint_at
from udec_ia.kernels.map.bridge import delc, to_virtual
from udec_ia.kernels.map.contact_reclassification import mvbak, mvfor, settle
from udec_ia.kernels.map.domain_segments import distance_ahead, next_not_virtual, not_virtual, same_segment
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
def has_left_edge(h: Memory, ic: int) -> bool:
    """True if the corner of a contact on an edge has no arc any more, or has slid out of a notch."""
    if iget(h, ic, g.KCCOD) == g.CORNER_CORNER:
        return False
    arc, _ = arc_and_edge(h, ic)
    if has_no_arc(h, arc):
        return getr(h, ic, g.KCFN) == 0
    return out_of_notch(h, ic)


@inlined
def is_contact_of_arc(h: Memory, jc: int, ib: int, jb: int, arc: int) -> bool:
    """True if item `jc` of block `ib` is a contact of its corner `arc` with block `jb`."""
    if not is_contact(h, jc) or iget(h, jc, g.KCCOD) == g.VIRTUAL or other(h, ib, jc) != jb:
        return False
    on_edge = iget(h, jc, g.KCCOD) == (g.EDGE_CORNER if iget(h, jc, g.KB1) == ib else g.CORNER_EDGE)
    return corner_of(h, ib, jc) == arc and not on_edge


@kernel
def neighbour_on_same_arc(h: Memory, ic: int) -> int:
    """A contact of the same corner beside contact `ic`, which has left a notch; 0 if there is none."""
    arc, edge = arc_and_edge(h, ic)
    ib, jb = iget(h, arc, g.KNB), iget(h, edge, g.KNB)
    after, before = nextcp(h, ib, ic), prevcp(h, ib, ic)
    if is_contact_of_arc(h, after, ib, jb, arc):
        return after
    return before if is_contact_of_arc(h, before, ib, jb, arc) else int64(0)


@kernel
def transfer_force(h: Memory, ic: int, jc: int, nx: float, ny: float) -> None:
    """Transfer the force of contact `ic`, with normal (nx, ny), to contact `jc`; ENERGY records the loss."""
    fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
    fx, fy = nx * fn + ny * fs, ny * fn - nx * fs
    if iget(h, ic, g.KB1) != iget(h, jc, g.KB1):
        fx, fy = -fx, -fy
    before = stored_energy(h, ic) + stored_energy(h, jc)
    mx, my, _, _, _, _ = meet(h, iget(h, jc, g.KCCOD), iget(h, jc, g.KCP1), iget(h, jc, g.KCP2))
    putr(h, jc, g.KCFN, getr(h, jc, g.KCFN) + (fx * mx + fy * my))
    putr(h, jc, g.KCFS, getr(h, jc, g.KCFS) + (fx * my - fy * mx))
    reset_forces(h, ic)
    h.cd[g.WFRIC] += before - stored_energy(h, jc)


@kernel
def move_over_bisector(h: Memory, ic: int, ib: int) -> bool:
    """Move contact `ic` to the next edge of block `ib`, if its corner is past a bisector there."""
    arc, edge = arc_and_edge(h, ic)
    code, ia = iget(h, ic, g.KCCOD), iget(h, edge, g.KR)
    if getr(h, edge, g.KRAD) < 0 and distance_past(h, edge, arc) > h.cr[g.GTOL]:
        return mvfor(h, ic, ib, code)
    return getr(h, ia, g.KRAD) < 0 and distance_past(h, ia, arc) < -h.cr[g.GTOL] and mvbak(h, ic, ib, code)


@kernel
def leave_notch(h: Memory, ic: int, nx: float, ny: float) -> bool:
    """Transfer the force of contact `ic`, of the normal (nx, ny), if its corner has left a notch.

    Returns True if the contact is on another edge now.
    """
    if iget(h, ic, g.KCCOD) == g.CORNER_CORNER:
        return False
    jc = neighbour_on_same_arc(h, ic)
    if jc == 0:
        _, edge = arc_and_edge(h, ic)
        return move_over_bisector(h, ic, iget(h, edge, g.KNB))
    if out_of_notch(h, ic):
        transfer_force(h, ic, jc, nx, ny)
    return False


ALL, NONE_WAITING = -1, np.zeros(0, np.int64)  # all contacts; none that waits
TURNED = 0.3  # sine of the angle; a little more than search.FACING, so that contacts do not come and go


@kernel
def update_geometry(h: Memory, ic: int) -> tuple[float, float, float]:
    """Update contact `ic` to a changed geometry and keep its forces; returns normal (x, y) and overlap."""
    nx, ny, overlap = settle(h, ic)
    putr(h, ic, g.KCN, overlap)
    return nx, ny, overlap


@inlined
def is_duplicate(h: Memory, ic: int, jc: int, jb: int) -> bool:
    """True if item `jc` of a block is a contact with block `jb` too, nearer than FTOL to contact `ic`."""
    if not is_contact(h, jc) or (iget(h, jc, g.KB1) != jb and iget(h, jc, g.KB2) != jb):
        return False
    dx, dy = getr(h, jc, g.KXC) - getr(h, ic, g.KXC), getr(h, jc, g.KYC) - getr(h, ic, g.KYC)
    return dx * dx + dy * dy < h.cr[g.FTOL] * h.cr[g.FTOL] and iget(h, jc, g.KCCOD) != g.VIRTUAL


@inlined
def has_duplicate(h: Memory, ic: int) -> bool:
    """True if a neighbour on block KB1 is a contact of the same two blocks, nearer than FTOL."""
    jb = iget(h, ic, g.KB2)
    return is_duplicate(h, ic, iget(h, ic, g.KL1), jb) or is_duplicate(h, ic, iget(h, ic, g.KLB1), jb)


@inlined
def has_passed_on_segment(
    h: Memory, ic: int, after: int, before: int, ip: int, arc: bool, nx: float, ny: float
) -> bool:
    """True if contact `ic` and a neighbour on that segment of corner `ip` are past each other.

    (nx, ny): normal of the contact, away from the block of the corner.
    """
    x, y, tolerance = getr(h, ic, g.KXC), getr(h, ic, g.KYC), h.cr[g.FTOL]
    if same_segment(h, after, ip, arc) and distance_ahead(h, ip, arc, after, x, y, nx, ny) < -tolerance:
        return True
    return same_segment(h, before, ip, arc) and distance_ahead(h, ip, arc, before, x, y, nx, ny) > tolerance


@inlined
def has_passed_neighbour(h: Memory, ic: int, nx: float, ny: float) -> bool:
    """True if contact `ic`, of the normal (nx, ny), and a neighbour on the same segment are past each other.

    If it is open, a block has passed through its gap.
    """
    code, ib, jb = iget(h, ic, g.KCCOD), iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    after, before = next_not_virtual(h, ib, ic), not_virtual(h, ib, prevcp(h, ib, ic))
    if has_passed_on_segment(h, ic, after, before, iget(h, ic, g.KCP1), code != g.EDGE_CORNER, nx, ny):
        return True
    after, before = next_not_virtual(h, jb, ic), not_virtual(h, jb, prevcp(h, jb, ic))
    return has_passed_on_segment(h, ic, after, before, iget(h, ic, g.KCP2), code != g.CORNER_EDGE, -nx, -ny)


@inlined
def has_turned_away(h: Memory, ic: int, nx: float, ny: float) -> bool:
    """True if the arc of a corner on an edge has turned away from it by more than TURNED.

    The circle of a blunt corner reaches far beyond its arc, even beyond its block. (nx, ny) is the contact's
    normal.
    """
    code = iget(h, ic, g.KCCOD)
    if code == g.CORNER_EDGE:
        return not faces(h, iget(h, ic, g.KCP1), nx, ny, real(h, TURNED))
    return code == g.EDGE_CORNER and not faces(h, iget(h, ic, g.KCP2), -nx, -ny, real(h, TURNED))


@inlined
def separates_no_domains(h: Memory, ic: int, nx: float, ny: float, overlap: float) -> bool:
    """True if open contact `ic` separates no domains: turned away, overtaken, or a third block in its gap."""
    if has_turned_away(h, ic, nx, ny) or has_passed_neighbour(h, ic, nx, ny):
        return True
    return overlap < 0 and gap_is_occupied(h, ic, (nx, ny, overlap, getr(h, ic, g.KXC), getr(h, ic, g.KYC)))


@kernel
def is_squeezed_through(h: Memory, ic: int, nx: float, ny: float, overlap: float) -> bool:
    """True if contact `ic` overlaps by more than the width of a narrow tip.

    Either the tip has come out on the other side, so that the blocks do not overlap there any more. Or the
    arc's centre is in the other block and the contact has passed a neighbour: the tip is squeezed out between
    two blocks that touch.
    """
    gap = nx, ny, overlap, getr(h, ic, g.KXC), getr(h, ic, g.KYC)
    if do_not_meet(h, iget(h, ic, g.KB1), iget(h, ic, g.KB2), gap):
        return True
    code, ip, iq = iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)
    if (code == g.EDGE_CORNER or getr(h, ip, g.KRAD) >= overlap) and (
        code == g.CORNER_EDGE or getr(h, iq, g.KRAD) >= overlap
    ):
        return False
    return has_passed_neighbour(h, ic, nx, ny)


@inlined
def delete_if_obsolete(h: Memory, ic: int, nx: float, ny: float, overlap: float) -> bool:
    """Delete contact `ic` if it is open too far, separates no domains any more, or is idle beside a twin.

    A bridge of the map becomes virtual instead; beside a twin it stays. (nx, ny) is the contact's normal.
    """
    if overlap > 0 and getr(h, ic, g.KCFN) != 0:
        return False
    is_bridge = iget(h, ic, g.KD1) == iget(h, ic, g.KD2)
    if overlap >= -h.cr[g.BTOL]:
        gone = has_left_edge(h, ic) or (overlap <= 0 and separates_no_domains(h, ic, nx, ny, overlap))
        if not gone and (is_bridge or not has_duplicate(h, ic)):
            return False
    h.ci[g.NBROKE] += 1
    if is_bridge:
        to_virtual(h, ic)
    else:
        delc(h, ic)
    return True


@inlined
def open_contact(h: Memory, ic: int) -> None:
    """Contact `ic` opens and loses the energy of its springs."""
    lose_shear(h, ic, getr(h, ic, g.KCFS))
    reset_forces(h, ic)


@inlined
def energy_lost(h: Memory, ic: int, overlap: float) -> float:
    """Energy lost with contact `ic`, now open to `overlap`; a law of its own may store some.

    It is the energy of its springs, and the work of its normal force in half of this step. A contact with a
    joint material has lost its energy before.
    """
    fn = getr(h, ic, g.KCFN)
    if fn == 0 or joint_at(h, ic) != 0:
        return real(h, 0.0)
    normal, shear = twice_stored(h, ic, fn, getr(h, ic, g.KCFS))
    return (normal + shear + fn * (overlap - getr(h, ic, g.KCN))) * real(h, 0.5)


@inlined
def needs_no_check(h: Memory, overlap: float) -> bool:
    """True if a contact without a force and with that overlap needs no comparison and no deletion."""
    return h.cr[g.ULOOK] < h.cr[g.HTOL] and overlap >= -h.cr[g.BTOL]


@kernel
def update_contact(h: Memory, ic: int, own: bool) -> bool:
    """Update contact `ic`; False if it is deleted. own: True if it has a law of its own."""
    nx, ny, overlap = settle(h, ic)
    if not own and getr(h, ic, g.KCFN) != 0 and leave_notch(h, ic, nx, ny):
        nx, ny, overlap = settle(h, ic)
    if is_idle(h, ic, own, overlap) and (not needs_no_check(h, overlap) or has_left_edge(h, ic)):
        if overlap <= 0 and not own:
            open_contact(h, ic)
        lost = energy_lost(h, ic, overlap)
        if delete_if_obsolete(h, ic, nx, ny, overlap):
            h.cd[g.WFRIC] += lost
            return False
    if overlap > h.cr[g.FTOL] and is_squeezed_through(h, ic, nx, ny, overlap) and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = OVERLAP_TOO_GREAT
        h.ci[g.IERAD] = ic
    return True


@kernel
def update_all_contacts(h: Memory) -> None:
    """Update every contact to a changed geometry and keep its force; contacts may be deleted."""
    ic = h.ci[g.ICPNT]
    while ic != 0:
        following = iget(h, ic, g.KC)
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            nx, ny, overlap = update_geometry(h, ic)
            delete_if_obsolete(h, ic, nx, ny, overlap)
        ic = following


@outlined
def change_map(h: Memory, waiting: Any, n: int, have_forces: bool) -> bool:
    """Update the first `n` contacts of `waiting`; deleted ones are 0 there afterwards.

    waiting: their addresses; negative if they have a law of their own. ALL for `n`: a command has changed the
    geometry, and all contacts are updated. have_forces: they have just opened, so that no length may change.
    """
    if n == ALL:
        update_all_contacts(h)
    finds_lengths = False
    for k in range(n):
        prefetch_waiting(h, waiting, n, k)
        ic = abs(waiting[k])
        if not update_contact(h, ic, waiting[k] < 0):
            waiting[k] = 0
        elif not have_forces and waits_for_length(h, ic):  # which the updates that follow do not change
            finds_lengths = True
    if finds_lengths:
        renew_lengths(h, waiting, n)
    return True
