"""What the verification problems share: figures to be compared, and small helpers."""

from __future__ import annotations

from dataclasses import dataclass

from udec_ia import Model
from udec_ia.layout import offsets as g

RHO = 2000.0  # density of all blocks, kg/m3
CROSS = [(1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)]  # four zones about grid-point 5


@dataclass(frozen=True)
class Figure:
    """A number that the program computed beside the exact one; within: relative tolerance (absolute if 0)."""

    what: str
    computed: float
    exact: float
    within: float

    @property
    def error(self) -> float:
        """Relative error, or absolute if the exact value is 0."""
        return (self.computed - self.exact) / (self.exact or 1.0)

    @property
    def holds(self) -> bool:
        return abs(self.error) <= self.within


def cycle_for(m: Model, seconds: float) -> None:
    """Cycle for a time, with the time-step of the last CYCLE."""
    m.cycle(round(seconds / float(m.h.cr[g.TDEL])))


def deform(m: Model, kind: str, x1: float, x2: float, y1: float, y2: float) -> None:
    """Make the rectangular block in a range rigid, simply-deformable, or four zones about its centroid."""
    if kind == "sdef":
        m.change(x1, x2, y1, y2, type="sdef")
    elif kind == "fdef":
        points = [((x1 + x2) / 2, (y1 + y2) / 2), (x2, y1), (x2, y2), (x1, y2), (x1, y1)]
        m.generate(x1, x2, y1, y2, "manual", points, CROSS)
