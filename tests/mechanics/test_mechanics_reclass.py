"""One contact from corner/edge over corner/corner to edge/corner (report 2.5), its force without a break.

A wedge that stands on its obtuse apex moves on a straight line over the rounded corner of a fixed block,
and back. Its mass is so great that no force bends its way: the overlap is a matter of geometry alone, which
the oracle knows, and the force is KN times the overlap.
"""

from __future__ import annotations

import pytest
from naive import contacts as naive
from support.mechanics_scenes import at, block, box, model, push, sound, step

from udec_ia import Model
from udec_ia.layout.offsets import GTOL

KN, D = 1.0, 0.3
DENSITY = 1e12
DT = 1e-2
SPEED = 1.0


def scene(side: int, up: int) -> Model:
    """A fixed block with a flat side, y = 0, that ends at x = 0, and a wedge whose apex stands on that side.

    side: 1 if the wedge stands at x = -1 and has to go to the right, -1 for the mirror image.
    up: 1 if the wedge stands above the fixed block, -1 if it hangs below: the blocks change their parts.
    """
    m = model(*box(-4, 4, -3, 3), d=D, density=DENSITY, stiffness=(KN, KN), gravity=(0.0, 0.0))
    m.split(-5, 0, 5, 0)
    apex = -side
    for way in (1, -1):
        m.split(apex - 0.5 * way, -0.15 * up, apex + 6 * way, 1.8 * up)
        m.delete(*sorted((apex, 5 * way)), *sorted((0, up)))
    m.split(0, -4 * up, 0, 0.01 * up)
    m.delete(*sorted((0, 5 * side)), *sorted((-3 * up, 0)))
    m.fix(-5, 5, *sorted((-3 * up, 0)))
    return m


def outlines(m: Model) -> dict[int, naive.Outline]:
    """Corners of all blocks, by address."""
    found: dict[int, naive.Outline] = {}
    for row in m.table("corner"):
        found.setdefault(int(row["KNB"]), []).append((float(row["KXP"]), float(row["KYP"])))
    return found


def watch(m: Model, contact: int, n: int, slack: float) -> list[int]:
    """Move for `n` cycles. Returns the codes of the contact as they follow each other.

    No other contact carries a force, though some are made ahead. The force changes by no more than KN v dt
    from one cycle to the next, and is KN times the overlap that the oracle finds. A code may last GTOL past
    the border, where it errs by the arc's rise, GTOL^2/2R.
    """
    most = KN * 1.02 * SPEED * DT  # the way leads 1 across and 0.2 down
    force = float(at(m, "contact", contact)["KCFN"])
    codes: list[int] = []
    for k in range(n):
        m.cycle(1)
        row = at(m, "contact", contact)
        assert (m.table("contact")["KCFN"] > 0).sum() == (row["KCFN"] > 0)
        assert abs(row["KCFN"] - force) <= most * (1 + 1e-9) + 2 * KN * slack
        force = float(row["KCFN"])
        expected = [found.overlap for found in naive.contacts(outlines(m), D)]
        assert force == pytest.approx(KN * max(expected, default=0.0), abs=KN * slack)
        if [row["KCCOD"]] != codes[-1:]:
            codes.append(int(row["KCCOD"]))
        if k % 10 == 0:
            sound(m)
    return codes


@pytest.mark.parametrize("up", [1, -1])
@pytest.mark.parametrize("side", [1, -1])
def test_one_contact_passes_a_corner_and_comes_back(side: int, up: int) -> None:
    m = scene(side, up)
    (row,) = m.table("contact")
    wedge = int(block(m, 0, up)["address"])
    there = [2, 1, 3] if row["KB1"] == wedge else [3, 1, 2]
    mass = float(block(m, 0, up)["KBM"])
    m.fraction(DT / (2 * (mass / KN) ** 0.5))
    m.cycle(1)
    assert step(m) == pytest.approx(DT)
    slack = float(m.h.cr[GTOL]) ** 2 / (2 * D) + 1e-12
    contact = int(row["address"])
    push(m, wedge, SPEED * side, -0.2 * SPEED * up)
    assert watch(m, contact, 160, slack) == there
    push(m, wedge, -SPEED * side, 0.2 * SPEED * up)
    assert watch(m, contact, 140, slack) == there[::-1]
