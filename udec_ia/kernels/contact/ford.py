"""The contact pass: forces from relative displacements (FORD, CVEL, PUTFCE); report 2.6.

For each contact in turn the pass calculates its place, the relative velocity of its two blocks, its law
(constitutive), and the forces on its blocks. It reads the map. It writes only to the contact, the force sums
of its blocks, WFRIC and the first error (NERR, IERAD); with ENERGY also to WSHAPE and WSTIF, with joint
materials to LSTIFF. Contacts that depend on their neighbours, or change the map, wait until all
others are done (map_changes.py).

The energy account gets the new forces while the contact still has the old ones (energy/work_account.py).

After a command that changes the map or the type of a block, `sum_all_forces` sums the same forces for all
blocks.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.kernel_memory import LEAD, fetch
from udec_ia.compiling.non_inlined_calls import call_entry
from udec_ia.errors import OVERLAP_TOO_GREAT
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.kernels.body.boundary_point import motion_at, putfce, velocity_at
from udec_ia.kernels.body.fdef import reset_point_forces, zone_forces
from udec_ia.kernels.body.sdef import reset_applied
from udec_ia.kernels.constitutive.joint_laws import has_own_law, is_idle, joint_forces
from udec_ia.kernels.constitutive.joint_models import stays_open
from udec_ia.kernels.constitutive.joint_stresses import needs_lengths, place_of_force, stress_forces
from udec_ia.kernels.contact.map_changes import needs_no_check, open_contact
from udec_ia.kernels.geometry.contact_geometry import (
    USED_WORDS,
    coord,
    coord_called,
    prefetch_corners,
    prefetch_points,
    prefetch_waiting,
)
from udec_ia.kernels.links.longer_groups import contact_words, joint_at, joint_behind
from udec_ia.layout import offsets as g


@inlined
def cvel(h: Memory, ic: int, nx: float, ny: float, soft: Any, joints: Any) -> tuple[float, float, float]:
    """Velocity of block KB2 relative to block KB1 at contact `ic` (CVEL), and their relative strain rate.

    The strain rate is that along the joint, and 0 in a pass without joint materials: by it the blocks slide
    faster or slower at the resultant of the stress than at the contact. nx, ny: normal.
    """
    x, y, ib, jb = getr(h, ic, g.KXC), getr(h, ic, g.KYC), iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    if soft is None or joints is None:
        vxi, vyi = velocity_at(h, ib, ic, x, y, soft)
        vxj, vyj = velocity_at(h, jb, ic, x, y, soft)
        return vxj - vxi, vyj - vyi, real(h, 0.0)
    vxi, vyi, ei = motion_at(h, ib, ic, x, y, ny, -nx)
    vxj, vyj, ej = motion_at(h, jb, ic, x, y, ny, -nx)
    return vxj - vxi, vyj - vyi, ej - ei


@inlined
def set_velocity(h: Memory, ic: int, xd: float, yd: float) -> None:
    """Relative velocity of contact `ic` := (xd, yd)."""
    putr(h, ic, g.KXDC, xd)
    putr(h, ic, g.KYDC, yd)


@inlined
def add_contact_forces(
    h: Memory,
    ic: int,
    nx: float,
    ny: float,
    normal: float,
    shear: float,
    overlap: float,
    has_joint: bool,
    soft: Any,
) -> None:
    """Add the forces of contact `ic` to its blocks; error 15 if it overlaps by more than DTOL2.

    has_joint: its force acts at the resultant of the stress of its joint. soft: as in run_cycles.
    """
    fx, fy = nx * normal + ny * shear, ny * normal - nx * shear
    x, y = getr(h, ic, g.KXC), getr(h, ic, g.KYC)
    if has_joint:
        place = getr(h, joint_behind(h, ic), g.KCJX)
        x, y = x + ny * place, y - nx * place
    putfce(h, iget(h, ic, g.KB1), ic, -fx, -fy, x, y, soft)
    putfce(h, iget(h, ic, g.KB2), ic, fx, fy, x, y, soft)
    if overlap > h.cr[g.DTOL2] and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = OVERLAP_TOO_GREAT
        h.ci[g.IERAD] = ic


@inlined
def must_wait(h: Memory, ic: int, has_joint: bool, own: bool, overlap: float, margin: float) -> bool:
    """True if contact `ic` may change the map, or depends on its neighbours.

    margin: see coord.
    """
    if margin < 0 or h.ci[g.LSHORT] != 0 or overlap > h.cr[g.FTOL]:
        return True
    if has_joint and needs_lengths(h, ic, joint_behind(h, ic)):
        return True
    return is_idle(h, ic, own, overlap) and not needs_no_check(h, overlap)


@inlined
def ford(h: Memory, ic: int, soft: Any, joints: Any, account: Any, has_waited: bool) -> tuple[int, bool]:
    """Calculate force and displacement of contact `ic` (FORD).

    Returns 0, or its address if it has to wait, negative if the contact has a law of its own (joint_laws.py);
    and True if it loses its force in this step. Others: as in ford_all.
    """
    ix, has_joint = joint_behind(h, ic), joints is not None and joint_at(h, ic) != 0
    own = joints is not None and (has_joint or has_own_law(h, joints, ic))
    nx, ny, overlap, margin = coord(h, ic)
    if not has_waited and must_wait(h, ic, has_joint, own, overlap, margin):
        return (-int64(ic) if own else int64(ic)), False
    before, zero = getr(h, ic, g.KCN), real(h, 0.0)
    putr(h, ic, g.KCN, overlap)
    xd, yd, stretching = cvel(h, ic, nx, ny, soft, joints)
    if not own and overlap <= zero:
        opens = getr(h, ic, g.KCFN) != 0
        open_contact(h, ic)
        set_velocity(h, ic, xd, yd)
        return int64(0), opens
    closing, sliding = -(xd * nx + yd * ny), yd * nx - xd * ny
    if joints is not None and has_joint:
        if getr(h, ix, g.KCJSN) == 0 and stays_open(h, ic, ix, overlap):
            putr(h, ic, g.KCS, getr(h, ic, g.KCS) + sliding * h.cr[g.TDEL])
            set_velocity(h, ic, xd, yd)
            return int64(0), False
        if soft is not None:  # at the resultant of the stress, and not at the contact
            sliding -= getr(h, ix, g.KCJX) * stretching
        fn, fs, us, dn, ds = stress_forces(h, joints, ic, ix, before, overlap, sliding)
    else:
        fn, fs, us, dn, ds = joint_forces(h, joints, ic, own, before, closing, sliding)
    if account != 0:
        call_entry(account, h, ic, own, before, (nx, ny), (xd, yd), (fn, fs), (dn, ds))
    opens = fn == 0 and getr(h, ic, g.KCFN) != 0
    set_velocity(h, ic, xd, yd)
    putr(h, ic, g.KCFN, fn)
    putr(h, ic, g.KCFS, fs)
    putr(h, ic, g.KCS, us)
    add_contact_forces(h, ic, nx, ny, fn + dn, fs + ds, overlap, has_joint, soft)
    return int64(0), opens


@inlined
def prefetch_contact(h: Memory, ic: int, beyond: int, joints: Any) -> int:
    """Prefetch the corners of contact `ic`, and a contact farther on; returns the next one, 0 at the end.

    beyond: words of LEAD contacts with what lies behind them.
    """
    if ic == 0:
        return int64(0)
    if joints is None:
        fetch(h, ic, g.NVCN, LEAD)
    else:
        fetch(h, ic + beyond, USED_WORDS)
    prefetch_corners(h, ic)
    return iget(h, ic, g.KC)


@inlined
def prefetch_next_points(h: Memory, ic: int) -> int:
    """Prefetch the grid-points at contact `ic`; returns the next contact, 0 at the end."""
    if ic == 0:
        return int64(0)
    prefetch_points(h, ic)
    return iget(h, ic, g.KC)


@kernel
def ford_all(h: Memory, soft: Any, joints: Any, change_map: Any, account: Any, waiting: Any) -> None:
    """Calculate all contacts that are not virtual; the first whose overlap is too large raises error 15.

    soft, joints: as in run_cycles. change_map: of map_changes.py. account: add_contact_work of
    work_account.py, or 0 without an account. waiting: room for the addresses of all contacts; those that
    have opened by a law of their own are entered from its end, and are compared with their neighbours last.
    """
    n = opened = 0
    ic = h.ci[g.ICPNT]
    ahead, nearer, beyond = ic, ic, LEAD * contact_words(h)
    for k in range(LEAD):
        ahead = prefetch_contact(h, ahead, beyond, joints)
        if soft is not None and k < LEAD // 2:
            nearer = prefetch_next_points(h, nearer)
    while ic != 0:
        ahead = prefetch_contact(h, ahead, beyond, joints)
        if soft is not None:
            nearer = prefetch_next_points(h, nearer)
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            waits, opens = ford(h, ic, soft, joints, account, False)
            if waits != 0:
                waiting[n] = waits
                n += 1
            elif joints is not None and opens:
                opened += 1
                waiting[len(waiting) - opened] = -ic
        ic = iget(h, ic, g.KC)
    if n > 0:
        call_entry(change_map, h, waiting, int64(n), False)
    late = 0
    for k in range(n):
        prefetch_waiting(h, waiting, n, k)
        if waiting[k] != 0:
            ic = abs(waiting[k])
            _, opens = ford(h, ic, soft, joints, account, True)
            if joints is not None and opens:
                waiting[late] = -ic
                late += 1
    for first, m in ((0, late), (len(waiting) - opened, opened)):
        if m > 0:
            call_entry(change_map, h, waiting[first : first + m], int64(m), True)


@kernel
def _inner_forces(h: Memory, ib: int) -> None:
    """Applied stress of block `ib` := 0, or the force sums of its grid-points := those of its zones."""
    zero = real(h, 0.0)
    ie = iget(h, ib, g.KBEX)
    if iget(h, ib, HEAD) == g.MSDEF:
        reset_applied(h, ie)
    elif iget(h, ib, HEAD) == g.MFDEF:
        reset_point_forces(h, ib)
        iz = iget(h, ie, g.KFZ)
        while iz != 0:
            zone_forces(h, iz, zero, zero, zero)
            iz = iget(h, iz, g.KZ)


@kernel
def sum_all_forces(h: Memory, soft: Any) -> None:
    """Force sums from the forces stored in the contacts and the stresses in the zones."""
    zero = real(h, 0.0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        putr(h, ib, g.KBFX, zero)
        putr(h, ib, g.KBFY, zero)
        putr(h, ib, g.KBFT, zero)
        if soft is not None:
            _inner_forces(h, ib)
        ib = iget(h, ib, g.KB)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        if getr(h, ic, g.KCFN) != zero:
            nx, ny, _, _ = coord_called(h, ic)
            fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
            fx, fy = nx * fn + ny * fs, ny * fn - nx * fs
            x, y = place_of_force(h, ic)
            putfce(h, iget(h, ic, g.KB1), ic, -fx, -fy, x, y, soft)
            putfce(h, iget(h, ic, g.KB2), ic, fx, fy, x, y, soft)
        ic = iget(h, ic, g.KC)
