"""Flow of water between domains (report 2.8): in steps of time, and to a steady state.

    q = K f(S) ((p1 - r g.x1) - (p2 - r g.x2))      K of the pipe: water_pressure.py
    f(S) = S S (3 - 2 S)                            S saturation of the domain that the water leaves

Domains and pipes are copied to arrays, in which many steps may follow one another. In a step all flows
follow from the same pressures. In a cycle each step takes its part of the change of volumes. The step is
stable below V/(Kw sum of K) of every domain (FDEL).

At the outside a contact has the pressure of its edge (BOUNDARY). Where that is 0, above a level or without a
condition, water leaves, but none comes in: a seepage face.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.errors import TOO_MANY_FLOW_STEPS
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti, putr, real
from udec_ia.kernels.links.longer_groups import pipe_at, water_at
from udec_ia.kernels.map.domain_water import excess_in, is_held, put_water
from udec_ia.kernels.water.water_outside import factor_of, outer_end, outside_at, pressure_outside
from udec_ia.kernels.water.water_pressure import flow_is_due, press, renew_volumes
from udec_ia.layout import offsets as g

SAFETY = 0.9  # of the greatest stable step
OUTSIDE = -1  # row of the outer domain


class Network(NamedTuple):
    """Domains and pipes as arrays.

    domain: (n,) addresses. p, s, v: pressure, saturation, volume. head: density times g.x. held: True if the
    pressure stays. excess: water less what fills the volume. lost: volume that is lost meanwhile. into: flow
    into each. pipe: (m,) contacts. one, two: rows of their domains, or OUTSIDE. k: flow by pressure. outer_p,
    outer_head: of the end outside. given: flow that comes from outside. q: flow from one to two.
    """

    domain: Any
    p: Any
    s: Any
    v: Any
    head: Any
    held: Any
    excess: Any
    lost: Any
    into: Any
    pipe: Any
    one: Any
    two: Any
    k: Any
    outer_p: Any
    outer_head: Any
    given: Any
    q: Any


@kernel
def empty_network(n: int, m: int) -> Network:
    """A network of `n` domains and `m` pipes."""
    return Network(
        np.empty(n, np.int64),
        np.empty(n, np.float64),
        np.empty(n, np.float64),
        np.empty(n, np.float64),
        np.empty(n, np.float64),
        np.empty(n, np.bool_),
        np.empty(n, np.float64),
        np.empty(n, np.float64),
        np.zeros(n, np.float64),
        np.empty(m, np.int64),
        np.empty(m, np.int64),
        np.empty(m, np.int64),
        np.empty(m, np.float64),
        np.zeros(m, np.float64),
        np.zeros(m, np.float64),
        np.zeros(m, np.float64),
        np.zeros(m, np.float64),
    )


@inlined
def head_at(h: Memory, x: float, y: float) -> float:
    """Density of water times gravity times place: what a pressure at rest increases by."""
    return h.cr[g.WDENS] * (np.float64(h.cr[g.GRAVX]) * x + np.float64(h.cr[g.GRAVY]) * y)


@kernel
def gather_domains(h: Memory, net: Network) -> int:
    """Copy all domains but the outer one to the arrays; returns their number."""
    n = 0
    idm = int64(h.ci[g.IDPNT])
    while idm != 0:
        if idm != h.ci[g.IODPNT]:
            ix = water_at(h, idm)
            puti(h, ix, g.KVROW, n)
            net.domain[n] = idm
            net.p[n], net.s[n] = getr(h, idm, g.KPP), getr(h, ix, g.KVSAT)
            net.v[n] = getr(h, ix, g.KVVOL)
            net.head[n] = head_at(h, getr(h, ix, g.KVX), getr(h, ix, g.KVY))
            net.held[n] = is_held(h, idm) or not net.v[n] > 0
            net.excess[n], net.lost[n] = excess_in(h, idm, net.v[n]), getr(h, ix, g.KVLOST)
            putr(h, ix, g.KVLOST, real(h, 0.0))
            n += 1
        idm = iget(h, idm, g.KD)
    return n


@kernel
def gather_pipes(h: Memory, net: Network) -> int:
    """Copy the pipes to the arrays; returns their number."""
    m, outer = 0, h.ci[g.IODPNT]
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        id1, id2 = iget(h, ic, g.KD1), iget(h, ic, g.KD2)
        if iget(h, ic, g.KCCOD) != g.VIRTUAL and id1 != id2:
            net.pipe[m] = ic
            net.one[m] = iget(h, water_at(h, id1), g.KVROW) if id1 != outer else OUTSIDE
            net.two[m] = iget(h, water_at(h, id2), g.KVROW) if id2 != outer else OUTSIDE
            net.k[m] = getr(h, pipe_at(h, ic), g.KPK)
            if id1 == outer or id2 == outer:
                gather_outside(h, net, m, ic)
            m += 1
        ic = iget(h, ic, g.KC)
    return m


@kernel
def gather_outside(h: Memory, net: Network, m: int, ic: int) -> None:
    """What contact `ic`, pipe `m`, has outside."""
    iou = outside_at(h, ic)
    x, y = outer_end(h, ic)
    net.outer_p[m], net.outer_head[m] = pressure_outside(h, iou, x, y), head_at(h, x, y)
    if iou != 0 and iget(h, iou, g.KOKIND) != g.PRESSURE_OUTSIDE:
        net.k[m] = 0.0
        if iget(h, iou, g.KOKIND) == g.FLOW_FROM_OUTSIDE:
            net.given[m] = np.float64(getr(h, iou, g.KOQ)) * factor_of(h, iou)


@inlined
def filled_part(s: float) -> float:
    """Part of its flow that a pipe has with the saturation `s` at the end that water leaves."""
    return s * s * (3.0 - 2.0 * s)


@inlined
def flow_of(net: Network, m: int) -> float:
    """Flow of pipe `m` from its first domain to the second at present pressures."""
    one, two, zero = net.one[m], net.two[m], 0.0
    if one >= 0 and two >= 0:
        q = net.k[m] * (net.p[one] - net.head[one] - net.p[two] + net.head[two])
        return q * filled_part(net.s[one] if q > zero else net.s[two])
    inner = max(one, two)
    q = net.k[m] * (net.p[inner] - net.head[inner] - net.outer_p[m] + net.outer_head[m])  # outwards
    if q > zero:
        q *= filled_part(net.s[inner])
    elif not net.outer_p[m] > zero:
        q = zero
    q -= net.given[m]
    return q if inner == one else -q


@kernel
def stable_step(net: Network, n: int, m: int, kw: float) -> float:
    """Greatest stable step of flow (s); 0 if nothing flows."""
    total = np.zeros(n, np.float64)
    for i in range(m):
        if net.one[i] >= 0:
            total[net.one[i]] += net.k[i]
        if net.two[i] >= 0:
            total[net.two[i]] += net.k[i]
    fastest = 0.0
    for i in range(n):
        if not net.held[i]:
            fastest = max(fastest, total[i] / net.v[i])
    return SAFETY / (kw * fastest) if fastest > 0 else 0.0


@kernel
def flow_step(net: Network, n: int, m: int, kw: float, dt: float, part: float) -> tuple[float, float]:
    """One step of flow. Returns the water (m2) that came from outside, and what emptied domains lacked.

    part: of the volume that is lost.
    """
    net.into[:n] = 0.0
    came, lacked = 0.0, 0.0
    for i in range(m):
        q = flow_of(net, i)
        net.q[i] = q
        if net.one[i] >= 0:
            net.into[net.one[i]] -= q
        else:
            came += q
        if net.two[i] >= 0:
            net.into[net.two[i]] += q
        else:
            came -= q
    for i in range(n):
        if net.held[i]:
            came -= net.into[i]
            continue
        excess = net.excess[i] + net.into[i] * dt + net.lost[i] * part
        if excess < -net.v[i]:
            lacked -= excess + net.v[i]
            excess = -net.v[i]
        net.excess[i] = excess
        net.p[i] = max(excess, 0.0) * kw / net.v[i]
        net.s[i] = min(1.0 + excess / net.v[i], 1.0)
    return came * dt, lacked


@kernel
def energy_of_step(net: Network, n: int, m: int, before: Any) -> tuple[float, float, float]:
    """Power of pressures outside on the water in a step, and of gravity, and of what viscosity takes.

    before: pressures before the step. The mean of both is that for which the sum is exact.
    """
    pumped, fell, lost = 0.0, 0.0, 0.0
    for i in range(n):
        before[i] = (before[i] + net.p[i]) * 0.5
        if net.held[i]:
            pumped -= net.into[i] * before[i]
    for i in range(m):
        one, two, q = net.one[i], net.two[i], net.q[i]
        if one >= 0 and two >= 0:
            fall = net.head[two] - net.head[one]
            fell += q * fall
            lost += q * (before[one] - before[two] + fall)
            continue
        inner, given = max(one, two), net.given[i]  # which comes in at pressure and height of the domain
        flows = (q if two >= 0 else -q) - given
        fall = net.head[inner] - net.outer_head[i]
        pumped += flows * net.outer_p[i] + given * before[inner]
        fell += flows * fall
        lost += flows * (net.outer_p[i] - before[inner] + fall)
    return pumped, fell, lost


@kernel
def scatter(h: Memory, net: Network, n: int, m: int) -> None:
    """Copy pressures, saturations and flows from the arrays."""
    for i in range(n):
        idm = net.domain[i]
        if not net.held[i]:
            put_water(h, idm, net.v[i], net.excess[i])
        putr(h, water_at(h, idm), g.KVQ, net.into[i])
    for i in range(m):
        putr(h, pipe_at(h, net.pipe[i]), g.KPQ, net.q[i])


@kernel
def find_flow_step(h: Memory) -> None:
    """Put the greatest stable step of flow into FDEL."""
    net = empty_network(h.ci[g.NDOM], h.ci[g.NCON])
    n = gather_domains(h, net)
    h.cr[g.FDEL] = stable_step(net, n, gather_pipes(h, net), np.float64(h.cr[g.WKW]))


@kernel
def flow(h: Memory, duration: float, limit: int) -> float:
    """Flow during `duration` (s) in equal stable steps, at most `limit`. Returns the time that has passed.

    NFLOW and FDEL are set.
    """
    net = empty_network(h.ci[g.NDOM], h.ci[g.NCON])
    n, m = gather_domains(h, net), 0
    m = gather_pipes(h, net)
    kw = np.float64(h.cr[g.WKW])
    step = stable_step(net, n, m, kw)
    h.cr[g.FDEL] = step
    steps = 1 if step == 0 else int64(np.ceil(min(duration / step, 1e15)))
    dt = duration / steps
    done = min(steps, int64(limit))
    before = net.p.copy()
    for _ in range(done):
        if h.ci[g.LENER] != 0:
            before[:n] = net.p[:n]
        came, lacked = flow_step(net, n, m, kw, dt, 1.0 / steps)
        h.cd[g.WATIN] += came
        h.cd[g.WATMAP] += lacked
        if h.ci[g.LENER] != 0:
            pumped, fell, lost = energy_of_step(net, n, m, before)
            h.cd[g.WPUMPW] += pumped * dt
            h.cd[g.WHEADW] += fell * dt
            h.cd[g.WVISCW] += lost * dt
    h.ci[g.NFLOW] = done
    scatter(h, net, n, m)
    return done * dt


# ---- in a cycle

MANY = 1_000_000  # steps of flow in one cycle: error 39


@outlined
def water_pass(h: Memory) -> bool:
    """Pressures after the motion of a cycle, flow, and the forces of the pressures on blocks."""
    dt = np.float64(h.cr[g.TDEL])
    renew_volumes(h, dt)
    if flow_is_due(h):
        flow(h, dt * h.ci[g.NFEVRY], MANY)
        if h.ci[g.NFLOW] == MANY and h.ci[g.NERR] == 0:
            h.ci[g.NERR] = TOO_MANY_FLOW_STEPS
    press(h, dt)
    return True
