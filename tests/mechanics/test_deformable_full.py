"""Fully-deformable blocks against exact solutions (report 2.9; targets of continuum mechanics)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.heap.accessors import puti, putr
from udec_ia.layout import offsets as g
from udec_ia.studies.verification_tools import generate, rectangle

RHO, K, G = 2000.0, 2e8, 1e8
CP = math.sqrt((K + 4 * G / 3) / RHO)


def slab(nodes: Any, d: float, bulk: float = K, shear: float = G, mixed: bool = False, **law: Any) -> Model:
    """A fully-deformable block under the nodes of a rectangle, rounded by `d`."""
    model = Model(**law)
    model.round(d)
    (x0, y0), (x1, y1) = nodes[0, 0], nodes[-1, -1]
    model.block(x0, y0, x0, y1, x1, y1, x1, y0)
    model.property(1, density=RHO, kn=1e9, ks=1e9, bulk=bulk, g=shear)
    generate(model, nodes, mixed)
    return model


def drive(model: Model, field: Any) -> None:
    """Give all grid-points the velocities field(x, y), for good."""
    for row in model.table("gridpoint"):
        ig = int(row["address"])
        u, v = field(float(row["KXG"]), float(row["KYG"]))
        putr(model.array.h, ig, g.KXDG, u)
        putr(model.array.h, ig, g.KYDG, v)
        puti(model.array.h, ig, g.KGFIX, 3)


@pytest.mark.parametrize("mixed", [False, True])
def test_patch(mixed: bool) -> None:
    """A linear velocity field strains an irregular mesh uniformly, as elasticity says, to rounding."""
    nodes = rectangle(0, 3, 0, 2, 3, 4)
    nodes[1:-1, 1:-1] += 0.1 * np.sin(7 * nodes[1:-1, 1:-1, ::-1])
    model = slab(nodes, 0.05, mixed=mixed)
    model.cycle(0)
    drive(model, lambda x, y: (1e-4 * x + 3e-4 * y, -2e-4 * x + 4e-4 * y))
    model.cycle(1)
    dt = float(model.h.cr[g.TDEL])
    one, two = K + 4 * G / 3, K - 2 * G / 3
    wanted = (one * 1e-4 + two * 4e-4, 2 * G * 0.5e-4, one * 4e-4 + two * 1e-4)
    zones = model.table("zone")
    for name, value in zip(("KZS11", "KZS12", "KZS22"), wanted, strict=True):
        np.testing.assert_allclose(zones[name], value * dt, rtol=1e-6)  # e dt itself is of the order 1e-7


def test_patch_finds_its_rest() -> None:
    """With the boundary displaced linearly, inner grid-points come to rest on the same linear field."""
    nodes = rectangle(0, 1, 0, 1, 4, 4)
    nodes[1:-1, 1:-1] += 0.03 * np.sin(9 * nodes[1:-1, 1:-1, ::-1])
    model = slab(nodes, 0.02)
    model.fraction(0.3)
    model.damping(1.0, CP / 4, "mass")
    model.cycle(0)
    before = model.table("gridpoint")
    for row in before[before["KCOR"] > 0]:
        ig = int(row["address"])
        putr(model.array.h, ig, g.KXDG, 1e-3 * float(row["KXG"]))
        puti(model.array.h, ig, g.KGFIX, 3)
    model.cycle(100)
    for row in before[before["KCOR"] > 0]:
        putr(model.array.h, int(row["address"]), g.KXDG, 0.0)
    model.cycle(1500)
    zones = model.table("zone")
    np.testing.assert_allclose(zones["KZS11"], zones["KZS11"].mean(), rtol=1e-6)
    np.testing.assert_allclose(zones["KZS12"], 0, atol=1e-6 * zones["KZS11"].mean())


def test_a_turn_by_360_degrees_strains_nothing() -> None:
    model = slab(rectangle(0, 2, 0, 1, 2, 2), 0.02)
    model.cycle(0)
    h, dt, steps = model.array.h, float(model.h.cr[g.TDEL]), 360
    model.insitu(-1, 3, -1, 2, 3e5, -1e5, 1e5)
    c, s = math.cos(2 * math.pi / steps), math.sin(2 * math.pi / steps)
    drive(model, lambda x, y: (0.0, 0.0))
    for _ in range(steps):
        for row in model.table("gridpoint"):
            x, y = float(row["KXG"]) - 1, float(row["KYG"]) - 0.5
            putr(h, int(row["address"]), g.KXDG, (c * x - s * y - x) / dt)
            putr(h, int(row["address"]), g.KYDG, (s * x + c * y - y) / dt)
        puti(h, int(model.table("block")["address"][0]), g.KBFIX, 0)
        model.cycle(1)
        zones = model.table("zone")
        np.testing.assert_allclose(zones["KZS11"] + zones["KZS22"], 4e5, rtol=1e-6)
        determinant = zones["KZS11"] * zones["KZS22"] - zones["KZS12"] ** 2
        np.testing.assert_allclose(determinant, 2e10, rtol=1e-6)
    np.testing.assert_allclose(zones["KZS11"], 3e5, rtol=1e-6)


def energies(m: Model) -> tuple[float, float]:
    """Kinetic energy of the slab, and its strain energy, J/m."""
    points, zones = m.table("gridpoint"), m.table("zone")
    kinetic = 0.5 * (points["KGPM"] * (points["KXDG"] ** 2 + points["KYDG"] ** 2)).sum()
    one, two = K + 4 * G / 3, K - 2 * G / 3
    s11, s12, s22 = zones["KZS11"], zones["KZS12"], zones["KZS22"]
    density = (one * (s11**2 + s22**2) - 2 * two * s11 * s22) / (one**2 - two**2) + s12**2 / G
    return float(kinetic), float((zones["KZM"] / RHO * density).sum() / 2)


def pulsed(length: float, lasts: float, stress: float) -> Model:
    """A bar on rollers with viscous ends, into which a smooth pulse of the given stress will run."""
    m = slab(rectangle(0, length, 0, 1, 60, 2), 0.02)
    for y in (0.0, 1.0):
        m.boundary(-1, length + 1, y - 0.01, y + 0.01, yvel=0)
    for x in (0.0, length):
        m.boundary(x - 0.01, x + 0.01, -1, 2, viscous=True)
    times = np.linspace(0, lasts, 60)
    factors = 0.5 * (1 - np.cos(2 * np.pi * times / lasts))
    m.function(1, *np.stack([times, factors], axis=-1).ravel().tolist(), 1.001 * lasts, 0.0)
    m.boundary(-0.01, 0.01, -1, 2, stress=(2 * stress, 0, 0), function=1)  # half of it stays in the dashpots
    m.fraction(0.5)
    m.cycle(0)
    return m


def test_a_pulse_leaves_through_a_viscous_edge() -> None:
    """A stress pulse as long as half the bar comes in as half of what is applied, runs with Cp, leaves."""
    length, most = 10.0, -1e4
    model = pulsed(length, 0.5 * length / CP, most)
    model.energy()
    step = float(model.h.cr[g.TDEL])
    model.cycle(int(0.75 * length / CP / step))
    kinetic, strain = energies(model)
    inside = kinetic + strain
    assert kinetic == pytest.approx(strain, rel=1e-2)
    assert model.balance().boundary == pytest.approx(inside, rel=1e-2)
    stress = model.table("zone")["KZS11"]
    assert stress.min() == pytest.approx(most, rel=2e-2)
    model.cycle(int(1.25 * length / CP / step))
    assert sum(energies(model)) < 0.01 * inside


def test_momentum_of_a_meshed_block_that_is_hit() -> None:
    model = Model()
    model.round(0.1)
    model.block(0, 0, 0, 2, 4, 2, 4, 0)
    model.property(1, density=RHO, kn=1e8, ks=1e8, bulk=K, g=G, friction=0.3)
    model.split(2, -1, 2, 3)
    generate(model, rectangle(2, 4, 0, 2, 2, 2))
    model.fraction(0.2)
    model.cycle(0)
    rigid = model.table("block")[model.table("block")["KX"] < 2][0]
    putr(model.h, int(rigid["address"]), g.KXD, 0.2)
    putr(model.h, int(rigid["address"]), g.KYD, 0.05)

    def momentum() -> Any:
        blocks = model.table("block")
        return np.array([(blocks["KBM"] * blocks["KXD"]).sum(), (blocks["KBM"] * blocks["KYD"]).sum()])

    before = momentum()
    model.cycle(400)
    np.testing.assert_allclose(momentum(), before, atol=1e-10 * abs(before).max())
    assert abs(model.table("zone")["KZS11"]).max() > 0
    assert model.check() == []
