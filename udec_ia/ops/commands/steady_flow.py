"""Steady flow of water between domains: nothing is stored, and blocks do not move (FLOW STEADY).

The unknown of a filled domain is its pressure p. That of another one is f(S), the part of the conductance
that its saturation S leaves. Newton's method begins with filled domains: from there pressures only fall
towards the steady state, whereas rising ones can pass a level at which water spills, and then turn without
end. A filled domain whose p would be negative begins to empty, another one is filled when f(S) would be
above 1. Each change follows from a linear system with a row for each domain. Volumes and Kw have no part in
it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import poll
from udec_ia.kernels.water.water_flow import Network, find_flows, gather, scatter
from udec_ia.layout import offsets as g

DIGITS = 2e-15  # part of the greatest potential: a fall below it has no digits
SHIFT = 1e-12  # added to the diagonal, as part of it: domains at rest without a way out have no level else
ROUNDS = 300  # of Newton's method; a few are usual


def part_of(s: Any) -> Any:
    """f(S) of saturations."""
    return s * s * (3.0 - 2.0 * s)


def saturation_of(part: Any) -> Any:
    """Saturations for which f(S) is `part`, 0 to 1: the roots of S S (3 - 2 S) = part in closed form."""
    return np.where(part > 0, 0.5 - np.sin(np.arcsin(1.0 - 2.0 * part) / 3.0), 0.0)


class SteadyFlow:
    """Pressures and f(S) on the way to a steady state; arrays over the rows and pipes of a network.

    Attributes
    ----------
    free
        True for rows whose pressure is free: the first ones.
    one, two, k
        Rows of each pipe, and its conductance.
    p, part, filled
        Pressure (Pa), f(S), and True for free rows that are filled.
    """

    def __init__(self, net: Network, free: int, rows: int, pipes: int) -> None:
        self.rows, self.free = rows, np.arange(rows) < free
        self.one, self.two = net.one[:pipes].astype(np.int64), net.two[:pipes].astype(np.int64)
        self.k, self.gravity = net.k[:pipes], net.gravity[:rows]
        self.given, self.taken = net.given[:rows], net.taken[:rows]
        self.p, self.part = net.potential[:rows] + self.gravity, part_of(net.s[:rows])
        self.filled = self.free & (net.s[:rows] >= 1.0)

    def fill(self) -> None:
        """Fill all free rows up to the highest level and the highest row."""
        levels = np.where(self.part > 0, self.p, 0.0) - self.gravity
        self.p = np.where(self.free, levels.max(initial=-np.inf) + self.gravity, self.p)
        self.part = np.where(self.free, 1.0, self.part)
        self.filled = self.free.copy()

    def balance(self, tolerance: float) -> tuple[int, float]:
        """Newton's method.

        Ends when no free row gains or loses more than `tolerance` of the flow through it. Returns the
        rounds, and the greatest such part.
        """
        for done in range(ROUNDS):
            poll()
            gained, rest = self._gain()
            if rest <= tolerance:
                return done, rest
            self._change(gained)
        return ROUNDS, self._gain()[1]

    def without_source(self) -> Any:
        """True for rows with water, and dry ones, that no water from outside or from a well reaches."""
        wet = self.part > 0
        number = self.connected(wet[self.one] & wet[self.two])
        source = (self.given > 0) | (wet & ~self.free)
        return ~np.isin(number, number[source])

    def limit_water(self, rows: Any, p: Any, part: Any) -> None:
        """Leave no more water in `rows` than that of `p` and `part`."""
        self.p = np.where(rows, np.minimum(self.p, p), self.p)
        self.part = np.where(rows, np.minimum(self.part, part), self.part)
        self.filled &= self.part >= 1.0

    def connected(self, pipes: Any) -> Any:
        """A number for each row, the same where `pipes` connect them; pipes: True for those that count."""
        ends = self.one[pipes], self.two[pipes]
        graph = coo_array((np.ones(len(ends[0])), ends), (self.rows, self.rows))
        return connected_components(graph, directed=False)[1]

    def _sum(self, row: Any, values: Any) -> Any:
        """Sum of the values of pipes for each row."""
        return np.bincount(row, values, self.rows)

    def _falls(self) -> tuple[Any, Any, Any]:
        """For each pipe the row that the water leaves, the other one, and the fall of the potential."""
        potential = self.p - self.gravity
        up = np.where(potential[self.one] > potential[self.two], self.one, self.two)
        down = self.one + self.two - up
        return up, down, potential[up] - potential[down]

    def _gain(self) -> tuple[Any, float]:
        """What each row gains, and for free rows the greatest such part of the flow through one."""
        up, down, fall = self._falls()
        q = self.k * self.part[up] * fall
        into, out = self.given + self._sum(down, q), self.taken * self.part + self._sum(up, q)
        conductance = self._sum(self.one, self.k) + self._sum(self.two, self.k)
        digits = conductance * np.abs(self.p - self.gravity).max(initial=0.0) * DIGITS
        missing = np.abs(into - out) > digits
        part = np.divide(np.abs(into - out) - digits, into + out, where=missing, out=np.zeros(self.rows))
        return into - out, float(part[self.free].max(initial=0.0))

    def _change(self, gained: Any) -> None:
        """One round: change p or f(S) of all free rows by what they have gained."""
        up, down, fall = self._falls()
        by_up = self.k * np.where(self.filled[up], self.part[up], fall)  # flow per unknown of its rows
        by_down = np.where(self.filled[down], -self.k * self.part[up], 0.0)
        diagonal = self._sum(up, by_up) - self._sum(down, by_down) + np.where(self.filled, 0.0, self.taken)
        changes = self.free & (diagonal > 0)
        place, size = np.cumsum(changes) - 1, int(changes.sum())
        inner = changes[up] & changes[down]
        up, down, all_rows = place[up[inner]], place[down[inner]], np.arange(size)
        values = np.concatenate((-by_up[inner], by_down[inner], diagonal[changes] * (1.0 + SHIFT)))
        ends = np.concatenate((down, up, all_rows)), np.concatenate((up, down, all_rows))
        change = np.zeros(self.rows)
        change[changes] = spsolve(coo_array((values, ends), (size, size)).tocsc(), gained[changes])
        blocked = self.free & ~changes & (gained > 0)  # water comes, and there is no way down
        p, part = self.p + change * self.filled, self.part + change * ~self.filled
        fills = self.free & ~self.filled & (blocked | (part > 1.0))
        self.filled = fills | (self.filled & (p >= 0))
        self.p = np.where(self.free, np.maximum(p, 0.0), self.p)
        self.part = np.where(self.free, np.clip(np.where(fills, 1.0, part), 0.0, 1.0), self.part)


def trapped_supply(array: MainArray) -> tuple[float, int]:
    """Flow from outside into a part of the network without a path to a held pressure or to the outside.

    Returns the greatest such flow (m2/s) and a domain in that part, or 0 and 0.
    """
    net, n, rows, m = gather(array.h)
    flow = SteadyFlow(net, n, rows, m)
    number = flow.connected(flow.k > 0)
    supply = np.bincount(number, flow.given - flow.taken)
    supply[number[~flow.free]] = 0.0
    if not supply.max(initial=0.0) > 0:
        return 0.0, 0
    worst = np.argmax(supply)
    return float(supply[worst]), int(net.domain[np.argmax(number == worst)])


def flow_to_steady(array: MainArray, tolerance: float) -> tuple[int, float]:
    """Pressures and saturations of steady flow; blocks do not move.

    Where no water from outside comes, what is at rest stays, and a dry domain stays dry. Ends when no domain
    gains or loses more than `tolerance` of the flow through it. Returns the rounds of Newton's method, and
    the greatest such part.
    """
    h = array.h
    net, n, rows, m = gather(h)
    flow = SteadyFlow(net, n, rows, m)
    p, part = flow.p, flow.part
    flow.fill()
    first, _ = flow.balance(tolerance)
    flow.limit_water(flow.without_source(), p, part)
    more, rest = flow.balance(tolerance)
    net.potential[:n] = (flow.p - flow.gravity)[:n]
    net.s[:n] = np.where(flow.filled, 1.0, saturation_of(flow.part))[:n]
    find_flows(net, rows, m)
    excess = flow.p[:n] / h.cr[g.WKW] + (net.s[:n] - 1.0)
    h.cd[g.WATPUT] += ((excess - net.excess[:n]) * net.v[:n]).sum()
    net.excess[:n] = excess
    scatter(h, net, n, rows, m)
    return first + more, rest
