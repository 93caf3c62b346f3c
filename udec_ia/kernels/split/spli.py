"""Split of one block along a line or a polyline (SPLI), with the changes of its lists.

The crack enters at corner A and leaves at corner B, both on the block's outline; where it meets edges,
corners are made first. The clockwise list is then cut twice and closed twice, with a twin of each of the two
corners and two contacts across the new crack, one at either end:

    before   ... uA  mA  A  wA ............ uB  mB  B  wB ...
    one      wA ... uB  cB  B  cA  mA  A'     (the twin A' closes the loop at wA)
    other    wB ... uA  cA  A  cB  mB  B'     (the twin B' closes the loop at wB)

mA are the contacts on the arc of A that lie beyond the crack. Where a polyline turns, each part has a corner,
after A and after B. The crack is a new domain with the two contacts cA and cB; the domains outside A and B
stay as they are and are flagged for an update.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, puti, putr
from udec_ia.kernels.body.displacements import displacement_of_point, put_displacement
from udec_ia.kernels.geometry.block_shape import density_of, geo, makeb
from udec_ia.kernels.links.linked_lists import (
    flag,
    idomp,
    is_contact,
    is_corner,
    link,
    nextcp,
    nextp,
    prevcp,
    set_corner_of,
    to_front,
)
from udec_ia.kernels.links.longer_groups import displacement_at, edge_at, find_block, find_corner
from udec_ia.kernels.map.bridge import makec, maked
from udec_ia.kernels.map.domain_segments import is_on_arc
from udec_ia.layout import offsets as g


@kernel
def makep(h: Memory, ib: int, x: float, y: float) -> int:
    """Make a corner of block `ib` at (x, y), with the velocity of the block, in no list yet (MAKEP)."""
    ip = find_corner(h)
    puti(h, ip, HEAD, g.MCOR)
    puti(h, ip, g.KNB, ib)
    putr(h, ip, g.KXP, x)
    putr(h, ip, g.KYP, y)
    td = getr(h, ib, g.KTD)
    putr(h, ip, g.KXDP, getr(h, ib, g.KXD) - td * (y - getr(h, ib, g.KY)))
    putr(h, ip, g.KYDP, getr(h, ib, g.KYD) + td * (x - getr(h, ib, g.KX)))
    return ip


@kernel
def new_block(h: Memory, material: int, constitutive: int) -> int:
    """Make a rigid block without corners at the head of the block list."""
    ib = find_block(h)
    puti(h, ib, HEAD, g.MRIG)
    puti(h, ib, g.KMAT, material)
    puti(h, ib, g.KCONS, constitutive)
    to_front(h, g.IBPNT, g.KB, g.KBB, ib)
    h.ci[g.NBLK] += 1
    return ib


@kernel
def corner_on_edge(h: Memory, ib: int, iq: int, x: float, y: float) -> int:
    """Put a corner at (x, y) on the edge of block `ib` that ends at corner `iq`; returns it."""
    ia = iget(h, iq, g.KR)
    ax, ay = getr(h, ia, g.KXP), getr(h, ia, g.KYP)
    tx, ty = getr(h, iq, g.KXP) - ax, getr(h, iq, g.KYP) - ay
    here = (x - ax) * tx + (y - ay) * ty
    ip = makep(h, ib, x, y)
    last = ia
    item = iget(h, ia, g.KL)
    while item != iq and not is_on_arc(h, ib, item):
        if (getr(h, item, g.KXC) - ax) * tx + (getr(h, item, g.KYC) - ay) * ty > here:
            break
        set_corner_of(h, ib, item, ip)
        last = item
        item = nextcp(h, ib, item)
    link(h, ib, last, ip)
    link(h, ib, ip, item)
    puti(h, ip, g.KR, ia)
    puti(h, iq, g.KR, ip)
    if h.ci[g.LJOINT] != 0:
        puti(h, edge_at(h, ip), g.KEJ, iget(h, edge_at(h, iq), g.KEJ))
        puti(h, edge_at(h, ip), g.KEOUT, iget(h, edge_at(h, iq), g.KEOUT))
    return ip


@kernel
def _before_cut(h: Memory, ib: int, ip: int, nx: float, ny: float) -> int:
    """Last item before corner `ip` whose place on the arc lies on this side of the line (uA, uB).

    (nx, ny) is normal to the line and points to the other side.
    """
    item = prevcp(h, ib, ip)
    while is_contact(h, item):
        if iget(h, item, g.KCCOD) != g.VIRTUAL:
            dx, dy = getr(h, item, g.KXC) - getr(h, ip, g.KXP), getr(h, item, g.KYC) - getr(h, ip, g.KYP)
            if not is_on_arc(h, ib, item) or dx * nx + dy * ny < 0:
                break
        item = prevcp(h, ib, item)
    return item


@kernel
def _move_items(h: Memory, ib: int, jb: int, iad: int, last: int) -> None:
    """Move the items from `iad` to `last` from block `ib` to block `jb`."""
    item = int64(iad)
    while True:
        following = nextcp(h, ib, item)
        if is_corner(h, item):
            puti(h, item, g.KNB, jb)
        elif iget(h, item, g.KB1) == ib:
            puti(h, item, g.KB1, jb)
        else:
            puti(h, item, g.KB2, jb)
        if item == last:
            return
        item = following


@kernel
def _first_run_is_shorter(h: Memory, ib: int, ia: int, iz: int) -> bool:
    """True if there are no more items from corner `ia` to corner `iz` than from `iz` to `ia`."""
    one, two = nextcp(h, ib, ia), nextcp(h, ib, iz)
    while True:
        if one == iz:
            return True
        if two == ia:
            return False
        one, two = nextcp(h, ib, one), nextcp(h, ib, two)


@kernel
def _turn(h: Memory, ib: int, ip: int, bends: Any, step: int) -> int:
    """Put a corner of block `ib` after corner `ip` for each of the `bends`; returns the last, or `ip`.

    step: 1 to take them in order, -1 from the end.
    """
    last = int64(ip)
    for i in range(len(bends)):
        k = i if step > 0 else len(bends) - 1 - i
        iq = makep(h, ib, bends[k, 0], bends[k, 1])
        link(h, ib, last, iq)
        puti(h, iq, g.KR, last)
        last = iq
    return last


@kernel
def _number_edges(h: Memory, twin: int, joints: Any, step: int) -> None:
    """Give the edges of the crack that ends at `twin` the numbers of their joints.

    step: 1 if the last edge has the last number, -1 if it has the first.
    """
    ip = int64(twin)
    for i in range(len(joints)):
        joint = joints[len(joints) - 1 - i if step > 0 else i]
        if joint != 0:
            puti(h, edge_at(h, ip), g.KEJ, joint)
        ip = iget(h, ip, g.KR)


@kernel
def _close(
    h: Memory, ib: int, last: int, near: int, ip: int, bend: int, far: int, twin: int, run: int
) -> None:
    """Close the list of one part: run ... last, near, ip, bends, far, contacts on the twin's arc, twin.

    near, far: the crack's contacts at `ip` and at the twin. bend: the last bend, already linked to `ip`, or
    `ip`. The contacts on the twin's arc are already linked to each other; the first of them follows `far`.
    """
    link(h, ib, last, near)
    link(h, ib, near, ip)
    link(h, ib, bend, far)
    set_corner_of(h, ib, near, ip)
    set_corner_of(h, ib, far, twin)
    link(h, ib, twin, run)
    puti(h, nextp(h, ib, run), g.KR, twin)
    puti(h, twin, g.KR, bend)
    puti(h, ib, g.KP, twin)


@kernel
def _to_twin(h: Memory, ib: int, crack: int, first: int, last: int, twin: int) -> None:
    """Put the contacts from `first` to `last` (0 for none) between a crack contact and the twin."""
    if first == 0:
        link(h, ib, crack, twin)
        return
    link(h, ib, crack, first)
    link(h, ib, last, twin)
    item = int64(first)
    while item != twin:
        set_corner_of(h, ib, item, twin)
        item = nextcp(h, ib, item)


@kernel
def _contacts_beyond(h: Memory, ib: int, last: int, ip: int) -> tuple[int, int]:
    """First and last contact between item `last` and corner `ip`; 0 and 0 if there is none."""
    first = nextcp(h, ib, last)
    if first == ip:
        return int64(0), int64(0)
    return first, prevcp(h, ib, ip)


@kernel
def _towards(h: Memory, ip: int, iq: int, bends: Any, k: int) -> tuple[float, float]:
    """The vector from corner `ip` to bend `k`, or to corner `iq` if there are no bends."""
    x, y = getr(h, iq, g.KXP), getr(h, iq, g.KYP)
    if len(bends) > 0:
        x, y = bends[k, 0], bends[k, 1]
    return x - getr(h, ip, g.KXP), y - getr(h, ip, g.KYP)


@kernel
def spli(h: Memory, ib: int, ia: int, iz: int, bends: Any, joints: Any) -> int:
    """Split block `ib` from its corner `ia` to its corner `iz` (SPLI). Returns the new block.

    bends: (k, 2) points where the crack turns on its way. joints: (k + 1,) numbers of the joints that its
    parts belong to, 0 for none.

    A crack between neighbours has bends. There must be memory for one block, two corners
    and two for each bend, two contacts and one domain. The caller sets masses, corner circles and contact
    codes of both parts.
    """
    step = 1
    if not _first_run_is_shorter(h, ib, ia, iz):
        ia, iz, step = iz, ia, -1
    near_a, near_z = (0, len(bends) - 1) if step > 0 else (len(bends) - 1, 0)
    dx, dy = _towards(h, ia, iz, bends, near_a)
    ua = _before_cut(h, ib, ia, -dy, dx)
    dx, dy = _towards(h, iz, ia, bends, near_z)
    uz = _before_cut(h, ib, iz, -dy, dx)
    firsta, lasta = _contacts_beyond(h, ib, ua, ia)
    firstz, lastz = _contacts_beyond(h, ib, uz, iz)
    wa, wz = iget(h, ia, g.KL), iget(h, iz, g.KL)
    ida, idz = idomp(h, ib, ua), idomp(h, ib, uz)
    jb = new_block(h, iget(h, ib, g.KMAT), iget(h, ib, g.KCONS))
    puti(h, jb, g.KBFIX, iget(h, ib, g.KBFIX))
    ta = makep(h, ib, getr(h, ia, g.KXP), getr(h, ia, g.KYP))
    tz = makep(h, ib, getr(h, iz, g.KXP), getr(h, iz, g.KYP))
    crack = maked(h)
    ca = makec(h, jb, ib, g.CORNER_CORNER, crack, ida)
    cz = makec(h, jb, ib, g.CORNER_CORNER, idz, crack)
    if uz == ia:  # neither contacts nor corners between the two
        wa, uz = cz, ta
    else:
        _move_items(h, ib, jb, wa, uz)
    if ua == iz:
        wz, ua = ca, tz
    if firsta != 0:
        _move_items(h, ib, jb, firsta, lasta)
    puti(h, iz, g.KNB, jb)
    puti(h, ta, g.KNB, jb)
    _to_twin(h, jb, ca, firsta, lasta, ta)
    _close(h, jb, uz, cz, iz, _turn(h, jb, iz, bends, -step), ca, ta, wa)
    _to_twin(h, ib, cz, firstz, lastz, tz)
    _close(h, ib, ua, ca, ia, _turn(h, ib, ia, bends, step), cz, tz, wz)
    _number_edges(h, ta, joints, -step)
    _number_edges(h, tz, joints, step)
    puti(h, crack, g.KDLOOP, ca)
    puti(h, ida, g.KDLOOP, ca)
    puti(h, idz, g.KDLOOP, cz)
    if len(bends) > 0:
        flag(h, crack)
    flag(h, ida)
    flag(h, idz)
    _share_motion(h, ib, jb)
    return jb


@kernel
def _share_motion(h: Memory, ib: int, jb: int) -> None:
    """Masses and velocities of both parts: block `ib` still has those of the whole."""
    x, y = getr(h, ib, g.KX), getr(h, ib, g.KY)
    xd, yd, td = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KTD)
    dens = density_of(h, ib)
    if h.ci[g.MCTOT] > 0:  # masses do not change any more
        dens = getr(h, ib, g.KBM) / (geo(h, ib)[0] + geo(h, jb)[0])
    if h.ci[g.LDISP] != 0:
        _share_displacement(h, ib, jb)
    for b in (ib, jb):
        makeb(h, b, dens)
        putr(h, b, g.KTD, td)
        putr(h, b, g.KXD, xd - td * (getr(h, b, g.KY) - y))
        putr(h, b, g.KYD, yd + td * (getr(h, b, g.KX) - x))


@kernel
def _share_displacement(h: Memory, ib: int, jb: int) -> None:
    """Displacements of both parts: block `ib` still has that of the whole, and its centroid."""
    x, y, turned = getr(h, ib, g.KX), getr(h, ib, g.KY), getr(h, displacement_at(h, ib), g.KBDT)
    for b in (jb, ib):
        _, xb, yb, _, _, _ = geo(h, b)
        ux, uy = displacement_of_point(h, ib, xb - x, yb - y)
        put_displacement(h, b, ux, uy, turned)
