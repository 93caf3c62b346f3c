"""FLOW STEADY in networks of joints with very different apertures, from dry and from filled joints."""

from __future__ import annotations

import numpy as np
import pytest

from udec_ia import Model, UdecError

WIDTH, HEIGHT = 30.0, 20.0
UNIT_WEIGHT = 9810.0


def network(seed: int) -> tuple[Model, np.random.Generator]:
    """A block with 9 joints of three sets, water in them, and closed at its base."""
    rng = np.random.default_rng(seed)
    m = Model()
    m.tell = m.inform = lambda _: None
    m.gravity(0, -9.81)
    m.property(1, density=2600, kn=1e9, ks=1e9)
    m.block(0, 0, 0, HEIGHT, WIDTH, HEIGHT, WIDTH, 0)
    for k in range(9):
        aperture = 10.0 ** rng.uniform(-5, -3)
        m.jproperty(k + 1, kn=1e10, ks=5e9, friction=0.6, aperture=aperture, residual_aperture=aperture / 5)
        y, x = rng.uniform(2, 16), rng.uniform(3, 24)
        sets = (
            (-1, y, WIDTH + 1, y + rng.uniform(0, 3)),
            (x, -1, x + rng.uniform(-2, 2), HEIGHT + 1),
            (1.3 * x - 12, -1, 1.3 * x + 4, HEIGHT + 1),
        )
        try:
            m.split(*sets[k % 3], joint=k + 1, jmaterial=k + 1)
        except UdecError:  # two joints nearly meet: this one is left out
            continue
    m.round(0.002)
    m.fluid()
    m.boundary(-1, WIDTH + 1, -0.1, 0.1, impermeable=True)
    return m, rng


def levels(m: Model, left: float, right: float) -> None:
    m.boundary(-1, 0.1, -1, HEIGHT + 1, level=left)
    m.boundary(WIDTH - 0.1, WIDTH + 1, -1, HEIGHT + 1, level=right)


def falls(m: Model) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of each pipe between two domains: its flow, f(S) where the water leaves, and the fall of potential."""
    rows = {int(row["domain"]): row for row in m.water()}
    inner = [pipe for pipe in m.pipes() if {int(pipe["one"]), int(pipe["two"])} <= rows.keys()]
    potential = {key: row["pressure"] + UNIT_WEIGHT * row["y"] for key, row in rows.items()}
    fall = np.array([potential[int(pipe["one"])] - potential[int(pipe["two"])] for pipe in inner])
    leaves = [int(pipe["one"] if h > 0 else pipe["two"]) for pipe, h in zip(inner, fall, strict=True)]
    s = np.array([rows[key]["saturation"] for key in leaves])
    return np.array([pipe["flow"] for pipe in inner]), s * s * (3 - 2 * s), fall


@pytest.mark.parametrize("seed", range(24))
def test_a_network_of_unlike_joints_is_steady(seed: int) -> None:
    m, rng = network(seed)
    left, right = rng.uniform(10, 19), rng.uniform(1, 8)
    levels(m, left, right)
    assert m.flow(steady=True).rest <= 1e-9
    first = m.water().copy()
    flow, part, fall = falls(m)
    into = dict.fromkeys((int(row["domain"]) for row in first), 0.0)
    through = into.copy()
    for pipe in m.pipes():  # the outside has no row
        for end, q in ((int(pipe["one"]), -pipe["flow"]), (int(pipe["two"]), pipe["flow"])):
            if end in into:
                into[end] += q
                through[end] += abs(q)
    greatest, pipes = max(through.values()), m.pipes()
    # Differences of potentials of 2e5 Pa have no digits below 3e-11 Pa.
    digits = 1e-10 * (pipes["aperture"] ** 3 / (12e-3 * pipes["length"])).max()
    assert greatest > 0
    assert all(abs(into[end]) <= 1e-9 * through[end] + digits for end in into)

    levels(m, HEIGHT + 5, HEIGHT + 1)  # all joints are full, and the flow is linear
    assert m.flow(steady=True).rest <= 1e-9
    assert (m.water()["saturation"] == 1).all()
    full, one, linear = falls(m)
    assert (one == 1).all()
    clear = np.abs(linear) > 1e-3  # Pa: enough digits for a conductance
    conductance = np.zeros(len(full))
    conductance[clear] = full[clear] / linear[clear]
    assert flow[clear] == pytest.approx((conductance * part * fall)[clear], rel=1e-6, abs=digits)

    levels(m, left, right)  # the same state from the other side, but for water that is at rest
    assert m.flow(steady=True).rest <= 1e-9
    moving = np.array([through[int(row["domain"])] > 1e-9 * greatest for row in first])
    assert m.water()["pressure"][moving] == pytest.approx(first["pressure"][moving], rel=1e-6, abs=1e-2)


def pool_and_crest(crest: float, level: float) -> Model:
    """A joint over a crest at (3, crest), with a vertical joint on either side, and a level at x = 10."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.gravity(0, -9.81)
    m.property(1, density=2600, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e10, ks=5e9, friction=0.6, aperture=1e-4, between=(1, 1))
    m.block(0, 0, 0, 5, 10, 5, 10, 0)
    m.polyline(0, 1, 3, crest, 6, 1, 10, 1)
    m.split(4.5, -1, 4.5, 6)
    m.split(1.5, -1, 1.5, 6)
    m.round(0.01)
    m.fluid()
    m.boundary("OUTSIDE", impermeable=True)
    m.boundary(9.9, 11, -1, 6, level=level)
    return m


@pytest.mark.parametrize(("level", "is_wet"), [(2.0, False), (4.5, True)])
def test_water_does_not_pass_a_crest_above_its_level(level: float, is_wet: bool) -> None:
    m = pool_and_crest(4.0, level)
    assert m.flow(steady=True).rest <= 1e-9
    rows = m.water()
    behind = rows[(rows["x"] < 1.4) & (rows["y"] < 2.5)]
    assert len(behind)
    assert (behind["saturation"] == (1.0 if is_wet else 0.0)).all()
    assert (rows["pressure"] <= np.maximum(UNIT_WEIGHT * (level - rows["y"]), 0) + 1e-3).all()


def test_a_well_empties_joints_that_get_no_water() -> None:
    m = pool_and_crest(4.0, 4.9)
    m.flow(steady=True)
    m.boundary(9.9, 11, -1, 6, impermeable=True)
    m.ppressure("CIRCLE 4.5 2.5 0.8", flow=-1e-6)
    assert m.flow(steady=True).rest <= 1e-9
    wells = np.hypot(m.water()["x"] - 4.5, m.water()["y"] - 2.5) < 0.8
    assert wells.any()
    assert (m.water()["saturation"][wells] == 0).all()


def row_of_joints(wide: float, narrow: float) -> Model:
    """A joint from 1e6 Pa to 2e5 Pa, narrow at both ends, with dead ends above its wide middle."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.property(1, density=2600, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e10, ks=5e9, friction=0.6, aperture=wide, between=(1, 1))
    m.jproperty(2, kn=1e10, ks=5e9, friction=0.6, aperture=narrow)
    m.block(0, 0, 0, 4, 10, 4, 10, 0)
    m.split(-1, 2, 11, 2, joint=1, jmaterial=1)
    for k in range(1, 10):
        m.split(k, 2, k, 5, joint=2, jmaterial=2)
    m.round(0.003)
    m.change(-1, 1.5, 1.9, 2.1, jmaterial=2)
    m.change(8.5, 11, 1.9, 2.1, jmaterial=2)
    m.fluid(mode="drained")
    for y1, y2 in ((3.9, 4.1), (-0.1, 0.1)):
        m.boundary(-1, 11, y1, y2, impermeable=True)
    m.boundary(-0.1, 0.1, -1, 5, ppressure=1e6)
    m.boundary(9.9, 10.1, -1, 5, ppressure=2e5)
    return m


@pytest.mark.parametrize(
    ("wide", "narrow", "digits"), [(1e-3, 1e-5, 1e-9), (1e-3, 1e-6, 1e-9), (1e-2, 1e-6, 1e-3)]
)
def test_apertures_of_several_decades(wide: float, narrow: float, digits: float) -> None:
    """By symmetry the pressure in the middle is the mean, and as much leaves as enters."""
    m = row_of_joints(wide, narrow)
    assert m.flow(steady=True).rest <= 1e-9
    rows = m.water()
    middle = rows["pressure"][(np.abs(rows["x"] - 5) < 1e-6) & (np.abs(rows["y"] - 2) < 0.1)]
    assert middle == pytest.approx(6e5, rel=digits)
    inside = {*rows["domain"].tolist()}
    ends = [abs(one["flow"]) for one in m.pipes() if one["flow"] and not {one["one"], one["two"]} <= inside]
    assert len(ends) == 2
    assert ends[0] == pytest.approx(ends[1], rel=10 * digits)


def test_flows_that_reals_cannot_hold_change_nothing() -> None:
    m = row_of_joints(1e-3, 1e-5)
    m.fluid(viscosity=1e300)
    before = m.array.h.ia.copy()
    assert not m.flow(steady=True).rest <= 1e-9
    assert (m.array.h.ia == before).all()


def crossing(sealed: bool) -> Model:
    """A vertical joint through the middle of a square of 4 m, and a joint to its right edge at y = 2."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.gravity(0, -9.81)
    m.property(1, density=2600, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e9, ks=1e9, aperture=5e-4, between=(1, 1))
    m.block(0, 0, 0, 4, 4, 4, 4, 0)
    m.split(2, -1, 2, 5)
    m.split(2, 2, 5, 2)
    m.round(0.01)
    m.fluid()
    if sealed:
        m.boundary("ALL", impermeable=True)
    return m


@pytest.mark.parametrize("outlet", ["well", "edge"])
def test_a_pool_below_a_well_stays(outlet: str) -> None:
    """A well that nothing feeds empties what is above it; the joint below the crossing stays full."""
    m = crossing(sealed=True)
    m.ppressure("ALL", level=4)
    if outlet == "well":
        m.ppressure("CIRCLE 3 2 0.2", flow=-1e-6)
    else:
        m.boundary(3.9, 4.1, -1, 5, flow=-1e-6)
    for _ in range(2):
        assert m.flow(steady=True).rest <= 1e-9
        rows = m.water()
        below = np.abs(rows["y"] - 1) < 0.1
        assert rows["pressure"][below] == pytest.approx(UNIT_WEIGHT, rel=1e-6)
        assert (rows["saturation"][~below] == 0).all()


SLAB = """START
GRAVITY 0 -9.81
PROPERTY MAT=1 DENSITY=2600 KN=1E9 KS=1E9
JPROPERTY JMATERIAL=1 KN=1E10 KS=5E9 FRICTION=0.6 APERTURE=5E-4 RAPERTURE=1E-4 BETWEEN 1 1
BLOCK 0,0 0,10 12,10 12,0
SPLIT -1 1.2 13 2.9
SPLIT -1 4.1 13 4.6
SPLIT -1 6.8 13 7.3
SPLIT 2.1 -1 3.3 11
SPLIT 5.2 -1 5.9 11
SPLIT 8.7 -1 8.1 11
SPLIT 10.2 -1 10.4 11
ROUND 0.02
FLUID DRAINED
BOUNDARY ALL IMPERMEABLE
"""


def slab(words: str) -> Model:
    """A slab with seven joints that is closed but for the conditions in `words`."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(SLAB + words)
    return m


def test_a_pool_has_the_level_of_its_brim_whatever_pressure_it_had() -> None:
    """The lowest open mouth of a joint on the right edge is at y = 4.6 - 0.5/14 = 4.5643."""
    for state in ("PPRESSURE ALL LEVEL=10", "PPRESSURE ALL 0", "PPRESSURE ALL 1E6"):
        m = slab(f"BOUNDARY 11.9 12.1 4 11 LEVEL=-5\n{state}\n")
        assert m.flow(steady=True).rest <= 1e-9
        rows = m.water()
        filled = rows["pressure"] > 1  # not what is left on a joint above
        assert filled.sum() > 20
        brim = 4.6 - 0.5 / 14
        assert rows["pressure"][filled] == pytest.approx(UNIT_WEIGHT * (brim - rows["y"][filled]), rel=1e-4)


@pytest.mark.parametrize("state", ["", "PPRESSURE ALL 0", "PPRESSURE ALL LEVEL=10"])
def test_an_outlet_that_draws_more_than_comes_is_partly_filled(state: str) -> None:
    """Three joints on the left bring 1e-6 m2/s each; each mouth on the right would draw 2e-6."""
    words = "BOUNDARY -0.1 0.1 -1 11 FLOW=1E-6\nBOUNDARY 11.9 12.1 -1 11 FLOW=-2E-6\n"
    m = slab(words + state)
    assert m.flow(steady=True).rest <= 1e-9
    rows = m.water()
    partly = (rows["saturation"] > 0) & (rows["saturation"] < 1) & (np.abs(rows["inflow"]) < 1e-15)
    mouth = partly & (rows["x"] > 11) & (rows["x"] < 11.3)
    assert rows["saturation"][mouth] == pytest.approx(0.5, rel=1e-6)  # f(0.5) = 0.5: with the one below 3e-6
