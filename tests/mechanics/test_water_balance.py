"""Where water comes from and goes to: wells, levels that fall, remarks on flow that is not steady."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from naive import water

from udec_ia import Model, UdecError
from udec_ia.advice.water_report import check_balance
from udec_ia.layout import offsets as g
from udec_ia.reader.water_rows import contact_flows, domain_water, water_account, water_balance

ALL = (-1e3, 1e3, -1e3, 1e3)
P, APERTURE, VISCOSITY = 1e5, 1e-3, 1e-3


def squares(nx: int, ny: int) -> tuple[Model, list[str]]:
    """Square blocks of 1 m, fixed, with water in their joints; and the keys of remarks."""
    m, keys = Model(), list[str]()
    m.tell = lambda text: keys.append(getattr(text, "key", ""))
    m.block(0, 0, 0, ny, nx, ny, nx, 0)
    for i in range(1, nx):
        m.split(i, -1, i, ny + 1)
    for j in range(1, ny):
        m.split(-1, j, nx + 1, j)
    m.round(0.05)
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=0.5)
    m.jproperty(1, kn=1e10, ks=1e10, friction=0.5, between=(1, 1), aperture=APERTURE)
    m.gravity(0, -9.81)
    m.fix(*ALL)
    m.fluid(viscosity=VISCOSITY)
    return m, keys


def test_a_well_gives_its_flow_to_a_network() -> None:
    m, _ = squares(3, 3)
    m.gravity(0, 0)
    m.boundary(*ALL, ppressure=0.0)
    m.ppressure("CIRCLE 1 1 0.3", flow=3e-6)
    m.flow(steady=True)
    k = water.cubic(APERTURE, 1.0, VISCOSITY)
    pipes = [((i, j), (i + 1, j), k) for i in range(3) for j in (1, 2)]
    pipes += [((i, j), (i, j + 1), k) for i in (1, 2) for j in range(3)]
    ends = dict.fromkeys(((0, 1), (0, 2), (3, 1), (3, 2), (1, 0), (2, 0), (1, 3), (2, 3)), 0.0)
    unit = water.kirchhoff(pipes, ends | {(1, 1): 1.0})
    taken = sum(k * (1.0 - unit[node]) for node in ((0, 1), (2, 1), (1, 0), (1, 2)))
    rows = domain_water(m.h)
    (centre,) = rows[np.hypot(rows["x"] - 1, rows["y"] - 1) < 0.3]
    assert centre["pressure"] == pytest.approx(3e-6 / taken, rel=1e-6)
    sources = {row["water from"]: row["inflow"] for row in water_balance(m.h)}
    assert sources == pytest.approx({"wells in domains": 3e-6, "pressure": -3e-6}, rel=1e-8)
    put = water_account(m.h)["from outside"]
    m.flow(time=1.0)
    assert water_account(m.h)["from outside"] == pytest.approx(put, abs=1e-14)  # as much leaves as comes


def test_joints_run_dry_as_the_level_falls() -> None:
    m, keys = squares(6, 4)
    m.boundary(-0.1, 0.1, -1, 5, level=3.5)
    m.flow(steady=True)
    assert (domain_water(m.h)["saturation"] > 0).any()
    m.boundary(-0.1, 0.1, -1, 5, level=-1.0)
    done = m.flow(steady=True)
    assert done.rest == 0
    assert np.abs(contact_flows(m.h)["flow"]).max() < 1e-20
    rows = domain_water(m.h)
    upright = np.abs(rows["y"] % 1 - 0.5) < 0.1  # a level joint stays filled: nothing makes its water flow
    assert upright.sum() == 20
    assert (rows["saturation"][upright] == 0).all()
    assert "flow-not-steady" not in keys


def test_a_partly_filled_joint_carries_what_comes_in() -> None:
    """Water that falls down a vertical joint fills S of it: q = k f(S) rho g l."""
    m, _ = squares(2, 1)
    m.boundary(-1, 3, 0.9, 1.1, flow=1e-7)
    m.flow(steady=True)
    (row,) = domain_water(m.h)
    full = 9810 * 0.5 * water.cubic(APERTURE, 0.5, VISCOSITY)  # from the middle of the joint to its end
    s = float(row["saturation"])
    assert s * s * (3 - 2 * s) * full == pytest.approx(1e-7, rel=1e-2)


def test_solve_reports_water_that_still_flows() -> None:
    m, _ = squares(2, 2)
    m.free(*ALL)
    m.fix(-1, 3, 0, 1)
    m.damping(local=0.8)
    m.solve(1e-4)
    m.fluid(kw=1e5)
    m.boundary(-0.1, 0.1, -1, 3, level=1.9)
    assert "water-flows" in m.solve(1e-2, 100000).keys
    m.flow(steady=True)
    m.fluid(mode="drained")
    solution = m.solve(1e-4)
    assert solution
    assert "water-flows" not in solution.keys


def test_a_held_pressure_that_joins_the_outside_is_reported() -> None:
    m, keys = squares(1, 2)
    m.free(*ALL)
    m.fix(-1, 2, 0, 1)
    m.ppressure("ALL", p=1e3, state="held")
    speed = 0.05
    m.boundary(-9, 9, 1, 2, xvel=-speed * 0.5, yvel=speed * 0.5, rotation=speed)
    m.cycle(1)
    assert "held-pressure-ended" not in keys
    m.cycle(math.ceil(0.1 / speed / float(m.h.cr[g.TDEL])))
    assert len(domain_water(m.h)) == 0
    assert "held-pressure-ended" in keys


def test_apertures_that_contradict_are_reported() -> None:
    m, keys = squares(1, 2)
    m.jproperty(1, aperture=1e-3, residual_aperture=2e-3)
    assert keys.count("apertures") == 1
    m.jproperty(1, aperture=1e-3, residual_aperture=1e-4, greatest_aperture=5e-3)
    assert keys.count("apertures") == 1
    m.jproperty(1, aperture=0.5, greatest_aperture=1.0)
    assert keys.count("apertures") == 2


def test_new_apertures_are_changes_of_domains_with_any_mode() -> None:
    for mode in "coupled", "undrained", "drained":
        m, _ = squares(2, 2)
        m.fluid(mode=mode)
        m.ppressure(*ALL, p=P)
        before = water_account(m.h)
        m.jproperty(1, aperture=2 * APERTURE)
        account = water_account(m.h)
        assert account["there"] > 1.5 * before["there"], mode
        gained = account["there"] - before["there"]
        assert account["by changes of domains"] == pytest.approx(gained, rel=1e-6), mode


def test_the_printout_has_the_conditions_of_water(tmp_path: Path) -> None:
    m, _ = squares(2, 2)
    m.boundary(-0.1, 0.1, -1, 3, level=1.9)
    m.ppressure("CIRCLE 1 1 0.3", p=0.0, state="held")
    m.flow(steady=True)
    names = [str(row["water from"]) for row in water_balance(m.h)]
    assert names == ["pressure", "seepage faces", "held domains"]
    assert sum(row["inflow"] for row in water_balance(m.h)) == pytest.approx(0.0, abs=1e-12)
    for what in "water", "boundaries":
        text = m.print(what)
        assert all(name in text for name in names)


@pytest.mark.parametrize("numbers", [(1, 2), (2, 1)])
@pytest.mark.parametrize("degrees", [10.0, 30.0, 40.0, 60.0, 85.0])
def test_a_wide_joint_keeps_its_material_where_a_tight_one_crosses_it(
    degrees: float, numbers: tuple[int, int]
) -> None:
    """The cubic law along the whole wide joint, whatever the angle and the numbers of the joints."""
    m, wide, slope = Model(), 3e-4, math.tan(math.radians(degrees))
    m.tell = lambda _: None
    m.property(1, density=2600, kn=1e9, ks=1e9)
    for number, aperture in zip(numbers, (1e-5, wide), strict=True):
        m.jproperty(number, kn=1e10, ks=5e9, friction=0.6, aperture=aperture)
    m.block(0, 0, 0, 20, 30, 20, 30, 0)
    m.split(-1, 10, 31, 10, joint=numbers[0], jmaterial=numbers[0])
    x = min(40.0, 20.0 / slope)
    m.split(15 - x, 10 - x * slope, 15 + x, 10 + x * slope, joint=numbers[1], jmaterial=numbers[1])
    m.round(0.05)
    m.fluid()
    m.boundary(-1, 31, -1, 21, ppressure=1e6, pygrad=1e5)
    m.flow(steady=True)
    half = min(15.0, 10.0 / slope)  # of the joint, along x
    exact = water.cubic(wide, 2 * half * math.hypot(1, slope), 1e-3) * 1e5 * 2 * half * slope
    rows = contact_flows(m.h)
    far = np.hypot(rows["x"] - 15, rows["y"] - 10) > 2
    on = far & (np.abs((rows["y"] - 10) - slope * (rows["x"] - 15)) < 0.1)
    assert np.abs(rows["flow"][on]) == pytest.approx(np.full(on.sum(), exact), rel=2e-3)


def test_a_tight_network_is_steady_beside_a_wide_crack() -> None:
    """Pressures of the network are those without the crack, which carries 1e9 times as much."""
    found = []
    for cracked in (False, True):
        m = Model()
        m.tell = lambda _: None
        m.gravity(0, -10)
        m.property(1, density=2600, kn=1e9, ks=1e9)
        m.jproperty(1, kn=1e10, ks=5e9, aperture=1e-2)
        m.jproperty(2, kn=1e10, ks=5e9, aperture=1e-5)
        m.block(0, 0, 0, 20, 30, 20, 30, 0)
        if cracked:
            m.split(-1, 2, 31, 2, joint=1, jmaterial=1)
        m.split(-1, 5, 31, 5, joint=2, jmaterial=2)
        m.split(-1, 10, 31, 10, joint=2)
        m.split(10, 4.9, 10, 10.1, joint=2)
        m.split(20, 4.9, 20, 10.1, joint=2)
        m.round(0.05)
        m.fluid()
        m.boundary(-1, 1, -1, 21, level=19)
        m.flow(steady=True)
        rows = domain_water(m.h)
        found.append({(round(float(r["x"]), 3), round(float(r["y"]), 3)): r["pressure"] for r in rows})
    for place, pressure in found[0].items():
        assert found[1][place] == pytest.approx(pressure, rel=1e-6)


def test_a_crack_that_is_held_to_a_level_gives_water_below_it() -> None:
    """The level is below the middle of the crack, in which its pressure is calculated."""
    m = Model()
    m.tell = lambda _: None
    m.gravity(0, -10)
    m.property(1, density=2000, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e10, ks=1e10, friction=5, aperture=5e-4, between=(1, 1))
    m.block(0, 0, 0, 20, 10, 20, 10, 0)
    m.split(-1, 5, 11, 5)
    m.split(4, 4.9, 4, 21)
    m.round(0.05)
    m.fix(*ALL)
    m.fluid(mode="drained")
    m.boundary(-1, 0.1, -1, 21, impermeable=True)
    for level in (12.0, 13.0):
        m.ppressure(3.9, 4.1, 6, 20, level=level, state="held")
        m.flow(steady=True)
        drop = 1e4 * (level - 5)  # from the foot of the crack to the seepage face, 6 m of joint away
        joint, corner = water.cubic(5e-4, 6.0, 1e-3), water.cubic(5e-4, 7.5, 1e-3)
        exact = drop / (1 / joint + 1 / corner)  # the pipe at the foot has half the length of the crack
        (held,) = (row["inflow"] for row in water_balance(m.h) if row["water from"] == "held domains")
        assert held == pytest.approx(exact, rel=0.02)


def test_a_well_never_takes_what_is_not_there() -> None:
    m, _ = squares(1, 2)
    m.boundary(*ALL, impermeable=True)
    m.ppressure(*ALL, p=P)
    m.ppressure(*ALL, flow=-1e-6)
    for _ in range(3):
        m.flow(time=5000.0)
    account = water_account(m.h)
    assert account["by changes of domains"] == 0
    assert 0 < account["there"] < 0.1 * account["by commands"]


def test_a_pulse_within_one_step_of_flow_is_not_lost() -> None:
    m, _ = squares(1, 2)
    m.boundary(*ALL, impermeable=True)
    m.function(1, 0, 0, 1, 1, 2, 0)
    m.boundary(-0.1, 0.1, -1, 3, flow=1e-4, function=1)
    m.flow(time=2.0)
    assert water_account(m.h)["from outside"] == pytest.approx(1e-4, rel=0.01)


def test_steps_and_a_time_of_flow() -> None:
    """One reservoir that fills: p tends to P as exp(-t/tau); the error of n steps is that of first order."""
    m, _ = squares(1, 2)
    m.fluid(kw=1e6)
    m.boundary(*ALL, impermeable=True)
    m.boundary(-0.1, 0.1, -1, 3, ppressure=P)
    m.ppressure(*ALL, p=0.0)
    step = float(m.h.cr[g.FDEL]) or 1.0
    done = m.flow(time=step, steps=1000)
    assert done.steps == 1000
    (row,) = domain_water(m.h)
    tau = row["volume"] / 1e6 / m.table("pipe")["KPK"].max()
    assert row["pressure"] == pytest.approx(P * (1 - math.exp(-step / tau)), rel=1e-3)


def test_the_factor_of_corners_is_a_real_number_in_a_deck(tmp_path: Path) -> None:
    m, _ = squares(2, 2)
    m.out = tmp_path
    m.run("JPROPERTY JMATERIAL=1 PFACTOR=1E-9")
    assert m.h.cr[g.JMKC] == pytest.approx(1e-9)


def one_joint(kw: float = 1e6) -> Model:
    """Two fixed slabs, and the joint between them."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.block(0, 0, 0, 2, 4, 2, 4, 0)
    m.split(-1, 1, 5, 1)
    m.round(0.05)
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=0.5)
    m.jproperty(1, kn=1e10, ks=1e10, friction=0.5, between=(1, 1), aperture=5e-4)
    m.fix("ALL")
    m.fluid(kw=kw)
    return m


def taken_part(s: float) -> float:
    """f(S)."""
    return s * s * (3 - 2 * s)


def test_a_source_and_a_sink_at_one_domain_are_two() -> None:
    m = one_joint()
    m.boundary(-0.1, 0.1, -1, 3, flow=1e-6)
    m.boundary(3.9, 4.1, -1, 3, flow=-2e-6)
    m.ppressure("ALL", p=0.0)
    m.flow(time=2e4, steps=4000)
    (row,) = m.water()
    assert taken_part(row["saturation"]) == pytest.approx(0.5, rel=1e-3)
    rows = m.pipes()
    assert np.abs(rows["flow"]) == pytest.approx(np.full(2, 1e-6), rel=1e-2)
    m.boundary(3.9, 4.1, -1, 3, flow=-1e-6)
    m.ppressure("ALL", p=1e3)
    m.flow(steps=1)
    assert np.abs(m.pipes()["flow"]) == pytest.approx(np.full(2, 1e-6))
    assert m.water()["inflow"] == pytest.approx(0, abs=1e-20)


def test_a_well_in_the_table_has_what_it_takes() -> None:
    m = one_joint()
    m.boundary("OUTSIDE", impermeable=True)
    m.ppressure("ALL", p=0.0)
    m.ppressure("ALL", flow=-1e-6)
    volume = float(m.water()["volume"][0])
    m.flow(time=0.3 * volume / 1e-6, steps=4000)
    before = float(m.water()["saturation"][0])
    m.flow(time=1e-4 * volume / 1e-6, steps=1)
    (row,) = [one for one in water_balance(m.h) if one["water from"] == "wells in domains"]
    assert row["inflow"] == pytest.approx(-1e-6 * taken_part(before), rel=1e-6)
    m.flow(steady=True)
    assert m.water()["saturation"] == [0.0]
    assert water_balance(m.h)["inflow"].sum() == 0


def test_at_rest_with_a_well_and_no_pipe() -> None:
    m = one_joint()
    m.boundary("OUTSIDE", impermeable=True)
    m.ppressure("ALL", flow=1e-9)
    m.flow(steps=1)
    (found,) = check_balance(m.array, 1e-4)
    assert found.key == "water-flows"
    m.ppressure("ALL", flow=0.0)
    m.flow(steps=1)
    assert [*check_balance(m.array, 1e-4)] == []


def test_words_of_ppressure() -> None:
    m = one_joint()
    m.ppressure("ALL", p=1e5)
    m.ppressure("ALL", state="held")
    assert (round(m.water()["pressure"][0]), m.water()["state"][0]) == (100000, 1)
    m.ppressure("ALL", state="free")
    assert (round(m.water()["pressure"][0]), m.water()["state"][0]) == (100000, 0)
    m.ppressure("ALL", pxgrad=1e4)
    assert m.water()["pressure"] == pytest.approx([2e4])
    for words, number in (
        ({"state": "hold"}, 10),
        ({}, 26),
        ({"level": 3.0}, 26),
        ({"level": 3.0, "pygrad": 1.0}, 10),
    ):
        with pytest.raises(UdecError) as error:
            m.ppressure("ALL", **words)
        assert error.value.number == number
    m.gravity(5, 0)
    with pytest.raises(UdecError) as error:
        m.ppressure("ALL", level=3.0)
    assert error.value.number == 26
    m.function(1, 0, 1)
    for conditions in ({"flow": 1e-6, "pygrad": -1e4}, {"impermeable": True, "function": 1}):
        with pytest.raises(UdecError) as error:
            m.boundary("OUTSIDE", **conditions)
        assert error.value.number == 10
    m.gravity(0, -10)
    m.ppressure("ALL", level=0.5, state="held")
    (row,) = m.water()
    assert (row["pressure"], row["saturation"]) == (0, 0)


def test_a_reservoir_that_is_filled_again_is_held() -> None:
    m, _ = squares(3, 3)
    m.fluid(kw=1e5)
    m.delete(1, 2, 1, 2)
    centre = "CIRCLE 1.5 1.5 0.3"
    m.ppressure(centre, p=2e4)
    m.boundary("OUTSIDE", ppressure=0.0)
    m.flow(steady=True)
    rows = m.water()
    (row,) = rows[(np.abs(rows["x"] - 1.5) < 0.1) & (np.abs(rows["y"] - 1.5) < 0.1)]
    assert (row["pressure"], row["state"]) == (2e4, 1)
    m.ppressure(centre, state="free")
    m.flow(time=1.0)
    rows = m.water()
    assert rows["pressure"].max() < 2e4


def test_steps_of_flow_follow_what_becomes_quicker() -> None:
    """An outflow that grows with a FUNCTION never takes more than a domain has in one step."""
    m = one_joint(kw=1e4)
    m.function(1, 0, 0, 1e3, 1)
    m.boundary(-0.1, 0.1, -1, 3, flow=-1e-4, function=1)
    m.ppressure("ALL", p=0.0)
    m.flow(time=1e3)
    there = water_account(m.h)
    assert abs(there["by changes of domains"]) < 1e-12
    assert there["there"] == pytest.approx(there["from outside"] + there["by commands"], rel=1e-9, abs=1e-15)


def test_a_joint_that_must_fill_before_it_spills_is_steady_from_dry_joints() -> None:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(
        "START\nGRAVITY 0 -9.81\nPROP MAT=1 DENS=2600 KN=1E9 KS=1E9\n"
        "JPROPERTY JMATERIAL=1 KN=1E10 KS=5E9 FRICTION=0.6 APERTURE=1.9E-4 RAPERTURE=3.8E-5\n"
        "JPROPERTY JMATERIAL=2 KN=1E10 KS=5E9 FRICTION=0.6 APERTURE=4.3E-4 RAPERTURE=8.6E-5\n"
        "BLOCK 0,0 0,20 30,20 30,0\nSPLIT -1,6.88 31,7.88 JOINT=1 JMATERIAL=1\n"
        "SPLIT 7.18,-1 23.18,21 JOINT=2 JMATERIAL=2\nROUND 0.02\nFIX ALL\nFLUID\n"
        "BOUNDARY -1 31 -.1 .1 IMPERMEABLE\nBOUNDARY -.1 .1 -1 21 LEVEL=10.54\n"
        "BOUNDARY 29.9 30.1 -1 21 LEVEL=7.617\n"
    )
    done = m.flow(steady=True)
    assert done.rest <= 1e-9
    length = math.hypot(30, 30 / 32)
    outlet = 6.88 + 31 / 32
    exact = 1.9e-4**3 / 0.012 / length * 9810 * (10.54 - outlet)
    assert np.abs(m.pipes()["flow"]).max() == pytest.approx(exact, rel=1e-3)


def test_held_without_a_pressure_keeps_water_at_rest() -> None:
    m, _ = squares(3, 3)
    m.boundary("OUTSIDE", level=5.0)
    m.flow(steady=True)
    m.ppressure("CIRCLE 1 1.5 0.3", state="held")
    m.flow(steady=True)
    assert np.abs(m.pipes()["flow"]).max() < 1e-15
    rows = m.water()
    assert rows["pressure"] == pytest.approx(9810 * (5 - rows["y"]))


def test_a_fill_ends_what_is_held_and_delete_reports_it() -> None:
    m, keys = squares(5, 5)
    m.boundary("OUTSIDE", ppressure=1e4)
    m.ppressure("CIRCLE 2 2.5 0.3", p=2e4, state="held")
    m.delete(1, 3, 2, 3)
    assert keys.count("held-pressure-ended") == 1
    m.fill(2, 2.5)
    m.gravity(0, 0)
    m.flow(steady=True)
    assert not np.isin(m.water()["state"], (1, 2)).any()
    assert np.abs(m.pipes()["flow"]).max() < 1e-15
    assert m.water()["pressure"] == pytest.approx(1e4)
    assert m.check() == []
