"""Tests that have no meaning in the checked build."""

from __future__ import annotations

import pytest

from udec_ia.compiling.build_choice import CHECKED

without_groups = pytest.mark.skipif(CHECKED, reason="uses words where no group is, which this build refuses")
with_any_offset = pytest.mark.skipif(
    CHECKED, reason="gives offsets of no field, which this build cannot name"
)
