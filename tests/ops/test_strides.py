"""What 32-bit reals make of a steady way, a few last digits in a cycle, is told, with the right numbers."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from udec_ia import Model

CYCLES = 5000
PUSHED = """START
PROP MAT=1 DENSITY=2000 KN=1E9 KS=1E9 FRICTION=0.5 BULK=1E9 G=5E8
BLOCK 0,0 0,3 20,3 20,0
SPLIT -1,1 21,1
SPLIT 12,0.5 12,4
SPLIT 14,0.5 14,4
DELETE 0,12 1,3
DELETE 14,20 1,3
FIX 0,20 0,1
ROUND 0.1
"""
HANGS = """START
PROP MAT=1 DENSITY=2000 KN=1E8 KS=1E8 FRICTION=0.3
BLOCK 0,0 0,10 2,10 2,0
SPLIT -1,1 3,1
SPLIT -1,8 3,8
DELETE 0,2 1,8
FIX 0,2 0,1
ROUND 0.1
GRAVITY 0,-10
"""


def run(
    text: str, build: str, out: Path, cycles: tuple[int, ...] = (CYCLES,)
) -> tuple[list[str], float, float]:
    """What is said of strides and of a given velocity; how far the upper block has gone in x and y."""
    m, said = Model(build, out=out), list[str]()
    m.tell, m.inform = said.append, lambda _: None
    m.run(text)
    before = m.table("block")
    for n in cycles:
        m.cycle(n)
    now = m.table("block")
    k = int(before["KY"].argmax())
    way = [float(now[one][k]) - float(before[one][k]) for one in ("KX", "KY")]
    return [one for one in said if "strides" in one or "BOUNDARY" in one], way[0], way[1]


def numbers(text: str) -> tuple[float, float]:
    """How far a body has gone, and how far it should have."""
    found = re.search(r"it has gone (\S+) m instead of (\S+) m", text)
    assert found
    return float(found[1]), float(found[2])


@pytest.mark.parametrize("speed", [1e-4, 8e-4, 1e-3, 1e-2])
@pytest.mark.parametrize("mesh", ["", "CHANGE 12 14 1 3 SDEF\n", "GEN 12 14 1 3 AUTO EDGE 1\n"])
def test_a_given_velocity_of_few_digits_is_told_before_and_after(
    speed: float, mesh: str, tmp_path: Path
) -> None:
    """The way that is told for the right one is that with 64-bit reals."""
    text = f"{PUSHED}{mesh}BOUNDARY 11 15 0.9 3.1 XVEL {speed}\n"
    (before, after), narrow, _ = run(text, "i32r32", tmp_path)
    silent, wide, _ = run(text, "i32r64", tmp_path)
    assert abs(narrow - wide) > 0.004 * wide
    assert silent == []
    assert before.startswith("BOUNDARY moves")
    gone, right = numbers(after)
    assert gone == pytest.approx(narrow, rel=0.01, abs=1e-7)
    assert right == pytest.approx(wide, rel=0.01)


def test_what_goes_many_digits_in_a_cycle_is_not_told(tmp_path: Path) -> None:
    text = f"{PUSHED}BOUNDARY 11 15 1.1 3 XVEL 1\n"
    said, narrow, _ = run(text, "i32r32", tmp_path, (1000,))
    _, wide, _ = run(text, "i32r64", tmp_path, (1000,))
    assert narrow == pytest.approx(wide, rel=0.004)
    assert said == []


@pytest.mark.parametrize("cycles", [(20_000,), (250,) * 80])
def test_a_block_that_hangs_in_the_air_is_told(cycles: tuple[int, ...], tmp_path: Path) -> None:
    """It has a velocity, and less than half a digit of a way in each cycle; in one CYCLE or after some."""
    text = f"{HANGS}FRACTION 3E-5\n"
    (said,), _, narrow = run(text, "i32r32", tmp_path, cycles)
    _, _, wide = run(text, "i32r64", tmp_path, cycles)
    assert narrow == 0
    gone, right = numbers(said)
    assert gone == 0
    assert right < 0
    if len(cycles) == 1:
        assert right == pytest.approx(wide, rel=0.05)


def test_a_fall_at_a_usual_step_is_not_told(tmp_path: Path) -> None:
    said, _, narrow = run(HANGS, "i32r32", tmp_path, (300,))
    _, _, wide = run(HANGS, "i32r64", tmp_path, (300,))
    assert narrow == pytest.approx(wide, rel=1e-3)
    assert said == []


def test_what_rests_on_its_springs_is_not_told(tmp_path: Path) -> None:
    """Its velocity is less than a digit in a cycle, and it need not go anywhere."""
    text = PUSHED.replace("ROUND 0.1", "ROUND 0.1\nGRAVITY 0,-10\nDAMP 0.5 100 MASS")
    assert run(text, "i32r32", tmp_path)[0] == []


def test_where_all_is_fixed_nothing_is_told(tmp_path: Path) -> None:
    assert run(f"{PUSHED}FIX 0 20 0 3\n", "i32r32", tmp_path, (300, 300))[0] == []


@pytest.mark.parametrize(("turn", "told"), [(1e-5, True), (1.0, False)])
def test_a_block_that_turns_by_few_digits_is_told(turn: float, told: bool, tmp_path: Path) -> None:
    """Its corners go whole digits or none, and it is out of shape."""
    text = HANGS.replace("GRAVITY 0,-10", "CYCLE 0")
    m, said = Model("i32r32", out=tmp_path), list[str]()
    m.inform = lambda _: None
    m.run(text)
    m.tell = said.append
    block = m.table("block")[int(m.table("block")["KY"].argmax())]
    m.patch(f"block@{block['address']}.KTD = {turn}")
    m.cycle(1000)
    assert [one for one in said if "as it turns" in one] == said
    assert bool(said) == told
