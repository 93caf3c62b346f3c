"""Steady flow of water between domains: nothing is stored, and blocks do not move (FLOW STEADY).

In a filled domain the unknown is its pressure p. In another one it is f(S), the factor of its conductance by
its saturation S. Newton's method begins with filled domains: iterations from dry joints can overshoot the
level at which water spills, and cycle. A filled domain whose p would be negative begins to empty, another one
becomes filled when f(S) would exceed 1. Each change follows from a linear system with a row for each domain.
Volumes and Kw have no influence.

A pool that nothing drains as yet would rise without bounds: it only rises to the next brim over which it
spills, and one that a well drains only falls to its highest row. If this does not end, it begins again with
whole changes, and then with damped ones: where the imbalance grows the diagonal is increased, as by water
that is stored in a short time-step.
"""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import MatrixRankWarning, spsolve

from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import poll
from udec_ia.kernels.water.water_flow import Network, find_flows, gather, scatter
from udec_ia.layout import offsets as g

DIGITS = 2e-15  # part of the greatest pressure: a difference below it has no digits
SMALLEST = 1e-15  # shift of the diagonal, as part of it; it gives filled parts without an outlet a level
FIRST, GREATEST = 1e-3, 1e3  # shift when the imbalance begins to grow, and at most
UP, DOWN = 10.0, 3.0  # factors by which the shift grows and falls
BEYOND = 1e-9  # part of the greatest pressure by which a pool goes beyond a brim or below its highest row


class Attempt(NamedTuple):
    """Rounds of Newton's method from the same start: how many, and whether pools are limited, or damped."""

    rounds: int
    is_limited: bool
    is_damped: bool


ATTEMPTS = Attempt(200, True, False), Attempt(50, False, False), Attempt(200, False, True)


def saturation_of(f: Any) -> Any:
    """Saturations S, 0 to 1, for values of f(S): the roots of S S (3 - 2 S) = f in closed form."""
    a = 2.0 * np.arcsin(np.sqrt(f))
    return np.sin(a / 6.0) ** 2 + np.sqrt(0.75) * np.sin(a / 3.0)


class SteadyFlow:
    """Pressures and f(S) on the way to a steady state.

    Arrays have n rows, domains and ends of pipes at held pressures (Network), or a place for each pipe.

    Attributes
    ----------
    free, filled
        (n,) True for rows whose pressure is free, the first ones; for those of them that are filled.
    p, f
        (n,) pressures (Pa), f(S).
    gravity, given, taken
        (n,) density times g.x (Pa); flows by conditions into a row, and out of it when it is filled (m2/s).
    one, two, k
        Rows of each pipe, and its conductance (m2/(Pa s)).
    total
        (n,) sum of the conductances at each row.
    """

    def __init__(self, net: Network, free: int, rows: int, pipes: int) -> None:
        self.rows, self.free = rows, np.arange(rows) < free
        self.one, self.two = net.one[:pipes].astype(np.int64), net.two[:pipes].astype(np.int64)
        self.k, self.gravity = net.k[:pipes], net.gravity[:rows]
        self.total = self._sum(self.one, self.k) + self._sum(self.two, self.k)
        self.given, self.taken = net.given[:rows], net.taken[:rows]
        s = net.s[:rows]
        self.p, self.f = net.potential[:rows] + self.gravity, s * s * (3.0 - 2.0 * s)
        self.filled = self.free & (s >= 1.0)

    def fill(self) -> None:
        """Fill all free rows up to the highest level and the highest row."""
        levels = np.where(self.f > 0, self.p, 0.0) - self.gravity
        self.p = np.where(self.free, levels.max(initial=-np.inf) + self.gravity, self.p)
        self.f = np.where(self.free, 1.0, self.f)
        self.filled = self.free.copy()

    def balance(self, tolerance: float) -> tuple[int, float]:
        """Newton's method.

        Ends when no free row gains or loses more than `tolerance` of the sum of its inflow and outflow.
        Returns the rounds, and the greatest such part.
        """
        start, done, imbalance = (self.p, self.f, self.filled), 0, np.inf
        for attempt in ATTEMPTS:
            self.p, self.f, self.filled = start
            rounds, imbalance = self._try(attempt, tolerance)
            done += rounds
            if imbalance <= tolerance:
                self._improve(tolerance)
                self._dry_out()
                break
        return done, imbalance

    def _try(self, attempt: Attempt, tolerance: float) -> tuple[int, float]:
        """The rounds of one attempt; what `balance` returns."""
        shift, before = SMALLEST, np.inf
        for done in range(attempt.rounds):
            poll()
            gained, imbalance = self._gain()
            if imbalance <= tolerance:
                return done, imbalance
            now = float(np.abs(gained[self.free]).sum())
            if attempt.is_damped and done:
                shift = max(shift / DOWN, SMALLEST) if now < before else min(max(UP * shift, FIRST), GREATEST)
            before = now
            if not self._change(gained, shift, attempt.is_limited):
                return done, np.inf
        return attempt.rounds, self._gain()[1]

    def _improve(self, tolerance: float) -> None:
        """One more round, which matters where conductances differ by many decades."""
        found = self.p, self.f, self.filled
        self._change(self._gain()[0], SMALLEST, False)
        if not self._gain()[1] <= tolerance:
            self.p, self.f, self.filled = found

    def without_source(self) -> Any:
        """True for rows that no water connects to a held pressure, to an edge with one, or to a well."""
        wet = self.f > 0
        component = self.components(wet[self.one] & wet[self.two] & (self.k > 0))
        source = (self.given > 0) | (wet & ~self.free)
        return ~np.isin(component, component[source])

    def limit_water(self, rows: Any, p: Any, f: Any) -> None:
        """Leave no more water in `rows` than that of `p` and `f`, at one level where it is connected."""
        wet = f > 0
        part = self.components(wet[self.one] & wet[self.two] & (self.k > 0))
        level = np.full(self.rows, -np.inf)
        np.maximum.at(level, part, p - self.gravity)
        self.p = np.where(rows, np.minimum(self.p, np.where(wet, level[part] + self.gravity, 0.0)), self.p)
        self.f = np.where(rows, np.minimum(self.f, f), self.f)
        self.filled &= self.f >= 1.0

    def components(self, pipes: Any) -> Any:
        """A number for each row, the same for rows that `pipes` connect; pipes: True for those that count."""
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

    def _digits(self) -> Any:
        """Flow of each row that comes from last digits of pressures only."""
        return self.total * (np.abs(self.p) + np.abs(self.gravity)).max(initial=0.0) * DIGITS

    def _gain(self) -> tuple[Any, float]:
        """Net inflow of each row (m2/s); greatest part of inflow plus outflow that a free row lacks."""
        up, down, fall = self._falls()
        q = self.k * self.f[up] * fall
        into, out = self.given + self._sum(down, q), self.taken * self.f + self._sum(up, q)
        lacked = np.abs(into - out) - self._digits()
        part = np.divide(lacked, into + out, where=lacked > 0, out=np.zeros(self.rows))
        return into - out, float(part[self.free].max(initial=0.0))

    def _dry_out(self) -> None:
        """Empty the rows through which no more flows than last digits."""
        up, _, fall = self._falls()
        leaves = (self.taken + self._sum(up, self.k * fall)) * self.f
        dry = self.free & ~self.filled & (leaves <= self._digits())
        self.f = np.where(dry, 0.0, self.f)

    def _change(self, gained: Any, shift: float, is_limited: bool) -> bool:
        """One round: change p and f(S) of all free rows by what they have gained.

        False, and nothing is changed, if the reals cannot hold the change.
        """
        up, down, fall = self._falls()
        by_up = self.k * np.where(self.filled[up], self.f[up], fall)  # flow per unknown of its rows
        by_down = np.where(self.filled[down], -self.k * self.f[up], 0.0)
        diagonal = self._sum(up, by_up) - self._sum(down, by_down) + np.where(self.filled, 0.0, self.taken)
        emptied = self.filled & ~(diagonal > 0) & (gained < 0)  # by a well: its pressure has no influence
        diagonal += shift * np.where(self.filled, self.total, diagonal)
        changes = self.free & ~emptied & (diagonal > 0)
        blocked = self.free & ~self.filled & ~changes & (gained > 0)  # water comes, and there is no way down
        change = self._solve(changes, (up, down), (by_up, by_down), diagonal, gained)
        if not np.isfinite(change).all():
            return False
        if is_limited:
            change = self._limited(change)
        p, f = np.where(self.filled, self.p + change, self.p), np.where(self.filled, self.f, self.f + change)
        fills = ~self.filled & (blocked | (self.free & (f > 1.0)))
        self.filled = fills | (self.filled & ~emptied & (p >= 0))
        self.p = np.where(self.free, np.where(emptied, 0.0, np.maximum(p, 0.0)), self.p)
        self.f = np.where(self.free, np.where(fills, 1.0, np.clip(f, 0.0, 1.0)), self.f)
        return True

    def _limited(self, change: Any) -> Any:
        """The change, but pools that would go beyond all of the network rise to a brim or fall to a row.

        A pool is a connected part of filled rows. It spills over the lowest row beside it from which water
        comes now. It falls until its highest row begins to empty.
        """
        level, pool = self.p - self.gravity, self.components(self.filled[self.one] & self.filled[self.two])
        beyond = BEYOND * (np.abs(self.p) + np.abs(self.gravity)).max(initial=0.0)
        rise, fall = np.full((2, self.rows), np.inf)
        for one, two in ((self.one, self.two), (self.two, self.one)):
            comes = self.filled[one] & ~self.filled[two] & (level[two] >= level[one]) & (self.k > 0)
            np.minimum.at(rise, pool[one[comes]], (level[two] - level[one])[comes] + beyond)
        np.minimum.at(fall, pool[self.filled], self.p[self.filled] + beyond)
        after = level + change
        high = self.filled & (after > np.maximum(level, -self.gravity).max(initial=0.0))
        low = self.filled & (after < -self.gravity.max(initial=0.0))
        rises, falls = (self.filled & np.isin(pool, pool[rows]) for rows in (high, low))
        change = np.where(rises, np.minimum(change, rise[pool]), change)
        return np.where(falls, np.maximum(change, -fall[pool]), change)

    def _solve(self, changes: Any, ends: Any, by_ends: Any, diagonal: Any, gained: Any) -> Any:
        """Changes of the unknowns of the rows where `changes` is true, 0 for the others.

        ends: rows that the water of each pipe leaves and enters. by_ends: its flow per unknown of these.
        """
        place, size, (up, down), (by_up, by_down) = np.cumsum(changes) - 1, changes.sum(), ends, by_ends
        inner = changes[up] & changes[down]
        up, down, middle = place[up[inner]], place[down[inner]], np.arange(size)
        values = np.concatenate((-by_up[inner], by_down[inner], diagonal[changes]))
        places = np.concatenate((down, up, middle)), np.concatenate((up, down, middle))
        change = np.zeros(self.rows)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", MatrixRankWarning)
            change[changes] = spsolve(coo_array((values, places), (size, size)).tocsc(), gained[changes])
        return change


def trapped_supply(array: MainArray) -> tuple[float, int]:
    """Flow from outside into a part of the network without a path to a held pressure or to the outside.

    Returns the greatest such flow (m2/s) and a domain in that part, or 0 and 0.
    """
    net, n, rows, m = gather(array.h)
    flow = SteadyFlow(net, n, rows, m)
    component = flow.components(flow.k > 0)
    supply = np.bincount(component, flow.given - flow.taken)
    supply[component[~flow.free]] = 0.0
    if not supply.max(initial=0.0) > 0:
        return 0.0, 0
    worst = np.argmax(supply)
    return float(supply[worst]), int(net.domain[np.argmax(component == worst)])


def flow_to_steady(array: MainArray, tolerance: float) -> tuple[int, float]:
    """Pressures and saturations of steady flow; blocks do not move.

    Water from outside or from wells can fill domains; others have no more than before. Ends when no domain
    gains or loses more than `tolerance` of the sum of its inflow and outflow. Returns the rounds of Newton's
    method, and the greatest such part; if that is above `tolerance`, nothing has been changed.
    """
    h = array.h
    net, n, rows, m = gather(h)
    flow = SteadyFlow(net, n, rows, m)
    p, f = flow.p, flow.f
    flow.fill()
    done, imbalance = flow.balance(tolerance)
    if imbalance <= tolerance:
        flow.limit_water(flow.without_source(), p, f)
        more, imbalance = flow.balance(tolerance)
        done += more
    if not imbalance <= tolerance:
        return done, imbalance
    net.potential[:n] = (flow.p - flow.gravity)[:n]
    net.s[:n] = np.where(flow.filled, 1.0, saturation_of(flow.f))[:n]
    find_flows(net, rows, m)
    excess = flow.p[:n] / h.cr[g.WKW] + (net.s[:n] - 1.0)
    h.cd[g.WATPUT] += ((excess - net.excess[:n]) * net.v[:n]).sum()
    net.excess[:n] = excess
    scatter(h, net, n, rows, m)
    return done, imbalance
