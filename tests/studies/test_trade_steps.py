"""Another time-step has other numbers of cycles, for the same time."""

from __future__ import annotations

import random

import pytest

from udec_ia.studies.settings import FIT, Setting, count_cycles, expected_cycles, share_of_bound
from udec_ia.studies.survey_run import Segment


def segment(asked: int, step: float, solve: bool = False, bound: float = 0.02) -> Segment:
    return Segment(asked, solve, 0.0, step, 0.1, False, bound, done=asked)


def ends(survey: list[Segment], setting: Setting) -> list[tuple[float, float, float]]:
    """Of each CYCLE: when it should end, when it does, and its step."""
    found = count_cycles(survey, setting)
    ideal = real = 0.0
    times = []
    for one, n in zip(survey, found.cycles, strict=True):
        step = (setting.safe * one.bound if setting.safe else setting.step * one.step) * found.fit
        ideal += one.asked * one.step
        real += (n or 0) * step
        times.append((ideal, real, step))
    return times


@pytest.mark.parametrize("step", [0.5, 0.25, 2.0])
def test_halves_and_doubles_are_exact(step: float) -> None:
    found = count_cycles([segment(300, 0.002), segment(200, 0.001)], Setting(step=step))
    assert found.fit == 1
    assert found.cycles == (300 / step, 200 / step)
    assert found.longer == (1 / step, 1 / step)


def test_any_step_ends_every_cycle_within_half_a_step() -> None:
    for seed in range(200):
        r = random.Random(seed)
        survey = [
            segment(r.randint(50, 2000), 10 ** r.uniform(-3, -2), bound=10 ** r.uniform(-2, -1.5))
            for _ in range(r.randint(1, 6))
        ]
        setting = Setting(step=10 ** r.uniform(-1, 0.3)) if r.random() < 0.7 else Setting(safe=0.3)
        assert 1 - FIT <= count_cycles(survey, setting).fit <= 1
        before = 0.0
        for ideal, real, step in ends(survey, setting):
            assert abs(real - ideal) <= 0.5 * max(step, before) * (1 + 1e-9)
            before = step


def test_a_single_cycle_command_is_always_exact() -> None:
    for seed in range(100):
        r = random.Random(seed)
        survey = [segment(r.randint(100, 3000), 0.001)]
        ((ideal, real, _),) = ends(survey, Setting(step=r.uniform(0.2, 4)))
        assert real == pytest.approx(ideal, rel=1e-9)


def test_solve_is_left_to_itself() -> None:
    survey = [segment(100_000, 0.001, solve=True), segment(0, 0.001)]
    found = count_cycles(survey, Setting(step=0.5, ratio=0.1))
    assert found.cycles == (None, 0)
    assert expected_cycles(survey, found, Setting(step=0.5, ratio=0.1)) > 2 * 100_000


def test_the_share_of_the_bound() -> None:
    assert share_of_bound([segment(10, 0.002), segment(10, 0.004)], Setting(step=3)) == pytest.approx(0.6)
