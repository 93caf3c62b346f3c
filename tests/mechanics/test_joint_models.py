"""Joint models YIELDING and BARTON in a shear box of two blocks, against the formulas for one point."""

from __future__ import annotations

from math import atan, inf, radians, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.joint_models import BartonBandis, ContinuouslyYielding, JointPoint
from support.seldom_compiled import compiled_if_usual

from udec_ia import Model, UdecError
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g

LENGTH, DENSITY = 4.0, 2000.0
KS, JRC, JCS, RESIDUAL = 5e9, 8.0, 100e6, radians(28)
BARTON: dict[str, Any] = {
    "model": "barton",
    "ks": KS,
    "friction": tan(RESIDUAL),
    "jrc": JRC,
    "jcs": JCS,
    "sigmac": JCS,
}
YIELDING: dict[str, Any] = {
    "model": "yielding",
    "kn": 2e8,
    "normal_exponent": 0.3,
    "kn_min": 1e9,
    "kn_max": 1e11,
    "ks": 1e8,
    "shear_exponent": 0.25,
    "ks_min": 5e8,
    "initial_friction": 1.0,
    "friction": tan(radians(30)),
    "roughness": 2e-3,
}


def granite() -> BartonBandis:
    return BartonBandis(jrc=JRC, jcs=JCS, sigma_c=JCS, residual=28.0, ks=KS)


def yielding(**changes: float) -> ContinuouslyYielding:
    joint = YIELDING | changes
    return ContinuouslyYielding(
        an=joint["kn"],
        en=joint["normal_exponent"],
        as_=joint["ks"],
        es=joint["shear_exponent"],
        peak=atan(joint["initial_friction"]),
        basic=atan(joint["friction"]),
        roughness=joint["roughness"],
        kn_range=(joint["kn_min"], joint["kn_max"]),
        ks_range=(joint["ks_min"], inf),
    )


def box(joint: dict[str, Any], build: str = "i32r64") -> Model:
    """A block LENGTH wide and 1 high on a fixed one, without weight."""
    m = Model(build)
    m.property(1, density=DENSITY)
    m.jproperty(1, **joint)
    m.block(0, 0, 0, 2, LENGTH, 2, LENGTH, 0)
    m.split(-1, 1, LENGTH + 1, 1, joint=1, jmaterial=1)
    m.fix(0, LENGTH, 0, 1)
    m.round(0.1)
    return m


def drive(m: Model, xvel: float, yvel: float, cycles: int) -> None:
    """Move the upper block without turning."""
    m.boundary(1.0, 3.0, 1.4, 1.6, xvel=xvel, yvel=yvel, rotation=0.0)
    m.cycle(cycles)


def state(m: Model) -> Any:
    """The joint of the first contact, with its closure and slip; that of the second has the same state."""
    rows, contact = m.table("joint"), m.table("contact")[0]
    for name in ("KCJSN", "KCJTS"):
        assert float(rows[name][1]) == pytest.approx(float(rows[name][0]), rel=1e-2, abs=1e3)
    joint = {name: rows[name][0] for name in rows.dtype.names}
    return joint | {"closure": float(contact["KCN"] + joint["KCJOFF"]), "slip": float(contact["KCS"])}


def follow(m: Model, point: JointPoint, legs: list[tuple[float, float, int]], rel: float) -> None:
    """Drive the box along `legs`, and compare it with the point at the end of each.

    rel: of the stresses, each at least 0.1 MPa.
    """
    for xvel, yvel, cycles in legs:
        drive(m, xvel, yvel, cycles)
        row = state(m)
        point.move(row["closure"] - point.closure, row["slip"] - point.slip, cycles)
        assert float(row["KCJSN"]) == pytest.approx(point.normal, rel=rel, abs=rel * 1e5)
        assert float(row["KCJTS"]) == pytest.approx(point.shear, rel=rel, abs=rel * 1e5)
    assert m.check() == []


CLOSURE = [(0, -1e-3, 500), (0, 1e-3, 300), (0, -1e-3, 600), (0, 1e-3, 1200), (0, -1e-3, 1200)]


def test_barton_closes_and_opens_along_its_curves() -> None:
    """Loading, unloading, reloading beyond the largest stress, opening and closing again."""
    m, point = box(BARTON), granite()
    m.energy("on")
    for leg in CLOSURE:
        follow(m, point, [leg], 1e-12)
        assert state(m)["KCJV1"] == pytest.approx(point.largest, rel=1e-12)
    balance = m.balance()
    assert abs(balance.residual) < 1e-2 * balance.throughput
    assert balance.friction == pytest.approx(LENGTH * point.dissipated(), rel=5e-3)


@pytest.mark.parametrize("closure", [2e-5, 5e-5, 9e-5])
def test_strength_of_barton_at_several_stresses(closure: float) -> None:
    """Slip to the strength, and back to that of the other side."""
    m, point = box(BARTON), granite()
    follow(m, point, [(0, -closure / 0.03, 0)], 1e-9)
    while state(m)["closure"] < closure:
        follow(m, point, [(0, -1e-3, 100)], 1e-9)
    for way in (0.3, -0.3):
        follow(m, point, [(way, 0, 600)], 1e-9)
        assert abs(state(m)["KCJTS"]) == pytest.approx(point.strength(point.normal), rel=1e-9)
        assert state(m)["KCJFLAG"] & g.JOINT_SLIPS


def test_yielding_closes_along_one_curve_and_yields() -> None:
    """The point closes in steps of the midpoint rule, the joint by the integral: 2e-3 of the stresses."""
    m, point = box(YIELDING), yielding()
    m.energy("on")
    follow(m, point, [(0, -2e-3, 800), (0, 1e-3, 400)], 2e-3)
    follow(m, point, [(1e-2, 0, 800), (-1e-2, 0, 900), (1e-2, -1e-4, 400), (3e-2, 0, 800)], 2e-3)
    assert state(m)["KCJTS"] ** 2 == pytest.approx((point.normal * tan(point.angle)) ** 2, rel=1e-2)
    follow(m, point, [(0, 4e-3, 800)], 2e-3)
    balance = m.balance()
    assert abs(balance.residual) < 1e-2 * balance.throughput
    assert balance.friction == pytest.approx(LENGTH * point.dissipated(), rel=1e-2)


@pytest.mark.parametrize("closure", [5e-5, 2e-4])
def test_friction_of_yielding_decreases_with_plastic_displacement(closure: float) -> None:
    m, point = box(YIELDING), yielding()
    while state(m)["closure"] < closure:
        follow(m, point, [(0, -1e-3, 100)], 2e-3)
    angles = []
    for _ in range(4):
        follow(m, point, [(5e-2, 0, 300)], 2e-3)
        angles.append(point.angle)
        plastic = float(state(m)["KCJV1"])
        fallen = (point.angle - point.basic) / (point.peak - point.basic)
        assert np.exp(-plastic / YIELDING["roughness"]) == pytest.approx(fallen, rel=2e-3)
    assert angles == sorted(angles, reverse=True)


@pytest.mark.parametrize("exponent", [0.0, 1.0, 2.0])
def test_closure_of_yielding_for_other_exponents(exponent: float) -> None:
    """Stiffness is 1e9 below 1 MPa and 1e11 at most; the point needs small steps where it grows fast."""
    given = {"normal_exponent": exponent, "kn": 1e9 / 1e6**exponent}
    m, point = box(YIELDING | given), yielding(**given)
    for _ in range(6):
        drive(m, 0, -0.1, 100)
        row = state(m)
        point.move(row["closure"] - point.closure, 0.0, 20000)
        assert row["KCJSN"] == pytest.approx(point.normal, rel=1e-3)
    assert row["KCJSN"] > 2e6


@pytest.mark.parametrize("build", ALL_SCHEMES)
@pytest.mark.parametrize("joint", [BARTON, YIELDING], ids=["barton", "yielding"])
def test_five_word_schemes(joint: dict[str, Any], build: str) -> None:
    """Closures are about 1e-4 at coordinates of 4: 32-bit reals leave 5e-7/1e-4 of them."""
    m = box(joint, build)
    point: JointPoint = granite() if joint is BARTON else yielding()
    legs = [(0, -1e-3, 500), (1e-2, 0, 400), (-1e-2, 0, 300), (0, 1e-3, 100)]
    with compiled_if_usual(build):
        follow(m, point, legs, 5e-3 if build in ("i32r64", "i64r64", "i16r64") else 5e-2)


@pytest.mark.parametrize("joint", [BARTON, YIELDING], ids=["barton", "yielding"])
def test_a_restart_changes_no_bit(joint: dict[str, Any], tmp_path: Path) -> None:
    m = box(joint)
    m.fraction(0.5, safe=True)
    drive(m, 2e-3, -1e-3, 300)
    m.save(tmp_path / "a.h5")
    m.cycle(300)
    other = Model()
    other.restart(tmp_path / "a.h5")
    other.cycle(300)
    used = int(m.h.ci[g.MFREE]) - 1
    assert np.array_equal(m.h.ia[:used], other.h.ia[:used])


def pressed(stress: float, **more: float) -> Model:
    """The box with a pressure on its upper block."""
    m = box(BARTON | more)
    m.damping(local=0.8)
    m.function(1, 0, 0, 0.02, 1)
    m.boundary(-1, LENGTH + 1, 1.9, 2.1, stress=(0, 0, -stress), function=1)
    return m


@pytest.mark.parametrize("safe", [True, False])
def test_the_step_follows_a_joint_that_stiffens(safe: bool) -> None:
    """It is 600 times as stiff in the end; step and stiffness agree to a tenth, and the block rests."""
    stress, point = 30e6, granite()
    m = pressed(stress)
    if safe:
        m.fraction(0.5, safe=True)
    m.energy("on")
    m.cycle(1)
    first = float(m.h.cr[g.TDEL])
    m.cycle(6000)
    row = state(m)
    assert row["KCJSN"] == pytest.approx(stress, rel=1e-3)
    assert row["closure"] == pytest.approx(point.first().closure(stress), rel=1e-2)
    stiffer = point.later().stiffness(stress) / point.initial_stiffness()
    assert stiffer > 600
    assert first / float(m.h.cr[g.TDEL]) == pytest.approx(stiffer**0.5, rel=0.1)
    assert row["KCJKN"] * 1.1 >= point.later().stiffness(stress) * LENGTH / 2
    balance = m.balance()
    assert abs(balance.residual) < 1e-2 * balance.throughput
    assert m.check() == []


def test_a_load_at_once_needs_knmax() -> None:
    """The first step would close the joint by more than its greatest closure."""
    m = box(BARTON)
    m.boundary(-1, LENGTH + 1, 1.9, 2.1, stress=(0, 0, -30e6))
    with pytest.raises(UdecError) as raised:
        m.cycle(10)
    assert raised.value.number == 38
    m = box(BARTON | {"kn_max": 2e13})
    m.boundary(-1, LENGTH + 1, 1.9, 2.1, stress=(0, 0, -30e6))
    assert m.solve(1e-5, static=True).reached
    assert state(m)["KCJSN"] == pytest.approx(30e6, rel=1e-3)


def test_length_that_grows_shortens_the_step() -> None:
    """A block slides from an overlap of 1 m to one of 2 m: rows of the stiffness matrix grow."""
    m = Model()
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=1e9, ks=1e9)
    m.block(0, 0, 0, 2, 8, 2, 8, 0)
    m.split(-1, 1, 9, 1, joint=1, jmaterial=1)
    m.split(4, 0, 4, 1)
    m.split(3, 1, 3, 2)
    m.split(5, 1, 5, 2)
    m.delete(0, 4, 0, 1)
    m.delete(0, 3, 1, 2)
    m.delete(5, 8, 1, 2)
    m.fix(0, 8, 0, 1)
    m.round(0.05)
    m.fraction(0.5, safe=True)
    m.gravity(0, -10)
    m.boundary(3, 5, 1, 2, xvel=2.0)
    m.cycle(1)
    first = float(m.h.cr[g.TDEL])
    m.cycle(int(0.3 / 2.0 / first))
    assert m.table("joint")["KCJKN"].sum() > 1.1 * 1e9
    assert float(m.h.cr[g.TDEL]) < 0.97 * first


@pytest.mark.parametrize("joint", [BARTON, YIELDING], ids=["barton", "yielding"])
def test_insitu_stresses_stay(joint: dict[str, Any]) -> None:
    """The closure agrees with the stress; more than the strength is reported. CHANGE keeps the stress."""
    m = box(joint)
    m.jproperty(2, **BARTON)
    m.insitu(0, LENGTH, 0, 2, -5e6, 0, -5e6)
    drive(m, 0, 0, 10)
    assert state(m)["KCJSN"] == pytest.approx(5e6, rel=1e-9)
    m.change(0, LENGTH, 0.9, 1.1, jmaterial=2)
    drive(m, 0, 0, 10)
    assert state(m)["KCJSN"] == pytest.approx(5e6, rel=1e-9)
    if joint is not BARTON:
        m.jproperty(2, **YIELDING)
        drive(m, 0, 0, 10)
        assert state(m)["KCJSN"] == pytest.approx(5e6, rel=1e-9)
        assert state(m)["KCJV1"] == 0


def test_words_of_a_deck_and_print() -> None:
    m = box(BARTON)
    m.run(
        "JPROPERTY JMATERIAL=2 YIELDING KN=2E8 KS=1E8 F=0.5 IFRICTION=1 ROUGHNESS=2E-3\n"
        "JPROPERTY JMATERIAL=3 BARTON KN=1E10 KS=1E9 F=0.5 JRC=6 JCS=80E6 APERTURE=1E-4\n"
    )
    assert [int(n) for n in m.h.ci[g.JMLAW : g.JMLAW + 4]] == [
        g.BARTON_BANDIS,
        g.CONTINUOUSLY_YIELDING,
        g.BARTON_BANDIS,
        g.UNDEFINED_JOINT,
    ]
    assert m.h.cr[g.JMKNI + 2] == 1e10
    point = granite()
    assert m.h.cr[g.JMKNI] == pytest.approx(point.initial_stiffness())
    assert m.h.cr[g.JMUM1] == pytest.approx(point.first().greatest)
    assert m.h.cr[g.JMUM3] == pytest.approx(point.later().greatest)
    printed = m.print("joints")
    for word in ("BARTON_BANDIS", "CONTINUOUSLY_YIELDING", "JRC", "ROUGHNESS", "JMUM3"):
        assert word in printed


@pytest.mark.parametrize(
    ("joint", "changes", "blamed"),
    [
        (BARTON, {"jrc": 0}, "jrc"),
        (BARTON, {"jcs": 0}, "jcs"),
        (BARTON, {"ks": 0}, "ks"),
        (BARTON, {"sigmac": 40e6}, "sigmac"),
        (BARTON, {"jrc": 0.5, "aperture": 0.5e-2}, "kn"),
        (BARTON, {"jrc": 3, "kn": 1e10, "aperture": 1e-7}, "aperture"),
        (BARTON, {"kn_max": 1e10}, "kn_max"),
        (BARTON, {"unit": "contact"}, "unit"),
        (YIELDING, {"kn": 0}, "kn"),
        (YIELDING, {"roughness": 0}, "roughness"),
        (YIELDING, {"kn_min": 0}, "kn_min"),
        (YIELDING, {"ks_min": 0}, "ks_min"),
        (YIELDING, {"normal_exponent": 1, "kn_max": 0}, "kn_max"),
        (YIELDING, {"kn_max": 1e8}, "kn_max"),
        (YIELDING, {"initial_friction": 0.1}, "initial_friction"),
    ],
)
def test_numbers_without_a_meaning(joint: dict[str, Any], changes: dict[str, Any], blamed: str) -> None:
    m = box(BARTON)
    before = m.h.cr.copy(), m.h.ci.copy(), m.h.ia.copy()
    with pytest.raises(UdecError) as raised:
        m.jproperty(2, **(joint | changes))
    assert (raised.value.number, raised.value.parameter) == (10 if blamed == "unit" else 28, blamed)
    assert all(np.array_equal(a, b) for a, b in zip(before, (m.h.cr, m.h.ci, m.h.ia), strict=True))
