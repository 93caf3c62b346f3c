"""Flow of water between domains (report 2.8): in steps of time, and to a steady state.

    q = K f(S) ((p1 - r g.x1) - (p2 - r g.x2))      K of the pipe: water_pressure.py
    f(S) = S S (3 - 2 S)                            S saturation of the domain that the water leaves

Domains and pipes are copied to arrays, in which many steps may follow one another. In a step all flows
follow from the same pressures. The step is stable below V/(Kw sum of K) of every domain (FDEL).

At the outside a contact has the pressure of its edge (BOUNDARY). Where that is 0, above a level or without a
condition, water leaves, but none comes in: a seepage face.

In a steady state nothing is stored. Each domain in turn gets the pressure or saturation with which its flows
balance, again and again, with over-relaxation; volumes and Kw have no part in it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.errors import TOO_MANY_FLOW_STEPS
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti, putr
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.kernels.links.longer_groups import edge_at, pipe_at, water_at
from udec_ia.kernels.map.domain_water import excess_in, is_held, put_water
from udec_ia.kernels.water.domain_outline import edge_after, ends_a_joint
from udec_ia.kernels.water.water_pressure import factor_of, press, pressure_outside, renew_volumes
from udec_ia.layout import offsets as g

SAFETY = 0.9  # of the greatest stable step
OUTSIDE = -1  # row of the outer domain
OVER = 1.6  # over-relaxation of filled domains


class Network(NamedTuple):
    """Domains and pipes as arrays.

    domain: (n,) addresses. p, s, v: pressure, saturation, volume. head: density times g.x. held: True if the
    pressure stays. excess: water less what fills the volume. into: flow into each. pipe: (m,) contacts.
    one, two: rows of their domains, or OUTSIDE. k: flow by pressure. outer_p, outer_head: of the end outside.
    given: flow that comes from outside. q: flow from one to two.
    """

    domain: Any
    p: Any
    s: Any
    v: Any
    head: Any
    held: Any
    excess: Any
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
def outside_on_wall(h: Memory, ib: int, ic: int, ahead: bool) -> int:
    """Condition of the edge of block `ib` at contact `ic`, or of the one beyond the corner there; 0 for none.

    ahead: the outside is ahead of the contact in the list of the block.
    """
    ip = edge_after(h, ib, ic)
    iou = iget(h, edge_at(h, ip), g.KEOUT)
    if iou != 0:
        return iou
    beyond = next_corner(h, ib, ip) if ahead else iget(h, ip, g.KR)
    corner = ip if ahead else iget(h, ip, g.KR)
    return iget(h, edge_at(h, beyond), g.KEOUT) if ends_a_joint(h, corner) else int64(0)


@kernel
def outside_at(h: Memory, ic: int) -> int:
    """Condition of water outside at contact `ic` between the outer domain and another; 0 for none.

    Of two different ones a pressure counts, then a flow.
    """
    from_one = iget(h, ic, g.KD2) == h.ci[g.IODPNT]  # the wall outside goes on ahead on block KB1
    one = outside_on_wall(h, iget(h, ic, g.KB1), ic, from_one)
    two = outside_on_wall(h, iget(h, ic, g.KB2), ic, not from_one)
    if one == 0 or two == 0:
        return one + two
    return one if iget(h, one, g.KOKIND) <= iget(h, two, g.KOKIND) else two


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
            net.excess[n] = excess_in(h, idm, net.v[n])
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
    x, y, iou = np.float64(getr(h, ic, g.KXC)), np.float64(getr(h, ic, g.KYC)), outside_at(h, ic)
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
def flow_step(net: Network, n: int, m: int, kw: float, dt: float) -> tuple[float, float]:
    """One step of flow. Returns the water (m2) that came from outside, and what emptied domains lacked."""
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
        excess = net.excess[i] + net.into[i] * dt
        if excess < -net.v[i]:
            lacked -= excess + net.v[i]
            excess = -net.v[i]
        net.excess[i] = excess
        net.p[i] = max(excess, 0.0) * kw / net.v[i]
        net.s[i] = min(1.0 + excess / net.v[i], 1.0)
    return came * dt, lacked


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
def flow(h: Memory, duration: float, most: int) -> float:
    """Flow during `duration` (s) in equal stable steps, at most `most`. Returns the time for which it flowed.

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
    done = min(steps, int64(most))
    for _ in range(done):
        came, lacked = flow_step(net, n, m, kw, dt)
        h.cd[g.WATIN] += came
        h.cd[g.WATMAP] += lacked
    h.ci[g.NFLOW] = done
    scatter(h, net, n, m)
    return done * dt


# ---- steady state


@kernel
def pipes_by_domain(net: Network, n: int, m: int) -> tuple[Any, Any]:
    """Numbers of the pipes at each domain: those of domain i are found[first[i]:first[i + 1]]."""
    first = np.zeros(n + 1, np.int64)
    for i in range(m):
        for row in (net.one[i], net.two[i]):
            if row >= 0:
                first[row + 1] += 1
    for i in range(n):
        first[i + 1] += first[i]
    place, found = first.copy(), np.empty(first[n], np.int64)
    for i in range(m):
        for row in (net.one[i], net.two[i]):
            if row >= 0:
                found[place[row]] = i
                place[row] += 1
    return first, found


@kernel
def full_drop(net: Network, i: int, pipes: Any) -> float:
    """Twice the greatest difference of heads over the pipes of domain `i`: the scale of its saturation."""
    drop = 0.0
    for k in pipes:
        one, two = net.one[k], net.two[k]
        there = net.outer_head[k] if one < 0 or two < 0 else net.head[one + two - i]
        drop = max(drop, abs(there - net.head[i]))
    return drop * 2.0 if drop > 0 else 1.0


@kernel
def relax_domain(net: Network, i: int, pipes: Any, scale: float) -> tuple[float, float]:
    """Change pressure or saturation of domain `i` towards balance; returns what it lacked, and all its flow.

    scale: pressure that counts as much as an empty domain lacks.
    """
    into, through, total = 0.0, 0.0, 0.0
    for k in pipes:
        q = flow_of(net, k)
        into += q if net.two[k] == i else -q
        through += abs(q)
        total += net.k[k]
    if net.held[i] or not total > 0:
        return 0.0, through
    level = net.p[i] if net.s[i] >= 1.0 else (net.s[i] - 1.0) * scale
    level = max(level + (OVER if level > 0 else 1.0) * into / total, -scale)
    net.p[i], net.s[i] = max(level, 0.0), min(1.0 + level / scale, 1.0)
    return abs(into), through


@kernel
def flow_to_steady(h: Memory, sweeps: int, tolerance: float) -> tuple[int, float]:
    """Pressures and saturations of steady flow; blocks do not move.

    Ends when no domain gains or loses more than `tolerance` of the greatest flow through one, or after
    `sweeps`. Returns the sweeps and that part.
    """
    net = empty_network(h.ci[g.NDOM], h.ci[g.NCON])
    n = gather_domains(h, net)
    m = gather_pipes(h, net)
    first, found = pipes_by_domain(net, n, m)
    scale = np.empty(n, np.float64)
    for i in range(n):
        scale[i] = full_drop(net, i, found[first[i] : first[i + 1]])
    done, part = 0, 1.0
    while done < sweeps and part > tolerance:
        worst, greatest = 0.0, 0.0
        for k in range(n):
            i = k if done % 2 == 0 else n - 1 - k
            lacked, through = relax_domain(net, i, found[first[i] : first[i + 1]], scale[i])
            worst, greatest = max(worst, lacked), max(greatest, through)
        done += 1
        part = worst / greatest if greatest > 0 else 0.0
    net.into[:n] = 0.0
    for k in range(m):
        q = flow_of(net, k)
        net.q[k] = q
        if net.one[k] >= 0:
            net.into[net.one[k]] -= q
        if net.two[k] >= 0:
            net.into[net.two[k]] += q
    for i in range(n):
        if net.held[i]:
            continue
        was = net.excess[i]
        net.excess[i] = net.v[i] * (net.p[i] / h.cr[g.WKW] + (net.s[i] - 1.0))
        h.cd[g.WATPUT] += net.excess[i] - was
    scatter(h, net, n, m)
    return done, part


# ---- in a cycle

MANY = 1_000_000  # steps of flow in one cycle: error 39


@outlined
def water_pass(h: Memory) -> bool:
    """Pressures after the motion of a cycle, flow, and the forces of the pressures on blocks."""
    dt = np.float64(h.cr[g.TDEL])
    renew_volumes(h, dt)
    if h.ci[g.LFLOW] == g.COUPLED and (h.ci[g.MCTOT] + 1) % h.ci[g.NFEVRY] == 0:
        flow(h, dt * h.ci[g.NFEVRY], MANY)
        if h.ci[g.NFLOW] == MANY and h.ci[g.NERR] == 0:
            h.ci[g.NERR] = TOO_MANY_FLOW_STEPS
    press(h, dt)
    return True
