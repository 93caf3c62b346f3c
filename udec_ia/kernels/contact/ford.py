"""The contact pass: forces from relative displacements (FORD, CVEL, PUTFCE); report 2.6.

Each contact in its turn: its geometry, which may give it another code or place, or end it; the relative
velocity of its two blocks; its law, number 1 (springs.py) or one of the user's (joint_law.py); and what the
blocks feel. An account of the energy is told what the contact feels while it still holds what it felt before
(energy/contacts.py).
"""

from __future__ import annotations

from typing import Any

from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.heap.ahead import LEAD, fetch
from udec_ia.heap.apart import call_entry
from udec_ia.heap.jit import apart, inlined, kernel
from udec_ia.kernels.body.boundary_point import putfce, velocity_at
from udec_ia.kernels.contact.joint_law import by_law, has_law, is_open
from udec_ia.kernels.contact.springs import by_springs
from udec_ia.kernels.detect.depth import do_not_meet
from udec_ia.kernels.detect.gaps import gap_taken
from udec_ia.kernels.geometry.contact_geometry import OVERLAP_TOO_GREAT, faces
from udec_ia.kernels.links.lists import is_contact
from udec_ia.kernels.map.bridge import delc, no_force, to_virtual
from udec_ia.kernels.map.reclass import settle
from udec_ia.kernels.map.segments import ahead_by, same_segment
from udec_ia.layout import offsets as g

TURNED = 0.3  # sine of the angle; a little more than search.FACING, so that contacts do not come and go


@kernel
def restart(h: Memory, ic: int) -> tuple[float, float, float]:
    """Settle contact `ic` in a changed geometry, its forces as they are; normal (x, y) and overlap."""
    nx, ny, overlap = settle(h, ic)
    putr(h, ic, g.KCN, overlap)
    return nx, ny, overlap


@inlined
def is_twin(h: Memory, ic: int, jc: int, ib: int, jb: int) -> bool:
    """True if item `jc` of block `ib` is a contact with block `jb` too, nearer than FTOL to contact `ic`."""
    if not is_contact(h, jc) or (iget(h, jc, g.KB1) != jb and iget(h, jc, g.KB2) != jb):
        return False
    dx, dy = getr(h, jc, g.KXC) - getr(h, ic, g.KXC), getr(h, jc, g.KYC) - getr(h, ic, g.KYC)
    return dx * dx + dy * dy < h.cr[g.FTOL] * h.cr[g.FTOL] and iget(h, jc, g.KCCOD) != g.VIRTUAL


@inlined
def has_twin(h: Memory, ic: int) -> bool:
    """True if a neighbour on block KB1 is a contact of the same two blocks, nearer than FTOL."""
    ib, jb = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    return is_twin(h, ic, iget(h, ic, g.KL1), ib, jb) or is_twin(h, ic, iget(h, ic, g.KLB1), ib, jb)


@inlined
def passed(h: Memory, ic: int, after: int, before: int, ip: int, arc: bool, nx: float, ny: float) -> bool:
    """True if contact `ic` and a neighbour on that segment of corner `ip` are past each other.

    (nx, ny): normal of the contact, away from the block of the corner.
    """
    x, y, most = getr(h, ic, g.KXC), getr(h, ic, g.KYC), h.cr[g.FTOL]
    if same_segment(h, after, ip, arc) and ahead_by(h, ip, arc, after, x, y, nx, ny) < -most:
        return True
    return same_segment(h, before, ip, arc) and ahead_by(h, ip, arc, before, x, y, nx, ny) > most


@inlined
def overtaken(h: Memory, ic: int, nx: float, ny: float) -> bool:
    """True if contact `ic`, of the normal (nx, ny), and a neighbour on the same segment are past each other.

    If it is open, something has slipped through its gap.
    """
    code = iget(h, ic, g.KCCOD)
    after, before, ip = iget(h, ic, g.KL1), iget(h, ic, g.KLB1), iget(h, ic, g.KCP1)
    if passed(h, ic, after, before, ip, code != g.EDGE_CORNER, nx, ny):
        return True
    after, before, ip = iget(h, ic, g.KL2), iget(h, ic, g.KLB2), iget(h, ic, g.KCP2)
    return passed(h, ic, after, before, ip, code != g.CORNER_EDGE, -nx, -ny)


@inlined
def turned_away(h: Memory, ic: int, nx: float, ny: float) -> bool:
    """True if the arc of a corner on an edge has turned away from it by more than TURNED.

    The circle of a blunt corner reaches far beyond its arc, even beyond its block. (nx, ny) is the contact's
    normal.
    """
    code = iget(h, ic, g.KCCOD)
    if code == g.CORNER_EDGE:
        return not faces(h, iget(h, ic, g.KCP1), nx, ny, real(h, TURNED))
    return code == g.EDGE_CORNER and not faces(h, iget(h, ic, g.KCP2), -nx, -ny, real(h, TURNED))


@inlined
def is_no_wall(h: Memory, ic: int, nx: float, ny: float, overlap: float) -> bool:
    """True if open contact `ic` has turned away, been overtaken, or has a third block in its gap."""
    if turned_away(h, ic, nx, ny) or overtaken(h, ic, nx, ny):
        return True
    return overlap < 0 and gap_taken(h, ic, (nx, ny, overlap, getr(h, ic, g.KXC), getr(h, ic, g.KYC)))


@kernel
def squeezed(h: Memory, ic: int, nx: float, ny: float, overlap: float) -> bool:
    """True if contact `ic` overlaps by more than a narrow tip can stand.

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
    return overtaken(h, ic, nx, ny)


@inlined
def drop(h: Memory, ic: int, nx: float, ny: float, overlap: float) -> bool:
    """Delete contact `ic` if it is open too far or no wall any more, or idle beside a twin.

    A bridge of the map becomes virtual instead; beside a twin it stays. (nx, ny) is the contact's normal.
    """
    if overlap > 0 and getr(h, ic, g.KCFN) != 0:
        return False
    is_bridge = iget(h, ic, g.KD1) == iget(h, ic, g.KD2)
    if overlap >= -h.cr[g.BTOL]:
        gone = overlap <= 0 and is_no_wall(h, ic, nx, ny, overlap)
        if not gone and (is_bridge or not has_twin(h, ic)):
            return False
    h.ci[g.NBROKE] += 1
    if is_bridge:
        to_virtual(h, ic)
    else:
        delc(h, ic)
    return True


@inlined
def cvel(h: Memory, ic: int, soft: Any) -> tuple[float, float]:
    """Velocity of block KB2 relative to block KB1 at contact `ic` (CVEL)."""
    x, y = getr(h, ic, g.KXC), getr(h, ic, g.KYC)
    vxi, vyi = velocity_at(h, iget(h, ic, g.KB1), ic, x, y, soft)
    vxj, vyj = velocity_at(h, iget(h, ic, g.KB2), ic, x, y, soft)
    return vxj - vxi, vyj - vyi


@inlined
def put_velocity(h: Memory, ic: int, xd: float, yd: float) -> None:
    """Relative velocity of contact `ic` := (xd, yd)."""
    putr(h, ic, g.KXDC, xd)
    putr(h, ic, g.KYDC, yd)


@inlined
def push(
    h: Memory, ic: int, nx: float, ny: float, normal: float, shear: float, overlap: float, soft: Any
) -> None:
    """Let the blocks of contact `ic` feel its forces.

    Error 15 if it overlaps by too much, or if a tip is squeezed out between two others.
    """
    fx, fy = nx * normal + ny * shear, ny * normal - nx * shear
    x, y = getr(h, ic, g.KXC), getr(h, ic, g.KYC)
    putfce(h, iget(h, ic, g.KB1), ic, -fx, -fy, x, y, soft)
    putfce(h, iget(h, ic, g.KB2), ic, fx, fy, x, y, soft)
    too_great = overlap > h.cr[g.DTOL2] or (overlap > h.cr[g.FTOL] and squeezed(h, ic, nx, ny, overlap))
    if too_great and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = OVERLAP_TOO_GREAT
        h.ci[g.IERAD] = ic


@inlined
def opens(h: Memory, ic: int, account: Any) -> None:
    """Contact `ic` overlaps no more, and loses what its springs held. account: as in ford."""
    if account != 0 and getr(h, ic, g.KCFN) != 0:
        zero = real(h, 0.0)
        none = zero, zero
        call_entry(account, h, ic, False, zero, none, none, none, none)
    no_force(h, ic)


@inlined
def ford(h: Memory, ic: int, soft: Any, joints: Any, account: Any) -> None:
    """Force and displacement calculation for contact `ic` (FORD), which may vanish in it.

    Geometry, motion, law, and what the blocks feel. soft, joints: as in run_cycles. account: where
    energy.contacts.note_contact is, 0 if no account is kept.
    """
    before, zero = getr(h, ic, g.KCN), real(h, 0.0)
    nx, ny, overlap = settle(h, ic)
    putr(h, ic, g.KCN, overlap)
    own = joints is not None and has_law(h, joints, ic)
    if not own and overlap <= zero:
        opens(h, ic, account)
    idle = is_open(h, ic, overlap) if own else getr(h, ic, g.KCFN) == zero
    still = h.cr[g.ULOOK] < h.cr[g.HTOL] and -h.cr[g.BTOL] <= overlap <= zero
    if idle and not still and drop(h, ic, nx, ny, overlap):
        return  # an open contact looks at its neighbours only when the domain pass says so
    xd, yd = cvel(h, ic, soft)
    if not own and overlap <= zero:
        put_velocity(h, ic, xd, yd)
        return
    closing, sliding = -(xd * nx + yd * ny), yd * nx - xd * ny
    if own:
        fn, fs, us, dn, ds = by_law(h, joints, ic, before, sliding)
    else:
        fn, fs, us, dn, ds = by_springs(h, ic, before, closing, sliding)
    if account != 0:
        call_entry(account, h, ic, own, before, (nx, ny), (xd, yd), (fn, fs), (dn, ds))
    put_velocity(h, ic, xd, yd)
    putr(h, ic, g.KCFN, fn)
    putr(h, ic, g.KCFS, fs)
    putr(h, ic, g.KCS, us)
    push(h, ic, nx, ny, fn + dn, fs + ds, overlap, soft)


@inlined
def look_ahead(h: Memory, ic: int) -> int:
    """Fetch what contact `ic` is going to look at; returns the contact after it, 0 where there is none."""
    if ic == 0:
        return int64(0)
    fetch(h, ic, g.NVCN, LEAD)
    fetch(h, iget(h, ic, g.KCP1), g.NVCR)
    fetch(h, iget(h, ic, g.KCP2), g.NVCR)
    if h.cr[g.ULOOK] >= h.cr[g.HTOL] and getr(h, ic, g.KCFN) == 0:  # it looks at its neighbours' first words
        fetch(h, iget(h, ic, g.KL1), g.NVDO)
        fetch(h, iget(h, ic, g.KL2), g.NVDO)
        fetch(h, iget(h, ic, g.KLB1), g.NVDO)
        fetch(h, iget(h, ic, g.KLB2), g.NVDO)
    return iget(h, ic, g.KC)


@kernel
def ford_all(h: Memory, soft: Any, joints: Any, account: Any) -> None:
    """All contacts that are not virtual; the first whose overlap is too great raises error 15."""
    ic = h.ci[g.ICPNT]
    ahead = ic
    for _ in range(LEAD):
        ahead = look_ahead(h, ahead)
    while ic != 0:
        ahead = look_ahead(h, ahead)  # not `ic`, which may vanish
        following = iget(h, ic, g.KC)
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            ford(h, ic, soft, joints, account)
        ic = following


@apart
def settle_all(h: Memory) -> bool:
    """Bring every contact up to date with a changed geometry, its force as it is."""
    ic = h.ci[g.ICPNT]
    while ic != 0:
        following = iget(h, ic, g.KC)
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            nx, ny, overlap = restart(h, ic)
            drop(h, ic, nx, ny, overlap)
        ic = following
    return True
