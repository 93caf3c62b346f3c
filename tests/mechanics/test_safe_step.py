"""FRACTION ... SAFE over random scenes and through a run in which contacts are made."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from naive.stiffness import Scene
from support.mechanics_scenes import block, box, model, push, sound, step
from support.safe_step_scenes import draw
from support.safe_step_search import LIMITS, ROUNDING, look

from udec_ia import Model
from udec_ia.running.critical_step import bound

JOINTS = (1e8, 1e8)


@pytest.mark.parametrize("kind", LIMITS)
def test_the_bound_is_below_the_true_limit_and_near_it(kind: str) -> None:
    """Stiffness ratios to 1e12, mass ratios to 1e9, slivers, all layouts; the oracle has its own matrices."""
    shares = np.array([look(kind, seed).bound for seed in range(20_000, 20_012)])
    shares = shares[np.isfinite(shares)]
    assert len(shares) > 8
    assert shares.max() <= 1 + ROUNDING
    assert shares.min() >= LIMITS[kind]
    assert np.median(shares) >= 2 / 3


def test_a_scene_is_known_by_its_kind_and_seed() -> None:
    one, other = (draw("deformable", 7).model for _ in range(2))
    np.testing.assert_array_equal(one.table("contact"), other.table("contact"))


def falling() -> Model:
    """A light block high above two heavy ones, which set the time-step until it lands."""
    m = model(*box(0, 6, -3, 3), d=0.02, density=2000.0, stiffness=JOINTS, friction=0.5)
    m.split(-1, 0, 7, 0)
    m.split(-1, -1.5, 7, -1.5)
    for x in (2.9, 3.1):
        m.split(x, -0.01, x, 4)
    m.delete(0, 2.9, 0, 3)
    m.delete(3.1, 6, 0, 3)
    m.split(2, 0.2, 4, 0.2)
    m.split(2, 0.4, 4, 0.4)
    m.delete(2.9, 3.1, 0, 0.2)
    m.delete(2.9, 3.1, 0.4, 3)
    m.fix(0, 6, -3, -1.5)
    m.fraction(0.9, safe=True)
    return m


def test_a_safe_step_is_checked_again_when_contacts_are_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is shortened before they bear a force, and CYCLEs cut otherwise, or a HISTORY, do not matter."""
    monkeypatch.chdir(tmp_path)  # where the history goes
    m, whole, recorded = falling(), falling(), falling()
    recorded.history(1, "TIME")
    for one in (m, whole, recorded):
        one.cycle(0)
        push(one, int(block(one, 3, 0.3)["address"]), yd=-1.0)
    long = step(m)
    for _ in range(40):
        m.cycle(50)
        assert step(m) <= 0.9 * Scene(m, (1.0, 1.0), JOINTS).critical() * (1 + 1e-9)
    whole.cycle(2000)
    recorded.cycle(2000)
    assert step(m) < 0.5 * long
    assert step(m) <= 0.9 * bound(m.array).step * (1 + 1e-12)
    assert abs(float(block(m, 3, 0.1)["KYD"])) < 1.0  # no faster than it came
    for kind in ("block", "contact"):
        np.testing.assert_array_equal(m.table(kind), whole.table(kind))
        for name in ("KXD", "KYD", "KX", "KY") if kind == "block" else ("KCFN", "KCN"):
            np.testing.assert_array_equal(recorded.table(kind)[name], whole.table(kind)[name])
    sound(m)
