"""The checker and tips thinner than an overlap: what lies on both sides needs no contact of its own."""

from __future__ import annotations

import numpy as np
import pytest

from udec_ia.checker.block_outlines import outlines
from udec_ia.checker.checked_state import State
from udec_ia.checker.missing_contacts import _lies_in_third
from udec_ia.heap.accessors import puti
from udec_ia.layout import offsets as g
from udec_ia.model import Model

# A block sinks by some millimetres into a wedge of 1.4 degrees, whose rounded tip is 1.3 mm thick, on a slab.
WEDGE = """START
PROPERTY MAT=1 DENSITY=2000 KN=2E7 KS=2E7 FRICTION=1
BLOCK 0 0 0 4 4 4 4 0
ROUND 0.05
SPLIT -1 2 5 2
SPLIT -4 1.9 8 2.2
FIX 0 4 0 2.1
GRAVITY 0 -10
DAMP 0.5 5 MASS
FRACTION 0.1
CYCLE 1500
"""


@pytest.mark.parametrize("stiffness", ["2E7", "8E6"])
def test_what_lies_on_both_sides_of_a_thin_tip(stiffness: str) -> None:
    """Without its own contact it is sound, without that of the tip it is not; a softer one sinks deeper."""
    model = Model()
    model.run(WEDGE.replace("2E7", stiffness))
    assert model.check() == []
    h = model.h
    slab, wedge, upper = (
        int(row["address"]) for row in sorted(model.table("block"), key=lambda row: float(row["KY"]))
    )

    def let_go(one: int, two: int) -> None:
        """Take the contact of two blocks at the tip for a virtual one."""
        for contact in model.table("contact"):
            if {int(contact["KB1"]), int(contact["KB2"])} == {one, two} and contact["KXC"] < 0.1:
                puti(h, int(contact["address"]), g.KCCOD, g.VIRTUAL)

    def named() -> bool:
        return any(
            found.invariant == 8 and f"block@{slab}" in found.message and f"block@{upper}" in found.message
            for found in model.check()
        )

    let_go(slab, upper)
    assert not named()
    let_go(wedge, upper)
    assert named()


def test_a_point_lies_in_a_third_block_but_not_in_its_rounded_tip() -> None:
    model = Model()
    model.block(0, 0, 0, 1, 3, 1, 3, 0)
    model.split(1, -1, 1, 2)
    model.split(2, -1, 2, 2)
    model.round(0.2)
    with np.errstate(all="ignore"):
        o = outlines(State(model.array))
    assert o is not None
    (third,) = np.flatnonzero((o.low[:, 0] > 0.9) & (o.high[:, 0] < 2.1))
    others = {0, 1, 2} - {int(third)}
    one, two = others
    for point, there in (
        ((1.5, 0.5), True),
        ((1.01, 0.5), True),
        ((1.01, 0.01), False),
        ((1.003, 0.5), False),
        ((0.99, 0.5), False),
    ):
        assert _lies_in_third(o, np.array(point), 0.005, (one, two)) is there
    assert not _lies_in_third(o, np.array((1.5, 0.5)), 0.005, (one, int(third)))
