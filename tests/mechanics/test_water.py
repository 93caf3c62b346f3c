"""Water: flow, volumes, pressures and their forces, conditions outside (docs/water.md)."""

from __future__ import annotations

import math
import os
import signal
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive import water
from support.random_water_scenes import play_briefly

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g
from udec_ia.model import undo
from udec_ia.reader.water_rows import contact_flows, domain_water, water_account, water_energy

ALL = (-1e3, 1e3, -1e3, 1e3)
VISCOSITY, APERTURE, P = 1e-3, 1e-3, 1e5


def slabs(kind: str = "rigid", width: float = 4.0, build: str = "i32r64") -> Model:
    """A slab 1 m high on another one."""
    m = Model(build)
    m.tell = lambda _: None
    m.block(0, 0, 0, 2, width, 2, width, 0)
    m.split(-1, 1, width + 1, 1, joint=1)
    m.round(0.05)
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=0.5, bulk=1e12, g=6e11)
    m.jproperty(1, kn=1e10, ks=1e10, friction=0.5, between=(1, 1), aperture=APERTURE)
    if kind != "rigid":
        m.change(*ALL, type=kind)
    if kind == "fdef":
        m.generate(*ALL, mode="automatic", edge=1.0)
    return m


def grid(nx: int, ny: int) -> Model:
    """Square blocks of 1 m."""
    m = Model()
    m.tell = lambda _: None
    m.block(0, 0, 0, ny, nx, ny, nx, 0)
    for i in range(1, nx):
        m.split(i, -1, i, ny + 1, joint=1)
    for j in range(1, ny):
        m.split(-1, j, nx + 1, j, joint=2)
    m.round(0.05)
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=0.5)
    return m


# ---- flow


@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_flow_along_a_joint_is_that_of_the_cubic_law(kind: str) -> None:
    m = slabs(kind)
    m.fix(*ALL)
    m.fluid(viscosity=VISCOSITY)
    m.boundary(-0.1, 0.1, -1, 3, ppressure=P)
    m.boundary(3.9, 4.1, -1, 3, ppressure=0.0)
    m.flow(steady=True)
    exact = water.cubic(APERTURE, 4.0, VISCOSITY) * P
    rows = contact_flows(m.h)
    assert np.abs(rows["flow"]) == pytest.approx(np.full(len(rows), exact), rel=1e-6)
    assert rows["length"].sum() == pytest.approx(4.0, rel=1e-9)


def test_a_network_of_two_joint_sets_is_kirchhoffs() -> None:
    m = grid(4, 3)
    apertures = {1: 4e-4, 2: 1e-3}
    for joint, aperture in apertures.items():
        m.jproperty(joint, kn=1e10, ks=1e10, friction=0.5, aperture=aperture)
    m.split(-3, -1, -3, 4, joint=1, jmaterial=1)  # a joint and its material, where there is no block
    m.split(-3, -1, -3, 4, joint=2, jmaterial=2)
    m.fix(*ALL)
    m.fluid(viscosity=VISCOSITY)
    m.boundary(-0.1, 0.1, -0.1, 3.1, ppressure=P)
    m.boundary(3.9, 4.1, -0.1, 3.1, ppressure=0.0)
    m.boundary(-0.1, 4.1, -0.1, 0.1, impermeable=True)
    m.boundary(-0.1, 4.1, 2.9, 3.1, ppressure=2e4)
    m.flow(steady=True)
    k = {joint: water.cubic(aperture, 1.0, VISCOSITY) for joint, aperture in apertures.items()}
    pipes = [((i, j), (i + 1, j), k[2]) for i in range(4) for j in (1, 2)]
    pipes += [((i, j), (i, j + 1), k[1]) for i in (1, 2, 3) for j in (1, 2)]
    given = {(0, j): P for j in (1, 2)} | {(4, j): 0.0 for j in (1, 2)} | {(i, 3): 2e4 for i in (1, 2, 3)}
    expected = water.kirchhoff(pipes, given)
    for row in domain_water(m.h):
        node = round(float(row["x"]), 6), round(float(row["y"]), 6)
        if node in expected:
            assert row["pressure"] == pytest.approx(expected[node], rel=1e-6)
    assert sum((round(float(r["x"]), 6), round(float(r["y"]), 6)) in expected for r in domain_water(m.h)) == 6


def test_water_at_rest_under_gravity_does_not_flow() -> None:
    m = grid(3, 3)
    m.jproperty(1, kn=1e10, ks=1e10, friction=0.5, aperture=APERTURE, between=(1, 1))
    m.fix(*ALL)
    m.gravity(0, -9.81)
    m.fluid()
    m.boundary(-0.1, 3.1, -0.1, 3.1, level=2.5)
    m.flow(steady=True)
    rows = domain_water(m.h)
    below = rows["y"] < 2.5 - 0.2
    assert rows["pressure"][below] == pytest.approx(9810 * (2.5 - rows["y"][below]), rel=1e-6)
    assert np.abs(contact_flows(m.h)["flow"]).max() < 1e-9
    assert (rows["saturation"][rows["y"] > 2.5 + 0.01] < 1e-3).all()


def test_diffusion_in_a_chain_of_reservoirs() -> None:
    m = slabs(width=4.0)
    m.jproperty(2, kn=1e10, ks=1e10, friction=0.5, aperture=1e-9)
    for k in range(1, 10):
        m.split(0.4 * k, 1, 0.4 * k, 3, joint=2, jmaterial=2)  # closed joints that divide the open one
    m.fix(*ALL)
    m.fluid(kw=1e7, viscosity=VISCOSITY)
    m.ppressure(*ALL, P)
    m.boundary(*ALL, impermeable=True)
    m.boundary(3.9, 4.1, -0.1, 2.1, ppressure=0.0)
    time = 0.02
    steps = m.flow(time=time).steps
    c = 1e7 * APERTURE**2 / (12 * VISCOSITY)
    rows = domain_water(m.h)
    joint = rows[np.abs(rows["y"] - 1) < 0.01]
    x, t = joint["x"], c * time / 16
    n = np.arange(200)[:, None]
    lam = (n + 0.5) * np.pi
    exact = (2 * (-1.0) ** n / lam * np.cos(lam * x / 4) * np.exp(-(lam**2) * t)).sum(axis=0)
    assert steps > 10
    assert joint["pressure"] / P == pytest.approx(exact, abs=0.02)


# ---- volumes and pressures


@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_a_joint_that_closes_undrained_gets_the_pressure_of_the_water_in_it(kind: str) -> None:
    m = slabs(kind)
    m.fluid(kw=2e8, mode="undrained")
    m.ppressure(*ALL, 0.0)
    m.fix(-9, 9, 0, 1)
    m.boundary(-9, 9, 1, 2, xvel=0, yvel=-1e-2, rotation=0)
    m.cycle(500)
    closure = 1e-2 * float(m.h.cd[g.TIME])
    rows = domain_water(m.h)
    exact = water.pressure_of_closing(2e8, APERTURE, closure)
    assert rows["pressure"] == pytest.approx(np.full(len(rows), exact), rel=1e-4)
    forces = m.reactions()["fy"]
    springs = 4.0 * 1e10 * closure
    assert np.abs(forces) == pytest.approx(np.full(2, springs + 4.0 * exact), rel=0.03)


def test_a_joint_that_opens_quickly_is_partly_filled() -> None:
    m = slabs()
    m.fluid(kw=2e9, mode="undrained")
    m.ppressure(*ALL, 0.0)
    m.fix(-9, 9, 0, 1)
    m.boundary(-9, 9, 1, 2, xvel=0, yvel=1e-2, rotation=0)
    m.cycle(500)
    opened = 1e-2 * float(m.h.cd[g.TIME])
    (row,) = domain_water(m.h)
    assert row["pressure"] == 0
    assert row["saturation"] == pytest.approx(APERTURE / (APERTURE + opened), rel=1e-6)


def test_the_volume_of_a_cavity_is_its_area() -> None:
    m = grid(3, 3)
    m.delete(1, 2, 1, 2)
    m.fluid()
    hole = [(1.0, 1.0), (1.0, 2.0), (2.0, 2.0), (2.0, 1.0)]
    assert domain_water(m.h)["volume"].max() == pytest.approx(water.area(hole), rel=1e-9)
    m.jproperty(1, kn=1e9, ks=1e9, aperture=1e-3, between=(1, 1))
    half = 3.0 * 2 + 3.0 * 2 - 4.0  # length of the joints without those of the cavity
    rows = domain_water(m.h)
    inside = rows[rows["volume"] < 0.5]["volume"].sum()
    assert inside < half * 1e-3
    assert inside + rows["volume"].max() - 1.0 == pytest.approx(half * 1e-3, rel=0.06)


def test_the_least_aperture_keeps_its_volume() -> None:
    m = slabs()
    m.jproperty(1, residual_aperture=8e-4)
    m.fluid(kw=1e6, mode="undrained")
    m.ppressure(*ALL, 0.0)
    m.fix(-9, 9, 0, 1)
    m.boundary(-9, 9, 1, 2, xvel=0, yvel=-0.1, rotation=0)
    while m.h.cd[g.TIME] < 4e-3:
        m.cycle(100)
    (row,) = domain_water(m.h)
    assert row["volume"] == pytest.approx(3.9 * 8e-4, rel=1e-6)
    assert row["pressure"] == pytest.approx(water.pressure_of_closing(1e6, APERTURE, 2e-4), rel=1e-4)


@pytest.mark.parametrize("seed", range(20))
def test_pressures_on_the_blocks_around_domains_cancel(seed: int) -> None:
    m = play_briefly(seed).model
    h = m.h
    assert np.isfinite(m.table("domain")["KPP"]).all()
    m.boundary(*ALL, free=True)
    before = sums(m)
    if not len(domain_water(h)):
        pytest.skip("the blocks have no domain between them")
    m.ppressure(*ALL, 1e3)
    after = sums(m)
    scale = 1e3 * 10 * len(m.table("block"))
    assert after == pytest.approx(before, abs=1e-9 * scale)


def sums(m: Model) -> np.ndarray:
    """Sum of the forces on all blocks, and of their moments about the origin."""
    b = m.table("block")
    moment = b["KBFT"] + b["KX"] * b["KBFY"] - b["KY"] * b["KBFX"]
    return np.array([b["KBFX"].sum(), b["KBFY"].sum(), moment.sum()])


@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_a_pressure_does_work_as_its_volume_grows(kind: str) -> None:
    """A held pressure opens a joint: its work is p times the growth of the volumes."""
    m = slabs(kind)
    m.gravity(0, -9.81)
    m.fluid(mode="drained")
    m.ppressure(*ALL, 2e5)
    m.fix(-9, 9, 0, 1)
    m.cycle(1)
    m.energy("on")
    before = domain_water(m.h)["volume"].sum()
    while domain_water(m.h)["volume"].sum() - before < 4e-4:
        m.cycle(20)
    grown = domain_water(m.h)["volume"].sum() - before
    balance = m.balance()
    assert balance.water == pytest.approx(2e5 * grown, rel=2e-3)
    assert abs(balance.residual) < 0.01 * balance.throughput


@pytest.mark.parametrize("mode", ["coupled", "undrained"])
def test_energy_and_water_are_accounted_for(mode: str) -> None:
    m = grid(3, 3)
    m.jproperty(1, kn=1e9, ks=1e9, friction=0.5, aperture=2e-3, between=(1, 1))
    m.fix(-9, 9, 0, 1)
    m.gravity(0, -9.81)
    m.fluid(kw=2e7, mode=mode)
    m.boundary(-0.1, 0.1, -0.1, 3.1, level=2.5)
    m.ppressure(*ALL, level=2.0)
    m.fraction(0.2, safe=True)
    m.energy("on")
    before = water_energy(m.h)["compression"]
    m.cycle(1000)
    balance, account, energy = m.balance(), water_account(m.h), water_energy(m.h)
    came = before + energy["from outside"] + energy["from gravity"]
    gone = energy["compression"] + energy["lost to viscosity"] + energy["work on blocks"]
    largest = max(map(abs, energy.values()))
    assert came == pytest.approx(gone, abs=0.01 * largest)
    assert abs(balance.residual) < 1e-3 * balance.throughput
    assert balance.water != 0
    assert account["there"] == pytest.approx(sum(account.values()) - account["there"], rel=1e-12)


# ---- outside


def test_a_seepage_face_lets_water_out_only() -> None:
    m = slabs()
    m.fix(*ALL)
    m.fluid()
    m.boundary(-0.1, 0.1, -1, 3, ppressure=P)
    m.flow(steady=True)
    assert contact_flows(m.h)["flow"] == pytest.approx(np.full(2, contact_flows(m.h)["flow"][0]))
    assert domain_water(m.h)["pressure"] == pytest.approx([P / 2])
    m.boundary(-0.1, 0.1, -1, 3, free=True)
    m.ppressure(*ALL, 0.0)
    m.flow(steps=10)
    assert (contact_flows(m.h)["flow"] == 0).all()


def test_a_given_flow_and_an_impermeable_edge() -> None:
    m = slabs()
    m.fix(*ALL)
    m.fluid()
    m.boundary(-0.1, 0.1, -1, 3, flow=2e-6)
    m.boundary(3.9, 4.1, -1, 3, ppressure=0.0)
    m.flow(steady=True)
    assert np.abs(contact_flows(m.h)["flow"]) == pytest.approx([2e-6, 2e-6], rel=1e-6)
    m.boundary(3.9, 4.1, -1, 3, impermeable=True)
    was = water_account(m.h)["there"]
    m.flow(time=5.0)
    assert water_account(m.h)["there"] - was == pytest.approx(1e-5, rel=1e-9)


def test_a_condition_is_that_of_its_own_edges() -> None:
    """An edge beyond another one without a condition has no influence: the joint ends at a dry face."""
    m = Model()
    m.tell = lambda _: None
    m.block(0, 0, 0, 2, 10, 2, 10, 0)
    m.split(-1, 1, 11, 1, joint=1)
    m.split(4, 1, 4, 3)
    m.delete(4, 10, 1, 2)
    m.round(0.05)
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=0.5)
    m.jproperty(1, kn=1e10, ks=1e10, friction=0.5, between=(1, 1), aperture=APERTURE)
    m.fix(*ALL)
    m.fluid()
    m.boundary(9.9, 10.1, -1, 1.1, ppressure=P)
    m.flow(steady=True)
    assert (contact_flows(m.h)["flow"] == 0).all()
    m.boundary(-0.1, 10.1, 0.9, 1.1, ppressure=P)  # the top of the lower slab
    m.flow(steady=True)
    assert np.abs(contact_flows(m.h)["flow"]).min() > 0


def turned_slab(pressure: float) -> Model:
    """The upper slab has turned about its left end, under a pressure on all sides: the joint is open."""
    m = slabs()
    m.fix(-9, 9, 0, 1)
    m.fluid(mode="drained")
    m.boundary(*ALL, ppressure=pressure)
    turn(m, 0.02)
    return m


def turn(m: Model, angle: float) -> None:
    """Turn the upper slab about its left end by an angle (rad)."""
    speed = math.copysign(0.05, angle)  # rad/s
    m.boundary(-9, 9, 1, 2, xvel=-speed * 0.5, yvel=speed * 2.0, rotation=speed)
    m.cycle(1)
    m.cycle(round(angle / speed / float(m.h.cr[g.TDEL])))


def test_a_joint_that_opens_gets_the_water_outside_and_keeps_it_when_it_closes() -> None:
    m = turned_slab(P)
    assert len(domain_water(m.h)) == 0  # it is part of the outside
    top = m.table("block")[m.table("block")["KY"] > 1][0]
    assert top["KBFY"] == pytest.approx(0.0, abs=0.05 * 4 * P)  # P on all sides but for one contact
    before = water_account(m.h)
    turn(m, -0.02)
    (row,) = domain_water(m.h)
    assert row["pressure"] == pytest.approx(P)
    assert row["saturation"] == 1
    account = water_account(m.h)
    assert account["there"] == pytest.approx(sum(account.values()) - account["there"], rel=1e-12)
    assert account["from outside"] > before["from outside"]


def test_a_dry_joint_stays_dry_when_it_opens_and_closes() -> None:
    m = turned_slab(0.0)
    turn(m, -0.02)
    (row,) = domain_water(m.h)
    assert (row["pressure"], row["saturation"]) == (0, 0)


def test_a_flow_that_cannot_leave_is_refused() -> None:
    m = slabs()
    m.fix(*ALL)
    m.fluid()
    m.boundary(*ALL, impermeable=True)
    m.boundary(-0.1, 0.1, -1, 3, flow=1e-6)
    with pytest.raises(UdecError) as error:
        m.flow(steady=True)
    assert error.value.number == 28


def test_a_well_takes_no_more_than_there_is() -> None:
    m = slabs()
    m.fix(*ALL)
    m.fluid(kw=1e6)
    m.boundary(-0.1, 0.1, -1, 3, flow=-1e-3)
    m.boundary(3.9, 4.1, -1, 3, ppressure=1e4)
    m.flow(time=100.0)
    came = contact_flows(m.h)["flow"]
    assert np.abs(came[0]) == pytest.approx(np.abs(came[1]), rel=1e-3)
    account = water_account(m.h)
    assert abs(account["by changes of domains"]) < 1e-12
    steady = m.flow(steady=True)
    assert np.abs(contact_flows(m.h)["flow"]) == pytest.approx(np.abs(came), rel=1e-3), steady


def test_a_held_pressure_below_zero_does_not_suck() -> None:
    flows = []
    for p in 0.0, -1e5:
        m = slabs()
        m.fix(*ALL)
        m.fluid()
        m.boundary(-0.1, 0.1, -1, 3, ppressure=P)
        m.ppressure(*ALL, p, state="held")
        m.flow(steps=1)
        flows.append(contact_flows(m.h)["flow"])
        assert water_account(m.h)["there"] >= 0
    assert np.array_equal(*flows)


def test_flow_follows_a_function_of_time() -> None:
    """A pressure that increases evenly at one end, 0 at the other: half of it, later by what is stored.

    That is Kw/V times the sum of K of the two contacts, which have a^3/(12 mu l) each.
    """
    m = slabs()
    m.fix(*ALL)
    m.fluid(kw=1e6)
    m.function(1, 0.0, 0.0, 10.0, 1.0)
    m.boundary(-0.1, 0.1, -1, 3, ppressure=P, function=1)
    m.flow(time=10.0)
    (row,) = domain_water(m.h)
    delay = row["volume"] / 1e6 / m.table("pipe")["KPK"].sum()  # s
    assert row["pressure"] == pytest.approx(P / 2 * (1 - delay / 10), rel=0.01 * delay)
    assert m.h.cd[g.TIME] == pytest.approx(10.0)


def test_flow_in_every_nth_cycle_takes_the_time_that_has_passed() -> None:
    m = slabs()
    m.fix(*ALL)
    m.fluid(kw=1e6, every=7)
    m.boundary(*ALL, impermeable=True)
    m.boundary(-0.1, 0.1, -1, 3, flow=1e-6)
    m.ppressure(*ALL, 0.0)
    m.cycle(10)
    m.fluid(every=3)
    m.cycle(5)
    assert water_account(m.h)["from outside"] == pytest.approx(1e-6 * float(m.h.cd[g.TIME]), rel=1e-9)


def test_steps_of_flow_are_as_many_as_were_given() -> None:
    m = slabs()
    m.fix(*ALL)
    m.fluid()
    m.boundary(-0.1, 0.1, -1, 3, ppressure=P)
    for n in 7, 14:
        was = float(m.h.cd[g.TIME])
        assert m.flow(steps=n).steps == n
        assert int(m.h.ci[g.NFLOW]) == n
        assert float(m.h.cd[g.TIME]) - was == pytest.approx(n * float(m.h.cr[g.FDEL]))


def test_a_model_of_roughness_has_its_aperture() -> None:
    m = slabs()
    m.jproperty(1, model="barton", jrc=8, jcs=1e8, sigmac=1e8, friction=0.5, aperture=0.0)
    m.fluid()
    expected = 8 / 5 * (0.2 - 0.1) * 1e-3  # Barton, Bandis and Bakhtar 1985
    assert contact_flows(m.h)["aperture"] == pytest.approx([expected] * 2, rel=1e-6)


def test_a_cavity_with_water_has_a_stable_step() -> None:
    """A filled slot under a long wall: omega dt of the block on the water stays below 2."""
    m = Model()
    m.tell = lambda _: None
    m.block(0, 0, 0, 3.05, 5, 3.05, 5, 0)
    for y in 1.0, 1.05:
        m.split(-1, y, 6, y, joint=1)
    for x in 0.5, 4.5:
        m.split(x, 0.99, x, 1.06, joint=1)
    m.round(0.01)
    m.property(1, density=2500, kn=1e8, ks=1e8, friction=0.5)
    m.jproperty(1, kn=1e9, ks=1e9, friction=0.5, between=(1, 1), aperture=1e-3)
    m.fix(0, 5, 0, 1.05)
    m.fluid(mode="undrained")
    m.delete(1, 4, 1, 1.05)
    m.ppressure(*ALL, 0.0, state="held")
    m.ppressure(1, 4, 1, 1.05, 0.0, state="free")
    m.fraction(0.2, safe=True)
    m.cycle(1)
    rows = domain_water(m.h)
    volume = rows["volume"][rows["state"] == g.FLOWS].sum()
    stiffness, mass = 2e9 * 4.0**2 / volume, 2500 * 5 * 2.0
    assert math.sqrt(stiffness / mass) * float(m.h.cr[g.TDEL]) < 2


def test_a_function_multiplies_the_pressure_outside() -> None:
    m = slabs()
    m.fix(-9, 9, 0, 1)
    m.function(1, 0.0, 0.0, 1e-3, 1.0)
    m.fluid(mode="drained")
    m.boundary(-0.1, 4.1, 1.9, 2.1, ppressure=P, function=1)
    m.boundary(-9, 9, 1, 2, xvel=0, yvel=0, rotation=0)
    while m.h.cd[g.TIME] < 5e-4:
        m.cycle(1)
    middle = float(m.h.cd[g.TIME]) - float(m.h.cr[g.TDEL]) / 2  # of the last step
    assert m.reactions()["fy"].max() == pytest.approx(4 * P * middle / 1e-3, rel=1e-6)


def test_a_level_loads_edges_below_it() -> None:
    m = slabs()
    m.gravity(0, -9.81)
    m.fix(*ALL)
    m.fluid()
    m.boundary(-0.1, 0.1, -1, 3, level=1.5)
    pushed = m.table("block")["KBFX"].sum()
    assert pushed == pytest.approx(9810 * 1.5**2 / 2, rel=1e-6)
    moments = sums(m)[2]
    assert moments == pytest.approx(-pushed * 0.5, rel=1e-6)


def test_an_excavation_is_drained_until_it_is_filled() -> None:
    m = grid(3, 3)
    m.jproperty(1, kn=1e10, ks=1e10, friction=0.5, aperture=APERTURE, between=(1, 1))
    m.fix(*ALL)
    m.fluid()
    m.boundary(-0.1, 3.1, -0.1, 3.1, ppressure=P)
    m.delete(1, 2, 1, 2)
    m.flow(steady=True)
    hole = domain_water(m.h)["volume"].argmax()
    assert domain_water(m.h)[hole]["pressure"] == 0
    assert domain_water(m.h)[hole]["inflow"] > 1e-4
    m.ppressure(1.2, 1.8, 1.2, 1.8, P)
    m.flow(steady=True)
    assert domain_water(m.h)["pressure"] == pytest.approx(np.full(len(domain_water(m.h)), P), rel=1e-6)


# ---- words and errors


def test_a_scene_without_fluid_has_no_word_of_water() -> None:
    m = slabs()
    m.cycle(10)
    assert [len(m.table(kind)) for kind in ("water", "pipe", "outside")] == [0, 0, 0]
    with pytest.raises(UdecError) as error:
        m.plot(0, joints="ppressure")
    assert error.value.number == 26


@pytest.mark.parametrize("repeated", [0.0, math.inf], ids=["copied", "repeated"])
@pytest.mark.parametrize(
    ("do", "number"),
    [
        (lambda m: m.fluid(kw=0.0), 28),
        (lambda m: m.fluid(mode="wet"), 10),
        (lambda m: m.fluid(every=0), 28),
        (lambda m: m.ppressure(*ALL), 26),
        (lambda m: m.ppressure(*ALL, 1.0, level=2.0), 10),
        (lambda m: m.ppressure(*ALL, level=2.0), 26),
        (lambda m: m.ppressure(8, 9, 8, 9, 1.0), 24),
        (lambda m: m.boundary(8, 9, 8, 9, ppressure=1.0), 24),
        (lambda m: m.boundary(*ALL, ppressure=1.0, flow=1.0), 10),
        (lambda m: m.boundary(*ALL, ppressure=1.0, xvel=1.0), 10),
        (lambda m: m.boundary(*ALL, ppressure=float("nan")), 28),
        (lambda m: m.flow(), 10),
        (lambda m: m.flow(steps=0), 28),
        (lambda m: m.flow(time=-1.0), 28),
        (lambda m: m.flow(time=1e30), 28),
        (lambda m: m.ppressure(*ALL, 1e308), 28),
        (lambda m: m.boundary(*ALL, ppressure=1e308), 28),
        (lambda m: m.jproperty(1, aperture=1e308), 28),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(
    do: Any, number: int, repeated: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both ways to undo: a copy of the words, or an earlier copy and the commands since then."""
    monkeypatch.setattr(undo, "REPEATED", repeated)
    m = slabs()
    m.fluid()
    before, used = m.h.ia.copy(), int(m.h.ci[g.MFREE]) - 1
    with pytest.raises(UdecError) as error:
        do(m)
    assert error.value.number == number
    assert np.array_equal(before[:used], m.h.ia[:used])
    assert m.check() == []


def test_without_fluid_its_commands_are_refused() -> None:
    for do in (
        lambda m: m.ppressure(*ALL, 1.0),
        lambda m: m.flow(steady=True),
        lambda m: m.boundary(*ALL, ppressure=1.0),
    ):
        with pytest.raises(UdecError) as error:
            do(slabs())
        assert error.value.number == 26


def test_a_deck_with_water(tmp_path: Path) -> None:
    """The words of the deck language, PRINT WATER and the pictures."""
    m = Model(out=tmp_path)
    out = m.run(
        """START
GRAVITY 0 -9.81
PROP MAT=1 DENS=2600 KN=1E9 KS=1E9 F=0.6
JPROPERTY JMATERIAL=1 KN=10E9 KS=5E9 FRICTION=0.6 APERTURE=5E-4 RAPERTURE=1E-4 MAPERTURE=2E-3 BETWEEN 1 1
BLOCK 0,0 0,20 30,20 30,0
SPLIT -1,8 31,12
SPLIT 10,-1 14,21
FIX 0 30 0 20
FLUID KW=2E9 DENSITY=1000 VISCOSITY=0.001
BOUNDARY -1 1 -1 21 LEVEL=18
BOUNDARY 29 31 -1 21 LEVEL=5
FLOW STEADY
CYCLE 10
HISTORY 5 KPP AT 5,9
CYCLE 10
PRINT WATER
PLOT 0 PPRESSURE
PLOT 0 SATURATION
PLOT 0 FLOW
STOP
END
"""
    )
    assert "error" not in str(out)
    assert len(m.histories()[0].numbers) == 3
    assert len(list(tmp_path.glob("*.png"))) == 3
    kinds = [g.PRESSURE_OUTSIDE, g.PRESSURE_OUTSIDE, g.DRY]
    assert m.table("outside")["KOKIND"].tolist() == kinds
    rows = contact_flows(m.h)
    assert f"{rows['flow'][0]:.6g}" in str(out)


def test_flow_can_be_interrupted() -> None:
    """An interrupt ends FLOW between two pieces, and nothing of it is left."""
    m = slabs()
    m.fix(*ALL)
    m.fluid()
    m.boundary(-0.1, 0.1, -1, 3, ppressure=P)
    before = m.h.ia.copy()
    timer = threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        m.flow(steps=99_000_000)
    timer.cancel()
    assert np.array_equal(before, m.h.ia)
    assert m.check() == []
