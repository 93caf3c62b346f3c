"""FLOW STEADY on random networks of pipes: levels, wells, and outlets that draw more than comes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import Delaunay

from udec_ia.ops.commands.steady_flow import SteadyFlow

BALANCED = 1e-9
UNIT_WEIGHT = 9810.0


def random_network(seed: int, kind: str) -> tuple[Any, int]:
    """A network of pipes between places in a plane, and how many of its rows are free.

    kind: with "levels" rows at the end are held, with "wells" also some flow into rows and out of them;
    "outlets" has no held rows, and outlets that would draw more than comes.
    """
    rng = np.random.default_rng([seed, len(kind)])
    n = int(rng.integers(5, 120))
    rows = n if kind == "outlets" else n + int(rng.integers(1, 6))
    place = np.column_stack([rng.uniform(0, 30, rows), rng.uniform(0, 20, rows)])
    sides = Delaunay(place).simplices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    pipes = np.unique(np.sort(sides, axis=1), axis=0)
    pipes = pipes[(rng.random(len(pipes)) < rng.uniform(0.5, 1.0)) & (pipes[:, 0] < n)]
    k = 10.0 ** rng.uniform(-12, -6, len(pipes))
    net = SimpleNamespace(one=pipes[:, 0], two=pipes[:, 1], k=k, gravity=-UNIT_WEIGHT * place[:, 1])
    net.given, net.taken, net.s = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    pressure = np.maximum(UNIT_WEIGHT * rng.uniform(-20, 20, rows), 0.0)
    pressure[:n] = 0.0
    net.s[n:] = pressure[n:] > 0
    net.s[:n] = [0.0, 1.0][seed % 2]
    net.potential = pressure - net.gravity
    usual = float(np.median(k)) * 1e4
    if kind != "levels":
        into, out = rng.choice(n, 3), rng.choice(n, 3)
        net.given[into] = usual * rng.uniform(0.02, 0.5, 3)
        net.taken[out] = usual * rng.uniform(0.02, 2.0, 3)
    if kind == "outlets":
        net.taken *= net.given.sum() / net.taken.sum() * rng.uniform(1.01, 4.0)
    return net, n


def is_balanced(net: Any, n: int, flow: SteadyFlow) -> bool:
    """True if as much enters each free row as leaves it, to last digits of the greatest flow."""
    into, out = net.given.copy(), net.taken * flow.f
    digits = np.zeros(len(into))
    for a, b, k in zip(net.one.tolist(), net.two.tolist(), net.k.tolist(), strict=True):
        fall = (flow.p[a] - net.gravity[a]) - (flow.p[b] - net.gravity[b])
        up, down = (a, b) if fall > 0 else (b, a)
        out[up] += k * flow.f[up] * abs(fall)
        into[down] += k * flow.f[up] * abs(fall)
        digits[[a, b]] += 1e-9 * k  # Pa: last digits of pressures of 1e5 Pa and more
    through = into + out
    return bool((np.abs(into - out) <= 1e-9 * (through + through.max()) + digits)[:n].all())


@pytest.mark.parametrize("kind", ["levels", "wells", "outlets"])
def test_random_networks_end_steady(kind: str) -> None:
    """All but one in fifty; and those that do are balanced, with no pressure in what is partly filled."""
    tried, failed = 0, []
    for seed in range(200):
        net, n = random_network(seed, kind)
        rows = len(net.s)
        flow = SteadyFlow(net, n, rows, len(net.k))
        part = flow.components(flow.k > 0)
        supply = np.bincount(part, flow.given - flow.taken)
        supply[part[~flow.free]] = 0.0
        if supply.max() > 0:
            continue  # it is refused: this flow cannot leave
        tried += 1
        flow.fill()
        _, rest = flow.balance(BALANCED)
        if not rest <= BALANCED:
            failed.append(seed)
            continue
        assert is_balanced(net, n, flow)
        assert ((flow.p >= 0) & (flow.f >= 0) & (flow.f <= 1))[:n].all()
        assert (flow.p[:n][flow.f[:n] < 1] == 0).all()
    assert tried >= 150
    assert len(failed) <= tried / 50
