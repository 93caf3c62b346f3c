"""The values of variables in a study: ranges, lists, grids, and messages on those that are not."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from udec_ia.studies.sweep import grid, values_of


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("0.3:0.9:7", [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]),
        ("10:30:3", [10, 20, 30]),
        ("0:1:3", [0.0, 0.5, 1.0]),
        ("5:-5:2", [5, -5]),
        ("1e6:1E9:4:log", [1e6, 1e7, 1e8, 1e9]),
        ("8:1:4:log", [8.0, 4.0, 2.0, 1.0]),
        (" 0.1, 2,SDEF ", [0.1, 2, "SDEF"]),
        ("0.5", [0.5]),
    ],
)
def test_values(text: str, values: list[object]) -> None:
    found = values_of("F", text)
    assert found == values
    assert [type(one) for one in found] == [type(one) for one in values]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("1:2", "a range is first:last:number"),
        ("1:2:x", "a range is first:last:number"),
        ("a:2:3", "a range is first:last:number"),
        ("1:2:1", "a range has 2 to 1000000 values, not 1"),
        ("1:2:3:lin", "'lin' is not a kind of range"),
        ("0:2:3:log", "begins and ends above 0"),
        ("1,,2", 'F cannot be ""'),
        ("1,a b", 'F cannot be "a b"'),
        ("1e999:2:3", "a range is first:last:number"),
        ("nan", 'F cannot be "nan"'),
        ("0.1,0.10", "F has the value 0.1 twice"),
        ("1:1:2", "F has the value 1 twice"),
    ],
)
def test_what_is_said_of_others(text: str, reason: str) -> None:
    with pytest.raises(ValueError, match="F") as caught:
        values_of("F", text)
    assert reason in str(caught.value)


def test_values_from_python() -> None:
    assert values_of("F", 0.5) == [0.5]
    assert values_of("F", np.array([1, 2])) == [1, 2]
    assert values_of("F", np.int64(3)) == [3]
    for wrong in ([], [None], [float("inf")], [True]):
        with pytest.raises(ValueError, match="F"):
            values_of("F", wrong)
    with pytest.raises(ValueError, match="not the name of a variable"):
        values_of("2F", 1)
    with pytest.raises(ValueError, match="1 is not the name of a variable"):
        grid({1: [2]})  # type: ignore[dict-item]
    for huge in ([10**400], "1" + "0" * 400, [-(10**5000)]):
        with pytest.raises(ValueError, match=r"F cannot be greater than 1\.8e\+308"):
            values_of("F", huge)


@given(st.decimals(-1000, 1000, places=3), st.decimals(-1000, 1000, places=3), st.integers(2, 40))
def test_a_range_is_rounded_once(a: Decimal, b: Decimal, n: int) -> None:
    """Each value is the real that is nearest to the exact one: no other is nearer to it."""
    if a == b:
        return
    for k, value in enumerate(values_of("F", f"{a}:{b}:{n}")):
        exact = Fraction(a) + (Fraction(b) - Fraction(a)) * k / (n - 1)
        off = [
            abs(Fraction(one) - exact) for one in (value, np.nextafter(value, -9e9), np.nextafter(value, 9e9))
        ]
        assert off[0] == min(off)


def test_a_grid_has_all_combinations_and_the_last_variable_changes_first() -> None:
    assert grid({"f": [1, 2], "N": "a,b"}) == [
        {"F": 1, "N": "a"},
        {"F": 1, "N": "b"},
        {"F": 2, "N": "a"},
        {"F": 2, "N": "b"},
    ]
    with pytest.raises(ValueError, match="given twice"):
        grid({"f": 1, "F": 2})
