"""Energy of joints with a material: the account closes whatever happens, and losses are those of theory."""

from __future__ import annotations

import numpy as np
import pytest

from udec_ia.model import Model

COLUMN = """START
PROP MAT=1 DENS=2000
JPROPERTY JMATERIAL=1 KN=2E8 KS=1E8 FRICTION=0.8 BETWEEN 1 1
BLOCK 0,0 0,4 1,4 1,0
SPLIT -1,1 2,1
ROUND {round}
FIX 0 1 0 1
GRAVITY {gx} -10
FRACTION 0.0625
ENERGY ON
"""
LAYERS = """START
PROP MAT=1 DENS=2000 BULK=1E9 G=6E8
JPROPERTY JMATERIAL=1 KN=1E9 KS=5E8 FRICTION=0.6 BETWEEN 1 1
BLOCK 0,0 0,3 4,3 4,0
SPLIT -1,1 5,1
ROUND 0.02
FIX 0 4 0 1
GRAVITY 0 -10
DAMPING LOCAL 0.8
ENERGY ON
CYCLE TIME 1
"""
SHEARED = """START
PROP MAT=1 DENS=2600
JPROPERTY JMATERIAL=1 KN=10E9 KS=1E9 FRICTION=0.7 COHESION=5E5 {more}
BLOCK 0,0 0,2 4,2 4,0
SPLIT -1,1 5,1 JOINT=1 JMATERIAL=1
FIX 0 4 0 1
ROUND 0.1
ENERGY ON
BOUNDARY 0 4 1.2 1.8 XVEL=0 YVEL=-1E-3 ROTATION=0
CYCLE TIME 0.1
BOUNDARY 0 4 1.2 1.8 XVEL=0.01 YVEL=0 ROTATION=0
CYCLE TIME {time}
"""
BENT = """START
PROP MAT=1 DENSITY=2500
JPROPERTY JMATERIAL=1 KN=1E10 KS=5E9 FRICTION=0.6 COHESION=4E5 TENSION=4E5 RCOHESION=0
BLOCK 0,-0.1 0,0.1 0.2,0.1 0.2,-0.1
SPLIT -1,0 1,0 JOINT=1 JMATERIAL=1
ROUND 0.005
FIX 0 0.2 -0.1 0
FRACTION 0.1 SAFE
DAMPING LOCAL=0.8
BOUNDARY -0.01 0.21 0.09 0.11 STRESS 0 0 -1E5
SOLVE 1E-5
ENERGY ON
BOUNDARY 0 0.2 0 0.1 ROTATION=0.01
CYCLE TIME 0.1
"""
SOFT = """START
PROP MAT=1 DENS=2600 BULK=10E9 G=5E9
JPROPERTY JMATERIAL=1 KN=10E9 KS=5E9 FRICTION=0.6 COHESION=1E7 BETWEEN 1 1
BLOCK 0,0 0,4 4,4 4,0
SPLIT -1,1 5,1
ROUND 0.05
FIX 0 4 0 1
CHANGE 0 4 1 4 SDEF
GRAVITY {gx} -10
DAMPING LOCAL=0.8
ENERGY ON
CYCLE 3000
"""
BARTON = "BARTON JRC=8 JCS=1E8 APERTURE=1E-3 KN=5E8 KNMAX=5E9 KS=2E8 FRICTION=1"
YIELDING = "YIELDING KN=2E8 KS=1E8 FRICTION=0.8 IFRICTION=0.8 ROUGHNESS=1E-3"
COULOMB = "KN=2E8 KS=1E8 FRICTION=0.8"
STRESSED = "JPROPERTY JMATERIAL=1 KN=2E9 KS=1E9 "
DECKS = {  # and the greatest part of the throughput that may be missing
    "rocks": (COLUMN.format(round=0.1, gx=4) + "CYCLE TIME 0.3", 1e-3),
    "loses a contact": (COLUMN.format(round=0.03, gx=4) + "CYCLE TIME 0.22", 5e-3),
    "rocks, BARTON": (COLUMN.format(round=0.03, gx=1.5).replace(COULOMB, BARTON) + "CYCLE TIME 0.06", 1e-3),
    "rocks, YIELDING": (COLUMN.format(round=0.03, gx=4).replace(COULOMB, YIELDING) + "CYCLE TIME 0.2", 5e-3),
    "breaks in bending": (BENT, 1e-3),
    "dilates": (SHEARED.format(more="DILATION=0.2 CRITICAL=5E-3", time=0.3), 1e-6),
    "dilates and weakens": (SHEARED.format(more="RCOHESION=0 DILATION=0.2 CRITICAL=5E-3", time=0.15), 1e-6),
    "is strained": (SOFT.format(gx=0), 1e-5),
    "is strained and sheared": (SOFT.format(gx=3), 1e-5),
    "gets another unit": (LAYERS + STRESSED + "CONTACT", 1e-6),
    "gets its ends": (LAYERS + STRESSED + "ENDS", 1e-6),
    "is cut": (LAYERS + "SPLIT 1.7,-1 1.7,5\nCYCLE 20", 1e-6),
    "gets zones": (LAYERS + "CHANGE 0 4 1 3 FDEF\nGENERATE 0 4 1 3 AUTOMATIC EDGE=1\nCYCLE 20", 1e-6),
}


def played(deck: str) -> Model:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(deck + "\n")
    return m


@pytest.mark.parametrize("what", DECKS)
def test_account_of_a_joint_closes(what: str) -> None:
    deck, missing = DECKS[what]
    balance = played(deck).balance()
    assert abs(balance.residual) < missing * balance.throughput


def test_a_break_in_bending_loses_the_energy_of_the_part_in_tension() -> None:
    """p_t T^2/6 KN of the part p_t in tension between both contacts, and D T^2/2 KN beyond the broken one."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(BENT.rsplit("CYCLE", 1)[0])
    for _ in range(4000):
        m.cycle(1)
        sn = m.table("joint")["KCJSN"]
        if (sn == 0).any():
            break
    tension, kn, d, p = 4e5, 1e10, 0.005, 0.19
    part = p * tension / (tension + sn.max())
    expected = tension**2 / kn * (part / 6 + d / 2)
    assert m.balance().friction == pytest.approx(expected, rel=0.02)  # T is reached within a step


def test_slip_of_a_strained_block_is_that_at_the_resultant() -> None:
    """It grows from the centre of the joint on, as far as the corner moves at the end."""
    m = played(SOFT.format(gx=0))
    corner = m.table("corner")["KXP"].max() - 4
    joints, contacts = m.table("joint"), m.table("contact")
    place = abs(contacts["KXC"] - 2) - abs(joints["KCJX"])
    assert np.abs(contacts["KCS"]) == pytest.approx(corner * place / 2, rel=1e-3)
    assert np.abs(contacts["KCFS"]) == pytest.approx(5e9 * np.abs(contacts["KCS"] * joints["KCJL"]), rel=1e-9)


def test_a_dilating_joint_that_weakens_slips_to_its_strength() -> None:
    """Its cohesion c goes, and it slips by c/(KS + f KN a): the normal stress rises by KN a of each slip."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(SHEARED.format(more="RCOHESION=0 DILATION=0.2", time=0))
    for _ in range(5000):
        m.cycle(1)
        joints = m.table("joint")
        if (joints["KCJSLIP"] != 0).all():
            break
    kn, ks, friction, cohesion, dilation = 10e9, 1e9, 0.7, 5e5, 0.2
    assert joints["KCJTS"] == pytest.approx(ks * (m.table("contact")["KCS"] - joints["KCJSLIP"]), rel=1e-9)
    assert abs(joints["KCJTS"]) == pytest.approx(friction * joints["KCJSN"], rel=1e-9)
    expected = cohesion / (ks + friction * kn * dilation)
    assert abs(joints["KCJSLIP"]) == pytest.approx(expected, rel=0.01)  # and what it moves in the step


def test_a_contact_whose_open_neighbour_is_removed_keeps_its_length() -> None:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(COLUMN.format(round=0.03, gx=4) + "CYCLE TIME 0.19\n")
    for _ in range(200):
        before = m.table("joint")
        m.cycle(1)
        if len(m.table("joint")) == 1:
            break
    assert len(m.table("joint")) == 1
    held = before[before["KCJSN"] > 0]
    m.cycle(2)
    after = m.table("joint")
    assert held["KCJL"][0] > 1.5 * 2 * 0.03
    assert after["KCJL"][0] == pytest.approx(held["KCJL"][0], rel=0.01)


@pytest.mark.parametrize("command", ["SPLIT 1.7,-1 1.7,5", "SPLIT 2.9,-1 2.9,5"])
def test_cutting_stressed_joints_leaves_them_at_rest(command: str) -> None:
    m = played(LAYERS + command)
    top, weight = m.table("contact"), 2000 * 10 * 4 * 2
    on_base = abs(top["KYC"] - 1) < 1e-3
    assert top["KCFN"][on_base].sum() == pytest.approx(weight, rel=1e-6)
    joints = m.table("joint")
    m.cycle(1)
    assert m.table("joint")["KCJSN"] == pytest.approx(joints["KCJSN"], abs=1)


def test_cutting_a_partly_open_joint_keeps_its_force() -> None:
    m = played(COLUMN.format(round=0.03, gx=4) + "CYCLE TIME 0.15")
    before = m.table("contact")["KCFN"].sum()
    assert (m.table("joint")["KCJSN"] == 0).any()
    m.run("SPLIT 0.5,0.8 0.5,5\n")
    m.cycle(1)
    contacts = m.table("contact")
    on_base = abs(contacts["KYC"] - 1) < 0.02
    assert contacts["KCFN"][on_base].sum() == pytest.approx(before, rel=0.05)


def test_cutting_far_away_changes_nothing() -> None:
    m = played(COLUMN.format(round=0.03, gx=4) + "CYCLE TIME 0.15")
    fields = ("KCJL", "KCJSN", "KCJOFF", "KCJFLAG")
    before = [m.table("joint")[name].tolist() for name in fields]
    m.run("SPLIT -1,3 2,3\n")
    joints, contacts = m.table("joint"), m.table("contact")
    old = abs(contacts["KYC"] - 1) < 0.02
    assert [joints[name][old].tolist() for name in fields] == [pytest.approx(one, rel=1e-2) for one in before]


@pytest.mark.parametrize("y", [0, 0.1, 0.25])
def test_rounding_does_not_weaken_a_joint(y: float) -> None:
    """An unloaded joint has stresses of rounding, which differ with its place."""
    deck = f"""START
PROP MAT=1 DENS=2000
JPROPERTY JMATERIAL=1 KN=2E8 KS=1E8 FRICTION=0.6 TENSION=2E4 RFRICTION=0.1
JPROPERTY JMATERIAL=2 KN=4E8 KS=2E8 FRICTION=0.3 RCOHESION=0 COHESION=1E5 BETWEEN 1 1
BLOCK 0,{y} 0,{y + 6} 8,{y + 6} 8,{y}
SPLIT -1 {y + 1} 9 {y + 1}
SPLIT -1 {y + 3.45} 9 {y + 3.74} JOINT=1 JMATERIAL=1
SPLIT -1 {y + 4.3} 9 {y + 4} JOINT=1 JMATERIAL=1
ROUND 0.03125
FIX -1 9 {y} {y + 1}
GRAVITY 7.68 -10
CYCLE 3"""
    assert not played(deck).table("joint")["KCJFLAG"].any()


def test_dilation_of_a_partly_open_joint() -> None:
    """A block that leans and slides: the work against dilation is that of the part that is closed."""
    m = Model()
    m.run("""START
PROP MAT=1 DENS=2600
JPROPERTY JMATERIAL=1 KN=2E9 KS=1E9 F=0.3 DILATION=0.2 BETWEEN 1 1
BLOCK 0,0 0,3 9,3 9,0
SPLIT -1,1 10,1
SPLIT 7,1 7,4
SPLIT 8,1 8,4
DELETE 0 7 1 3
DELETE 8 9 1 3
ROUND 0.01
FIX 0 9 0 1
GRAVITY -8 -10
ENERGY ON
FRACTION 0.1
CYCLE TIME 0.1
""")
    balance = m.balance()
    assert abs(balance.residual) < 1e-3 * balance.throughput
