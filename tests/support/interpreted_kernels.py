"""Kernels interpreted beside compiled ones, where there are both."""

from __future__ import annotations

from typing import Any

import pytest
from naive.relocate import differences, essence

from udec_ia.compiling.build_choice import DISABLED
from udec_ia.compiling.interpreted_kernels import interpreted
from udec_ia.model import Model

both_ways = pytest.mark.skipif(DISABLED, reason="there is one way only")


def unlike(play: Any, build: str, seed: int) -> list[str]:
    """Fields in which the scene `seed`, played compiled and interpreted in every command, has other bits."""
    compiled = essence(play(seed, Model(build), cycles=(2, 4)).model.array)
    with interpreted():
        found = essence(play(seed, Model(build), cycles=(2, 4)).model.array)
    return differences(compiled, found)
