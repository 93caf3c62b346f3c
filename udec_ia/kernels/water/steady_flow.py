"""Steady flow of water between domains: nothing is stored, and blocks do not move (FLOW STEADY).

Each domain in turn gets the pressure or saturation with which its flows balance, again and again, with
over-relaxation; volumes and Kw have no part in it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory
from udec_ia.kernels.water.water_flow import (
    Network,
    empty_network,
    flow_of,
    gather_domains,
    gather_pipes,
    scatter,
)
from udec_ia.layout import offsets as g

OVER = 1.6  # over-relaxation of filled domains


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
