"""Joints with joint materials: slip, rotation, modulus, tension and energy in closed forms; the rules."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive import joint_targets as targets

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

K, LENGTH, DENSITY = 1e8, 4.0, 2000.0
WEIGHT = DENSITY * LENGTH * 10  # of a block LENGTH wide and 1 high


def on_joint(d: float = 0.02, **joint: Any) -> Model:
    """A block LENGTH wide and 1 high on a fixed one of the same size, with LOCAL damping."""
    m = Model()
    m.property(1, density=DENSITY)
    m.jproperty(1, **{"kn": K, "ks": K, **joint})
    m.block(0, 0, 0, 2, LENGTH, 2, LENGTH, 0)
    m.split(-1, 1, LENGTH + 1, 1, joint=1, jmaterial=1)
    m.fix(0, LENGTH, 0, 1)
    m.round(d)
    m.damping(local=0.8)
    m.energy("on")
    return m


def stresses(m: Model) -> Any:
    """Rows of the joint table in the order of the contacts along x, of those with a joint material."""
    rows = m.table("joint")[np.argsort(m.table("contact")["KXC"], kind="stable")]
    return rows[rows["KCJMAT"] != 0]


def accounted(m: Model) -> bool:
    """True if the energies balance within 0.1 % of what passed through."""
    balance = m.balance()
    return bool(abs(balance.residual) <= 1e-3 * balance.throughput)


def test_a_block_rests_by_its_weight() -> None:
    """W/(k L), whatever the rounding length."""
    for d in (0.01, 0.1):
        m = on_joint(d, friction=0.5)
        m.gravity(0, -10)
        m.cycle(2500)
        assert m.table("contact")["KCN"] == pytest.approx(WEIGHT / (K * LENGTH), rel=1e-6)
        assert sum(row["KCJL"] for row in stresses(m)) == pytest.approx(LENGTH, rel=1e-9)
        assert m.check() == []


def test_the_form_of_the_report_turns_as_two_ends() -> None:
    """k L p^2/4 with p between the points of application, within 1 %; group 8 has the averages."""
    m = on_joint(unit="ends", friction=3.0)
    m.gravity(2.0, -10)
    m.cycle(4000)
    contacts = m.table("contact")
    left, right = np.argsort(contacts["KXC"])
    p = float(contacts["KXC"][right] - contacts["KXC"][left])
    angle = float(contacts["KCN"][right] - contacts["KCN"][left]) / p
    assert abs(angle) * K * LENGTH * p**2 / 4 == pytest.approx(DENSITY * LENGTH * 2.0 * 0.5, rel=0.01)
    (joint,) = m.table("jointext")
    assert joint["KJL"] == pytest.approx(p, rel=1e-3)
    assert joint["KJSN"] == pytest.approx(WEIGHT / LENGTH, rel=1e-6)
    assert joint["KJUN"] == pytest.approx(WEIGHT / LENGTH / K, rel=1e-6)
    assert abs(joint["KJTS"]) == pytest.approx(DENSITY * 2.0, rel=1e-4)
    elastic = joint["KJUS"] - m.table("joint")["KCJSLIP"].mean()
    assert abs(elastic) == pytest.approx(DENSITY * 2.0 / K, rel=1e-3)
    assert accounted(m)
    assert m.check() == []


def test_the_form_of_the_report_slips_as_a_whole() -> None:
    """At L c + f W, although one end alone would slip at nine tenths: the block leans on the other one."""
    m = on_joint(unit="ends", friction=0.4, cohesion=1e3)
    m.gravity(0, -10)
    m.cycle(2000)
    strength = (LENGTH * 1e3 + 0.4 * WEIGHT) / (DENSITY * LENGTH)  # as an acceleration
    for share in (0.2, 0.4, 0.6, 0.8, 0.9, 0.97):
        m.gravity(share * strength, -10)
        m.cycle(1000)
    joints = m.table("joint")
    assert (np.abs(joints["KCJTS"]) > 1e3 + 0.4 * joints["KCJSN"]).any()
    assert (joints["KCJSLIP"] == 0).all()
    m.gravity(1.03 * strength, -10)
    m.cycle(500)
    assert (m.table("joint")["KCJFLAG"] & g.JOINT_SLIPS).all()
    assert np.abs(m.table("joint")["KCJSLIP"]).min() > 1e-4


def test_the_form_of_the_report_slips_at_a_closed_end() -> None:
    """One end is open: the other has the friction of its own stress, not of the average."""
    m = on_joint(unit="ends", friction=0.5)
    for cycles, given in (
        (40, {"yvel": -2e-3, "xvel": 0.0, "rotation": 0.0}),
        (40, {"yvel": 0.0, "xvel": 0.0, "rotation": 2e-3}),
        (200, {"yvel": 0.0, "xvel": 1e-2, "rotation": 0.0}),
    ):
        m.boundary(0, LENGTH, 1.4, 1.6, **given)
        m.cycle(cycles)
    closed, opened = stresses(m)
    assert closed["KCJSN"] > 0
    assert opened["KCJSN"] == opened["KCJTS"] == 0
    assert abs(closed["KCJTS"]) == pytest.approx(0.5 * closed["KCJSN"], rel=1e-9)


def test_a_force_stays_as_the_unit_changes() -> None:
    """INSITU of 1980, then a joint material per length, per contact and with ends; then INSITU of nothing."""
    m = Model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, friction=1.0)
    m.block(0, 0, 0, 2, LENGTH, 2, LENGTH, 0)
    m.split(-1, 1, LENGTH + 1, 1, joint=1)
    m.fix(0, LENGTH, 0, 2)
    m.round(0.02)
    m.insitu(0, LENGTH, 0, 2, -1e5, 0, -2e5)
    m.cycle(1)
    force = float(m.table("contact")["KCFN"].sum())
    assert force == pytest.approx(2e5 * LENGTH, rel=1e-6)
    m.jproperty(1, kn=K, ks=K, friction=1.0)
    m.change(-1, 5, 0.9, 1.1, jmaterial=1)
    for unit in ("length", "contact", "ends", "contact", "length"):
        m.jproperty(1, unit=unit)
        m.cycle(2)
        assert float(m.table("contact")["KCFN"].sum()) == pytest.approx(force, rel=1e-6), unit
    m.insitu(0, LENGTH, 0, 2, 0, 0, 0)
    m.cycle(2)
    assert float(np.abs(m.table("contact")["KCFN"]).max()) == pytest.approx(0, abs=1e-6 * force)


def test_a_joint_material_does_not_glue_a_gap() -> None:
    m = on_joint(d=0.1)
    m.gravity(0, 1)
    while m.table("contact")["KCN"].max() > -0.1 * 0.1:
        m.cycle(5)
    m.jproperty(2, kn=K, ks=K, tension=1e9)
    m.change(-1, 5, 0.5, 1.5, jmaterial=2)
    m.jproperty(3, kn=K, ks=K, tension=1e9, between=(1, 1))
    m.cycle(1)
    assert len(m.table("contact")) > 0
    assert (m.table("contact")["KCFN"] == 0).all()


def test_ends_of_joints_that_come_and_go() -> None:
    """Blocks that topple and slide off: extensions follow the map, and the state is sound in every cycle."""
    m = Model()
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=K, ks=K, friction=0.3, unit="ends", between=(1, 1))
    m.block(0, 0, 0, 4, 4, 4, 4, 0)
    for y in (1, 2, 3):
        m.split(-1, y, 5, y + 0.1)
    m.split(2, -1, 2.1, 5)
    m.fix(0, 4, 0, 0.9)
    m.round(0.05)
    m.gravity(6, -10)
    counts = set()
    for _ in range(60):
        m.cycle(25)
        assert m.check() == []
        counts.add(len(m.table("jointext")))
    assert len(counts) > 1
    m.jproperty(1, unit="length")
    assert len(m.table("jointext")) == 0
    assert m.check() == []


@pytest.mark.parametrize("sideways", [0.5, 2.0, 5.0, 12.0, 16.0])
def test_a_block_leans_as_on_a_uniform_joint(sideways: float) -> None:
    """Closed (e < L/6) and partly open: moment and angle of the closed form, to a part in a hundred."""
    m = on_joint(friction=3.0)
    m.gravity(sideways, -10)
    m.cycle(4000)
    left, right = sorted(
        m.table("contact").tolist(), key=lambda row: row[m.table("contact").dtype.names.index("KXC")]
    )
    names = m.table("contact").dtype.names
    x, u = names.index("KXC"), names.index("KCN")
    angle = (right[u] - left[u]) / (right[x] - left[x])
    moment = DENSITY * LENGTH * sideways * 0.5
    assert targets.rocking_moment(K, LENGTH, WEIGHT, angle) == pytest.approx(moment, rel=0.01)
    assert accounted(m)


def test_the_slip_force_is_that_of_the_whole_length() -> None:
    """L (c + s tan phi) at every slip, although contacts pass from edge to edge."""
    m = Model()
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=K, ks=K, friction=0.5, cohesion=4.4e4)
    m.block(0, -1, 0, 1, 7, 1, 7, -1)
    m.split(-1, 0, 8, 0, joint=1, jmaterial=1)
    m.split(1, 0, 1, 1)
    m.split(6, 0, 6, 1)
    m.delete(0, 1, 0, 1)
    m.delete(6, 7, 0, 1)
    m.fix(0, 7, -1, 0)
    m.round(0.02)
    m.energy("on")
    m.boundary(0.9, 6.1, 0.9, 1.1, stress=(0, 0, -1e5))
    m.damping(local=0.8)
    m.cycle(1500)
    m.boundary(3.4, 3.6, 0.4, 0.6, xvel=0.01)
    for _ in range(3):
        m.cycle(400)
        force = -float(m.table("contact")["KCFS"].sum())
        assert force == pytest.approx(targets.slip_force(5.0, 4.4e4, 1e5, 0.5), rel=1e-3)
    assert accounted(m)


@pytest.mark.parametrize(
    ("kind", "n", "edge"), [("sdef", 5, 0), ("sdef", 10, 0), ("fdef", 5, 0.5), ("fdef", 5, 0.3)]
)
def test_the_modulus_of_a_jointed_bar(kind: str, n: int, edge: float) -> None:
    """1/E_m = 1/E + 1/(kn S), whatever the mesh and the number of blocks, to half a per cent."""
    bulk, shear, kn, side = 5e9, 3e9, 8e9, 5 / n
    m = Model()
    m.property(1, density=2500, bulk=bulk, g=shear)
    m.jproperty(1, kn=kn, ks=4e9, friction=0.6)
    m.block(0, 0, 0, 1, 5, 1, 5, 0)
    for k in range(1, n):
        m.split(k * side, -1, k * side, 2, joint=1, jmaterial=1)
    m.fix(0, side, 0, 1)
    m.round(0.02)
    if kind == "sdef":
        m.change(side, 5, 0, 1, type="sdef")
    else:
        for k in range(n - 1):
            m.generate(side, 5, 0, 1, "automatic", edge=edge + 0.07 * k)
    m.boundary(4.9, 5.1, -1, 2, stress=(-1e6, 0, 0))
    assert m.solve(1e-7, static=True).reached
    young = 4 * shear * (3 * bulk + shear) / (3 * bulk + 4 * shear)  # plane strain, free across
    exact = 1e6 * ((5 - side) / young + (n - 1) / kn)
    assert 5 - float(m.table("corner")["KXP"].max()) == pytest.approx(exact, rel=5e-3)


def test_a_glued_cantilever_breaks_at_its_tensile_strength() -> None:
    """Turns as h^3/12 until T h^2/6, then breaks at the root; contacts are D inside the edge, 0.4 % late."""
    m = Model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e10, ks=1e10, cohesion=1e6, tension=1e6)
    m.block(0, 0, 0, 1, 5, 1, 5, 0)
    for x in (1, 2, 3, 4):
        m.split(x, -1, x, 2, joint=1, jmaterial=1)
    m.fix(0, 1, 0, 1)
    m.round(0.002)
    m.damping(local=0.8)
    for weight in (3.0, 6.0, 8.0, 9.0, 9.8, 10.1, 10.3):
        m.gravity(0, -weight)
        m.cycle(3000)
    rows = m.table("contact")
    root = rows[np.abs(rows["KXC"] - 1) < 0.1]
    turn = abs(np.diff(root["KCN"])[0] / np.diff(root["KYC"])[0])
    assert turn == pytest.approx(
        targets.root_moment(DENSITY, 10.3, 1, 4) / targets.rotation_stiffness(1e10, 1), rel=1e-3
    )
    assert not (m.table("joint")["KCJFLAG"] & g.JOINT_BROKEN).any()
    assert targets.root_moment(DENSITY, 10.55, 1, 4) > targets.breaking_moment(1e6, 1) * 1.004
    m.gravity(0, -10.55)
    m.cycle(3000)
    assert float(m.table("block")["KY"].min()) < 0.4  # it falls


def rules(order: str = "pair line") -> Model:
    """Three blocks with a bed joint of joint 3, a head joint of the pair, and a range."""
    m = Model()
    m.property(1, density=DENSITY, kn=1e8, ks=1e8)
    m.jproperty(1, kn=K, ks=K)
    m.jproperty(2, kn=2 * K, ks=K, between=(1, 1))
    m.jproperty(3, kn=3 * K, ks=K)
    m.block(0, 0, 0, 2, 4, 2, 4, 0)
    m.split(-1, 1, 5, 1, joint=3, jmaterial=1)
    m.split(2, 1, 2, 3)
    return m


def materials(m: Model) -> dict[tuple[float, float], int]:
    """Joint material of each contact by its place; 0 without one."""
    return {
        (round(float(c["KXC"]), 1), round(float(c["KYC"]), 1)): int(row["KCJMAT"])
        for c, row in zip(m.table("contact"), m.table("joint"), strict=True)
    }


def test_range_before_joint_before_pair_of_materials() -> None:
    m = rules()
    m.round(0.1)
    by_place = materials(m)
    assert {material for (_, y), material in by_place.items() if y == 1.0} == {1}
    assert {material for (_, y), material in by_place.items() if y > 1.05} == {2}
    assert m.change(1.8, 2.2, 1.5, 2.1, jmaterial=3) == 1
    assert sorted(materials(m).values()) == [1, 1, 1, 1, 2, 3]
    m.jproperty(2, between=(1, 2))  # no such pair any more
    assert sorted(materials(m).values()) == [0, 1, 1, 1, 1, 3]
    assert m.check() == []


def test_a_contact_that_forms_later_on_a_joint_has_its_material() -> None:
    """A block slides along its bed joint to another block, which was cut off below the same joint."""
    m = Model()
    m.property(1, density=DENSITY, kn=1e8, ks=1e8)
    m.jproperty(1, kn=K, ks=K)
    m.block(0, 0, 0, 2, 4, 2, 4, 0)
    m.split(-1, 1, 5, 1, joint=3, jmaterial=1)
    m.split(2, -1, 2, 1)
    m.split(1, 1, 1, 3)
    m.delete(1, 4, 1, 2)
    m.fix(0, 4, 0, 1)
    m.round(0.05)
    m.gravity(0, -10)
    m.damping(local=0.8)
    m.cycle(500)
    m.boundary(0.4, 0.6, 1.4, 1.6, xvel=1.0)
    before = {frozenset((int(c["KB1"]), int(c["KB2"]))) for c in m.table("contact")}
    while float(m.table("block")["KX"][m.table("block")["KY"] > 1][0]) < 1.8:
        m.cycle(100)
    after = m.table("contact")
    new = {
        int(row["KCJMAT"])
        for c, row in zip(after, m.table("joint"), strict=True)
        if frozenset((int(c["KB1"]), int(c["KB2"]))) not in before and c["KCFN"] > 0
    }
    assert new == {1}
    assert m.check() == []


def test_a_restart_changes_no_bit(tmp_path: Path) -> None:
    m = on_joint(friction=0.3, tension=1e3, cohesion=1e3)
    m.gravity(2.0, -10)
    m.cycle(700)
    m.save(tmp_path / "a.h5")
    m.cycle(700)
    other = Model()
    other.restart(tmp_path / "a.h5")
    other.cycle(700)
    used = int(m.h.ci[g.MFREE]) - 1
    assert np.array_equal(m.h.ia[:used], other.h.ia[:used])


def test_wrong_numbers_change_nothing() -> None:
    m = on_joint()
    before = m.h.cr.copy(), m.h.ci.copy(), m.h.ia.copy()
    for wrong, number in (
        (lambda: m.jproperty(51, kn=1, ks=1), 4),
        (lambda: m.jproperty(2, kn=1e8), 28),
        (lambda: m.jproperty(1, friction=-1.0), 28),
        (lambda: m.jproperty(1, model="other"), 10),
        (lambda: m.jproperty(1, between=(1, 99)), 4),
        (lambda: m.change(0, 9, 0, 9, jmaterial=7), 4),
        (lambda: m.change(0, 9, 0, 9, jmaterial=1, material=1), 10),
        (lambda: m.split(1, 0, 1, 3, jmaterial=9), 4),
        (lambda: m.split(1, 0, 1, 3, joint=201), 4),
        (lambda: m.split(1, 0, 1, 3, joint=1, jmaterial=9), 4),
    ):
        with pytest.raises(UdecError) as raised:
            wrong()
        assert raised.value.number == number
    assert all(np.array_equal(a, b) for a, b in zip(before, (m.h.cr, m.h.ci, m.h.ia), strict=True))


@pytest.mark.parametrize("loaded", [False, True])
def test_a_gap_between_two_roundings_is_no_tension(loaded: bool) -> None:
    """Two joints cross at 8 degrees, so that two of the four corners are 0.05 D apart."""
    m = Model()
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=5e8, ks=5e8, friction=0.6, cohesion=1e6, tension=5e5, between=(1, 1))
    m.block(0, 0, 0, 4, 4, 4, 4, 0)
    m.split(-1, 2, 5, 2)
    m.split(-1, 1.7, 5, 2.3)
    m.round(0.01)
    stress = -1e6 if loaded else 0.0
    if loaded:
        for face in ((-0.1, 0.1, -1, 5), (3.9, 4.1, -1, 5), (-1, 5, -0.1, 0.1), (-1, 5, 3.9, 4.1)):
            m.boundary(*face, stress=(stress, 0.0, stress))
        m.insitu(-1, 5, -1, 5, stress, 0.0, stress)
    m.cycle(500)
    at_gap = m.table("contact")["KCN"] < -0.04 * 0.01
    sn = m.table("joint")["KCJSN"]
    assert at_gap.sum() == 1
    assert sn[~at_gap] == pytest.approx(-stress, rel=1e-6, abs=1e-3)
    assert abs(sn[at_gap][0]) < 1.0  # the contact of two corners, on which INSITU puts nothing


def test_less_friction_is_not_more_strength_under_tension() -> None:
    """At the first slip the shear stress stays below the peak strength, c + f sn."""
    m = on_joint(friction=1.2, cohesion=1e6, tension=5e5, residual_friction=0.0, kn=1e10, ks=1e10)
    m.boundary(0, LENGTH, 1.1, 1.9, xvel=0.0, yvel=4e-2, rotation=0.0)
    m.cycle(time=1e-3)
    m.boundary(0, LENGTH, 1.1, 1.9, xvel=0.1, yvel=0.0, rotation=0.0)
    m.cycle(time=2e-3)
    for row in stresses(m):
        assert row["KCJSN"] < -1e5
        assert abs(row["KCJTS"]) == pytest.approx(1e6 + 1.2 * row["KCJSN"], rel=1e-6)


def separate_blocks(**joint: Any) -> Model:
    """Two blocks without contact, cut by a numbered joint; `joint`: of a joint material, if it is given."""
    m = Model()
    m.property(1, density=2500)
    if joint:
        m.jproperty(1, between=(1, 1), **joint)
    m.block(0, 0, 0, 1, 3, 1, 3, 0)
    m.split(1, -1, 1, 2, joint=3)
    m.split(2, -1, 2, 2, joint=3)
    m.fix(0, 1, 0, 1)
    m.delete(1, 2, 0, 1)
    return m


def test_blocks_apart_have_the_stiffness_of_joint_materials() -> None:
    m = separate_blocks(kn=1e10, ks=1e9)
    m.cycle(1)
    assert m.h.ci[g.NVIRT] == m.h.ci[g.NCON] == 1
    assert m.h.cr[g.TDEL] == pytest.approx(m.h.cr[g.FRAC] * 2 * np.sqrt(2500 / 1e10))


def test_blocks_apart_without_any_stiffness_are_an_error() -> None:
    m = separate_blocks()
    with pytest.raises(UdecError) as caught:
        m.cycle(1)
    assert caught.value.number == 11


def test_short_steps_follow_a_property_that_is_written_directly() -> None:
    """What a joint material allows is found at each CYCLE, also if no command has come."""
    m = on_joint(unit="length")
    m.cycle(10)
    allowed = m.h.ci[g.JMSHORT]
    m.array.h.cr[g.JMDIL] = 0.1
    m.cycle(1)
    assert allowed & g.SPRINGS_ALONE != 0
    assert m.h.ci[g.JMSHORT] & g.SPRINGS_ALONE == 0
