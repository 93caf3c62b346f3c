"""A number that the program computed, beside the exact one, and how far off it may be, part by part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite


@dataclass(frozen=True)
class Answer:
    """what, unit: of the number. within: reasons for an error, and how large it can be, in the unit.

    The tolerance is the sum of these parts. Each is derived from what the run was given, as its reason says;
    none is chosen so that the number holds.
    """

    what: str
    unit: str
    computed: float
    exact: float
    within: Mapping[str, float]

    @property
    def error(self) -> float:
        """Computed less exact, in the unit."""
        return self.computed - self.exact

    @property
    def tolerance(self) -> float:
        """In the unit."""
        return sum(self.within.values())

    @property
    def holds(self) -> bool:
        """False also if any number is none."""
        return isfinite(self.computed) and abs(self.error) <= self.tolerance

    @property
    def why(self) -> str:
        """The parts of the tolerance, the largest first, without those below a thousandth of it."""
        parts = sorted(self.within.items(), key=lambda part: -part[1])
        return "; ".join(
            f"{self.share(part)} {name}" for name, part in parts if part >= 1e-3 * self.tolerance
        )

    def share(self, part: float) -> str:
        """A difference as a share of the exact number, or with its unit where that is 0."""
        if self.exact != 0:
            return f"{100 * part / abs(self.exact):.2g} %"
        return f"{part:.2g} {self.unit}".rstrip()
