"""What a pressure does on the walls of blocks: its forces, and the volume that the walls sweep.

A piece of a wall lies on one edge of a block, whose points move as the block does. The force of a pressure on
a piece is p times its length along its normal, out of the domain. The volume that the piece sweeps is the
work of that force over p, so that energy is kept.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.kernels.body.boundary_point import lever
from udec_ia.kernels.body.fdef import putfdf
from udec_ia.kernels.body.sdef import putstr
from udec_ia.kernels.water.domain_outline import Outlines, Point
from udec_ia.layout import offsets as g


@kernel
def wall_velocity(h: Memory, ib: int, ip: int, x: float, y: float) -> tuple[float, float]:
    """Velocity of block `ib` at the point (x, y) of its edge that ends at corner `ip`."""
    if iget(h, ib, HEAD) == g.MFDEF and iget(h, ip, g.KGP) != 0:
        part = np.float64(lever(h, ip, x, y))
        one, two = iget(h, iget(h, ip, g.KR), g.KGP), iget(h, ip, g.KGP)
        u, v = np.float64(getr(h, one, g.KXDG)), np.float64(getr(h, one, g.KYDG))
        return u + part * (getr(h, two, g.KXDG) - u), v + part * (getr(h, two, g.KYDG) - v)
    rx, ry, td = x - getr(h, ib, g.KX), y - getr(h, ib, g.KY), np.float64(getr(h, ib, g.KTD))
    u, v = getr(h, ib, g.KXD) - td * ry, getr(h, ib, g.KYD) + td * rx
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        e12 = np.float64(getr(h, ie, g.KED12))
        u += getr(h, ie, g.KED11) * rx + e12 * ry
        v += e12 * rx + getr(h, ie, g.KED22) * ry
    return u, v


@kernel
def swept_rate(h: Memory, line: Outlines, first: int, end: int) -> float:
    """Growth of the volume inside an outline by the motion of its walls (m2/s)."""
    rate = 0.0
    for k in range(first + 1, end):
        ip, ib = line.edge[k], line.block[k]
        if ip == 0 or iget(h, ib, g.KBFIX) == g.FIXED:
            continue
        ax, ay, bx, by = line.x[k - 1], line.y[k - 1], line.x[k], line.y[k]
        dx, dy = bx - ax, by - ay
        u, v = wall_velocity(h, ib, ip, (ax + bx) * 0.5, (ay + by) * 0.5)
        rate += u * dy - v * dx
    return rate


@kernel
def push_wall(h: Memory, ib: int, ip: int, fx: float, fy: float, x: float, y: float) -> None:
    """Add a force at the point (x, y) of the edge that ends at corner `ip` to block `ib`."""
    putr(h, ib, g.KBFX, getr(h, ib, g.KBFX) + fx)
    putr(h, ib, g.KBFY, getr(h, ib, g.KBFY) + fy)
    moment = (x - getr(h, ib, g.KX)) * fy - (y - getr(h, ib, g.KY)) * fx
    putr(h, ib, g.KBFT, getr(h, ib, g.KBFT) + moment)
    kind = iget(h, ib, HEAD)
    if kind == g.MSDEF:
        putstr(h, ib, real(h, fx), real(h, fy), real(h, x), real(h, y))
    elif kind == g.MFDEF and iget(h, ip, g.KGP) != 0:
        part = np.float64(lever(h, ip, x, y))
        putfdf(h, iget(h, ip, g.KGP), real(h, fx * part), real(h, fy * part))
        rest = 1.0 - part
        putfdf(h, iget(h, iget(h, ip, g.KR), g.KGP), real(h, fx * rest), real(h, fy * rest))


@inlined
def push_with_power(h: Memory, ib: int, ip: int, fx: float, fy: float, x: float, y: float) -> float:
    """As push_wall; returns the power of the force."""
    push_wall(h, ib, ip, fx, fy, x, y)
    if iget(h, ib, g.KBFIX) == g.FIXED:
        return 0.0
    u, v = wall_velocity(h, ib, ip, x, y)
    return fx * u + fy * v


@kernel
def press_piece(h: Memory, ib: int, ip: int, a: Point, b: Point, pa: float, pb: float) -> float:
    """Pressure, linear from `pa` at point a to `pb` at point b, on a piece of a wall of block `ib`.

    Returns the power of its force. What increases linearly from one end has its resultant at a third.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    if pa == pb:
        return push_with_power(h, ib, ip, pa * dy, -pa * dx, a[0] + 0.5 * dx, a[1] + 0.5 * dy)
    one, two, near, far = pa * 0.5, pb * 0.5, 1.0 / 3.0, 2.0 / 3.0
    power = push_with_power(h, ib, ip, one * dy, -one * dx, a[0] + near * dx, a[1] + near * dy)
    return power + push_with_power(h, ib, ip, two * dy, -two * dx, a[0] + far * dx, a[1] + far * dy)


@kernel
def press_below_level(h: Memory, ib: int, ip: int, a: Point, b: Point, pa: float, pb: float) -> float:
    """The same where a pressure below 0 counts as 0: on the part of the piece that is below the level."""
    if pa <= 0 and pb <= 0:
        return 0.0
    if pa < 0 or pb < 0:
        part = pa / (pa - pb)
        level = (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))
        if pa < 0:
            return press_piece(h, ib, ip, level, b, 0.0, pb)
        return press_piece(h, ib, ip, a, level, pa, 0.0)
    return press_piece(h, ib, ip, a, b, pa, pb)
