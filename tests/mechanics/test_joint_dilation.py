"""The joint law that comes with the program in direct shear, against closed forms.

One contact in a shear box: the shear displacement is given in steps; either the normal displacement is
held, or it follows so that the normal force stays.
"""

from __future__ import annotations

import numpy as np
import pytest

from udec_ia.laws.joint_dilation import clj2
from udec_ia.layout.material import Material

KN, KS = 1e9, 5e8
FRICTION, COHESION, RESIDUAL, REST = 0.8, 2e4, 0.5, 5e3
DILATION, CRITICAL = 0.2, 2e-3
LOAD = 1e5
EPS = float(np.finfo(float).eps)
PEAK = COHESION + FRICTION * LOAD


def material(**others: float) -> Material:
    numbers = {
        "kn": KN, "ks": KS, "friction": FRICTION, "cohesion": COHESION, "residual_friction": RESIDUAL,
        "residual_cohesion": REST, "dilation": DILATION, "critical_slip": CRITICAL,
    }  # fmt: skip
    return Material(**{**dict.fromkeys(Material._fields, 0.0), **numbers, **others})


class Box:
    """A shear box with one contact, loaded by `fn`. opened: how far it has given way since."""

    def __init__(self, m: Material, fn: float = LOAD) -> None:
        self.m, self.fn, self.fs, self.us, self.opened = m, fn, 0.0, 0.0, 0.0

    @property
    def slip(self) -> float:
        return self.us - self.fs / KS

    def shear(self, u: float, steps: int, gives_way: bool) -> None:
        """Shear by `u`. A box that gives way opens until the normal force is what it was."""
        for _ in range(steps):
            un = self.fn / KN - self.opened
            dfn, dfs = clj2(self.fn, self.fs, 0.0, u / steps, un, self.us, self.m)
            self.fs += dfs
            self.us += u / steps
            if gives_way:
                self.opened += dfn / KN
            else:
                self.fn += dfn


def strength(slip: float, fn: float = LOAD) -> float:
    w = min(slip / CRITICAL, 1)
    return COHESION + w * (REST - COHESION) + (FRICTION + w * (RESIDUAL - FRICTION)) * fn


def test_peak_residual_and_dilation_under_a_constant_load() -> None:
    """Elastic up to the peak; then the joint weakens as it slips, and opens by DILATION times the slip.

    The strength is that of the slip before the step: late by what the joint slips in a step.
    """
    box, steps = Box(material()), 1000
    box.shear(PEAK / KS, 10, gives_way=True)
    assert box.fs == pytest.approx(PEAK, rel=100 * EPS)
    assert box.opened == pytest.approx(0, abs=100 * EPS * PEAK / KS)
    for i in range(1, 4):
        box.shear(0.4 * CRITICAL, steps, gives_way=True)
        in_a_step = 2 * 0.4 * CRITICAL / steps  # not 1, as the spring lets go while the strength falls
        assert strength(box.slip) <= box.fs <= strength(box.slip - in_a_step)
        assert box.opened == pytest.approx(DILATION * min(box.slip, CRITICAL), rel=1e5 * EPS)
        assert (box.slip > CRITICAL) == (i == 3)
    assert box.fs == pytest.approx(REST + RESIDUAL * LOAD, rel=100 * EPS)
    assert box.opened == pytest.approx(DILATION * CRITICAL, rel=1e5 * EPS)


def test_a_joint_that_cannot_open_is_pressed_together() -> None:
    """The normal force grows by KN DILATION times the slip until that is critical, the strength with it."""
    box = Box(material())
    box.shear(PEAK / KS + 4 * CRITICAL, 4000, gives_way=False)
    pressed = LOAD + KN * DILATION * CRITICAL
    assert box.fn == pytest.approx(pressed, rel=1e5 * EPS)
    assert box.fs == pytest.approx(REST + RESIDUAL * pressed, rel=1e5 * EPS)


def test_going_back_closes_the_joint() -> None:
    """The opening is that of the slip as it is: nothing where it began, the same on either side."""
    box = Box(material())
    for u in (PEAK / KS + CRITICAL / 2, -CRITICAL / 2, -CRITICAL, -CRITICAL):
        box.shear(u, 1000, gives_way=True)
        assert box.opened == pytest.approx(DILATION * min(abs(box.slip), CRITICAL), rel=1e5 * EPS)
    assert box.slip < -CRITICAL


def test_without_a_critical_slip_it_is_coulombs_law() -> None:
    box = Box(material(critical_slip=0.0))
    for u in (3e-3, -5e-3, 1e-4):
        box.shear(u, 100, gives_way=False)
        before = box.fs
        assert box.fn == LOAD
    box.shear(3e-3, 100, gives_way=False)
    assert abs(before) < PEAK
    assert box.fs == pytest.approx(PEAK, rel=100 * EPS)


def test_a_joint_that_is_pulled_apart_bears_nothing() -> None:
    assert clj2(10.0, 3.0, -11.0 / KN, 0.0, 1e-8, 0.0, material()) == (-10.0, -3.0)
