"""Limits of halved steps, the significant digits of samples, and least sets."""

from __future__ import annotations

import math
import random

import pytest

from udec_ia.studies.extrapolation import converges, extrapolate
from udec_ia.studies.significant_digits import shared_digits


@pytest.mark.parametrize("order", [1, 2])
def test_what_converges_is_extrapolated(order: int) -> None:
    found = extrapolate([3 + 0.1 * 2.0 ** (-order * k) for k in range(3)])
    assert found is not None
    assert found.value == pytest.approx(3, abs=1e-12)
    assert found.order == pytest.approx(order)
    assert found.error == pytest.approx(1.25 * 0.1 * 4.0**-order)


def test_an_order_above_that_of_the_formulation_is_not_believed() -> None:
    values = [1 + 0.1 * 2.0 ** (-2.7 * k) for k in range(4)]
    found, sought = extrapolate(values), extrapolate(values, 12.0)
    assert found is not None
    assert sought is not None
    assert found.error == pytest.approx(abs(values[3] - values[2]))
    assert abs(sought.value - 1) < 1e-12 < abs(found.value - 1) < found.error


def test_the_error_is_a_bound_where_the_first_order_leads() -> None:
    for seed in range(200):
        r = random.Random(seed)
        a = r.uniform(-1, 1)
        b = a * r.uniform(-0.5, 0.5)
        values = [5 + a * h + b * h * h for h in (1, 0.5, 0.25, 0.125)]
        found = extrapolate(values)
        assert abs(found.value - 5) <= found.error * (1 + 1e-9)


def test_what_scatters_has_the_finest_value_and_its_spread() -> None:
    found = extrapolate([1.0, 1.4, 0.9])
    assert found is not None
    assert (found.value, found.error) == (0.9, pytest.approx(1.0))
    assert math.isnan(found.order)
    assert not converges([1.0, 1.4, 0.9])
    assert extrapolate([1.0, math.nan]).error == math.inf


def test_errors_are_shares_of_the_limit() -> None:
    found = extrapolate([2.0, 2.0, 2.0])
    assert found is not None
    assert (found.error, found.error_of(2.002)) == (0.0, pytest.approx(1e-3))
    assert found.error_of(math.nan) == math.inf


def test_the_digits_are_those_of_the_spread() -> None:
    r, sigma = random.Random(7), 1e-6
    found = shared_digits([1 + r.gauss(0, sigma) for _ in range(1000)], 52)
    assert found is not None
    assert found.digits == pytest.approx(6, abs=0.05)
    assert found.mean == pytest.approx(1, abs=1e-6)


def test_equal_results_have_all_digits_that_words_have() -> None:
    found = shared_digits([0.5] * 4, 23)
    assert found is not None
    assert found.digits == pytest.approx(24 * math.log10(2))
    assert shared_digits([1.0, math.nan, math.inf], 52) is None
