"""Bolts: an axial and a shear spring between points of two blocks (BOLT).

With n along the bolt, t to its left, L its length, u the displacements of its ends and w their rotations,
both springs have, in a step,

    elongation   dq = n (u2 - u1)                      N := N + KN dq     KN, or YOUNG AREA/length
    shear        dq = t (u2 - u1) - L (w1 + w2)/2      S := S + KS dq

so that a bolt that moves as a rigid body is not strained: the shear is that of the two blocks in the middle
of the bolt. The forces on the ends are those that do the same work: N n + S t and the moment L S/2 on the
first, -N n - S t and L S/2 on the second. They leave momentum and angular momentum as they are. Axes are
those in the middle of the step, and the elongation is the exact change of the length.

N is at most YIELD, S at most SHEAR; the bolt breaks at a plastic elongation of BREAK times its first length.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti, putr
from udec_ia.kernels.structures.attached_points import block_at, moved_by, push, zone_at
from udec_ia.layout import offsets as g


@inlined
def limited(force: float, limit: float) -> float:
    """The force, between -limit and limit; without a limit if that is 0."""
    return min(max(force, -limit), limit) if limit > 0 else force


@kernel
def bolt_axis(h: Memory, ia: int) -> tuple[float, float, float]:
    """Length of bolt `ia`, and the unit vector from its first to its second end."""
    dx = np.float64(getr(h, ia, g.KAX2)) - np.float64(getr(h, ia, g.KAX1))
    dy = np.float64(getr(h, ia, g.KAY2)) - np.float64(getr(h, ia, g.KAY1))
    length = np.sqrt(dx * dx + dy * dy)
    return length, dx / length, dy / length


@kernel
def bolt_stiffness(h: Memory, ia: int) -> tuple[float, float]:
    """Axial and shear stiffness of bolt `ia`; 0 if it is broken."""
    if iget(h, ia, g.KASTAT) & g.BROKEN:
        return 0.0, 0.0
    i = iget(h, ia, g.KAMAT) - 1
    kn, ks = np.float64(h.cr[g.STKN + i]), np.float64(h.cr[g.STKS + i])
    if kn == 0:
        kn = np.float64(h.cr[g.STYM + i]) * np.float64(h.cr[g.STAREA + i]) / getr(h, ia, g.KALEN)
    return kn, ks


@kernel
def bolt_energy(h: Memory, ia: int) -> float:
    """Energy stored in the springs of bolt `ia`, in J/m."""
    fn, fs = np.float64(getr(h, ia, g.KAFN)), np.float64(getr(h, ia, g.KAFS))
    kn, ks = bolt_stiffness(h, ia)
    energy = fn * fn / (kn + kn) if kn > 0 else 0.0
    return float(energy + fs * fs / (ks + ks)) if ks > 0 else float(energy)


@kernel
def push_by_bolt(h: Memory, ia: int) -> None:
    """Add the forces of bolt `ia` to the force sums of its two blocks."""
    length, nx, ny = bolt_axis(h, ia)
    fn, fs = np.float64(getr(h, ia, g.KAFN)), np.float64(getr(h, ia, g.KAFS))
    fx, fy, moment = fn * nx - fs * ny, fn * ny + fs * nx, length * fs * 0.5
    x1, y1 = np.float64(getr(h, ia, g.KAX1)), np.float64(getr(h, ia, g.KAY1))
    x2, y2 = np.float64(getr(h, ia, g.KAX2)), np.float64(getr(h, ia, g.KAY2))
    push(h, iget(h, ia, g.KAB1), iget(h, ia, g.KAZ1), x1, y1, fx, fy, moment)
    push(h, iget(h, ia, g.KAB2), iget(h, ia, g.KAZ2), x2, y2, -fx, -fy, moment)


@kernel
def strain_bolt(h: Memory, ia: int, elongation: float, shear: float) -> None:
    """New forces of bolt `ia`. What it does not store of the work on it is lost to yielding."""
    kn, ks = bolt_stiffness(h, ia)
    if kn == 0:
        return
    i, stored = iget(h, ia, g.KAMAT) - 1, bolt_energy(h, ia)
    fn, fs = np.float64(getr(h, ia, g.KAFN)), np.float64(getr(h, ia, g.KAFS))
    trial_n, trial_s = fn + kn * elongation, fs + ks * shear
    new_n, new_s = limited(trial_n, h.cr[g.STYF + i]), limited(trial_s, h.cr[g.STSF + i])
    state = iget(h, ia, g.KASTAT)
    if new_n != trial_n:
        state |= g.YIELDED
        plastic = getr(h, ia, g.KAPL) + (trial_n - new_n) / kn
        putr(h, ia, g.KAPL, plastic)
        if h.cr[g.STBRK + i] > 0 and plastic > h.cr[g.STBRK + i] * getr(h, ia, g.KALEN):
            state |= g.BROKEN
    if new_s != trial_s:
        state |= g.SHEARED
    if state & g.BROKEN:
        new_n, new_s = 0.0, 0.0
    puti(h, ia, g.KASTAT, state)
    putr(h, ia, g.KAFN, new_n)
    putr(h, ia, g.KAFS, new_s)
    if h.ci[g.LENER] != 0:
        work = ((fn + new_n) * elongation + (fs + new_s) * shear) * 0.5
        h.cd[g.WYIELD] += work + stored - bolt_energy(h, ia)


@kernel
def move_bolt(h: Memory, ia: int) -> None:
    """Ends and forces of bolt `ia` after the blocks have moved."""
    x1, y1 = np.float64(getr(h, ia, g.KAX1)), np.float64(getr(h, ia, g.KAY1))
    x2, y2 = np.float64(getr(h, ia, g.KAX2)), np.float64(getr(h, ia, g.KAY2))
    u1, v1, w1 = moved_by(h, iget(h, ia, g.KAB1), iget(h, ia, g.KAZ1), x1, y1)
    u2, v2, w2 = moved_by(h, iget(h, ia, g.KAB2), iget(h, ia, g.KAZ2), x2, y2)
    putr(h, ia, g.KAX1, x1 + u1)
    putr(h, ia, g.KAY1, y1 + v1)
    putr(h, ia, g.KAX2, x2 + u2)
    putr(h, ia, g.KAY2, y2 + v2)
    du, dv = u2 - u1, v2 - v1
    ox, oy = x2 - x1, y2 - y1
    mx, my = ox + du * 0.5, oy + dv * 0.5
    old, mean = np.sqrt(ox * ox + oy * oy), np.sqrt(mx * mx + my * my)
    nx, ny = ox + du, oy + dv
    elongation = 2.0 * (du * mx + dv * my) / (old + np.sqrt(nx * nx + ny * ny))
    shear = (dv * mx - du * my) / mean - mean * (w1 + w2) * 0.5
    strain_bolt(h, ia, elongation, shear)


@kernel
def sum_bolts(h: Memory, moved: bool) -> None:
    """Add the forces of all bolts to the force sums of blocks; moved: blocks have, and forces are new."""
    ia = int64(h.ci[g.IBTPNT])
    while ia != 0:
        if moved:
            move_bolt(h, ia)
        push_by_bolt(h, ia)
        ia = iget(h, ia, g.KA)


@kernel
def attach_bolts(h: Memory) -> bool:
    """Find the blocks and zones of all ends again, 0 where none is left; True if one has changed."""
    changed = False
    ia = int64(h.ci[g.IBTPNT])
    while ia != 0:
        for x, y, to_block, to_zone in (
            (getr(h, ia, g.KAX1), getr(h, ia, g.KAY1), g.KAB1, g.KAZ1),
            (getr(h, ia, g.KAX2), getr(h, ia, g.KAY2), g.KAB2, g.KAZ2),
        ):
            ib = block_at(h, np.float64(x), np.float64(y), iget(h, ia, to_block))
            iz = zone_at(h, ib, np.float64(x), np.float64(y)) if ib != 0 else int64(0)
            changed = changed or ib != iget(h, ia, to_block) or iz != iget(h, ia, to_zone)
            puti(h, ia, to_block, ib)
            puti(h, ia, to_zone, iz)
        ia = iget(h, ia, g.KA)
    return changed
