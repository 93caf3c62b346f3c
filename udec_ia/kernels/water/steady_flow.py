"""Steady flow of water between domains: nothing is stored, and blocks do not move (FLOW STEADY).

Two steps take turns. Conjugate gradients find the pressures of filled domains with which their flows balance,
while the others stay as they are. Then each domain in turn gets the pressure or saturation with which its own
flows balance, a few times. Volumes and Kw have no part in it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory
from udec_ia.kernels.water.water_flow import (
    Network,
    find_flows,
    gather,
    part_of,
    put_state,
    scatter,
)
from udec_ia.layout import offsets as g

DIGITS = 2e-15  # part of the greatest potential
OVER = 1.5  # over-relaxation of filled domains
SWEEPS = 10  # after each solution for the filled domains
ITERATIONS, RESIDUAL = 5000, 1e-13  # of conjugate gradients: most; part of the first residual to stop at


@kernel
def pipes_by_row(net: Network, rows: int, m: int) -> tuple[Any, Any]:
    """Numbers of the pipes at each row: those of row i are found[first[i]:first[i + 1]]."""
    first = np.zeros(rows + 1, np.int64)
    for i in range(m):
        first[net.one[i] + 1] += 1
        first[net.two[i] + 1] += 1
    for i in range(rows):
        first[i + 1] += first[i]
    place, found = first.copy(), np.empty(first[rows], np.int64)
    for i in range(m):
        for row in (net.one[i], net.two[i]):
            found[place[row]] = i
            place[row] += 1
    return first, found


@kernel
def full_drop(net: Network, i: int, pipes: Any) -> float:
    """Twice the greatest fall by gravity over the pipes of row `i`.

    While conjugate gradients work, a row is empty where its pressure would be that much below 0.
    """
    drop = 0.0
    for k in pipes:
        drop = max(drop, abs(net.gravity[net.one[k]] - net.gravity[net.two[k]]))
    return drop * 2.0 if drop > 0 else 1.0


@inlined
def saturation_of(part: float) -> float:
    """S for which f(S) is `part`, 0 to 1: the root of S S (3 - 2 S) = part in closed form."""
    if part <= 0:
        return 0.0
    return 0.5 - np.sin(np.arcsin(1.0 - 2.0 * min(part, 1.0)) / 3.0)


@kernel
def relax_row(net: Network, i: int, pipes: Any, top: float) -> tuple[float, float]:
    """Change pressure or saturation of row `i` to balance; returns what it lacked, and all its flow.

    An empty or partly filled row gets the saturation with which what comes in leaves again. A filled one gets
    a pressure, and begins to empty below 0. top: greatest potential, below whose last digits nothing is
    lacking.
    """
    into, leaves = net.given[i], net.taken[i]  # leaves: when the row is filled
    total = 0.0
    for k in pipes:
        other = net.two[k] if net.one[k] == i else net.one[k]
        fall = net.potential[other] - net.potential[i]
        if fall > 0:
            into += net.k[k] * fall * part_of(net.s[other])
        else:
            leaves -= net.k[k] * fall
        total += net.k[k]
    out = leaves * part_of(net.s[i])
    lacked = max(abs(into - out) - total * top * DIGITS, 0.0)
    if into >= leaves and not total > 0:
        return 0.0, into + out
    if into < leaves and (net.s[i] < 1.0 or not total > 0):
        put_state(net, i, 0.0, saturation_of(into / leaves))
    elif total > 0:
        p = net.potential[i] + net.gravity[i] + OVER * (into - leaves) / total
        put_state(net, i, max(p, 0.0), 1.0 if p >= 0 else saturation_of(into / leaves))
    return lacked, into + out


@kernel
def multiply(net: Network, m: int, c: Any, filled: Any, x: Any, y: Any) -> None:
    """y := flow out of each filled row for the pressures `x` of these rows, by the conductances `c`."""
    y[:] = 0.0
    for k in range(m):
        one, two = net.one[k], net.two[k]
        q = c[k] * (filled[one] * x[one] - filled[two] * x[two])
        y[one] += q
        y[two] -= q
    y *= filled


@kernel
def balance_filled(net: Network, n: int, rows: int, m: int, scale: Any) -> None:
    """Change the pressures of filled rows so that their flows balance; those below 0 begin to empty.

    scale: pressure below 0 with which a row would be empty. Which end of a pipe the water leaves stays as it
    is.
    """
    filled, c, diagonal = np.zeros(rows), np.empty(m), np.zeros(rows)
    for i in range(n):
        filled[i] = 1.0 if net.s[i] >= 1.0 else 0.0
    for k in range(m):
        one, two = net.one[k], net.two[k]
        c[k] = net.k[k] * part_of(net.s[one] if net.potential[one] > net.potential[two] else net.s[two])
        diagonal[one] += c[k]
        diagonal[two] += c[k]
    find_flows(net, rows, m)
    x, y, r = np.zeros(rows), np.empty(rows), net.into[:rows] * filled
    inverse = np.where(diagonal > 0, 1.0 / np.where(diagonal > 0, diagonal, 1.0), 0.0)
    z = inverse * r
    d, was = z.copy(), (r * z).sum()
    first, count = was, 0
    while count < ITERATIONS and was > RESIDUAL * RESIDUAL * first and was > 0:
        multiply(net, m, c, filled, d, y)
        curved = (d * y).sum()
        if not curved > 0:
            break
        x += d * (was / curved)
        r -= y * (was / curved)
        z = inverse * r
        now = (r * z).sum()
        d = z + d * (now / was)
        was, count = now, count + 1
    for i in range(n):
        if filled[i] > 0:
            state = max(net.potential[i] + net.gravity[i] + x[i], -scale[i])
            put_state(net, i, max(state, 0.0), min(1.0 + state / scale[i], 1.0))


@inlined
def root_of(part: Any, i: int) -> int:
    """The row that stands for the part of the network in which row `i` is."""
    while part[i] != i:
        part[i] = part[part[i]]  # the next search is shorter
        i = part[i]
    return i


@kernel
def trapped_supply(h: Memory) -> tuple[float, int]:
    """Flow from outside into a part of the network without a path to a held pressure or to the outside.

    Returns the greatest such flow (m2/s) and a domain in that part, or 0 and 0.
    """
    net, n, rows, m = gather(h)
    part, supply, closed = np.arange(rows + 1), np.zeros(rows + 1), np.ones(rows + 1)
    for k in range(m):
        if net.k[k] > 0:
            part[root_of(part, net.one[k])] = root_of(part, net.two[k])
    for i in range(rows):
        root = root_of(part, i)
        supply[root] += net.given[i] - net.taken[i]
        if i >= n:
            closed[root] = 0.0
    worst = np.argmax(supply * closed)  # the last place, without a row, is for a network that has none
    if not supply[worst] * closed[worst] > 0:
        return 0.0, 0
    return supply[worst], net.domain[worst]


@kernel
def fill_to_highest(h: Memory) -> None:
    """Fill all domains whose pressure is free up to the highest level that there is: another first state."""
    net, n, rows, m = gather(h)
    highest = -np.inf
    for i in range(rows):
        if net.s[i] > 0:
            highest = max(highest, net.potential[i])
    for i in range(n):
        p = highest + net.gravity[i]
        was = net.excess[i]
        net.excess[i] = p / h.cr[g.WKW] if p >= 0 else -1.0
        h.cd[g.WATPUT] += (net.excess[i] - was) * net.v[i]
    scatter(h, net, n, rows, m)


@kernel
def flow_to_steady(h: Memory, sweeps: int, tolerance: float) -> tuple[int, float]:
    """Pressures and saturations of steady flow; blocks do not move.

    Ends when no domain gains or loses more than `tolerance` of the flow through it, or after `sweeps`.
    Returns the sweeps and the greatest such part.
    """
    net, n, rows, m = gather(h)
    first, found = pipes_by_row(net, rows, m)
    scale = np.empty(n, np.float64)
    for i in range(n):
        scale[i] = full_drop(net, i, found[first[i] : first[i + 1]])
    done, rest, top = 0, 1.0, 0.0
    while done < sweeps and rest > tolerance:
        rest = 0.0
        for i in range(rows):
            top = max(top, abs(net.potential[i]))
        if done % SWEEPS == 0:
            balance_filled(net, n, rows, m, scale)
        for k in range(n):
            i = k if done % 2 == 0 else n - 1 - k
            lacked, through = relax_row(net, i, found[first[i] : first[i + 1]], top)
            rest = max(rest, lacked / through if through > 0 else 0.0)
        done += 1
    find_flows(net, rows, m)
    for i in range(n):
        was, p = net.excess[i], max(net.potential[i] + net.gravity[i], 0.0)
        net.excess[i] = p / h.cr[g.WKW] + (net.s[i] - 1.0)
        h.cd[g.WATPUT] += (net.excess[i] - was) * net.v[i]
    scatter(h, net, n, rows, m)
    return done, rest
