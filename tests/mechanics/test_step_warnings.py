"""Warnings of a time-step near the safe bound, and how often they come."""

from __future__ import annotations

from typing import Any

import pytest
from support.mechanics_scenes import box, model

from udec_ia import Model, UdecError

NEAR = "step-near-bound"


def resting(build: str = "i32r64", ks: float = 1e8, d: float = 0.1, gravity: float = 10.0) -> Model:
    """A square on a fixed one."""
    m = model(*box(0, 1, -1, 1), d=d, density=2000.0, stiffness=(2e8, ks), friction=0.5, build=build)
    m.split(-1, 0, 2, 0)
    m.fix(0, 1, -1, 0)
    m.gravity(0, -gravity)
    return m


def collect_warnings(m: Model) -> list[str]:
    """The keys of all warnings from now on."""
    keys: list[str] = []
    m.tell = lambda warning: keys.append(getattr(warning, "key", ""))
    return keys


@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
@pytest.mark.parametrize("damps", [True, False])
@pytest.mark.parametrize("share", [0.5, 0.9, 1.0])
def test_impacts_are_warned_of_near_the_bound_if_nothing_damps(build: str, damps: bool, share: float) -> None:
    m = resting(build)
    printed = collect_warnings(m)
    if damps:
        m.damping(local=0.5)
    m.fraction(share, safe=True)
    for _ in range(3):
        m.cycle(10)
    assert [one for one in printed if one.startswith("step")] == [NEAR] * (not damps and share > 0.8)


def test_a_block_that_is_thrown_up_is_told_of_before_and_stopped_with_a_cure() -> None:
    """With hardly any shear stiffness the bound is the limit of the swing itself, and each landing gains."""
    m = resting(ks=1e6, d=0.45)
    printed = collect_warnings(m)
    m.fraction(0.9, safe=True)
    with pytest.raises(UdecError, match=r"more energy than was put in(.|\n)*take FRACTION 0\.45 SAFE"):
        m.cycle(3000)
    assert NEAR in printed


@pytest.mark.parametrize("damp", [{"fcrit": 0.3, "freq": 30, "only": "stiffness"}, {"local": 0.8}])
def test_a_safe_step_is_told_as_the_share_that_was_asked_for(damp: dict[str, Any]) -> None:
    """The bound is what damping leaves of it."""
    m = resting()
    m.damping(**damp)
    m.fraction(0.9, safe=True)
    m.cycle(1)
    assert ", 0.9 of the safe bound with its damping" in m.step_limits()


def test_what_reals_resolve_is_told_once_though_its_numbers_change() -> None:
    m = resting("i32r32", gravity=0.001)
    printed = collect_warnings(m)
    m.damping(0.5, 100, "mass")
    m.fraction(0.1, safe=True)
    for place in (1.0, 30.0, 100.0):
        m.gravity(0, -0.001 * place)
        m.cycle(2)
    assert printed.count("coarse-reals") == 1
