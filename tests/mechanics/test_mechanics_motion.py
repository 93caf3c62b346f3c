"""Blocks in free motion and on one spring: what the law of motion must do exactly."""

from __future__ import annotations

from math import log, pi, sqrt

import numpy as np
import pytest
from naive.dynamics import angle_between, bounce, peaks
from support.mechanics_scenes import G, at, block, box, model, on_base, push, sound, step

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.layout.offsets import ALPHA, BETA, DTOL

EPS = np.finfo(float).eps


def floating(gravity: tuple[float, float]) -> Model:
    """A unit square with its lower left corner at (0, 2), above a fixed base whose top is y = 0."""
    m = model(*box(0, 1, -1, 3), d=0.1, gravity=gravity)
    m.split(-1, 0, 2, 0)
    m.split(-1, 2, 2, 2)
    m.delete(0, 1, 0, 2)
    m.fix(0, 1, -1, 0)
    return m


def test_free_fall_is_exact() -> None:
    """v = v0 + n g dt and y = y0 + n v0 dt + n (n + 1)/2 g dt^2: only the rounding of n additions is lost."""
    m = floating((1.0, -G))
    address = block(m, 0.5, 2.5)["address"]
    push(m, address, xd=2.0, yd=20.0)
    n = 500
    m.cycle(n)
    dt, row = step(m), at(m, "block", address)
    for x, v, x0, v0, a in ((row["KX"], row["KXD"], 0.5, 2.0, 1.0), (row["KY"], row["KYD"], 2.5, 20.0, -G)):
        assert v == pytest.approx(v0 + n * a * dt, abs=n * EPS * abs(v0))
        path = n * v0 * dt + n * (n + 1) / 2 * a * dt**2
        assert x == pytest.approx(x0 + path, abs=n * EPS * (abs(x0) + n * abs(v0) * dt))
    assert row["KTD"] == 0
    sound(m)


def test_a_spinning_block_keeps_its_speed_and_its_shape() -> None:
    """A rotation by the half-angle tangent keeps lengths to rounding: 4 roundings of a coordinate a cycle."""
    m = floating((0.0, 0.0))
    address = block(m, 0.5, 2.5)["address"]
    omega, n = 7.0, 10_000
    push(m, address, td=omega)
    edges, direction = _edges(m, address)
    m.cycle(1)
    _, after = _edges(m, address)
    turned = angle_between(*direction[0], *after[0])
    assert turned == pytest.approx(2 * np.arctan(omega * step(m) / 2), abs=8 * EPS)
    m.cycle(n - 1)
    row = at(m, "block", address)
    assert row["KTD"] == omega
    assert (row["KX"], row["KY"]) == (0.5, 2.5)
    lengths, _ = _edges(m, address)
    assert lengths == pytest.approx(edges, abs=n * 4 * EPS * 3)
    sound(m)


def _edges(m: Model, address: int) -> tuple[list[float], list[tuple[float, float]]]:
    """Lengths and directions of the edges and of the spokes to the circle centres of a block."""
    corners = m.table("corner")
    corners = corners[corners["KNB"] == address]
    found = []
    for a, b in zip(corners, np.roll(corners, -1), strict=True):
        found += [(b["KXP"] - a["KXP"], b["KYP"] - a["KYP"]), (a["KXCP"] - a["KXP"], a["KYCP"] - a["KYP"])]
    return [float(np.hypot(*edge)) for edge in found], found


def on_its_apex(fraction: float) -> Model:
    """A triangle that stands on its lower corner, at rest under gravity."""
    m = on_base(2.0, 2.0, d=0.1, width=3.0, fraction=fraction)
    for side in (-1, 1):
        m.split(-side * 0.1, -0.2, side * 1.1, 2.2)
    m.delete(-2, -0.5, 0, 1.3)
    m.delete(0.5, 2, 0, 1.3)
    m.damping(2.0, sqrt(1e8 / 2e3) / (2 * pi), "stiffness")
    m.cycle(int(40 / fraction))
    return m


@pytest.mark.parametrize(("fcrit", "only"), [(0.0, None), (0.1, None), (0.1, "mass"), (0.1, "stiffness")])
def test_bounce_on_one_contact(fcrit: float, only: str | None) -> None:
    """w = sqrt(KN/m), damped; the logarithmic decrement is 2 pi xi/sqrt(1 - xi^2), xi = (ALPHA/w + BETA w)/2.

    Half as much weight again is put on a triangle at rest on its corner. Central differences shorten the
    period by (w dt)^2/24; the dashpot lags by half a step, as if the mass were smaller by xi w dt of itself.
    """
    m = on_its_apex(0.02)
    (resting,) = (row for row in m.table("contact") if row["KCFN"] > 0)
    body = block(m, 0, 1.3)
    mass, kn = float(body["KBM"]), 1e8
    assert mass == pytest.approx(2000.0)
    assert resting["KCN"] == pytest.approx(mass * G / kn, rel=1e-6)
    w = sqrt(kn / mass)
    m.damping(fcrit, w / (2 * pi), only)
    m.gravity(0, -1.5 * G)
    overlaps = []
    n = int(4.5 * pi / 0.04)
    for _ in range(n):
        m.cycle(1)
        (row,) = (row for row in m.table("contact") if row["KCFN"] > 0)
        overlaps.append(float(row["KCN"]))
    dt, alpha, beta = step(m), float(m.h.cr[ALPHA]), float(m.h.cr[BETA])
    assert w * dt == pytest.approx(0.04)
    swing = 0.5 * mass * G / kn
    independent = bounce(mass, kn, 1.5 * G, dt, alpha, beta, float(resting["KCN"]), n)
    assert overlaps == pytest.approx(independent, abs=1e-6 * swing)
    xi = (alpha / w + beta * w) / 2
    assert xi == pytest.approx(fcrit if only is None else fcrit / 2)
    (t1, first), (t2, second) = peaks([u - 3 * swing for u in overlaps])[:2]
    lag = xi * w * dt
    assert 2 * pi / ((t2 - t1) * dt) == pytest.approx(w * sqrt(1 - xi**2), rel=lag + (w * dt) ** 2 / 12)
    decrement = 2 * pi * xi / sqrt(1 - xi**2)
    assert log(first / second) == pytest.approx(decrement, rel=lag, abs=1e-4)
    sound(m)


def quarters(friction: float) -> Model:
    """Four free blocks that fill a square of side 2 about the origin, cut by two inclined lines."""
    m = model(*box(-1, 1, -1, 1), d=0.08, gravity=(0.0, 0.0), friction=friction, fraction=0.02)
    m.split(-2, -0.4, 2, 0.4)
    m.split(-0.2, -2, 0.2, 2)
    return m


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_colliding_blocks_keep_their_momentum(friction: float) -> None:
    """Each contact acts equal and opposite on its blocks at one point: the sums change by rounding only.

    Every cycle rounds the momenta of the two blocks of 8 contacts; velocities and arms are of order one.
    """
    m = quarters(friction)
    for i, row in enumerate(m.table("block")):
        push(m, row["address"], -row["KX"] + 0.3, -row["KY"], 0.5 * (i - 1))
    m.cycle(0)
    before = _momentum(m)
    scale = float((m.table("block")["KBM"]).sum())
    busy = 0
    for k in range(1, 41):
        m.cycle(10)
        busy += int((m.table("contact")["KCFN"] > 0).any())
        assert _momentum(m) == pytest.approx(before, abs=10 * k * 16 * EPS * scale)
        sound(m)
    assert 3 < busy < 40


def _momentum(m: Model) -> list[float]:
    b = m.table("block")
    px, py = b["KBM"] * b["KXD"], b["KBM"] * b["KYD"]
    spin = b["KX"] * py - b["KY"] * px + b["KBI"] * b["KTD"]
    return [float(px.sum()), float(py.sum()), float(spin.sum())]


def pair_of_squares(gap: float) -> Model:
    """Unit squares side by side, `gap` apart, two above a fixed base 40 wide, without gravity; D = 0.1."""
    m = model(*box(-20, 20, -1, 3), d=0.1, gravity=(0.0, 0.0))
    m.split(-21, 0, 21, 0)
    m.split(-21, 2, 21, 2)
    m.delete(-20, 20, 0, 2)
    m.fix(-20, 20, -1, 0)
    for x in (-1 - gap / 2, -gap / 2, gap / 2, 1 + gap / 2):
        m.split(x, 1, x, 4)
    m.delete(-20, -1 - gap / 2, 2, 3)
    m.delete(1 + gap / 2, 20, 2, 3)
    if gap:
        m.delete(-gap / 2, gap / 2, 2, 3)
    return m


@pytest.mark.parametrize("gap", [0.0, 3.0])
@pytest.mark.parametrize("angle", [0.0, 0.5, 1.0])
def test_blocks_fly_apart_however_fast(gap: float, angle: float) -> None:
    """At two rounding lengths a cycle each, side by side or upwards: nothing is in their way."""
    m = pair_of_squares(gap)
    m.cycle(1)
    speed = 0.2 / step(m)
    left, right = (block(m, x, 2.5) for x in (-0.5 - gap / 2, 0.5 + gap / 2))
    for row, way in ((left, -1), (right, 1)):
        push(m, row["address"], way * speed * np.cos(angle), speed * np.sin(angle))
    n = 50
    m.cycle(n)
    for row, way in ((left, -1), (right, 1)):
        now = at(m, "block", row["address"])
        assert now["KX"] == pytest.approx(row["KX"] + way * n * 0.2 * np.cos(angle), abs=1e-9)
        assert now["KY"] == pytest.approx(row["KY"] + n * 0.2 * np.sin(angle), abs=1e-9)
    sound(m)


@pytest.mark.parametrize(("way", "ends"), [(0.2, True), (0.005, False)])
def test_blocks_that_go_into_each_other_in_one_step_end_the_run(way: float, ends: bool) -> None:
    """From a gap to an overlap of more than D/2: error 15. Slower ones meet in a contact."""
    m = pair_of_squares(0.5)
    m.property(1, kn=1e12, ks=1e12)
    m.cycle(1)
    left, right = (block(m, x, 2.5)["address"] for x in (-0.75, 0.75))
    push(m, left, way / 2 / step(m))
    push(m, right, -way / 2 / step(m))
    if ends:
        with pytest.raises(UdecError, match="penetrate each other") as caught:
            m.cycle(20)
        assert caught.value.number == 15
        return
    m.cycle(200)
    assert at(m, "block", left)["KXD"] < 0 < at(m, "block", right)["KXD"]
    sound(m)


@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
@pytest.mark.parametrize(("kn", "fraction"), [(1e3, 0.1), (4e3, 0.1), (1e6, 3.0), (1e6, 100.0)])
def test_a_block_on_another_does_not_fall_through_it_in_one_step(
    kn: float, fraction: float, build: str
) -> None:
    """Springs in a wrong unit, or a wrong FRACTION: in one step its weight takes it deep into the other."""
    m = Model(build)
    m.property(1, density=2000, kn=kn, ks=kn)
    m.block(0, 0, 0, 2, 10, 2, 10, 0)
    m.split(-1, 1, 11, 1)
    m.fix(0, 10, 0, 1)
    m.gravity(0, -10)
    m.fraction(fraction)
    with pytest.raises(UdecError) as caught:
        m.cycle(10)
    assert caught.value.number == 15
    assert 10 * step(m) ** 2 > 2 * float(m.h.cr[DTOL])
