"""BOUNDARY, FUNCTION and INSITU against sums and integrals by hand, for blocks of every type."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest
from naive.bodies import area_and_moments, momentum, points_of
from support.lone_block_loads import CP, CS, EVERYWHERE, RHO, SKEW, TYPES, lone, tractions
from support.mechanics_scenes import box, push, sound

from udec_ia import Model
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g
from udec_ia.studies.verification_tools import generate, rectangle

EPS = float(np.finfo(float).eps)


# ---- velocities and forces


def halfway(m: Model, n: int) -> Any:
    """Times in the middle of the next `n` steps."""
    return float(m.h.cd[g.TIME]) + float(m.h.cr[g.TDEL]) * (np.arange(n) + 0.5)


POINTS = (0.0, 0.5, 0.002, 2.0, 0.003, -1.0, 0.0045, 0.25)


def factors(name: str, t: Any) -> Any:
    """What a sine of 300 Hz that lasts 4 ms, or the function above, is at the times t."""
    if name == "sine":
        return np.where(t <= 4e-3, np.sin(2 * pi * 300 * t), 0.0)
    return np.interp(t, POINTS[::2], POINTS[1::2])


def history(m: Model, name: str) -> dict[str, Any]:
    if name == "sine":
        return {"sine": (300.0, 4e-3)}
    m.function(7, *POINTS)
    return {"function": 7}


@pytest.mark.parametrize("name", ["sine", "function"])
@pytest.mark.parametrize("kind", TYPES)
def test_given_velocities_are_those_halfway_through_each_step(kind: str, name: str) -> None:
    m = lone(kind, SKEW)
    m.fraction(0.05)
    m.cycle(0)
    m.boundary(*EVERYWHERE, xvel=0.3, yvel=-0.2, **history(m, name))
    before = m.table("gridpoint") if kind == "zoned" else m.table("block")
    n = int(6e-3 / float(m.h.cr[g.TDEL]))
    factor = factors(name, halfway(m, n))
    m.cycle(n)
    after = m.table("gridpoint") if kind == "zoned" else m.table("block")
    names = ("KXG", "KYG") if kind == "zoned" else ("KX", "KY")
    held = after["KCOR"] > 0 if kind == "zoned" else slice(None)
    for v, name_ in zip((0.3, -0.2), names, strict=True):
        moved = after[name_][held] - before[name_][held]
        way = (v * factor * float(m.h.cr[g.TDEL])).sum()
        np.testing.assert_allclose(moved, way, atol=n * EPS * 4)
    sound(m)


@pytest.mark.parametrize("name", ["sine", "function"])
@pytest.mark.parametrize("kind", TYPES)
def test_forces_give_the_impulse_of_their_history(kind: str, name: str) -> None:
    m = lone(kind, SKEW)
    m.fraction(0.05)
    m.cycle(0)
    many = len(m.table("gridpoint")) or 1
    assert m.boundary(*EVERYWHERE, xforce=3e4, yforce=-1e4, **history(m, name)) == many
    n = int(6e-3 / float(m.h.cr[g.TDEL]))
    impulse = (factors(name, halfway(m, n)) * float(m.h.cr[g.TDEL])).sum()
    size = (abs(factors(name, halfway(m, n))) * float(m.h.cr[g.TDEL])).sum()
    m.cycle(n)
    total, _ = momentum(m)
    np.testing.assert_allclose(
        total[:2], np.array([3e4, -1e4]) * impulse * many, atol=n * EPS * 3e4 * size * many
    )


def test_a_sine_begins_with_its_command() -> None:
    """After 0.1 s of settling, for its own duration, and from zero."""
    m = lone("rigid", box(0, 2, 0, 1))
    m.cycle(1)
    dt = float(m.h.cr[g.TDEL])
    m.cycle(int(0.1 / dt))
    begun = float(m.h.cd[g.TIME])
    m.boundary(*EVERYWHERE, xvel=1.0, sine=(50.0, 0.01))
    lasts = int(0.01 / dt)
    for _ in range(lasts + 3):
        t = float(m.h.cd[g.TIME]) - begun + dt / 2
        m.cycle(1)
        expected = np.sin(2 * np.pi * 50 * t) if t <= 0.01 else 0.0
        assert m.table("block")["KXD"][0] == pytest.approx(expected, abs=1e-9)
    assert lasts > 3


# ---- stresses and viscous edges


@pytest.mark.parametrize("kind", TYPES)
def test_stresses_that_grow_have_their_resultant_and_moment(kind: str) -> None:
    """One cycle from rest: momentum and angular momentum are the time-step times force and moment."""
    rng = np.random.default_rng(5)
    for _ in range(4):
        stress, xgrad, ygrad = rng.normal(0, 1e4, (3, 3)).tolist()
        m = lone(kind, SKEW)
        m.cycle(0)
        m.boundary(*EVERYWHERE, stress=tuple(stress), xgrad=tuple(xgrad), ygrad=tuple(ygrad))
        m.cycle(1)
        force, moment = tractions(SKEW, stress, xgrad, ygrad)
        row, dt = m.table("block")[0], float(m.h.cr[g.TDEL])
        spin = float(row["KBI"]) * float(row["KTD"])
        if kind == "zoned":
            points = points_of(m)[int(row["address"])]
            masses = [float(p["KGPM"]) for p in points]
            total = [
                sum(q * float(p[k]) for q, p in zip(masses, points, strict=True)) for k in ("KXDG", "KYDG")
            ]
            start = np.array([(p["KXG"] - dt * p["KXDG"], p["KYG"] - dt * p["KYDG"]) for p in points])
            turn = sum(
                q * (x * float(p["KYDG"]) - y * float(p["KXDG"]))
                for q, p, (x, y) in zip(masses, points, start, strict=True)
            )
        else:
            total = [float(row["KBM"]) * float(row[k]) for k in ("KXD", "KYD")]
            x, y = (float(row[k]) - dt * float(row[v]) for k, v in (("KX", "KXD"), ("KY", "KYD")))
            turn = spin + x * total[1] - y * total[0]
        scale = np.abs([*stress, *xgrad, *ygrad]).sum() * 10
        np.testing.assert_allclose(total, force * dt, atol=1e-12 * scale * dt)
        assert turn == pytest.approx(moment * dt, abs=1e-12 * scale * dt)


def test_stresses_strain_a_simply_deformable_block_by_their_mean() -> None:
    """J de/dt + de/dt J = 2 A S at rest: the integral of t r over the outline is A S about the centroid."""
    stress, xgrad, ygrad = (1e5, -3e4, 2e5), (4e4, 1e4, -2e4), (1e4, -4e4, 3e4)
    m = lone("sdef", SKEW)
    m.cycle(0)
    m.boundary(*EVERYWHERE, stress=stress, xgrad=xgrad, ygrad=ygrad)
    m.cycle(1)
    area, x, y, second = area_and_moments(SKEW)
    s11, s12, s22 = np.array(stress) + x * np.array(xgrad) + y * np.array(ygrad)
    mean = np.array([[s11, s12], [s12, s22]])
    row = m.table("sdef")[0]
    rate = np.array([[row["KED11"], row["KED12"]], [row["KED12"], row["KED22"]]], float) / float(
        m.h.cr[g.TDEL]
    )
    found = RHO * (rate @ second + second @ rate) / 2
    np.testing.assert_allclose(found, area * mean, rtol=1e-5)  # the strain rate has turned with the block


def test_loads_do_not_turn_with_their_block() -> None:
    """Loads keep their direction: a spinning block gets the same momentum as one at rest."""
    m = lone("rigid", box(0, 2, 0, 1))
    m.cycle(0)
    ib, dt = int(m.table("block")["address"][0]), float(m.h.cr[g.TDEL])
    push(m, ib, td=5.0)
    m.boundary(*EVERYWHERE, stress=(-1e4, 0, 0), xgrad=(1e3, 0, 0))
    force, _ = tractions(box(0, 2, 0, 1), (-1e4, 0, 0), (1e3, 0, 0), (0, 0, 0))
    m.cycle(100)
    total, _ = momentum(m)
    np.testing.assert_allclose(total[:2], 100 * dt * force, atol=1e-9 * 100 * dt * 1e4)


@pytest.mark.parametrize("kind", TYPES)
def test_a_viscous_outline_stops_a_block_exponentially(kind: str) -> None:
    """m dv/dt = -C v, C = 2 h rho Cp + 2 w rho Cs for motion along x.

    A step takes C dt/m of the velocity, which is off from the exponential by (C dt/m)^2/2. A grid-point has
    its own share of C and of the mass, so only the impulse of a meshed block is known: -C times its way.
    """
    w, h = 3.0, 2.0
    m = lone(kind, box(0, w, 0, h))
    m.boundary(*EVERYWHERE, viscous=True)
    m.fraction(0.02)
    m.cycle(0)
    mass, dt = RHO * w * h, float(m.h.cr[g.TDEL])
    c = 2 * h * RHO * CP + 2 * w * RHO * CS
    v, n = 0.01, 40
    if kind != "zoned":
        push(m, int(m.table("block")["address"][0]), xd=v)
        m.cycle(n)
        row = m.table("block")[0]
        assert row["KXD"] == pytest.approx(v * (1 - c * dt / mass) ** n, rel=1e-10)
        assert row["KXD"] == pytest.approx(v * np.exp(-c * dt * n / mass), rel=n * (c * dt / mass) ** 2)
        return
    for p in m.table("gridpoint"):
        putr(m.h, int(p["address"]), g.KXDG, v)
    before, _ = momentum(m)
    impulse = 0.0
    for _ in range(n):
        outer = [p for p in m.table("gridpoint") if p["KCOR"]]
        for condition in m.table("bound"):
            (p,) = (p for p in outer if p["address"] == condition["KUG"])
            impulse -= dt * float(condition["KUCXX"] * p["KXDG"] + condition["KUCXY"] * p["KYDG"])
        m.cycle(1)
    assert sum(m.table("bound")["KUCXX"]) == pytest.approx(c, rel=1e-12)
    after, _ = momentum(m)
    assert after[0] - before[0] == pytest.approx(impulse, rel=1e-10)
    assert 0 < after[0] < 0.9 * before[0]


# ---- initial stresses


@pytest.mark.parametrize("kind", ["sdef", "zoned", "mesh"])
def test_stresses_in_equilibrium_stay(kind: str) -> None:
    """div S + rho g = 0 inside and S n outside: nothing moves by more than rounding accumulates.

    A force sum is off by some roundings of the greatest force; over n steps of dt velocities grow to n dt
    times that over the least mass.
    """
    gx, gy = -3.0, -10.0
    stress, xgrad, ygrad = (-5e4, 1e4, -8e4), (2e3, 1e3, 500.0), (300.0, -2e3 - RHO * gx, -1e3 - RHO * gy)
    m = lone(kind, SKEW if kind != "mesh" else box(0, 3, 0, 2))
    if kind == "mesh":
        nodes = rectangle(0, 3, 0, 2, 3, 2)
        nodes[1:-1, 1:-1] += 0.1 * np.sin(7 * nodes[1:-1, 1:-1, ::-1])
        generate(m, nodes)
    m.gravity(gx, gy)
    m.insitu(*EVERYWHERE, *stress, xgrad=xgrad, ygrad=ygrad)
    m.boundary(*EVERYWHERE, stress=stress, xgrad=xgrad, ygrad=ygrad)
    m.fraction(0.3)
    n = 200
    before = m.table("zone") if kind != "sdef" else m.table("sdef")
    m.cycle(n)
    dt = float(m.h.cr[g.TDEL])
    rows, names = (
        (m.table("block"), ("KXD", "KYD")) if kind == "sdef" else (m.table("gridpoint"), ("KXDG", "KYDG"))
    )
    least = rows["KBM"].min() if kind == "sdef" else rows["KGPM"].min()
    force = 32 * EPS * 2e5 * 3
    for name in names:
        assert np.abs(rows[name]).max() <= n * dt * force / least
    after = m.table("zone") if kind != "sdef" else m.table("sdef")
    for name in ("KZS11", "KZS22") if kind != "sdef" else ("KS111", "KS122"):
        np.testing.assert_allclose(after[name], before[name], rtol=1e-8)
