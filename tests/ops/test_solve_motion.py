"""What SOLVE reports of blocks that move or have moved at its end, and of what damps."""

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


def test_a_block_in_the_air_falls_and_one_that_has_landed_rests(tmp_path: Path) -> None:
    """It hangs over a pit of 4 m among fixed blocks."""
    m = made(HANGS, tmp_path)
    blocks = m.table("block")
    loose = int(blocks["address"][int(np.hypot(blocks["KX"] - 0.25, blocks["KY"] - 5.2).argmin())])
    first = m.solve(1e-4, limit=2000, static=True)
    assert not first
    assert first.fallen == (loose,)
    assert f"block@{loose} at (" in str(first)
    m = made(HANGS, tmp_path)
    last = m.solve(1e-4, limit=30_000, static=True)
    assert last
    assert last.fallen == (loose,)
    assert m.solve(1e-6, limit=1000, static=True)  # which is to be reached, as it rests


def test_damping_of_strains_is_not_said_to_act_in_a_rigid_model(tmp_path: Path) -> None:
    m = made(COLUMN, tmp_path)
    m.damping(0.5, 10, "internal")
    assert "INTERNAL" not in str(m.solve(1e-9, limit=400))
    m.property(1, bulk=1e9, g=5e8)
    m.change(0, 2, 1, 10, type="sdef")
    told: list[str] = []
    m.inform = told.append
    m.explain_step = True
    m.cycle(1)
    assert any("INTERNAL damping" in one for one in told)


@pytest.mark.parametrize("static", [False, True])
def test_joints_too_soft_for_the_rounding_are_error_15(static: bool, tmp_path: Path) -> None:
    m = made(COLUMN.replace("KN=1E9 KS=1E9", "KN=1E6 KS=1E6").replace("ROUND 0.1", "ROUND 0.01"), tmp_path)
    with pytest.raises(UdecError) as refused:
        m.solve(1e-4, limit=5000, static=static)
    assert refused.value.number == 15
    assert "a greater KN" in str(refused.value)
