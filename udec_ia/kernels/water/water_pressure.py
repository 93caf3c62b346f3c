"""Pressures of domains: generated as blocks move, and their forces on the walls of blocks (report 2.6, 2.8).

A pass over all domains when the contacts have their forces, blocks have moved, and before pressures act:

    volume     V = area + sum of e b, at least sum of e a_r    e length of the joint at each contact,
                                                               b aperture where walls touch without stress,
                                                               a_r least aperture, of the joint material
    motion     dV = sum over the walls of p-force over p, times velocity and dt: what the blocks sweep
    pressure   p (V + dV) = p V - Kw dV       a filled domain; in others the saturation S follows, and p is 0
    force      p times each piece of a wall, at its middle

The force is what the work p dV belongs to, so energy is kept. V is a function of the state. It changes
otherwise than by dV as contacts slide along walls or the map changes; pressure and saturation stay then, and
WATMAP counts the water. The outer domain holds none: BOUNDARY loads its edges.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.kernels.body.boundary_point import lever
from udec_ia.kernels.body.fdef import putfdf
from udec_ia.kernels.body.sdef import putstr
from udec_ia.kernels.constitutive.joint_stresses import SIDE1, SIDE2
from udec_ia.kernels.contact.joint_lengths import joint_on_side
from udec_ia.kernels.links.longer_groups import edge_at, joint_at, pipe_at, water_at
from udec_ia.kernels.map.domain_segments import count_items
from udec_ia.kernels.map.domain_water import excess_in, put_water, water_in
from udec_ia.kernels.water.domain_outline import (
    Outline,
    area_of,
    room_for_outline,
    trace_outline,
    wall_lengths,
)
from udec_ia.layout import offsets as g

LEAST_PART = 0.1  # least aperture over the one without load, if it is not given
SHRUNK = 0.9  # part of the volume that the time-step allows for, from which on the step is found again
THIN = 1e-3  # least aperture over D where no joint material gives one


@kernel
def apertures(h: Memory, ic: int) -> tuple[float, float, float]:
    """Aperture of contact `ic`, that of its joint where walls touch without stress, and the least one."""
    ix, gap = joint_at(h, ic), -np.float64(getr(h, ic, g.KCN))
    m = iget(h, ix, g.KCJMAT) - 1 if ix != 0 else int64(-1)
    if m < 0 or not h.cr[g.JMAPER + m] > 0:
        least = np.float64(h.cr[g.DTOL]) * THIN
        return max(gap, least), 0.0, least
    given, offset = np.float64(h.cr[g.JMAPER + m]), np.float64(getr(h, ix, g.KCJOFF))
    least = np.float64(h.cr[g.JMRAP + m])
    if not least > 0:
        least = given * LEAST_PART
    aperture = max(given + gap - offset, least)
    if h.cr[g.JMMAP + m] > 0:
        aperture = min(aperture, max(np.float64(h.cr[g.JMMAP + m]), least))
    return aperture, given - offset, least


@kernel
def has_factor(h: Memory, ic: int) -> float:
    """Permeability factor of contact `ic`, if it has one and no joint is beside it; else 0."""
    ix = joint_at(h, ic)
    m = iget(h, ix, g.KCJMAT) - 1 if ix != 0 else int64(-1)
    if m < 0 or not h.cr[g.JMKC + m] > 0:
        return 0.0
    one, _ = joint_on_side(h, ic, SIDE1)
    two, _ = joint_on_side(h, ic, SIDE2)
    return np.float64(h.cr[g.JMKC + m]) if one < 0 and two < 0 else 0.0


@kernel
def set_conductance(h: Memory, ic: int) -> None:
    """Aperture of the pipe at contact `ic`, and its flow by pressure: a^3/(12 mu l), or a corner's factor."""
    ix = pipe_at(h, ic)
    aperture, _, _ = apertures(h, ic)
    length = np.float64(getr(h, ix, g.KPL1)) + getr(h, ix, g.KPL2)
    factor = has_factor(h, ic)
    if factor == 0.0 and length > 0:
        factor = aperture * aperture * aperture / (12.0 * h.cr[g.WVISC] * length)
    putr(h, ix, g.KPA, aperture)
    putr(h, ix, g.KPK, factor)


# ---- volumes


@kernel
def share_lengths(h: Memory, idm: int, line: Outline, n: int, near: Any) -> tuple[float, float, float]:
    """Lengths of the joints at the contacts of domain `idm`, which its outline has, for their pipes.

    Returns their sum, and the sums of length times aperture without stress and times least aperture.
    """
    total, free, least, x, y, many = 0.0, 0.0, 0.0, 0.0, 0.0, 0
    for k in range(n):
        if line.edge[k] != 0:  # a wall begins at point k; the one before has ended at the same contact
            continue
        ic, before = line.item[k], k - 1 if k > 0 else n - 1
        if iget(h, ic, g.KCCOD) == g.VIRTUAL:
            continue
        length = min(near[before], near[k])
        putr(h, pipe_at(h, ic), g.KPL1 if line.block[k] == iget(h, ic, g.KB2) else g.KPL2, length)
        _, one, two = apertures(h, ic)
        total, free, least = total + length, free + length * one, least + length * two
        x, y, many = x + getr(h, ic, g.KXC), y + getr(h, ic, g.KYC), many + 1
    ix = water_at(h, idm)
    putr(h, ix, g.KVLEN, total)
    if many > 0 and iget(h, ix, g.KVCODE) == g.FLOWS:
        putr(h, ix, g.KVX, x / many)
        putr(h, ix, g.KVY, y / many)
    return total, free, least


@kernel
def measure_domain(h: Memory, idm: int, line: Outline, near: Any) -> tuple[int, float, float]:
    """Trace domain `idm` and find lengths; returns the points of its outline, its volume, and the least one.

    The volume can be less than the least one, which counts then.
    """
    n = trace_outline(h, idm, line)
    wall_lengths(h, line, n, near)
    _, free, least = share_lengths(h, idm, line, n, near)
    return n, area_of(line, n) + free, least


# ---- motion


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
def swept_rate(h: Memory, line: Outline, n: int) -> float:
    """Growth of the volume inside an outline of `n` points by the motion of its walls (m2/s)."""
    rate = 0.0
    for k in range(1, n):
        ip, ib = line.edge[k], line.block[k]
        if ip == 0 or iget(h, ib, g.KBFIX) == g.FIXED:
            continue
        dx, dy = line.x[k] - line.x[k - 1], line.y[k] - line.y[k - 1]
        u, v = wall_velocity(h, ib, ip, (line.x[k] + line.x[k - 1]) * 0.5, (line.y[k] + line.y[k - 1]) * 0.5)
        rate += u * dy - v * dx
    return rate


@kernel
def compress(h: Memory, idm: int, volume: float, least: float, swept: float) -> None:
    """New volume of domain `idm`, and its pressure after `swept` (m2), by which motion has made it grow.

    volume, least: of the present state.
    """
    ix = water_at(h, idm)
    p, saturation = np.float64(getr(h, idm, g.KPP)), np.float64(getr(h, ix, g.KVSAT))
    was, now = np.float64(getr(h, ix, g.KVVOL)), max(volume, least)
    if iget(h, ix, g.KVCODE) == g.FLOWS:
        h.cd[g.WATERW] += p * swept * 0.5
        h.cd[g.WDRIVE] += max(p * swept * 0.5, 0.0)
    if iget(h, ix, g.KVCODE) != g.FLOWS or h.ci[g.LFLOW] == g.DRAINED:
        h.cd[g.WATIN] += water_in(h, p, saturation, now) - water_in(h, p, saturation, was)
        putr(h, ix, g.KVVOL, now)
        return
    if now < np.float64(getr(h, ix, g.KVSTEP)) * SHRUNK:
        h.ci[g.LSTIFF] = 1
    before = max(volume - swept, least)
    h.cd[g.WATMAP] += water_in(h, p, saturation, before) - water_in(h, p, saturation, was)
    put_water(h, idm, now, excess_in(h, idm, before) + (before - now))


# ---- forces


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
def press_piece(
    h: Memory, ib: int, ip: int, a: tuple[float, float], b: tuple[float, float], pa: float, pb: float
) -> float:
    """Pressure, linear from `pa` at point a to `pb` at point b, on a piece of a wall of block `ib`.

    Returns the power of its force. What increases linearly from one end has its resultant at a third.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    if pa == pb:
        return push_with_power(h, ib, ip, pa * dy, -pa * dx, a[0] + 0.5 * dx, a[1] + 0.5 * dy)
    one, two, third = pa * 0.5, pb * 0.5, 1.0 / 3.0
    power = push_with_power(h, ib, ip, one * dy, -one * dx, a[0] + third * dx, a[1] + third * dy)
    third += third
    return power + push_with_power(h, ib, ip, two * dy, -two * dx, a[0] + third * dx, a[1] + third * dy)


@kernel
def pressure_at(h: Memory, idm: int, x: float, y: float) -> float:
    """Pressure of the water of domain `idm` at (x, y): held ones can have a gradient, and are not below 0."""
    ix, p = water_at(h, idm), np.float64(getr(h, idm, g.KPP))
    if iget(h, ix, g.KVCODE) == g.FLOWS:
        return p
    gx, gy = np.float64(getr(h, ix, g.KVGX)), np.float64(getr(h, ix, g.KVGY))
    return max(p + gx * (x - getr(h, ix, g.KVX)) + gy * (y - getr(h, ix, g.KVY)), 0.0)


@kernel
def pressure_outside(h: Memory, iou: int, x: float, y: float) -> float:
    """Pressure at (x, y) that condition `iou` gives; 0 if it is none of pressure."""
    if iou == 0 or iget(h, iou, g.KOKIND) != g.PRESSURE_OUTSIDE:
        return 0.0
    p = np.float64(getr(h, iou, g.KOP)) + getr(h, iou, g.KOGX) * x + getr(h, iou, g.KOGY) * y
    return max(p, 0.0) * factor_of(h, iou)


@inlined
def factor_of(h: Memory, iou: int) -> float:
    """Present factor of condition `iou`."""
    isg = iget(h, iou, g.KOS)
    return np.float64(getr(h, isg, g.KTNOW)) if isg != 0 else 1.0


@kernel
def press_domain(h: Memory, idm: int, line: Outline, n: int) -> float:
    """Forces of the water in domain `idm` on its walls. Returns their power at the present velocities.

    Of a pressure that flow and motion change it is half the power: the other half is that of the pressure
    before (compress).
    """
    power, outer = 0.0, idm == h.ci[g.IODPNT]
    for k in range(1, n):
        ip = line.edge[k]
        if ip == 0:
            continue
        a, b = (line.x[k - 1], line.y[k - 1]), (line.x[k], line.y[k])
        if outer:
            iou = iget(h, edge_at(h, ip), g.KEOUT)
            if iou == 0 or iget(h, iou, g.KOKIND) != g.PRESSURE_OUTSIDE:
                continue
            power += press_outside(h, line.block[k], ip, iou, a, b)
        else:
            pa, pb = pressure_at(h, idm, a[0], a[1]), pressure_at(h, idm, b[0], b[1])
            power += press_piece(h, line.block[k], ip, a, b, pa, pb)
    flows = not outer and iget(h, water_at(h, idm), g.KVCODE) == g.FLOWS
    return power * 0.5 if flows else power


@kernel
def press_outside(
    h: Memory, ib: int, ip: int, iou: int, a: tuple[float, float], b: tuple[float, float]
) -> float:
    """The same for the piece from a to b of an edge with condition `iou`; only the part below its level."""
    factor, gx, gy = factor_of(h, iou), np.float64(getr(h, iou, g.KOGX)), np.float64(getr(h, iou, g.KOGY))
    p0 = np.float64(getr(h, iou, g.KOP))
    pa, pb = p0 + gx * a[0] + gy * a[1], p0 + gx * b[0] + gy * b[1]
    if pa <= 0 and pb <= 0:
        return 0.0
    if pa < 0 or pb < 0:
        part = pa / (pa - pb)
        level = (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))
        if pa < 0:
            a, pa = level, 0.0
        else:
            b, pb = level, 0.0
    return press_piece(h, ib, ip, a, b, pa * factor, pb * factor)


# ---- passes


@kernel
def longest_loop(h: Memory) -> int:
    """Number of items of the longest loop of a domain."""
    longest, idm = 0, int64(h.ci[g.IDPNT])
    while idm != 0:
        if iget(h, idm, g.KDLOOP) != 0:
            longest = max(longest, count_items(h, idm))
        idm = iget(h, idm, g.KD)
    return longest


@kernel
def renew_volumes(h: Memory, dt: float) -> None:
    """Volumes and pressures of all domains after motion in a step `dt`, apertures and flows by pressure.

    dt: 0 after a command, when domains keep their pressure.
    """
    items = longest_loop(h)
    line, near = room_for_outline(items), np.empty(4 * items + 4, np.float64)
    idm = int64(h.ci[g.IDPNT])
    while idm != 0:
        if iget(h, idm, g.KDLOOP) != 0:
            n, volume, least = measure_domain(h, idm, line, near)
            if idm != h.ci[g.IODPNT]:
                compress(h, idm, volume, least, swept_rate(h, line, n) * dt if dt > 0 else 0.0)
        idm = iget(h, idm, g.KD)
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            set_conductance(h, ic)
        ic = iget(h, ic, g.KC)


@kernel
def press(h: Memory, dt: float) -> None:
    """Forces of all pressures on blocks.

    Their work in the step `dt` that has ended is added to WATERW, and to WDRIVE what puts energy in.
    """
    line = room_for_outline(longest_loop(h))
    idm = int64(h.ci[g.IDPNT])
    while idm != 0:
        is_pressed = idm == h.ci[g.IODPNT] and h.ci[g.IOUPNT] != 0
        if idm != h.ci[g.IODPNT]:
            is_pressed = getr(h, idm, g.KPP) != 0 or iget(h, water_at(h, idm), g.KVCODE) == g.HELD
        if is_pressed and iget(h, idm, g.KDLOOP) != 0:
            work = press_domain(h, idm, line, trace_outline(h, idm, line)) * dt
            h.cd[g.WATERW] += work
            h.cd[g.WDRIVE] += max(work, 0.0)
        idm = iget(h, idm, g.KD)
