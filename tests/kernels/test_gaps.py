"""Third blocks in the gaps of open contacts: what comes through such a gap meets what is behind it."""

from __future__ import annotations

import pytest
from support.watched_model import Over, WatchedModel

from udec_ia.model import Model

D = 0.1
GAP = 0.4 * D  # between two fixed blocks, which have a contact across it

# Two fixed blocks with a gap between them, and two needles of 9 degrees that point into it from both sides.
NEEDLES = f"""START
PROPERTY MAT=1 DENSITY=2000 KN=1E8 KS=1E8 FRICTION=0
BLOCK 0 0 0 6 4 6 4 0
SPLIT -1 3.15 5 3.15
SPLIT -1 2.85 5 2.85
SPLIT {2 - GAP / 2} 2.8 {2 - GAP / 2} 3.2
SPLIT {2 + GAP / 2} 2.8 {2 + GAP / 2} 3.2
DELETE 1.9 2.1 2.9 3.1
SPLIT 2.0913 3.14 1.8583 6.1
SPLIT 1.9087 3.14 2.1417 6.1
SPLIT 2.0913 2.86 1.8583 -0.1
SPLIT 1.9087 2.86 2.1417 -0.1
"""


def needles() -> Model:
    """The model of NEEDLES, with nothing left above and below but the needles."""
    model = Model()
    model.run(NEEDLES)
    for row in model.table("block"):
        x, y = float(row["KX"]), float(row["KY"])
        needle = abs(x - 2) < 1e-6 and not 1.7 < y < 4.3
        if not needle and not 2.85 < y < 3.15:
            model.delete(x - 1e-3, x + 1e-3, y - 1e-3, y + 1e-3)
    return model


@pytest.mark.parametrize("share", [0.03, 0.2, 0.9])
def test_two_needles_that_meet_in_a_gap_have_a_contact(share: float) -> None:
    """However fast they come there: `share` is what both together go in a cycle, in rounding lengths."""
    stage = WatchedModel(model=needles())
    model = stage.model
    model.round(D)
    model.fix(0, 4, 2.8, 3.2)
    model.cycle(0)
    addresses = {float(row["KY"]): int(row["address"]) for row in model.table("block")}
    pair = frozenset((addresses[min(addresses)], addresses[max(addresses)]))
    model.gravity(0, 0)
    for y in (min(addresses), max(addresses)):
        speed = share / 2 * D / stage.step * (1 if y < 3 else -1)
        assert model.boundary(1.9, 2.1, y - 0.1, y + 0.1, xvel=0, yvel=speed) == 1
    stage.cycle(int(2 * 1.2 / (share * D)), step=20 if share < 0.1 else 1)
    assert pair not in stage.contacts()
    with pytest.raises(Over):  # they are pressed into each other; stage looks at every cycle before
        stage.cycle(int(0.8 / (share * D)))
    assert set(stage.errors) == {15}
