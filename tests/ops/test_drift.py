"""What 32-bit reals round on the way is told after a run, where it counts against the way, and only there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model

CYCLES = 3000
COLUMN = """START
PROP MAT=1 DENS=2000 KN=2E8 KS=1E8 FRICTION=0.6 BULK=3E8 G=2E8
BLOCK 0,0 0,6 2,6 2,0
SPLIT -1 2 3 2
SPLIT -1 4 3 4
FIX 0 2 0 2
CHANGE 0 2 2 6 SDEF
ROUND 0.1
GRAVITY 1,-10
DAMP 0.3 5 MASS
"""
FALL = COLUMN.replace("FIX 0 2 0 2", "FIX 0 2 0 2\nDELETE 0 2 2 4")


def told(text: str, build: str, out: Path, runs: int = 1) -> tuple[list[str], np.ndarray]:
    """What is said of digits in some runs, CYCLES in all; centroids at the end."""
    m, said = Model(build, out=out), list[str]()
    m.tell = said.append
    m.run(text)
    start = m.table("block")
    for _ in range(runs):
        m.cycle(CYCLES // runs)
    now = m.table("block")
    away = np.stack([now[k].astype(float) - start[k] for k in ("KX", "KY")], axis=1)
    return [one for one in said if "digit" in one], away


@pytest.mark.parametrize("runs", [1, 30])
def test_what_32_bit_reals_lose_of_a_short_way_is_told(runs: int, tmp_path: Path) -> None:
    """Once, however many CYCLEs it is; and it is lost indeed."""
    said, narrow = told(COLUMN, "i32r32", tmp_path, runs)
    silent, wide = told(COLUMN, "i32r64", tmp_path, runs)
    way = np.hypot(*wide.T).max()
    assert np.hypot(*(narrow - wide).T).max() > 0.01 * way
    assert silent == []
    (text,) = said
    assert "reals of 32 bits, whose last digit is" in text
    assert f"of the {way:.1g}"[:8] in text


def test_what_moves_far_is_not_told(tmp_path: Path) -> None:
    """A block falls by two metres, and is where it is to be."""
    said, narrow = told(FALL, "i32r32", tmp_path)
    _, wide = told(FALL, "i32r64", tmp_path)
    assert np.hypot(*(narrow - wide).T).max() < 0.003 * np.hypot(*wide.T).max()
    assert said == []


def test_what_rests_is_not_told(tmp_path: Path) -> None:
    """Where nothing moves at all, nothing is lost: without gravity, and from a settled state on."""
    still = COLUMN.replace("GRAVITY 1,-10\n", "")
    assert told(still, "i32r32", tmp_path)[0] == []


def test_blocks_that_are_cut_begin_anew(tmp_path: Path) -> None:
    """Of too few cycles nothing is said, and the way of other blocks is no way of these."""
    m, said = Model("i32r32", out=tmp_path), list[str]()
    m.tell = said.append
    m.run(COLUMN)
    m.cycle(150)
    m.split(-1, 5, 3, 5)
    m.cycle(150)
    assert not any("moved places" in one for one in said)
