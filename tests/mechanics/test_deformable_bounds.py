"""BOUNDARY, FUNCTION, FIX and INSITU against sums and integrals by hand, for blocks of every type."""

from __future__ import annotations

from itertools import pairwise
from math import pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mechanics import at, block, box, model, push, sound
from naive.bodies import area_and_moments, by_address, momentum, outlines, points_of
from naive.relocate import differences, essence

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g
from udec_ia.verify.grids import fan, generate, rectangle

EPS = float(np.finfo(float).eps)
RHO, K, G, D = 2000.0, 2e8, 1e8, 0.05
CP, CS = sqrt((K + 4 * G / 3) / RHO), sqrt(G / RHO)
TYPES = ("rigid", "sdef", "zoned")
EVERYWHERE = (-100.0, 100.0, -100.0, 100.0)
SKEW = [(0.0, 0.0), (-0.3, 1.5), (1.0, 2.2), (2.5, 1.4), (1.8, -0.4)]


def lone(kind: str, ring: list[tuple[float, float]]) -> Model:
    """A block of `kind` without gravity or damping, alone."""
    m = model(*ring, d=D, gravity=(0.0, 0.0), density=RHO)
    m.property(1, bulk=K, g=G)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    elif kind == "zoned":
        fan(m, 0, 0, edge_points=1)
    return m


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


def tractions(
    ring: list[tuple[float, float]], stress: Any, xgrad: Any, ygrad: Any, edges: int | None = None
) -> tuple[Any, Any]:
    """Resultant and moment about the origin of the tractions all around a clockwise outline.

    edges: number of edges that count, or all of them.

    By three points of Gauss on each edge, which are exact for any polynomial of the fifth degree.
    """
    nodes, weights = np.polynomial.legendre.leggauss(3)
    force, moment = np.zeros(2), 0.0
    for (ax, ay), (bx, by) in [*pairwise([*ring, ring[0]])][:edges]:
        normal = np.array((-(by - ay), bx - ax))  # outwards, times the length
        for s, w in zip((1 + nodes) / 2, weights / 2, strict=True):
            x, y = ax + s * (bx - ax), ay + s * (by - ay)
            s11, s12, s22 = np.array(stress) + x * np.array(xgrad) + y * np.array(ygrad)
            t = w * np.array([[s11, s12], [s12, s22]]) @ normal
            force += t
            moment += x * t[1] - y * t[0]
    return force, moment


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


# ---- blocks that are held


def on_floor(kind: str) -> tuple[Model, int, int]:
    """A block of `kind` on a floor of the same kind, pressed by gravity: model, floor and block."""
    m = model(*box(0, 2, -1, 1), d=0.1, friction=0.5)
    m.property(1, bulk=K, g=G)
    m.split(-1, 0, 3, 0)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    elif kind == "zoned":
        fan(m, 1, 0.5)
        fan(m, 1, -0.5)
    return m, int(block(m, 1, -0.5)["address"]), int(block(m, 1, 0.5)["address"])


@pytest.mark.parametrize("kind", TYPES)
def test_a_fixed_block_has_no_velocity_whatever_is_given(kind: str) -> None:
    """What stands on it does not feel the velocity. Set free, the block has it."""
    m, floor, _ = on_floor(kind)
    plain, _, _ = on_floor(kind)
    for one in (m, plain):
        one.fix(0, 2, -1, 0)
    m.boundary(-0.1, 2.1, -1.1, 0.05 if kind != "zoned" else -0.5, xvel=0.5)
    for one in (m, plain):
        one.cycle(50)
    for row, name in (("block", "KX"), ("block", "KXD"), ("contact", "KCFS"), ("contact", "KCFN")):
        np.testing.assert_array_equal(m.table(row)[name], plain.table(row)[name])
    assert m.table("contact")["KCFN"].max() > 0
    m.free(0, 2, -1, 0)
    before = float(at(m, "block", floor)["KX"])
    m.cycle(10)
    dt = float(m.h.cr[g.TDEL])
    if kind != "zoned":
        assert at(m, "block", floor)["KX"] - before == pytest.approx(5 * dt, rel=1e-9)
    else:
        corner = m.table("gridpoint")["KYG"].argmin()
        assert m.table("gridpoint")["KXDG"][corner] == 0.5
    sound(m)


@pytest.mark.parametrize("kind", TYPES)
def test_fix_stops_all_of_a_block(kind: str) -> None:
    """A block that is fixed while it flies and deforms stands still at once; set free it starts from rest."""
    m, _, top = on_floor(kind)
    m.fix(0, 2, -1, 0)
    m.gravity(0, 0)
    m.cycle(1)
    for p in points_of(m).get(top, []):
        putr(m.h, int(p["address"]), g.KYDG, 0.1)
        putr(m.h, int(p["address"]), g.KXDG, 0.05 * float(p["KYG"]))
    if kind != "zoned":
        push(m, top, xd=0.1, yd=0.1, td=0.1)
    if kind == "sdef":
        putr(m.h, int(at(m, "block", top)["KBEX"]), g.KED11, 0.1)
    m.cycle(2)
    m.fix(0, 2, 0, 1)
    where = m.table("corner")
    m.cycle(5)
    for name in ("KXP", "KYP"):
        np.testing.assert_array_equal(m.table("corner")[name], where[name])
    contacts = m.table("contact")
    assert not contacts["KXDC"][contacts["KCFN"] > 0].any()
    m.free(0, 2, 0, 1)
    assert not any(at(m, "block", top)[k] for k in ("KXD", "KYD", "KTD"))
    assert not any(p[k] for p in points_of(m).get(top, []) for k in ("KXDG", "KYDG"))
    sound(m)


def test_both_velocities_given_stop_the_turning() -> None:
    m = lone("rigid", box(0, 2, 0, 1))
    m.cycle(0)
    push(m, int(m.table("block")["address"][0]), td=2.0)
    m.boundary(*EVERYWHERE, xvel=1.0, yvel=0.0)
    m.cycle(10)
    ring = m.table("corner")
    assert m.table("block")["KTD"][0] == 0
    assert np.hypot(ring["KXDP"] - 1, ring["KYDP"]).max() == 0


# ---- conditions that live on


@pytest.mark.parametrize("kind", ["rigid", "sdef"])
def test_conditions_on_a_block_that_is_cut(kind: str) -> None:
    """Both parts have the velocities; the resultant and the moment of the loads stay."""
    m = model(*box(0, 4, 0, 2), d=D, gravity=(0.0, 0.0), density=RHO)
    m.property(1, bulk=K, g=G)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    m.boundary(*EVERYWHERE, xforce=100.0, yforce=-50.0)
    m.boundary(*EVERYWHERE, stress=(-1e4, 2e3, -3e4), xgrad=(1e3, 0, 2e3))
    m.boundary(*EVERYWHERE, yvel=0.25)
    before = load_sums(m)
    m.split(-1, 0.7, 5, 1.1)
    m.split(1.5, -1, 2.5, 3)
    sound(m)
    np.testing.assert_allclose(load_sums(m), before, rtol=1e-10)
    assert set(m.table("block")["KBFIX"]) == {4}
    m.cycle(3)
    np.testing.assert_array_equal(m.table("block")["KYD"], 0.25)
    corners = by_address(m.table("corner"))
    for row in m.table("bound"):
        if row["KUP"]:
            assert corners[int(row["KUP"])]["KNB"] == row["KUB"]
    m.boundary(*EVERYWHERE, free=True)
    assert set(m.table("block")["KBFIX"]) == {0}
    assert len(m.table("bound")) == 0


def load_sums(m: Model, only: int = 0) -> Any:
    """Resultant and moment about the origin of all loads, or of those on the block at the address `only`."""
    corners, blocks = by_address(m.table("corner")), by_address(m.table("block"))
    total = np.zeros(3)
    for row in m.table("bound"):
        if only and row["KUB"] != only:
            continue
        fx, fy = float(row["KUFX"]), float(row["KUFY"])
        if row["KUP"]:
            x, y = (float(corners[int(row["KUP"])][k]) for k in ("KXP", "KYP"))
        else:
            ring = [(float(c["KXP"]), float(c["KYP"])) for c in outlines(m)[int(row["KUB"])]]
            _, x, y, _ = area_and_moments(ring)
            assert int(row["KUB"]) in blocks
        total += (fx, fy, x * fy - y * fx)
    return total


@pytest.mark.parametrize("kind", ["rigid", "sdef"])
def test_an_edge_that_is_cut_carries_its_traction_on(kind: str) -> None:
    """Each new edge has the resultant and the moment of the traction on it, however often it is cut."""
    m = model(*box(0, 10, 0, 3), d=D, gravity=(0.0, 0.0), density=RHO)
    m.property(1, bulk=K, g=G)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    stress, xgrad = (2e4, 1e4, -1e5), (0.0, 5e2, -3e4)
    m.boundary(-1, 11, 2.9, 3.1, stress=stress, xgrad=xgrad)
    m.boundary(-1, 11, 2.9, 3.1, viscous=True)
    m.split(-1, 1, 11, 1)  # touches no loaded edge
    m.split(2, 0.5, 2, 4)
    m.split(8, -1, 10, 3)  # through the corner where the load ends
    m.split(5, 4, 7, -1)
    sound(m)
    loaded = 0
    for ib, ring in outlines(m).items():
        points = [(float(c["KXP"]), float(c["KYP"])) for c in ring]
        force, moment = np.zeros(2), 0.0
        length = 0.0
        for (ax, ay), (bx, by) in pairwise([*points, points[0]]):
            if ay == by == 3:
                edge, turn = tractions([(ax, ay), (bx, by), (ax, ay)], stress, xgrad, (0, 0, 0), edges=1)
                force, moment, length = force + edge, moment + turn, length + abs(bx - ax)
        np.testing.assert_allclose(load_sums(m, ib), [*force, moment], atol=1e-7)
        normal = sum(float(row["KUCYY"]) for row in m.table("bound") if row["KUB"] == ib)
        assert normal == pytest.approx(RHO * CP * length, rel=1e-12)
        loaded += length > 0
    assert loaded == 3


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


def test_a_grid_point_inside_takes_velocities_and_forces() -> None:
    m = lone("zoned", box(0, 2, 0, 1))
    (inner,) = (row for row in m.table("gridpoint") if not row["KCOR"])
    x, y = float(inner["KXG"]), float(inner["KYG"])
    assert m.boundary(x - 0.01, x + 0.01, y - 0.01, y + 0.01, xvel=0.5, yvel=0.0) == 1
    m.cycle(10)
    held = at(m, "gridpoint", int(inner["address"]))
    assert (held["KGFIX"], held["KXDG"], held["KYDG"]) == (3, 0.5, 0)


def all_kinds() -> Model:
    """A rigid, a simply-deformable and two meshed blocks on a floor, with conditions of all sorts."""
    m = model(*box(0, 4, -1, 1), d=D, friction=0.5, density=RHO)
    m.property(1, bulk=K, g=G)
    m.split(-1, 0, 5, 0)
    for x in (2, 1, 3):
        m.split(x, -0.5, x, 2)
    m.fix(0, 4, -1, 0)
    m.change(1, 2, 0, 1, type="sdef")
    fan(m, 2.5, 0.5, edge_points=1)
    fan(m, 3.5, 0.5)
    m.function(2, 0, 0, 0.01, 1)
    m.boundary(-0.1, 4.1, 0.9, 1.1, stress=(0, 0, -2e4), xgrad=(0, 0, 5e3), function=2)
    m.boundary(-0.1, 1.6, 0.1, 0.9, xforce=500.0, sine=(40.0, 1.0))
    m.boundary(3.9, 4.1, -0.1, 1.1, viscous=True)
    m.boundary(3.4, 4.1, 0.9, 1.1, xvel=-0.01, sine=(20.0, 1.0))
    return m


def test_conditions_go_with_what_they_act_on() -> None:
    """DELETE, CHANGE and GENERATE take those of their block, and a sine that is no longer in use."""
    m = all_kinds()
    m.cycle(20)
    sound(m)
    assert len(m.table("signal")) == 3
    for gone, (x, signals) in (
        (lambda: m.change(2, 3, 0, 1, type="rigid"), (2.5, 3)),
        (lambda: m.delete(3, 4, 0, 1), (3.5, 2)),
        (lambda: m.change(1, 2, 0, 1, type="fdef"), (1.5, 2)),
        (lambda: m.change(0, 1, 0, 1, type="fdef"), (0.5, 1)),
    ):
        ib = int(block(m, x, 0.5)["address"])
        others = sorted(m.table("bound")["address"][m.table("bound")["KUB"] != ib].tolist())
        assert len(others) < len(m.table("bound"))
        gone()
        assert sorted(m.table("bound")["address"].tolist()) == others
        assert len(m.table("signal")) == signals
        assert m.check() == []
    assert len(m.table("bound")) == 0


def test_a_block_without_zones_takes_no_condition() -> None:
    """GENERATE would leave nothing of it for the condition to act on."""
    m = lone("rigid", SKEW)
    m.change(*EVERYWHERE, type="fdef")
    for asked in ({"stress": (-1.0, 0.0, 0.0)}, {"viscous": True}, {"xforce": 1.0}, {"xvel": 0.0}):
        with pytest.raises(UdecError) as refused:
            m.boundary(*EVERYWHERE, **asked)
        assert refused.value.number == 24
    assert len(m.table("bound")) == 0


@pytest.mark.parametrize("cycles", [0, 15])
def test_a_restart_keeps_all_conditions(cycles: int, tmp_path: Path) -> None:
    m = all_kinds()
    m.cycle(cycles)
    other = Model.restore(m.save(tmp_path / "bounds.h5"))
    for one in (m, other):
        one.cycle(30)
    assert differences(essence(m.array), essence(other.array)) == []


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
