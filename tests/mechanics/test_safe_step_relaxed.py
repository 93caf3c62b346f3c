"""FRACTION ... SAFE with what leads to rest: LOCAL, COMBINED and KINETIC damping change the critical step.

What swings as fast as the step lets it turns about in every cycle. LOCAL damping then adds its share to the
force that turns it; KINETIC damping must begin a step from rest with half of the force.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any

import numpy as np
import pytest
from support.mechanics_scenes import box, model

from udec_ia import Model
from udec_ia.layout import offsets as g
from udec_ia.running.critical_step import bound
from udec_ia.running.mass_scaling import scale_anew
from udec_ia.running.stiffness_bound import damped_step

DAMPINGS: dict[str, dict[str, Any]] = {
    "local": {"local": 0.8},
    "combined": {"combined": 0.8},
    "kinetic": {"kinetic": True},
}


def column(heights: list[float], **damping: Any) -> Model:
    """Blocks on each other in a corner of two fixed ones, the weight askew, so that all joints are closed."""
    top = sum(heights)
    m = model(*box(-1, 1, -1, top), d=min(heights) / 50, density=2500.0, stiffness=(1e9, 5e8), friction=5.0)
    for y in np.cumsum([0, *heights[:-1]]):
        m.split(-2, float(y), 2, float(y))
    m.split(0, -2, 0, top + 1)
    m.fix(-1, 1, -1, 0)
    m.fix(-1, 0, -1, top)
    m.gravity(-3, -10)
    m.damping(**damping)
    return m


def energy(m: Model) -> float:
    """Twice that of motion along x and y."""
    blocks = m.table("block")
    return float((blocks["KBM"] * (blocks["KXD"] ** 2 + blocks["KYD"] ** 2)).sum())


@pytest.mark.parametrize("how", DAMPINGS)
@pytest.mark.parametrize("heights", [[1.0] * 8, [1.0, 0.05, 1.0]], ids=["equal", "thin"])
@pytest.mark.parametrize("share", [0.7, 0.99])
def test_a_safe_step_leads_to_rest(heights: list[float], how: str, share: float) -> None:
    m = column(heights, **DAMPINGS[how])
    m.fraction(share, safe=True)
    m.cycle(20)
    before = energy(m)
    m.cycle(2000)
    assert energy(m) < 1e-3 * before
    assert m.check() == []


def grows(force: Callable[[float, float, float], float], step: float) -> bool:
    """True if x'' = force(x, v, force of the cycle before) of frequency 1 grows in steps of that length."""
    x, v, last = 1.0, 0.0, 0.0
    for _ in range(4000):
        f = -x
        v += step * force(f, v, last)
        x += step * v
        last = f
        if abs(x) > 1e6:
            return True
    return False


@pytest.mark.parametrize("f", [0.1, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("how", ["local", "combined"])
def test_the_critical_step_is_that_of_an_oscillator(how: str, f: float) -> None:
    """Bisected over runs of one mass on a spring, whose critical step is 2 without damping."""

    def force(now: float, v: float, last: float) -> float:
        share = np.sign(v) if how == "local" else (np.sign(v) - np.sign(now - last)) / 2
        return float(now - f * abs(now) * share)

    low, high = 0.5, 2.5
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (low, middle) if grows(force, middle) else (middle, high)
    m = column([1.0], **{how: f})
    assert damped_step(m.h, 2.0) == pytest.approx(2 / sqrt(1 + f), rel=1e-12)
    assert damped_step(m.h, 2.0) <= low + 1e-4
    assert damped_step(m.h, 2.0) > 0.98 * low


@pytest.mark.parametrize("share", [0.5, 0.9, 0.99])
def test_kinetic_damping_never_swings_farther_than_it_began(share: float) -> None:
    """A block on its joint goes from rest as A cos(n w): no overlap is above that of the first swing."""
    m = model(*box(0, 1, -1, 1), d=0.02, density=2500.0, stiffness=(1e9, 1e9), friction=0.5)
    m.split(-1, 0, 2, 0)
    m.fix(0, 1, -1, 0)
    m.gravity(0, -10)
    m.damping(kinetic=True)
    m.fraction(share, safe=True)
    rest, greatest = 2500.0 * 10 / 2e9, 0.0
    for _ in range(400):
        m.cycle(1)
        closed = m.table("contact")
        greatest = max(greatest, float(closed["KCFN"][closed["KCCOD"] != g.VIRTUAL].max()) / 1e9)
    assert rest < greatest <= 2 * rest * (1 + 1e-9)


@pytest.mark.parametrize("how", DAMPINGS)
@pytest.mark.parametrize("beta", [0.0, 1e-4])
def test_masses_that_are_scaled_anew_suit_the_damping(how: str, beta: float) -> None:
    """Where nothing has changed they are what they were: the step is the same, and as safe."""
    m = column([1.0, 0.2, 1.0], **DAMPINGS[how])
    m.h.cr[g.BETA] = beta
    m.fraction(0.9, scaled=True)
    m.cycle(0)
    before = m.table("relax")
    m.h.ci[g.MSCALE] = -1  # as if contacts had been made since
    scale_anew(m.array)
    after = m.table("relax")
    assert len(before) > 2
    for name in ("KRXM", "KRXI"):
        np.testing.assert_allclose(after[name], before[name], rtol=1e-9)
    assert float(m.h.cr[g.TDEL]) <= 0.9 * damped_step(m.h, bound(m.array).step) * (1 + 1e-9)
