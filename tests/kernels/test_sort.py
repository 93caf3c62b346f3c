"""Sorting against the language's own."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from udec_ia.kernels.geometry.box_sweep import stable_order


@given(st.lists(st.integers(-3, 3), max_size=40))
def test_rows_come_in_the_order_of_their_keys_and_equal_keys_as_they_stood(keys: list[int]) -> None:
    expected = sorted(range(len(keys)), key=keys.__getitem__)
    assert list(stable_order(np.array(keys, np.int64))) == expected
