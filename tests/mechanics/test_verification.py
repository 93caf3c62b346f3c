"""The verification problems, each figure within its tolerance of the exact value."""

from __future__ import annotations

import pytest
from verification import PROBLEMS


@pytest.mark.parametrize("name", PROBLEMS)
def test_problem(name: str) -> None:
    figures = PROBLEMS[name]()
    assert figures
    for figure in figures:
        assert figure.holds, f"{figure.what}: {figure.computed:g}, exact {figure.exact:g}"


def test_footing_without_pairs_of_zones_is_too_strong() -> None:
    """Mixed discretisation is what brings the limit load down to its place."""
    mixed, plain = (figure.error for figure in PROBLEMS["footing"]())
    assert plain > 0.05 > mixed > 0
