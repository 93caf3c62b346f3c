"""Free blocks: those that are thrown (VELOCITY), and those that have left the scene (DELETE OUTSIDE)."""

from __future__ import annotations

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.motion import set_corner_velocities
from udec_ia.layout import offsets as g
from udec_ia.ops.commands import energy_account
from udec_ia.ops.commands.change_or_delete_blocks import remove_blocks
from udec_ia.ops.commands.corner_rounding import update_flagged
from udec_ia.ops.common.block_ranges import blocks_in
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.common.number_limits import check_real_range, finite
from udec_ia.reader.group_ranges import Range
from udec_ia.reader.list_walks import chain

LIMITS = (g.OUTX1, g.OUTX2, g.OUTY1, g.OUTY2)
LOOK_OUTSIDE = 100  # cycles between two searches for blocks that have left
LEFT_OVER = 2  # blocks that stay, wherever they are


def set_velocities(array: MainArray, where: Range, vx: float, vy: float, w: float) -> int:
    """VELOCITY: give the blocks in the range the velocity of a rigid body. Returns their number.

    vx, vy: of the centroid, m/s. w: angular velocity, rad/s, anticlockwise. Fixed blocks are left out. Where
    BOUNDARY prescribes a velocity, it replaces this one in the next cycle. Error 28 for what is not finite.
    """
    finite(array, vx=vx, vy=vy, w=w)
    check_real_range(array, "the velocity", [vx, vy, w])
    h = array.h
    blocks = [ib for ib in blocks_in(array, where) if iget(h, ib, g.KBFIX) != g.FIXED]
    for ib in blocks:
        for k, value in ((g.KXD, vx), (g.KYD, vy), (g.KTD, w)):
            putr(h, ib, k, value)
        set_corner_velocities(h, ib)
        if iget(h, ib, HEAD) == g.MSDEF:
            for k in (g.KED11, g.KED12, g.KED21, g.KED22):
                putr(h, iget(h, ib, g.KBEX), k, 0.0)
        elif iget(h, ib, HEAD) == g.MFDEF:
            _move_grid_points(h, ib, vx, vy, w)
    return len(blocks)


def _move_grid_points(h: Memory, ib: int, vx: float, vy: float, w: float) -> None:
    """Give the grid-points of block `ib` the velocities of a rigid body."""
    x, y = float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
    for ig in chain(h, iget(h, iget(h, ib, g.KBEX), g.KFG), g.KG):
        putr(h, ig, g.KXDG, vx - w * (float(getr(h, ig, g.KYG)) - y))
        putr(h, ig, g.KYDG, vy + w * (float(getr(h, ig, g.KXG)) - x))


def delete_outside(array: MainArray, x1: float, x2: float, y1: float, y2: float) -> int:
    """DELETE OUTSIDE: delete blocks outside of these limits, now and while cycling. Returns how many now.

    Error 10 if nothing is between the limits, 28 for what is not finite, 19 if fewer than two blocks are
    left.
    """
    finite(array, x1=x1, x2=x2, y1=y1, y2=y2)
    check_real_range(array, "a limit", [x1, x2, y1, y2])
    if not (x1 < x2 and y1 < y2):
        raise UdecError(10, "nothing is between the limits", "OUTSIDE x1 x2 y1 y2", parameter="x1")
    h = array.h
    h.ci[g.LOUTS] = 1
    for name, limit in zip(LIMITS, (x1, x2, y1, y2), strict=True):
        h.cr[name] = limit
    gone = _outside(h)
    left = int(h.ci[g.NBLK]) - len(gone)
    if gone and left < LEFT_OVER:
        raise UdecError(19, f"only {left} block(s) would be left", "two blocks must remain")
    _remove(array, gone)
    return len(gone)


def delete_departed_blocks(array: MainArray) -> bool:
    """Delete the blocks outside of the limits of DELETE OUTSIDE, if it is the cycle for that; True if any.

    The last two blocks stay.
    """
    h = array.h
    if not h.ci[g.LOUTS] or h.ci[g.MCTOT] % LOOK_OUTSIDE:
        return False
    gone = _outside(h)[: max(int(h.ci[g.NBLK]) - LEFT_OVER, 0)]
    if gone:
        energy_account.end(array)
        _remove(array, gone)
        energy_account.begin(array)
    return bool(gone)


def _outside(h: Memory) -> list[int]:
    """Addresses of the blocks with centroids outside of the limits of DELETE OUTSIDE. Fixed ones stay."""
    x1, x2, y1, y2 = (float(h.cr[name]) for name in LIMITS)
    blocks = list_of(h, "block")
    x, y = (np.asarray(getr(h, blocks, k), np.float64) for k in (g.KX, g.KY))
    outside = (x < x1) | (x > x2) | (y < y1) | (y > y2)
    return [int(ib) for ib in blocks[outside & (integers(h, blocks, g.KBFIX) != g.FIXED)]]


def _remove(array: MainArray, blocks: list[int]) -> None:
    """Delete `blocks`, and count them."""
    if not blocks:
        return
    h = array.h
    h.ci[g.NLEFT] += len(blocks)
    remove_blocks(h, blocks)
    update_flagged(array)
    if h.ci[g.MCTOT] > 0:
        renew_forces(array)
