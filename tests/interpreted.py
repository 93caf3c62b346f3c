"""Tests that have kernels interpreted beside compiled ones, where there are both."""

from __future__ import annotations

import pytest
from numba.core import config

from udec_ia.heap import plain

both_ways = pytest.mark.skipif(bool(config.DISABLE_JIT) or plain.wanted(), reason="there is one way only")
