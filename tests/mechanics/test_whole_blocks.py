"""BOUNDARY ... ROTATION: blocks of every type that move as they are told, against exact rotations."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from naive.bodies import momentum
from support.lone_block_loads import EVERYWHERE, SKEW, TYPES, lone
from support.mechanics_scenes import block, box, model, on_base, push, sound

from udec_ia import Model, UdecError
from udec_ia.compiling.interpreted_kernels import interpreted
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.restart import look_into

EPS = float(np.finfo(float).eps)


def outline(m: Model) -> Any:
    """Corners of the only block, relative to its centroid."""
    corners, row = m.table("corner"), m.table("block")[0]
    return np.column_stack([corners["KXP"] - row["KX"], corners["KYP"] - row["KY"]])


def stress(m: Model, kind: str) -> Any:
    """Invariants of the stresses of the only block."""
    if kind == "rigid":
        return np.zeros(2)
    rows = m.table("sdef" if kind == "sdef" else "zone")
    names = ("KS111", "KS122", "KS112") if kind == "sdef" else ("KZS11", "KZS22", "KZS12")
    s11, s22, s12 = (rows[name] for name in names)
    return np.stack([s11 + s22, s11 * s22 - s12 * s12])


@pytest.mark.parametrize("kind", TYPES)
def test_a_block_moves_as_a_rigid_body(kind: str) -> None:
    """Whatever its motion and stress before, and whatever pushes it."""
    m = lone(kind, SKEW)
    if kind != "rigid":
        m.insitu(*EVERYWHERE, -2e5, 3e4, -1e5)
    m.gravity(0.0, -10.0)
    if kind != "zoned":
        push(m, int(m.table("block")["address"][0]), 0.1, -0.2, 0.5)
    m.cycle(20)
    assert m.boundary(*EVERYWHERE, xvel=0.3, yvel=-0.2, rotation=0.7) == 1
    m.boundary(*EVERYWHERE, yforce=1e5)
    sound(m)
    m.cycle(0)
    before, at, inside = outline(m), m.table("block")[0].copy(), stress(m, kind)
    n, dt = 400, float(m.h.cr[g.TDEL])
    m.cycle(n)
    after = m.table("block")[0]
    way = np.array([after["KX"] - at["KX"], after["KY"] - at["KY"]])
    np.testing.assert_allclose(way, np.array([0.3, -0.2]) * n * dt, atol=n * EPS)
    angle = n * 2 * np.arctan(0.7 * dt / 2)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    np.testing.assert_allclose(outline(m), before @ turn.T, atol=n * EPS * 10)
    np.testing.assert_allclose(stress(m, kind), inside, rtol=1e-9)
    assert momentum(m)[0][0] == pytest.approx(0.3 * float(after["KBM"]), rel=1e-12)
    sound(m)


@pytest.mark.parametrize("kind", TYPES)
def test_its_energy_is_the_work_of_its_drive(kind: str) -> None:
    """Velocity and rotation by a FUNCTION that grows: all kinetic energy comes through the boundary."""
    m = lone(kind, SKEW)
    m.fraction(0.05)
    m.cycle(1)  # which finds the moment of inertia of grid-points
    m.energy()
    m.function(1, 0.0, 0.0, 0.01, 1.0)
    m.boundary(*EVERYWHERE, xvel=0.3, yvel=0.1, rotation=0.7, function=1)
    m.cycle(time=0.006)
    row, account = m.table("block")[0], m.balance()
    kinetic = row["KBM"] * (row["KXD"] ** 2 + row["KYD"] ** 2) / 2 + row["KBI"] * row["KTD"] ** 2 / 2
    assert account.kinetic == pytest.approx(float(kinetic), rel=1e-6)
    assert account.boundary == pytest.approx(account.kinetic, rel=1e-6)


@pytest.mark.parametrize("kind", ["rigid", "sdef"])
def test_a_lid_that_cannot_tilt_falls_freely(kind: str) -> None:
    """x velocity and rotation are given, y is free."""
    m = lone(kind, SKEW)
    m.cycle(0)
    m.gravity(1.0, -10.0)
    m.boundary(*EVERYWHERE, xvel=0.5, rotation=0.0)
    m.boundary(-100, 0.1, -100, 100, stress=(1e4, 0.0, 0.0))  # it would turn
    n = 50
    m.cycle(n)
    row = m.table("block")[0]
    assert (float(row["KXD"]), float(row["KTD"])) == (0.5, 0.0)
    assert int(row["KBFIX"]) == g.GIVEN_X + g.GIVEN_TURN
    assert float(row["KYD"]) == pytest.approx(-10.0 * n * float(m.h.cr[g.TDEL]), rel=1e-9)
    sound(m)


@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_a_fixed_platen_pushes_with_its_velocity(kind: str) -> None:
    """A fixed block under a column gets a velocity: it lifts it; FIX stops it, FREE lets it fall."""
    m = model(*box(0, 2, 0, 3), d=0.05, stiffness=(1e8, 1e8), friction=0.5)
    m.property(1, bulk=1e9, g=6e8)
    m.split(-1, 1, 3, 1)
    m.split(-1, 2, 3, 2)
    m.fix(0, 2, 0, 1)
    if kind == "fdef":
        m.generate(0, 2, 0, 1, "automatic", edge=0.8)
    else:
        m.change(0, 2, 0, 1, kind)
    m.damping(local=0.8)
    m.solve(1e-6)
    before = m.table("block").copy()
    assert m.boundary(0, 2, 0, 1, yvel=0.01) == 1
    sound(m)
    t = float(m.h.cd[g.TIME])
    m.cycle(time=0.2)
    passed = float(m.h.cd[g.TIME]) - t
    rows = m.table("block")
    lowest = int(before["KY"].argmin())
    assert rows["KY"][lowest] - before["KY"][lowest] == pytest.approx(0.01 * passed, rel=1e-9)
    np.testing.assert_allclose(rows["KY"] - before["KY"], 0.01 * passed, rtol=0.3)
    assert rows["KX"][lowest] == pytest.approx(before["KX"][lowest], abs=1e-12)
    sound(m)
    m.fix(0, 2, 0, 1.2)
    at = float(m.table("block")["KY"][lowest])
    m.cycle(5)
    assert float(m.table("block")["KY"][lowest]) == at
    m.free(0, 2, 0, 1.2)  # the condition holds it again
    m.cycle(5)
    assert float(m.table("block")["KY"][lowest]) > at
    assert m.boundary(0, 2, 0, 1.2, free=True) == 2
    assert int(m.table("block")["KBFIX"][lowest]) == 0
    m.cycle(5)
    assert float(m.table("block")["KYD"][lowest]) < 0.01
    sound(m)


def test_grid_points_of_a_body_get_no_velocity_of_their_own() -> None:
    m = lone("zoned", SKEW)
    with pytest.raises(UdecError) as caught:
        m.boundary(*EVERYWHERE, rotation=0.1)
    assert (caught.value.number, caught.value.parameter) == (26, "rotation")
    m.boundary(*EVERYWHERE, xvel=0.1)
    m.boundary(*EVERYWHERE, xvel=0.0, yvel=0.0, rotation=0.1)
    assert len(m.table("bound")) == 2
    with pytest.raises(UdecError) as caught:
        m.boundary(*EVERYWHERE, xvel=0.1)
    assert (caught.value.number, caught.value.parameter) == (28, "xvel")
    assert m.boundary(*EVERYWHERE, free=True) == 2
    assert set(m.table("gridpoint")["KGFIX"].tolist()) == {0}
    assert m.boundary(*EVERYWHERE, xvel=0.1) == len(m.table("gridpoint"))
    sound(m)


def test_an_edge_alone_gives_a_rigid_block_no_velocity() -> None:
    m = on_base(1.0, 1.0, 0.1, 4.0)
    with pytest.raises(UdecError) as caught:
        m.boundary(-1, 1, 0.9, 1.1, yvel=-0.1)
    assert caught.value.number == 24
    assert "GENERATE" in caught.value.advice
    with pytest.raises(UdecError) as caught:
        m.boundary(-1, 1, 0.9, 1.1, rotation=0.1)
    assert caught.value.number == 24


@pytest.mark.parametrize("kind", TYPES)
def test_a_change_of_type_releases_or_holds(kind: str) -> None:
    m = lone(kind, SKEW)
    m.boundary(*EVERYWHERE, xvel=0.0, yvel=0.0, rotation=0.1)
    for other in ("sdef", "rigid", "fdef"):
        m.change(*EVERYWHERE, type=other)
        sound(m)


def test_the_parts_of_a_turning_block_turn(tmp_path: Any) -> None:
    m = lone("rigid", box(0, 2, 0, 1))
    m.boundary(*EVERYWHERE, xvel=0.1, yvel=0.0, rotation=0.2)
    m.split(1, -1, 1, 2)
    assert m.table("block")["KTD"].shape == (2,)
    assert m.table("block")["KBFIX"].tolist() == [14, 14]
    sound(m)
    path = m.save(tmp_path / "one.h5")
    assert len(look_into(path).h.ia) > 0
    other = Model.restore(path)
    other.cycle(10)
    m.cycle(10)
    used = int(m.h.ci[g.MFREE]) - 1
    assert other.h.ia[:used].tobytes() == m.h.ia[:used].tobytes()
    assert block(m, 0.5, 0.5)["KTD"] == 0.2


def driven(build: str) -> Model:
    """A column on a floor of every type that turns, under a weight that grows, with a sum of reactions."""
    m = Model(build=build)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5, bulk=1e9, g=6e8)
    m.block(0, 0, 0, 2, 6, 2, 6, 0)
    m.split(-1, 1, 7, 1)
    for x in (2, 4):
        m.split(x, -1, x, 3)
    m.round(0.05)
    m.change(2, 4, 0, 1, "sdef")
    m.generate(4, 6, 0, 1, "automatic", edge=1.5)
    m.function(1, 0.0, 0.5, 0.1, 1.0)
    m.gravity(0.0, -10.0, function=1)
    m.boundary(0, 6, 0, 1, xvel=0.0, yvel=0.01, rotation=0.001, function=1)
    m.cycle(3)
    return m


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_compiled_and_interpreted_runs_agree_in_every_scheme(build: str) -> None:
    one, two = driven(build), driven(build)
    one.cycle(4)
    with interpreted():
        two.cycle(4)
    used = int(one.h.ci[g.MFREE]) - 1
    assert one.h.ia[:used].tobytes() == two.h.ia[:used].tobytes()
    assert one.h.cr.tobytes() == two.h.cr.tobytes()
    np.testing.assert_allclose(one.reactions()["fy"], two.reactions()["fy"])
    sound(one)
