"""Numbers in pictures as people write them: 3.2 MPa, not 3.2e+06 Pa, and scales with round numbers."""

from __future__ import annotations

import math
from typing import NamedTuple

LARGER = {  # units of the field table: those in which pictures show them, and how many times larger they are
    "m": (("µm", 1e-6), ("mm", 1e-3), ("m", 1.0)),
    "m/s": (("µm/s", 1e-6), ("mm/s", 1e-3), ("m/s", 1.0)),
    "Pa": (("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)),
    "N": (("N", 1.0), ("kN", 1e3), ("MN", 1e6)),
    "N/m": (("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6)),
    "J/m": (("J/m", 1.0), ("kJ/m", 1e3), ("MJ/m", 1e6)),
}
FILLED = {"m": 0.1, "m/s": 0.1}  # of a unit that the largest number fills; 1 of others: 0.2 m, but 200 kPa
ROUND = (5.0, 2.0, 1.0)


class Unit(NamedTuple):
    """name: as it is written. size: in the unit of the field table."""

    name: str
    size: float

    def text(self, value: float) -> str:
        """A number of the field table with four digits and this unit."""
        return f"{value / self.size:.4g} {self.name}".strip()

    def label(self, quantity: str) -> str:
        """The label of an axis or of a scale of colours."""
        return f"{quantity} ({self.name})" if self.name else quantity


def readable(unit: str, largest: float) -> Unit:
    """The unit in which a picture shows numbers of `unit` up to `largest`: the largest one that these fill.

    A unit that has no others stays.
    """
    choice = LARGER.get(unit, ((unit, 1.0),))
    filled = [Unit(*one) for one in choice if largest >= FILLED.get(unit, 1.0) * one[1]]
    if filled:
        return filled[-1]
    return Unit(*choice[0]) if largest > 0 else Unit(unit, 1.0)


def in_readable_units(value: float, unit: str) -> str:
    """One number with the unit that suits it."""
    return readable(unit, abs(value)).text(value)


def round_number(largest: float) -> float:
    """The greatest of 1, 2 and 5 times a power of ten that is not above `largest`, which is positive."""
    power = 10.0 ** math.floor(math.log10(largest))
    return next(digit * power for digit in ROUND if digit * power <= largest * (1 + 1e-9))
