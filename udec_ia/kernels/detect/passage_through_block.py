"""Blocks that penetrate another block within a single step, too fast for a contact (error 15).

Two blocks never overlap by more than CTOL without a contact or an error, for these reasons:

1.  After an update of a domain every two segments of its boundary that are nearer than ATOL have a contact,
    or one near them that represents both (contact_search.py); an overlap at which no contact can be made is
    error 15.
2.  Until the next update its points approach each other by at most ETOL in x and in y, so by ATOL at most:
    KUMAX sums their greatest relative displacement, and above ETOL the domain is updated in the same cycle
    (domain_pass.py). So no segments without a contact touch before that cycle.
3.  A step of at most ETOL then makes an overlap of at most CTOL, with which a contact can be made.
4.  In a longer step blocks may penetrate deeper, or pass through each other. So after a step of more than
    ETOL this file follows the paths of all corners of the domain. No corner may have been deeper in another
    block of the domain than CTOL, or have entered and left it at a depth of more than FTOL. No edge may lie
    deeper than CTOL in another block.
5.  Contacts separate domains like walls. An open one is given up when another block comes between the two
    (third_block_in_gap.py). A closed one ends the run if a tip is squeezed through it (map_changes.py).
6.  Commands that change outlines flag all domains, which are updated before the next cycle. A command that
    would cause a deeper overlap is refused, and nothing is changed (ops/commands/corner_rounding.py).

The path of a corner is relative to the other block: a point is moved back to its place before the step with
its own block, and forward with the other one. The path from there to its present place is that in the frame
of the other block, however fast the two rotate. An arc is followed at its two ends and in the middle.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.errors import OVERLAP_TOO_GREAT
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, real
from udec_ia.kernels.body.boundary_point import lever
from udec_ia.kernels.detect.domain_pass import relative_velocity
from udec_ia.kernels.detect.point_depth import depth_in
from udec_ia.kernels.geometry.box_sweep import ABOVE, BELOW, LEFT, RIGHT, overlapping_boxes
from udec_ia.kernels.geometry.contact_geometry import tangents
from udec_ia.kernels.map.domain_segments import ARC, BLOCK, COLUMNS, CORNER, collect, count_items
from udec_ia.layout import offsets as g

POINTS = 3  # points of an arc that are followed
STEPS = 8  # places tested while a point moves by CTOL in x or in y
LOOKS = 20_000  # places on one path: a thousand rounding lengths in a step are too many to follow


@kernel
def _turned(h: Memory, ib: int, rx: float, ry: float, way: int) -> tuple[float, float]:
    """The vector (rx, ry) in block `ib`, which turns and strains, one step later (`way` 1) or before (-1)."""
    half = h.cr[g.TDEL] * real(h, 0.5) * real(h, way)
    td = getr(h, ib, g.KTD)
    a, b, c, d = real(h, 0.0), -td * half, td * half, real(h, 0.0)
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        a, d = getr(h, ie, g.KED11) * half, getr(h, ie, g.KED22) * half
        b, c = b + getr(h, ie, g.KED12) * half, c + getr(h, ie, g.KED12) * half
    x, y = rx + a * rx + b * ry, ry + c * rx + d * ry
    one = real(h, 1.0)
    det = (one - a) * (one - d) - b * c
    return ((one - d) * x + b * y) / det, (c * x + (one - a) * y) / det


@kernel
def previous_place(h: Memory, ib: int, ip: int, x: float, y: float) -> tuple[float, float]:
    """Place of the point (x, y) of block `ib`, near its corner `ip`, before this step.

    A fixed block does not move, even if RSET has given it a velocity.
    """
    if iget(h, ib, g.KBFIX) == g.FIXED:
        return x, y
    dt = h.cr[g.TDEL]
    if iget(h, ib, HEAD) == g.MFDEF:
        return x - getr(h, ip, g.KXDP) * dt, y - getr(h, ip, g.KYDP) * dt
    xn, yn = getr(h, ib, g.KX), getr(h, ib, g.KY)
    rx, ry = _turned(h, ib, x - xn, y - yn, -1)
    return xn - getr(h, ib, g.KXD) * dt + rx, yn - getr(h, ib, g.KYD) * dt + ry


@kernel
def place_moved_with(h: Memory, ib: int, ip: int, x: float, y: float) -> tuple[float, float]:
    """New place of a point that was at (x, y) and moved with block `ib`, near its edge that ends at `ip`."""
    if iget(h, ib, g.KBFIX) == g.FIXED:
        return x, y
    dt = h.cr[g.TDEL]
    if iget(h, ib, HEAD) == g.MFDEF:
        ia = iget(h, ip, g.KR)
        part = min(max(lever(h, ip, x, y), real(h, 0.0)), real(h, 1.0))
        rest = real(h, 1.0) - part
        vx = rest * getr(h, ia, g.KXDP) + part * getr(h, ip, g.KXDP)
        vy = rest * getr(h, ia, g.KYDP) + part * getr(h, ip, g.KYDP)
        return x + vx * dt, y + vy * dt
    xn, yn = getr(h, ib, g.KX), getr(h, ib, g.KY)
    sx, sy = getr(h, ib, g.KXD) * dt, getr(h, ib, g.KYD) * dt
    rx, ry = _turned(h, ib, x - (xn - sx), y - (yn - sy), 1)
    return xn + rx, yn + ry


@kernel
def arc_point(h: Memory, ip: int, k: int) -> tuple[float, float]:
    """Point `k` of the arc of corner `ip`: its middle, beginning or end; an edge point has only one."""
    x, y, rad, d = getr(h, ip, g.KXP), getr(h, ip, g.KYP), getr(h, ip, g.KRAD), h.cr[g.DTOL]
    if rad <= 0:
        return x, y
    if k == 0:
        cx, cy = getr(h, ip, g.KXCP), getr(h, ip, g.KYCP)
        far = np.sqrt((x - cx) * (x - cx) + (y - cy) * (y - cy))
        return cx + (x - cx) * rad / far, cy + (y - cy) * rad / far
    tx, ty, ux, uy = tangents(h, ip)
    if k == 1:
        return x - d * tx, y - d * ty
    return x + d * ux, y + d * uy


@kernel
def _box_around(h: Memory, jb: int) -> tuple[float, float, float, float]:
    """Box around block `jb` (around its old place if it has zones), extended by CTOL: lower, upper ends."""
    far = real(h, np.inf)
    lx, ly, hx, hy = far, far, -far, -far
    first = iget(h, jb, g.KP)
    jp = first
    while True:
        x, y = getr(h, jp, g.KXP), getr(h, jp, g.KYP)
        lx, ly, hx, hy = min(lx, x), min(ly, y), max(hx, x), max(hy, y)
        if iget(h, jb, HEAD) == g.MFDEF:
            x, y = previous_place(h, jb, jp, x, y)
            lx, ly, hx, hy = min(lx, x), min(ly, y), max(hx, x), max(hy, y)
        jp = iget(h, jp, g.KR)
        if jp == first:
            return lx - h.cr[g.CTOL], ly - h.cr[g.CTOL], hx + h.cr[g.CTOL], hy + h.cr[g.CTOL]


@kernel
def _between(start: float, way: float, low: float, high: float) -> tuple[float, float]:
    """Fractions of a path along one axis at which it enters and leaves the range `low` to `high`."""
    if way == 0:
        return (0.0, 1.0) if low <= start <= high else (1.0, 0.0)
    one, two = np.float64((low - start) / way), np.float64((high - start) / way)
    return max(min(one, two), 0.0), min(max(one, two), 1.0)


@kernel
def _depths(h: Memory, ib: int, ip: int, jb: int, k: int) -> tuple[float, float, float]:
    """Depths of point `k` of the arc of corner `ip` of block `ib` in block `jb`.

    Depth before this step, greatest depth on the path, and depth now; only up to the first place that is too
    deep. Infinite if the path is too long to follow, as near a block with an extreme strain. A
    fully-deformable block `jb` is taken as it was before the step; any other one moves the point's first
    place along. Parts of the path far from the block are skipped, however long they are.
    """
    x, y = arc_point(h, ip, k)
    fx, fy = previous_place(h, ib, ip, x, y)
    back = h.cr[g.TDEL]
    if iget(h, jb, HEAD) != g.MFDEF:
        fx, fy = place_moved_with(h, jb, iget(h, jb, g.KP), fx, fy)
        back = real(h, 0.0)
    before, now = depth_in(h, jb, fx, fy, back), depth_in(h, jb, x, y, real(h, 0.0))
    deepest = now
    lx, ly, hx, hy = _box_around(h, jb)
    (enters, leaves), (above, below) = _between(fx, x - fx, lx, hx), _between(fy, y - fy, ly, hy)
    first, last = max(enters, above), min(leaves, below)
    if first < last:
        way = np.float64(max(abs(x - fx), abs(y - fy))) * (last - first)
        looks = way / np.float64(h.cr[g.CTOL]) * STEPS
        if not looks < LOOKS:
            return before, real(h, np.inf), now
        n = 1 + int(looks)
        for i in range(n + 1):
            part = real(h, first + (last - first) * i / n)
            place = fx + (x - fx) * part, fy + (y - fy) * part
            deepest = max(deepest, depth_in(h, jb, place[0], place[1], back * (real(h, 1.0) - part)))
            if deepest > h.cr[g.CTOL]:
                break
    return before, deepest, now


@kernel
def _has_penetrated(h: Memory, ib: int, ip: int, jb: int) -> bool:
    """True if in this step the arc of corner `ip` of block `ib` was deeper than CTOL in block `jb`.

    Also True if it was deeper than FTOL and has entered and left the block.
    """
    for k in range(POINTS if getr(h, ip, g.KRAD) > 0 else 1):
        before, deepest, now = _depths(h, ib, ip, jb, k)
        if deepest > h.cr[g.CTOL] or (before <= 0 and now <= 0 and deepest > h.cr[g.FTOL]):
            return True
    return False


@kernel
def edge_lies_in(h: Memory, ip: int, jb: int, jp: int) -> bool:
    """True if the edge that ends at corner `ip` lies deeper than CTOL in block `jb`, behind its edge `jp`.

    If two tips have slid past each other, there may be no corner in the other block. The edge is tested in
    the middle of the common part of the two edges, between its roundings.
    """
    ia, ja = iget(h, ip, g.KR), iget(h, jp, g.KR)
    ax, ay = getr(h, ia, g.KXP), getr(h, ia, g.KYP)
    ux, uy = getr(h, ip, g.KXP) - ax, getr(h, ip, g.KYP) - ay
    zz = ux * ux + uy * uy
    zero, share = real(h, 0.0), h.cr[g.DTOL] / np.sqrt(zz)  # share of the edge that a rounding takes
    low = share if getr(h, ia, g.KRAD) > 0 else zero
    high = real(h, 1.0) - (share if getr(h, ip, g.KRAD) > 0 else zero)
    first = ((getr(h, ja, g.KXP) - ax) * ux + (getr(h, ja, g.KYP) - ay) * uy) / zz
    last = ((getr(h, jp, g.KXP) - ax) * ux + (getr(h, jp, g.KYP) - ay) * uy) / zz
    first, last = min(max(first, low), high), min(max(last, low), high)
    at = (first + last) * real(h, 0.5)
    x, y = ax + ux * at, ay + uy * at
    vx, vy = getr(h, jp, g.KXP) - getr(h, ja, g.KXP), getr(h, jp, g.KYP) - getr(h, ja, g.KYP)
    # the block is to the right of its edge
    behind = (x - getr(h, ja, g.KXP)) * vy - (y - getr(h, ja, g.KYP)) * vx
    if first == last or behind <= h.cr[g.CTOL] * np.sqrt(vx * vx + vy * vy):
        return False
    return bool(depth_in(h, jb, x, y, zero) > h.cr[g.CTOL])


@kernel
def _include(boxes: Any, i: int, x: float, y: float) -> None:
    """Widen box `i` by the point (x, y)."""
    boxes[i, LEFT], boxes[i, RIGHT] = min(boxes[i, LEFT], x), max(boxes[i, RIGHT], x)
    boxes[i, BELOW], boxes[i, ABOVE] = min(boxes[i, BELOW], y), max(boxes[i, ABOVE], y)


@kernel
def swept_boxes(h: Memory, seg: Any, n: int, more: int) -> Any:
    """Boxes of the area that each segment has passed in this step, and `more` unused rows."""
    boxes = np.empty((n + more, 4), np.float64)
    for i in range(n):
        boxes[i, LEFT] = boxes[i, BELOW] = np.inf
        boxes[i, RIGHT] = boxes[i, ABOVE] = -np.inf
        ib, ip = seg[i, BLOCK], seg[i, CORNER]
        for k in range(POINTS):
            if seg[i, ARC] == 1:
                iq = ip
                x, y = arc_point(h, ip, k)
            else:
                iq = ip if k == 0 else iget(h, ip, g.KR)
                x, y = getr(h, iq, g.KXP), getr(h, iq, g.KYP)
            fx, fy = previous_place(h, ib, iq, x, y)
            _include(boxes, i, x, y)
            _include(boxes, i, fx, fy)
    return boxes


@kernel
def _corner_passed_through(h: Memory, idm: int) -> int:
    """A corner in domain `idm` that has penetrated or crossed another block in this step; 0 if none."""
    items = count_items(h, idm)
    seg = np.empty((2 * items + 2, COLUMNS), np.int64)
    n, _ = collect(h, idm, seg, np.empty((min(h.ci[g.NVIRT], items), 3), np.int64))
    pairs = overlapping_boxes(swept_boxes(h, seg, n, 0), n)
    for k in range(len(pairs)):
        i, j = pairs[k, 0], pairs[k, 1]
        if seg[i, BLOCK] == seg[j, BLOCK]:
            continue
        for one, two in ((i, j), (j, i)):
            ip = seg[one, CORNER]
            if seg[one, ARC] == 1 and _has_penetrated(h, seg[one, BLOCK], ip, seg[two, BLOCK]):
                return int64(ip)
            edges = seg[one, ARC] + seg[two, ARC] == 0
            if edges and edge_lies_in(h, ip, seg[two, BLOCK], seg[two, CORNER]):
                return int64(ip)
    return int64(0)


@outlined
def detect_passages(h: Memory) -> bool:
    """True, and error 15, if in this step a corner has penetrated another block of its domain.

    Domains without a displacement above ETOL are skipped, as are all after an error.
    """
    idm = h.ci[g.IDPNT]
    while idm != 0 and h.ci[g.NERR] == 0:
        if relative_velocity(h, idm, True) * h.cr[g.TDEL] > h.cr[g.ETOL]:
            ip = _corner_passed_through(h, idm)
            if ip != 0:
                h.ci[g.NERR] = OVERLAP_TOO_GREAT
                h.ci[g.IERAD] = ip
        idm = iget(h, idm, g.KD)
    return bool(h.ci[g.NERR] != 0)
