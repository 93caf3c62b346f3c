"""What a quantity tends to as the time-step is halved again and again, and how far that is known.

Three values v1, v2, v3 of a step, a half and a quarter of it. If the differences d1 = v2 - v1 and d2 = v3 -
v2 have one sign and d1/d2 = 2^p with p from 0.5 to 3, the error goes with the power p of the step, and

    v = v3 + d2 / (2^p - 1)

(Richardson 1911; p observed, as Roache, Perspective: a method for uniform reporting of grid refinement
studies, J. Fluids Eng. 116, 1994, asks for). The error of v is taken to be the whole correction, or, with
four values, what the fourth has moved it by, if that is less: an extrapolation is no farther off than the
one before it. Else v3 is what there is, and the greatest of all differences its error: small, or none of
the values means anything beyond it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

LEAST, MOST = 0.5, 3.0  # orders that are one


@dataclass(frozen=True)
class Limit:
    """value, and its error, both in the unit of the quantity. order: observed, NaN if there is none."""

    value: float
    error: float
    order: float = math.nan

    @property
    def share(self) -> float:
        """The error as a share of the value."""
        return share(self.error, self.value)

    def error_of(self, value: float) -> float:
        """How far `value` is off, as a share of the limit; infinite for what is no number."""
        return share(abs(value - self.value), self.value) if math.isfinite(value) else math.inf


def share(error: float, value: float) -> float:
    """`error` over the size of `value`: 0 if there is no error, infinite if there is one of 0."""
    if error == 0:
        return 0.0
    return error / abs(value) if value else math.inf


def limit(values: Sequence[float], most: float = MOST) -> Limit | None:
    """The limit of values whose steps are halved from one to the next; None if the last is no number.

    most: the greatest order that is one.
    """
    finite = [value for value in values if math.isfinite(value)]
    if not finite or not math.isfinite(values[-1]):
        return None
    if len(finite) == 1:
        return Limit(finite[0], math.inf)
    extrapolated = _extrapolated(finite[-3:], most)
    if extrapolated is not None:
        before = _extrapolated(finite[-4:-1], most)
        if before is None:
            return extrapolated
        moved = abs(extrapolated.value - before.value)
        return replace(extrapolated, error=min(extrapolated.error, moved))
    differences = [b - a for a, b in pairwise(finite)]
    return Limit(finite[-1], max(map(abs, differences[-2:])))


def _extrapolated(values: Sequence[float], most: float) -> Limit | None:
    """What three values tend to, None if they have no order."""
    if len(values) < 3:
        return None
    one, two = (b - a for a, b in pairwise(values))
    if one == two == 0:
        return Limit(values[-1], 0.0)
    if one * two > 0 and LEAST <= (order := math.log2(one / two)) <= most:
        correction = two / (2**order - 1)
        return Limit(values[-1] + correction, abs(correction), order)
    return None


def shrinks(values: Sequence[float]) -> bool:
    """True if the last difference is smaller than the one before by a quarter or more."""
    if len(values) < 3:
        return True
    one, two = abs(values[-2] - values[-3]), abs(values[-1] - values[-2])
    return two <= 0.75 * one
