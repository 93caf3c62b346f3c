"""The checker and concave corners: the outline is sharp there, and the circle's centre is no point of it."""

from __future__ import annotations

import pytest

from udec_ia.heap.accessors import getr, puti, putr
from udec_ia.layout import offsets as g
from udec_ia.model import Model
from udec_ia.reader.list_walks import corners, groups

# A funnel that narrows towards a thin slab: circles of its concave corners reach into what lies beside them.
FUNNEL = """START
BLOCK 0 0 0 10 10 10 10 8 8 8 1.15 1.02 1.8 8 1 8 1 1 10 1 10 0
SPLIT -1 9 11 9
SPLIT 1.2 7 9 7
SPLIT 1.1 5 9 5
"""
NOTCH = """START
BLOCK 0 0 0 4 4 4 2 2 4 1 7 1 6 2 9 3 9 0
SPLIT 5 1.2 10 1.2
"""


def test_a_circle_that_reaches_into_a_neighbour() -> None:
    model = Model()
    model.run(FUNNEL)
    slab = min(
        groups(model.h, "block"),
        key=lambda block: abs(getr(model.h, block, g.KY) - 6) + abs(getr(model.h, block, g.KX) - 4.1),
    )
    x, y = float(getr(model.h, slab, g.KX)), float(getr(model.h, slab, g.KY))
    model.delete(x - 0.01, x + 0.01, y - 0.01, y + 0.01)
    model.round(0.3)
    assert model.check() == []


def place_tip(model: Model, x: float) -> tuple[int, int]:
    """The body and the wedge of NOTCH; the wedge is put with its tip at x, and the contacts are let go."""
    body, wedge = sorted(groups(model.h, "block"), key=lambda block: float(getr(model.h, block, g.KX)))
    tip = min(float(getr(model.h, corner, g.KXP)) for corner in corners(model.h, wedge))
    for group, fields in [(wedge, (g.KX,)), *((c, (g.KXP, g.KXCP)) for c in corners(model.h, wedge))]:
        for field in fields:
            putr(model.h, group, field, float(getr(model.h, group, field)) + x - tip)
    for contact in groups(model.h, "contact"):
        puti(model.h, contact, g.KCCOD, g.VIRTUAL)
    return body, wedge


@pytest.mark.parametrize("d", [0.05, 0.14])
def test_a_wedge_in_a_notch(d: float) -> None:
    """In the notch, whose sides are nowhere rounded, it meets nothing; beyond the corner it overlaps."""
    model = Model()
    model.run(NOTCH)
    model.round(d)
    place_tip(model, 3.0)
    assert not any(found.invariant == 8 for found in model.check())
    body, wedge = place_tip(model, 1.0)
    assert any(
        found.invariant == 8 and f"block@{body}" in found.message and f"block@{wedge}" in found.message
        for found in model.check()
    )
