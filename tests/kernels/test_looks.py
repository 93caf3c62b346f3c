"""When open contacts look at their neighbours: each time something in a domain has moved by HTOL."""

from __future__ import annotations

import pytest

from udec_ia.layout.offsets import ETOL, HTOL, TDEL, ULOOK
from udec_ia.model import Model

FAST = 30.0  # HTOL a cycle: no domain pass waits
DECK = """START
PROPERTY MAT=1 DENSITY=2000 KN=1E8 KS=1E8 FRICTION=0
BLOCK 0 0 0 2 1 2 1 0
SPLIT -1 1 2 1
ROUND 0.1
FRACTION 0.001
CYCLE 0
"""


def flying(apart: float) -> Model:
    """Two blocks that are going to fly side by side, the upper one faster by `apart` HTOL a cycle."""
    model = Model()
    model.run(DECK)
    speed = float(model.h.cr[HTOL] / model.h.cr[TDEL])
    for y, more in ((0.5, 0.0), (1.5, apart)):
        assert model.boundary(-1, 2, y - 0.1, y + 0.1, xvel=(FAST + more) * speed, yvel=0) == 1
    return model


def sums(model: Model, n: int) -> list[float]:
    """ULOOK in HTOL after each of `n` cycles."""
    found = []
    for _ in range(n):
        model.cycle(1)
        found.append(float(model.h.cr[ULOOK] / model.h.cr[HTOL]))
    return found


def test_blocks_that_fly_together_do_not_look() -> None:
    """However fast."""
    assert max(sums(flying(0.0), 20)) < 1e-6


def test_what_moves_in_a_domain_is_summed_until_they_look() -> None:
    """By 0.4 HTOL a cycle: they look in every third one."""
    assert sums(flying(0.4), 7) == pytest.approx([0.4, 0.8, 1.2, 0.4, 0.8, 1.2, 0.4], rel=1e-6)


def test_they_look_when_a_domain_is_updated() -> None:
    """Which is when the sum of a domain has come to ETOL, 100 HTOL."""
    model = flying(0.4)
    before = 0.0
    for _ in range(300):
        model.cycle(1)
        most = max(float(u) for u in model.table("domain")["KUMAX"])
        if most < before:  # it has been updated in this cycle, and its sum begins anew
            break
        before = most
    assert before > 0.98 * float(model.h.cr[ETOL])
    assert model.h.cr[ULOOK] == model.h.cr[HTOL]
