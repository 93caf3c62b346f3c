"""Flow of water between domains (report 2.8): in steps of time, and to a steady state.

    q = K f(S) ((p1 - r g.x1) - (p2 - r g.x2))      K conductance of the pipe: water_pressure.py, r density
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
from udec_ia.kernels.water.water_outside import (
    factor_of,
    outer_end,
    outlines_with_conditions,
    pressure_outside,
)
from udec_ia.kernels.water.water_pressure import flow_is_due, held_pressure, press, renew_volumes
from udec_ia.layout import offsets as g

SAFETY = 0.9  # of the greatest stable step
GREATEST_SLOPE = 1.5  # of f(S): what leaves a domain grows with the water in it
MANY = 1_000_000  # steps of flow in one cycle: error 39


class Network(NamedTuple):
    """Domains and pipes as arrays.

    A row is a domain, or an end of a pipe at the outside or in a domain whose pressure is held: pressures
    there depend on the place of the contact. Held domains come after all others, and then the ends. domain:
    address, 0 for the outside. potential: pressure less gravity. gravity: density times g.x. s: saturation.
    v: volume. inverse: 1/v. excess: water per volume less 1. lost: volume that is lost meanwhile. given,
    taken: flows by conditions into the row, and out of it where it is filled. part: f(S), which multiplies
    what is taken. into: flow into the row. pipe: contacts. one, two: rows. k: conductance. q: flow from one
    to two.
    """

    domain: Any
    potential: Any
    gravity: Any
    s: Any
    v: Any
    inverse: Any
    excess: Any
    lost: Any
    given: Any
    taken: Any
    part: Any
    into: Any
    pipe: Any
    one: Any
    two: Any
    k: Any
    q: Any


@kernel
def empty_network(n: int, m: int) -> Network:
    """A network of `n` rows and `m` pipes."""
    return Network(
        domain=np.zeros(n, np.int64),
        potential=np.empty(n),
        gravity=np.empty(n),
        s=np.empty(n),
        v=np.empty(n),
        inverse=np.empty(n),
        excess=np.zeros(n),
        lost=np.zeros(n),
        given=np.zeros(n),
        taken=np.zeros(n),
        part=np.zeros(n),
        into=np.zeros(n),
        pipe=np.empty(m, np.int64),
        one=np.empty(m, np.uint32),  # a step waits for memory
        two=np.empty(m, np.uint32),
        k=np.empty(m),
        q=np.zeros(m),
    )


@inlined
def gravity_term(h: Memory, x: float, y: float) -> float:
    """Density of water times gravity times place: what a pressure at rest increases by."""
    return h.cr[g.WDENS] * (np.float64(h.cr[g.GRAVX]) * x + np.float64(h.cr[g.GRAVY]) * y)


@inlined
def put_state(net: Network, i: int, p: float, s: float) -> None:
    """Pressure and saturation of row `i`."""
    net.potential[i], net.s[i] = p - net.gravity[i], s


@inlined
def part_of(s: float) -> float:
    """f(S): part of the conductance that saturation `s` leaves."""
    return s * s * (3.0 - 2.0 * s)


@inlined
def add_given_flow(net: Network, i: int, q: float) -> None:
    """A condition gives row `i` the flow `q`, or takes it if that is negative."""
    net.given[i] += max(q, 0.0)
    net.taken[i] += max(-q, 0.0)


@kernel
def gather_domains(h: Memory, net: Network, n: int, held: bool) -> int:
    """Copy the domains whose pressure is held, or the others, to the rows behind `n`; returns the rows."""
    idm = int64(h.ci[g.IDPNT])
    while idm != 0:
        ix = water_at(h, idm)
        volume = np.float64(getr(h, ix, g.KVVOL))
        if idm != h.ci[g.IODPNT] and (is_held(h, idm) or not volume > 0) == held:
            puti(h, ix, g.KVROW, n)
            net.domain[n], net.v[n], net.inverse[n] = idm, volume, 1.0 / volume if volume > 0 else 0.0
            net.gravity[n] = gravity_term(h, getr(h, ix, g.KVX), getr(h, ix, g.KVY))
            put_state(net, n, max(np.float64(getr(h, idm, g.KPP)), 0.0), np.float64(getr(h, ix, g.KVSAT)))
            if not held:
                add_given_flow(net, n, np.float64(getr(h, ix, g.KVGIVN)))
            net.excess[n], net.lost[n] = excess_in(h, idm, np.float64(1.0)), getr(h, ix, g.KVLOST)
            n += 1
        idm = iget(h, idm, g.KD)
    return n


@kernel
def gather_pipes(h: Memory, net: Network, n: int) -> tuple[int, int]:
    """Copy the pipes to the arrays behind `n` rows; returns the numbers of rows and pipes."""
    rows, m, outer = n, 0, h.ci[g.IODPNT]
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        id1, id2 = iget(h, ic, g.KD1), iget(h, ic, g.KD2)
        if iget(h, ic, g.KCCOD) != g.VIRTUAL and id1 != id2:
            net.pipe[m], net.k[m] = ic, getr(h, pipe_at(h, ic), g.KPK)
            for idm, ends in ((id1, net.one), (id2, net.two)):
                if idm != outer and not is_held(h, idm):
                    ends[m] = iget(h, water_at(h, idm), g.KVROW)
                elif idm != outer:
                    gather_held_end(h, net, ic, idm, rows)
                    ends[m], rows = rows, rows + 1
            if id1 == outer or id2 == outer:
                if id1 == outer:
                    net.one[m], inner = rows, net.two[m]
                else:
                    net.two[m], inner = rows, net.one[m]
                gather_outside(h, net, m, ic, inner, rows)
                rows += 1
            m += 1
        ic = iget(h, ic, g.KC)
    return rows, m


@kernel
def gather_held_end(h: Memory, net: Network, ic: int, idm: int, row: int) -> None:
    """The end in domain `idm`, whose pressure is held, of the pipe at contact `ic`, as row `row`."""
    x, y = np.float64(getr(h, ic, g.KXC)), np.float64(getr(h, ic, g.KYC))
    p = max(held_pressure(h, idm, (x, y)), 0.0)
    net.domain[row], net.gravity[row] = idm, gravity_term(h, x, y)
    put_state(net, row, p, 1.0 if p > 0 else 0.0)


@kernel
def gather_outside(h: Memory, net: Network, m: int, ic: int, inner: int, row: int) -> None:
    """The outside end of pipe `m`, at contact `ic`, as row `row`: water comes from pressures above 0 only.

    inner: row of the other end.
    """
    iou = iget(h, pipe_at(h, ic), g.KPOUT)
    x, y = outer_end(h, ic)
    net.gravity[row] = gravity_term(h, x, y)
    p = pressure_outside(h, iou, x, y)
    put_state(net, row, p, 1.0 if p > 0 else 0.0)
    if iou != 0 and iget(h, iou, g.KOKIND) in (g.FLOW_FROM_OUTSIDE, g.IMPERMEABLE):
        net.k[m] = 0.0
        add_given_flow(net, inner, flow_from_outside(h, iou))


@inlined
def flow_from_outside(h: Memory, iou: int) -> float:
    """Flow that condition `iou` gives a contact, or 0."""
    if iget(h, iou, g.KOKIND) != g.FLOW_FROM_OUTSIDE:
        return 0.0
    return np.float64(getr(h, iou, g.KOQ)) * factor_of(h, iou)


@kernel
def gather(h: Memory) -> tuple[Network, int, int, int]:
    """The network of the present state, and its numbers of rows that are not held, of all, and of pipes."""
    net = empty_network(h.ci[g.NDOM] + 2 * h.ci[g.NCON], h.ci[g.NCON])
    n = gather_domains(h, net, 0, False)
    rows, m = gather_pipes(h, net, gather_domains(h, net, n, True))
    return net, n, rows, m


@inlined
def flow_of(net: Network, m: int, one: int, two: int) -> float:
    """Flow of pipe `m` from its row `one` to its row `two` at present pressures."""
    fall = net.potential[one] - net.potential[two]
    return net.k[m] * fall * part_of(net.s[one] if fall > 0 else net.s[two])


@inlined
def supply_of(net: Network, i: int) -> float:
    """What conditions have given row `i` in the last step, less what they have taken."""
    return net.given[i] - net.taken[i] * net.part[i]


@kernel
def stable_step(net: Network, n: int, rows: int, m: int, kw: float) -> float:
    """Greatest stable step of flow (s), in which no row empties; 0 if nothing flows."""
    total, leaves = np.zeros(rows, np.float64), net.taken[:rows].copy()
    for i in range(m):
        one, two = net.one[i], net.two[i]
        total[one] += net.k[i]
        total[two] += net.k[i]
        fall = net.potential[one] - net.potential[two]
        leaves[one if fall > 0 else two] += net.k[i] * abs(fall)
    fastest = 0.0
    for i in range(n):
        fastest = max(fastest, max(kw * total[i], GREATEST_SLOPE * leaves[i]) * net.inverse[i])
    return SAFETY / fastest if fastest > 0 else 0.0


@kernel
def find_flows(net: Network, rows: int, m: int) -> None:
    """Flow of each pipe, and into each row, at present pressures."""
    for i in range(rows):
        net.part[i] = part_of(net.s[i])
        net.into[i] = supply_of(net, i)
    for i in range(m):
        one, two = net.one[i], net.two[i]
        q = flow_of(net, i, one, two)
        net.q[i] = q
        net.into[one] -= q
        net.into[two] += q


@kernel
def flow_step(
    net: Network, n: int, rows: int, m: int, kw: float, dt: float, share: float
) -> tuple[float, float]:
    """One step of flow. Returns the water (m2) that came from outside, and what emptied domains lacked.

    share: part of the lost volume that is lost in this step.
    """
    find_flows(net, rows, m)
    came, lacked = 0.0, 0.0
    for i in range(n, rows):
        came -= net.into[i]
    for i in range(rows):
        came += supply_of(net, i)
    for i in range(n):
        excess = net.excess[i] + (net.into[i] * dt + net.lost[i] * share) * net.inverse[i]
        if excess < -1.0:
            lacked -= (excess + 1.0) * net.v[i]
            excess = -1.0
        net.excess[i] = excess
        put_state(net, i, max(excess, 0.0) * kw, min(1.0 + excess, 1.0))
    return came * dt, lacked


@kernel
def energy_of_step(net: Network, n: int, rows: int, m: int, before: Any) -> tuple[float, float, float]:
    """Power of pressures outside on the water in a step, and of gravity, and of what viscosity takes.

    before: potentials before the step; pressures after this call. The mean of the pressures before and after
    is that for which the sum is exact. What is given comes in at the pressure of the domain.
    """
    pumped, fell, lost = 0.0, 0.0, 0.0
    for i in range(rows):
        before[i] = (before[i] + net.potential[i]) * 0.5 + net.gravity[i]
        pumped += before[i] * (supply_of(net, i) - (net.into[i] if i >= n else 0.0))
    for i in range(m):
        one, two, q = net.one[i], net.two[i], net.q[i]
        fall = net.gravity[two] - net.gravity[one]
        fell += q * fall
        lost += q * (before[one] - before[two] + fall)
    return pumped, fell, lost


@kernel
def scatter(h: Memory, net: Network, n: int, rows: int, m: int) -> None:
    """Copy pressures, saturations and flows from the arrays."""
    for i in range(rows):
        idm = net.domain[i]
        if i < n:
            put_water(h, idm, net.v[i], net.excess[i] * net.v[i])
        if idm != 0:
            ix = water_at(h, idm)
            is_end = iget(h, ix, g.KVROW) != i
            putr(h, ix, g.KVQ, net.into[i] + (getr(h, ix, g.KVQ) if is_end else 0.0))
    for i in range(m):
        q, ix = net.q[i], pipe_at(h, net.pipe[i])
        iou, inner = iget(h, ix, g.KPOUT), min(net.one[i], net.two[i])
        if iou != 0:
            given = flow_from_outside(h, iou)
            if given < 0:
                given *= net.part[inner]
            q += given if net.one[i] > inner else -given
        putr(h, ix, g.KPQ, q)


@kernel
def find_flow_step(h: Memory) -> None:
    """Put the greatest stable step of flow into FDEL."""
    net, n, rows, m = gather(h)
    h.cr[g.FDEL] = stable_step(net, n, rows, m, np.float64(h.cr[g.WKW]))


@kernel
def flow_for_time(h: Memory, duration: float, given: int) -> None:
    """Flow during `duration` (s) in equal steps: `given` ones, or if that is 0 as many as are stable.

    NFLOW and FDEL are set. If more than MANY steps are needed nothing flows: error 39.
    """
    net, n, rows, m = gather(h)
    for i in range(rows):
        if net.domain[i] != 0:
            putr(h, water_at(h, net.domain[i]), g.KVLOST, real(h, 0.0))  # the steps take it in
    kw, steps = np.float64(h.cr[g.WKW]), int64(given)
    if steps == 0:
        step = stable_step(net, n, rows, m, kw)
        h.cr[g.FDEL] = step
        steps = max(int64(np.ceil(min(duration / step, 1e15))), 1) if step > 0 else int64(1)
        if steps > MANY:
            steps, duration = int64(1), 0.0  # nothing flows
            if h.ci[g.NERR] == 0:
                h.ci[g.NERR] = TOO_MANY_FLOW_STEPS
    dt, before = duration / steps, net.potential.copy()
    for _ in range(steps):
        if h.ci[g.LENER] != 0:
            before[:rows] = net.potential[:rows]
        came, lacked = flow_step(net, n, rows, m, kw, dt, 1.0 / steps)
        h.cd[g.WATIN] += came
        h.cd[g.WATMAP] += lacked
        if h.ci[g.LENER] != 0:
            pumped, fell, lost = energy_of_step(net, n, rows, m, before)
            h.cd[g.WPUMPW] += pumped * dt
            h.cd[g.WHEADW] += fell * dt
            h.cd[g.WVISCW] += lost * dt
    h.ci[g.NFLOW] = steps
    scatter(h, net, n, rows, m)


@outlined
def water_pass(h: Memory) -> bool:
    """Pressures after the motion of a cycle, flow, and the forces of the pressures on blocks."""
    dt = np.float64(h.cr[g.TDEL])
    line = outlines_with_conditions(h)
    renew_volumes(h, line, dt)
    if h.ci[g.LFLOW] == g.COUPLED:
        h.cd[g.WWAIT] += dt
    if flow_is_due(h):
        flow_for_time(h, h.cd[g.WWAIT], 0)
        if h.ci[g.NERR] != TOO_MANY_FLOW_STEPS:
            h.cd[g.WWAIT] = 0.0
    press(h, line, dt)
    return True
