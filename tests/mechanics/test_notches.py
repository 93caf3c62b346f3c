"""A corner slides through a slight notch, from one edge to the other: what it leaves, what it takes along."""

from __future__ import annotations

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.layout import offsets as g

D, DEEP, STEP = 0.05, 0.3, 0.04  # depth of the corner in the edge, and its way in a cycle, in D


class Slide:
    """A block that is driven by a sharp corner over a base with a notch at (0, 0), from left to right.

    The top of the base falls to the notch by `slope` and rises from it by as much.
    """

    def __init__(self, slope: float, friction: float = 0.0) -> None:
        m = Model()
        m.property(1, density=2000, kn=1e8, ks=1e8, friction=friction)
        m.energy()
        roof = [(-3.5, -1), (-3.5, 3), (0, 3), (0, 1.2), (-1, slope + 0.01), (-3, 1.2), (-3.25, 1.2)]
        base = [(-3.25, 3.25 * slope), (0, 0), (2, 2 * slope), (2, -1)]
        m.block(*np.ravel([*roof, *base]))
        m.split(-3, -2, -3, 4)
        m.delete(-4, -3, -2, 4)
        m.round(D)
        m.fix(-3, 2, -1, 0.9)
        m.cycle(0)
        blocks = m.table("block")
        self.model, self.fixed = m, int(blocks["address"][blocks["KY"] < 0.5][0])
        self.seen = 0  # contacts when last looked at
        self.left, self.right = np.array([1.0, -slope]), np.array([1.0, slope])

    def step(self, way: np.ndarray) -> None:
        """One cycle, the upper block moved by `way`, in D. Sound after a change, and every fifth time."""
        x, y = (float(v) for v in way * D / self.model.h.cr[g.TDEL])
        self.model.boundary(-3, 5, 1.2, 5, xvel=x, yvel=y)
        self.model.cycle(1)
        contacts = len(self.contacts())
        if contacts != self.seen or int(self.model.h.ci[g.MCTOT]) % 5 == 0:
            assert self.model.check() == []
        self.seen = contacts

    def contacts(self) -> np.ndarray:
        """The contacts that are not virtual."""
        found = self.model.table("contact")
        return found[found["KCCOD"] != g.VIRTUAL]

    def force(self) -> np.ndarray:
        """What the base feels of all contacts together."""
        blocks = self.model.table("block")
        (base,) = blocks[blocks["address"] == self.fixed]
        return np.array([base["KBFX"], base["KBFY"]])

    def press(self) -> None:
        """Down, until the corner is DEEP in the edge."""
        while self.contacts()["KCN"].max(initial=-1.0) < DEEP * D:
            self.step(np.array([0.0, -STEP]))


@pytest.mark.parametrize(("slope", "many"), [(0.002, 1), (0.05, 2)])
def test_a_corner_takes_its_force_through_a_notch(slope: float, many: int) -> None:
    """It ends with one contact as before, which holds what all held: nothing is lost, or felt twice."""
    slide = Slide(slope)
    slide.press()
    slide.step(STEP * slide.left)
    before = slide.model.balance()
    forces, contacts = [slide.force()], [1]
    cycles = round(1 / (STEP * D))
    for k in range(2 * cycles):
        slide.step(STEP * (slide.left if k < cycles else slide.right))
        forces.append(slide.force())
        contacts.append(len(slide.contacts()))
    assert (contacts[0], max(contacts), contacts[-1]) == (1, many, 1)
    assert contacts.count(2) * STEP <= 1.5  # from ETOL before the notch to D behind it
    turned = 2 * slope * np.hypot(*forces[0])  # as the normal turns at once
    closing = 1e8 * 2 * slope * STEP * D  # as an edge comes nearer on the way along the other
    assert np.hypot(*np.diff(forces, axis=0).T).max() <= 1.05 * (turned + 2 * closing)
    lost = 1e8 * 2 * slope * D * 1.5  # by opening on that way, at most
    assert abs(np.hypot(*forces[-1]) - np.hypot(*forces[0])) <= lost
    jump = np.hypot(*forces[0]) * 2 * slope * STEP * D  # work of a step that ends as far beyond the bisector
    assert abs(slide.model.balance().residual - before.residual) <= jump
