"""What SOLVE says of what moves at its end: it has hardly begun, it falls, or it has landed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model, UdecError

COLUMN = """START
PROP MAT=1 DENSITY=2000 KN=1E9 KS=1E9 FRICTION=0.5
BLOCK 0,0 0,10 2,10 2,0
SPLIT -1,1 3,1
SPLIT -1,4 3,4
SPLIT -1,7 3,7
FIX 0,2 0,1
ROUND 0.1
GRAVITY 0,-10
"""
SLOPE = """START
PROP MAT=1 DENSITY=2000 KN=1E8 KS=1E8 FRICTION=0.49
BLOCK 0,0 0,8 10,8 10,0
SPLIT -1,0.5 11,6.5
SPLIT 5,3 5,9
SPLIT 7,4 7,9
SPLIT 4,6 8,6
DELETE 0,10 6,8
DELETE 0,5 3,8
FIX 0,10 0,4
ROUND 0.1
GRAVITY 0,-10
"""
HANGS = """START
PROP MAT=1 DENSITY=2600 KN=2E9 KS=1E9 FRICTION=0.5
BLOCK 0,0 0,10 10,10 10,0
SPLIT -1,1 11,1
SPLIT -1,5 11,5
SPLIT 5,1 5,11
SPLIT 0.5,5 0.5,11
SPLIT -1,5.4 0.6,5.4
DELETE 0 0.5 5.5 11
DELETE 0 5 1 5
FIX 0 10 0 1
FIX 5 10 1 5
FIX 0.6 5 5 11
ROUND 0.02
GRAVITY 0 -10
"""


def made(text: str, out: Path, build: str = "i32r64") -> Model:
    m = Model(build, out=out)
    m.tell = m.inform = lambda _: None
    m.run(text)
    return m


@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
@pytest.mark.parametrize("fraction", [1e-9, 1e-5])
def test_a_tiny_step_is_no_collapse_and_no_want_of_digits(
    fraction: float, build: str, tmp_path: Path
) -> None:
    m = made(COLUMN, tmp_path, build)
    m.damping(local=0.8)
    m.fraction(fraction)
    solution = m.solve(1e-4, limit=1000)
    assert solution.state == "hardly begun"
    assert "take a greater FRACTION, or SOLVE 0.0001 STATIC" in solution.why
    m.fraction(0.1)
    assert m.solve(1e-4, limit=3000) or build == "i32r32"


def test_a_block_in_the_air_falls_and_one_that_has_landed_rests(tmp_path: Path) -> None:
    """It hangs over a pit of 4 m among fixed blocks."""
    m = made(HANGS, tmp_path)
    first = m.solve(1e-4, limit=2000, static=True)
    assert first.state == "collapse"
    blocks = m.table("block")
    loose = blocks["address"][int(np.hypot(blocks["KX"] - 0.25, blocks["KY"] - 3.9).argmin())]
    assert f"no contact bears block@{loose} " in first.why
    m = made(HANGS, tmp_path)
    last = m.solve(1e-4, limit=30_000, static=True)
    assert last
    assert last.state != "still moves"
    assert m.solve(1e-6, limit=1000, static=True)  # which is to be reached, as it rests


def test_what_has_just_landed_does_not_creep(tmp_path: Path) -> None:
    whole = made(HANGS, tmp_path).solve(1e-4, limit=30_000, static=True).cycles
    solution = made(HANGS, tmp_path).solve(1e-4, limit=whole - 20, static=True)
    assert not solution
    assert solution.state == "settles"


def test_damping_that_acts_already_is_no_cure(tmp_path: Path) -> None:
    """In long reals the last digits are no cause, and in so few cycles nothing comes to rest."""
    m = made(COLUMN, tmp_path)
    m.damping(local=0.001)
    solution = m.solve(1e-9, limit=400)
    assert solution.state == "swings"
    assert "LOCAL damping takes 0.001" in solution.why
    assert "take DAMPING LOCAL 0.8" not in solution.why


def test_damping_of_strains_is_not_said_to_act_in_a_rigid_model(tmp_path: Path) -> None:
    m = made(COLUMN, tmp_path)
    m.damping(0.5, 10, "internal")
    assert "INTERNAL" not in m.solve(1e-9, limit=400).why
    m.property(1, bulk=1e9, g=5e8)
    m.change(0, 2, 1, 10, type="sdef")
    told: list[str] = []
    m.inform = told.append
    m.explain_step = True
    m.cycle(1)
    assert any("INTERNAL damping" in one for one in told)


@pytest.mark.parametrize("static", [False, True])
def test_joints_too_soft_for_the_rounding_are_told_of_before_and_after(static: bool, tmp_path: Path) -> None:
    m = made(COLUMN.replace("KN=1E9 KS=1E9", "KN=1E6 KS=1E6").replace("ROUND 0.1", "ROUND 0.01"), tmp_path)
    told: list[str] = []
    m.tell = told.append
    with pytest.raises(UdecError) as refused:
        m.solve(1e-4, limit=5000, static=static)
    assert refused.value.number == 15
    assert "a greater KN" in str(refused.value)
    assert any("bears it at an overlap of 0.06 m; more than 0.005 m is error 15" in one for one in told)


def test_a_block_that_falls_at_its_terminal_speed_does_not_settle(tmp_path: Path) -> None:
    """Mass damping holds its speed down, and it moves by less than a tenth of the rounding length."""
    m = made(
        COLUMN.replace("GRAVITY 0,-10", "DELETE 0,2 1,7\nGRAVITY 0,-1").replace("ROUND 0.1", "ROUND 0.3"),
        tmp_path,
    )
    m.damping(0.5, 5, "mass")
    solution = m.solve(1e-4, limit=800)
    assert solution.state == "collapse"
    assert "nothing holds what moves most" in solution.why


def test_what_a_law_lets_creep_does_not_settle(tmp_path: Path) -> None:
    """Its shear force fades by a thousandth in a cycle; the pace is the same after twice as many cycles."""
    law = tmp_path / "law.py"
    law.write_text("def clj2(fn, fs, dun, dus, un, us, m):\n    return m.kn * dun, m.ks * dus - 0.001 * fs\n")
    m = Model(out=tmp_path, constitutive=str(law))
    m.tell = m.inform = lambda _: None
    m.run(COLUMN.replace("GRAVITY 0,-10", "CHANGE 0 2 0 10 CONS=2\nGRAVITY 3,-10"))
    m.damping(0.5, 5, "mass")
    found = [m.solve(1e-6, limit=4000) for _ in range(2)]
    assert [one.state for one in found] == ["creep", "creep"]
    assert all("the law of its contacts lets it" in one.why for one in found)


@pytest.mark.parametrize(("local", "state"), [(0.8, "settles"), (0.0, "swings")])
def test_whether_it_loses_energy_is_told_by_energy(local: float, state: str, tmp_path: Path) -> None:
    """And not by the kinetic energy of some moments of the swing."""
    text = COLUMN.replace("FIX 0,2 0,1", "CHANGE 0 2 1 10 SDEF\nFIX 0,2 0,1").replace(
        "FRICTION", "BULK 1E9 G 6E8 FRICTION"
    )
    m = made(text, tmp_path)
    if local:
        m.damping(local=local)
    solution = m.solve(1e-9, limit=1000)
    assert not solution
    assert solution.state == state


def test_what_slips_on_slower_than_before_is_no_rest(tmp_path: Path) -> None:
    """A slope steeper than friction bears, heavily damped: the ratio is reached, and it goes on."""
    m = made(SLOPE, tmp_path)
    m.damping(adaptive=0.99)
    m.cycle(300)
    solution = m.solve(0.05, limit=60_000)
    assert solution
    assert solution.state == "still moves"
