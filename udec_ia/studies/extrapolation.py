"""Extrapolates the values of a quantity to a time-step of 0, and estimates how far the result is known.

Three values v1, v2, v3 belong to a step, a half and a quarter of it. If the differences d1 = v2 - v1 and
d2 = v3 - v2 have one sign and d1/d2 = 2^p with p from 0.5 to 3, the error goes with the power p of the step:

    v = v3 + d2 / (2^p - 1)

(Richardson 1911; p observed, as in Roache, J. Fluids Eng. 116, 1994). The error of v is the whole correction
or, with four values, the change of v by the fourth, if that is less; both with a factor of safety. An order
above 2.2 is not that of the formulation but chance: then p = 2, and the whole of d2 is the error (Oberkampf
and Roy, Verification and validation in scientific computing, 2010, 8.6). Where rest is sought more closely
from value to value as well (`highest`), p may be greater. Without an order the result is v3, and its error
twice the greatest of the last differences.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

LOWEST, HIGHEST = 0.5, 3.0  # orders that are accepted
FORMAL, DOUBTFUL = 2.0, 2.2  # order of the formulation, and from which on an observed one is chance
SAFETY = 1.25  # on the error of an extrapolation, as Roache takes it for three grids
LEFT = 2  # times the last differences: what may be left where there is no order


@dataclass(frozen=True)
class Extrapolation:
    """value, and its error, both in the unit of the quantity. order: observed, NaN if there is none."""

    value: float
    error: float
    order: float = math.nan

    @property
    def share(self) -> float:
        """The error as a share of the value."""
        return share(self.error, self.value)

    @property
    def is_zero(self) -> bool:
        """True if the value cannot be distinguished from 0: shares of it mean nothing."""
        return 0 < self.error >= abs(self.value) and math.isfinite(self.error)

    def error_of(self, value: float) -> float:
        """How far `value` is off, as a share of this one; infinite for NaN."""
        return share(abs(value - self.value), self.value) if math.isfinite(value) else math.inf


def share(error: float, value: float) -> float:
    """`error` over the size of `value`: 0 if there is no error, infinite if there is one of 0."""
    if error == 0:
        return 0.0
    return error / abs(value) if value else math.inf


def extrapolate(values: Sequence[float], highest: float = HIGHEST) -> Extrapolation:
    """What values tend to whose steps are halved; an infinite error if unknown. highest: order accepted."""
    finite = [value for value in values if math.isfinite(value)]
    if len(finite) < 2 or not math.isfinite(values[-1]):
        return Extrapolation(values[-1], math.inf)
    extrapolated = _by_order(finite[-3:], highest)
    if extrapolated is not None:
        before = _by_order(finite[-4:-1], highest)
        if before is None or _doubtful(extrapolated.order, highest):
            return extrapolated
        moved = abs(extrapolated.value - before.value)
        return replace(extrapolated, error=min(extrapolated.error, SAFETY * moved))
    differences = [b - a for a, b in pairwise(finite)]
    return Extrapolation(finite[-1], LEFT * max(map(abs, differences[-2:])))


def _by_order(values: Sequence[float], highest: float) -> Extrapolation | None:
    """What three values tend to, None if they have no order."""
    if len(values) < 3:
        return None
    one, two = (b - a for a, b in pairwise(values))
    if one == two == 0:
        return Extrapolation(values[-1], 0.0)
    if one * two > 0 and LOWEST <= (order := math.log2(one / two)) <= highest:
        if _doubtful(order, highest):
            return Extrapolation(values[-1] + two / (2**FORMAL - 1), abs(two), order)
        correction = two / (2**order - 1)
        return Extrapolation(values[-1] + correction, SAFETY * abs(correction), order)
    return None


def _doubtful(order: float, highest: float) -> bool:
    """True if values converge faster than the formulation lets them."""
    return highest == HIGHEST and order > DOUBTFUL


def converges(values: Sequence[float]) -> bool:
    """True if the last difference is smaller than the one before by a quarter or more."""
    if len(values) < 3:
        return True
    one, two = abs(values[-2] - values[-3]), abs(values[-1] - values[-2])
    return two <= 0.75 * one
