"""Pressures of domains: generated as blocks move, and their forces on the walls of blocks (report 2.6, 2.8).

A pass over all domains when the contacts have their forces, blocks have moved, and before pressures act:

    volume     V = area + sum of e b, at least sum of e a_r    e length of the joint at each contact, b its
                                                               aperture without stress, a_r the least one
    motion     dV: what the walls sweep       wall_forces.py
    pressure   p' (V + dV) = p V - Kw dV      p before, p' after; a filled domain. In others the saturation S
                                              follows, and p is 0
    force      p times each piece of a wall

V is a function of the state. It changes otherwise than by dV as contacts slide along walls or the map
changes; pressure and saturation stay then, and WATMAP counts the water. Where flow is due, its steps take dV
in. The outer domain holds no water: BOUNDARY loads its edges.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti, putr, real
from udec_ia.kernels.constitutive.joint_materials import joint_numbers
from udec_ia.kernels.constitutive.joint_stresses import SIDE1, SIDE2
from udec_ia.kernels.contact.joint_lengths import joint_on_side
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.longer_groups import joint_at, pipe_at, water_at
from udec_ia.kernels.map.domain_water import excess_in, is_held, put_water, water_in, water_of
from udec_ia.kernels.water.domain_outline import Outlines, Point, area_of, find_feet, find_reaches
from udec_ia.kernels.water.wall_forces import press_below_level, press_piece, swept_rate
from udec_ia.kernels.water.water_outside import outlines_with_conditions, press_outside, pressure_outside
from udec_ia.layout import offsets as g

SMALLEST_PART = 0.1  # least aperture over the one without load, if it is not given
SHRUNK = 0.9  # part of the volume that the time-step allows for, from which on the step is found again
SHORTEST_PIPE = 0.1  # times D: least length of a pipe, where two corners meet at a crossing
THIN = 1e-3  # least aperture over D where no joint material gives one


@kernel
def reach_of_tip(h: Memory, ip: int, nx: float, ny: float) -> float:
    """How far the true corner `ip` reaches beyond its arc along (nx, ny), away from its block."""
    x, y = getr(h, ip, g.KXP) - getr(h, ip, g.KXCP), getr(h, ip, g.KYP) - getr(h, ip, g.KYCP)
    return max(np.float64(x) * nx + np.float64(y) * ny - getr(h, ip, g.KRAD), 0.0)


@kernel
def gap_of_walls(h: Memory, ic: int) -> float:
    """Gap between the walls at contact `ic`, as they are without rounding; negative for an overlap."""
    gap = -np.float64(getr(h, ic, g.KCN))
    if gap <= 0:
        return gap
    code, ip, iq = iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2)
    nx, ny, _, _, _, _ = meet(h, code, ip, iq)
    if code != g.EDGE_CORNER:
        gap -= reach_of_tip(h, ip, nx, ny)
    if code != g.CORNER_EDGE:
        gap -= reach_of_tip(h, iq, -nx, -ny)
    return max(gap, 0.0)


@inlined
def joint_material(h: Memory, ic: int) -> int:
    """Place of the joint material of contact `ic` in its tables; -1 if it has none."""
    ix = joint_at(h, ic)
    return iget(h, ix, g.KCJMAT) - 1 if ix != 0 else int64(-1)


@kernel
def free_aperture(h: Memory, ic: int) -> tuple[float, float]:
    """Aperture of contact `ic` where its walls touch without stress, and the smallest one."""
    m = joint_material(h, ic)
    if m < 0 or not h.cr[g.JMHAP + m] > 0:
        return 0.0, np.float64(h.cr[g.DTOL]) * THIN
    given, smallest = np.float64(h.cr[g.JMHAP + m]), np.float64(h.cr[g.JMRAP + m])
    if not smallest > 0:
        smallest = given * SMALLEST_PART
    return given - np.float64(getr(h, joint_at(h, ic), g.KCJOFF)), smallest


@kernel
def aperture_at(h: Memory, ic: int) -> float:
    """Aperture of contact `ic` for flow."""
    m = joint_material(h, ic)
    free, smallest = free_aperture(h, ic)
    aperture = max(free + gap_of_walls(h, ic), smallest)
    if m >= 0 and h.cr[g.JMMAP + m] > 0:
        aperture = min(aperture, max(np.float64(h.cr[g.JMMAP + m]), smallest))
    return aperture


@kernel
def aperture_of_crossing(h: Memory, ic: int) -> float:
    """Aperture without stress of the joint that crosses the one of contact `ic`, a corner of both, or 0."""
    _, other = joint_numbers(h, ic)
    m = h.ci[g.JLINE + other - 1] - 1 if other != 0 else -1
    if m < 0:
        return 0.0
    widest = np.float64(h.cr[g.JMMAP + m])
    return min(np.float64(h.cr[g.JMHAP + m]), widest if widest > 0 else np.inf)


@kernel
def corner_factor(h: Memory, ic: int) -> float:
    """Permeability factor of contact `ic`, if it has one and no joint is beside it; else 0."""
    m = joint_material(h, ic)
    if m < 0 or not h.cr[g.JMKC + m] > 0:
        return 0.0
    one, _ = joint_on_side(h, ic, SIDE1)
    two, _ = joint_on_side(h, ic, SIDE2)
    return np.float64(h.cr[g.JMKC + m]) if one < 0 and two < 0 else 0.0


@kernel
def set_conductance(h: Memory, ic: int) -> None:
    """Aperture of the pipe at contact `ic`, and its conductance: a^3/(12 mu l), or a corner's factor."""
    ix = pipe_at(h, ic)
    aperture = aperture_at(h, ic)
    length = np.float64(getr(h, ix, g.KPL1)) + getr(h, ix, g.KPL2)
    if length < h.cr[g.DTOL] and iget(h, ic, g.KCCOD) == g.CORNER_CORNER:
        aperture = max(aperture, aperture_of_crossing(h, ic))
    length = max(length, np.float64(h.cr[g.DTOL]) * SHORTEST_PIPE)
    factor = corner_factor(h, ic)
    if factor == 0.0:
        factor = aperture * aperture * aperture / (12.0 * np.float64(h.cr[g.WVISC]) * length)
    putr(h, ix, g.KPA, aperture)
    putr(h, ix, g.KPK, factor)


# ---- volumes


@kernel
def share_lengths(h: Memory, idm: int, line: Outlines, first: int, end: int) -> tuple[float, float]:
    """Lengths of the joints at the contacts of domain `idm`, which its outline has, for their pipes.

    Returns the sums of length times aperture without stress, and of length times smallest aperture.
    """
    free, smallest, x, y, many, before = 0.0, 0.0, 0.0, 0.0, 0, end - 1
    for k in range(first, end):
        ic = line.item[k]
        if line.edge[k] == 0 and iget(h, ic, g.KCCOD) != g.VIRTUAL:  # the wall before has ended there
            length = min(line.reach[before], line.reach[k])
            putr(h, pipe_at(h, ic), g.KPL1 if line.block[k] == iget(h, ic, g.KB2) else g.KPL2, length)
            one, two = free_aperture(h, ic)
            free, smallest = free + length * one, smallest + length * two
            x, y, many = x + np.float64(getr(h, ic, g.KXC)), y + np.float64(getr(h, ic, g.KYC)), many + 1
        before = k
    ix = water_at(h, idm)
    if many > 0 and iget(h, ix, g.KVCODE) != g.HELD:
        putr(h, ix, g.KVX, x / many)
        putr(h, ix, g.KVY, y / many)
    return free, smallest


@kernel
def measure_domain(h: Memory, idm: int, line: Outlines, first: int, end: int) -> tuple[float, float]:
    """Find the lengths of domain `idm` on its outline; returns its volume, and the smallest one.

    The volume can be less than the smallest one, which counts then. KVLEN: a wall of length L that moves
    changes the pressure, which acts on all walls, of length W together: that is the stiffness Kw L W/V, half
    of it between the wall and those opposite. Each of the two contacts at the ends of the longest wall takes
    half of that, and any other no more.
    """
    find_feet(h, line, first, end)
    longest, total = find_reaches(h, line, first, end)
    putr(h, water_at(h, idm), g.KVLEN, np.sqrt(longest * total) * 0.5)
    free, smallest = share_lengths(h, idm, line, first, end)
    return area_of(line, first, end) + free, smallest


# ---- motion


@inlined
def flow_is_due(h: Memory) -> bool:
    """True if water flows in this cycle; the change of volume is then part of the steps of flow."""
    return bool(h.ci[g.LFLOW] == g.COUPLED and (h.ci[g.MCTOT] + 1) % h.ci[g.NFEVRY] == 0)


@kernel
def compress(h: Memory, idm: int, volume: float, smallest: float, swept: float, moves: bool) -> None:
    """New volume of domain `idm`, and its pressure after `swept` (m2), by which motion has made it grow.

    volume, smallest: of the present state. moves: it follows from motion, not from a command.
    """
    ix = water_at(h, idm)
    p, saturation = np.float64(getr(h, idm, g.KPP)), np.float64(getr(h, ix, g.KVSAT))
    was, now = np.float64(getr(h, ix, g.KVVOL)), max(volume, smallest)
    if iget(h, ix, g.KVCODE) == g.FLOWS:
        h.cd[g.WATERW] += p * swept * 0.5
        h.cd[g.WDRIVE] += max(p * swept * 0.5, 0.0)
        if h.ci[g.LFLOW] == g.DRAINED:
            h.cd[g.WPUMPW] += p * swept * 0.5
    if iget(h, ix, g.KVCODE) != g.FLOWS or h.ci[g.LFLOW] == g.DRAINED:
        came = water_in(h, p, saturation, now) - water_in(h, p, saturation, was)
        h.cd[g.WATIN if moves else g.WATMAP] += came
        putr(h, ix, g.KVVOL, now)
        return
    known = np.float64(getr(h, ix, g.KVSTEP))
    if now < known * SHRUNK or known == 0.0 < now:
        h.ci[g.LSTIFF] = 1
    before = max(volume - swept, smallest)
    h.cd[g.WATMAP] += water_in(h, p, saturation, before) - water_in(h, p, saturation, was)
    lost = before - now
    if flow_is_due(h) and saturation >= 1.0:
        putr(h, ix, g.KVLOST, lost)
        lost = 0.0
    put_water(h, idm, now, excess_in(h, idm, before) + lost)


# ---- forces


@kernel
def held_pressure(h: Memory, idm: int, at: Point) -> float:
    """Pressure at a point of domain `idm`, in which it is held with a gradient; it may be below 0."""
    ix, p = water_at(h, idm), np.float64(getr(h, idm, g.KPP))
    gx, gy = np.float64(getr(h, ix, g.KVGX)), np.float64(getr(h, ix, g.KVGY))
    return p + gx * (at[0] - getr(h, ix, g.KVX)) + gy * (at[1] - getr(h, ix, g.KVY))


@kernel
def press_domain(h: Memory, idm: int, line: Outlines, first: int, end: int) -> float:
    """Forces of the water in domain `idm` on its walls. Returns their power at the present velocities.

    Of a pressure that flow and motion change it is half the power: the other half is that of the pressure
    before (compress).
    """
    power, outer, p = 0.0, idm == h.ci[g.IODPNT], np.float64(getr(h, idm, g.KPP))
    flows = not outer and not is_held(h, idm)
    for k in range(first + 1, end):
        ip, ib = line.edge[k], line.block[k]
        if ip == 0:
            continue
        if outer:
            power += press_outside(h, line, k)
            continue
        a, b = (line.x[k - 1], line.y[k - 1]), (line.x[k], line.y[k])
        if flows:
            power += press_piece(h, ib, ip, a, b, p, p)
        else:
            power += press_below_level(h, ib, ip, a, b, held_pressure(h, idm, a), held_pressure(h, idm, b))
    return power * 0.5 if flows else power


# ---- passes


@kernel
def fill_from_outside(h: Memory, idm: int, line: Outlines, first: int, end: int, volume: float) -> None:
    """Domain `idm` has been cut from the outer one: it is filled if there is a pressure outside."""
    p, ix, outer = 0.0, water_at(h, idm), h.ci[g.IODPNT]
    for k in range(first, end):
        ic = line.item[k]
        if line.edge[k] == 0 and outer in (iget(h, ic, g.KD1), iget(h, ic, g.KD2)):
            x, y = np.float64(getr(h, ic, g.KXC)), np.float64(getr(h, ic, g.KYC))
            p = max(p, pressure_outside(h, iget(h, pipe_at(h, ic), g.KPOUT), x, y))
    puti(h, ix, g.KVCODE, g.FLOWS)
    putr(h, idm, g.KPP, p)
    putr(h, ix, g.KVSAT, 1.0 if p > 0 else 0.0)
    putr(h, ix, g.KVVOL, volume)
    h.cd[g.WATIN] += water_of(h, idm)


@kernel
def renew_pipe(h: Memory, ic: int) -> None:
    """Conductance of the pipe at contact `ic`; without flow and condition where it has none."""
    ix, id1, id2 = pipe_at(h, ic), iget(h, ic, g.KD1), iget(h, ic, g.KD2)
    is_real = iget(h, ic, g.KCCOD) != g.VIRTUAL
    if is_real:
        set_conductance(h, ic)
    if not is_real or id1 == id2:
        putr(h, ix, g.KPQ, real(h, 0.0))
    if not is_real or h.ci[g.IOUPNT] == 0 or h.ci[g.IODPNT] not in (id1, id2):
        puti(h, ix, g.KPOUT, 0)


@kernel
def renew_volumes(h: Memory, line: Outlines, dt: float) -> None:
    """Volumes and pressures of all domains after motion in a step `dt`, apertures and flows by pressure.

    dt: 0 after a command, when domains keep their pressure.
    """
    idm, k, first, outer = int64(h.ci[g.IDPNT]), 0, 0, h.ci[g.IODPNT]
    while idm != 0:
        end = line.ends[k]
        if end > first:
            volume, smallest = measure_domain(h, idm, line, first, end)
            if iget(h, water_at(h, idm), g.KVCODE) == g.CUT_FROM_OUTSIDE:
                fill_from_outside(h, idm, line, first, end, max(volume, smallest))
            elif idm != outer:
                swept = swept_rate(h, line, first, end) * dt if dt > 0 else 0.0
                compress(h, idm, volume, smallest, swept, dt > 0)
        idm, k, first = iget(h, idm, g.KD), k + 1, end
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        renew_pipe(h, ic)
        ic = iget(h, ic, g.KC)


@kernel
def renew_present_volumes(h: Memory) -> None:
    """Volumes, apertures and flows by pressure of the present state, after a command."""
    renew_volumes(h, outlines_with_conditions(h), 0.0)


@inlined
def is_pressed(h: Memory, idm: int) -> bool:
    """True if there may be a pressure in domain `idm`."""
    if idm == h.ci[g.IODPNT]:
        return bool(h.ci[g.IOUPNT] != 0)
    return bool(getr(h, idm, g.KPP) != 0 or iget(h, water_at(h, idm), g.KVCODE) == g.HELD)


@kernel
def press(h: Memory, line: Outlines, dt: float) -> None:
    """Forces of all pressures on blocks.

    Their work in the step `dt` that has ended is added to WATERW, and to WDRIVE what puts energy in.
    """
    idm, k, first = int64(h.ci[g.IDPNT]), 0, 0
    while idm != 0:
        end = line.ends[k]
        if end > first and is_pressed(h, idm):
            work = press_domain(h, idm, line, first, end) * dt
            h.cd[g.WATERW] += work
            h.cd[g.WDRIVE] += max(work, 0.0)
            if idm == h.ci[g.IODPNT] or is_held(h, idm) or h.ci[g.LFLOW] == g.DRAINED:
                h.cd[g.WPUMPW] += work
        idm, k, first = iget(h, idm, g.KD), k + 1, end


@kernel
def press_present(h: Memory) -> None:
    """Forces of all pressures on blocks, after a command."""
    press(h, outlines_with_conditions(h), 0.0)
