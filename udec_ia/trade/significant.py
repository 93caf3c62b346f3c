"""Digits that a sample of perturbed results shares, with confidence.

D. Sohier, P. de Oliveira Castro, F. Fevotte, B. Lathuiliere, E. Petit, O. Jamond, Confidence intervals for
stochastic arithmetic, ACM Trans. Math. Softw. 47(2), 2021, for errors that are normal and centred: with the
confidence 1 - a the s first bits of a result are significant with the probability p if

    s <= -log2(sigma/|mu|) - [1/2 log2((n - 1)/chi2) + log2(F((p + 1)/2))]

sigma, mu: of the n results; chi2: the a/2 quantile of the chi-squared distribution with n - 1 degrees of
freedom; F: quantile of the normal distribution. The package significantdigits has the same, and needs
SciPy.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from statistics import NormalDist, fmean, stdev

PROBABILITY = CONFIDENCE = 0.95
FEWEST = 3  # results that are a sample
HALVINGS = 200


@dataclass(frozen=True)
class Digits:
    """Of `runs` results. mean; spread: sigma/|mu|; digits: -log10 of it; lower: the lower end of the
    interval.

    full: digits that the words have; a sample of equal numbers has as many.
    """

    runs: int
    mean: float
    spread: float
    digits: float
    lower: float
    full: float


def digits(results: Sequence[float], bits: int) -> Digits | None:
    """The digits of results with so many bits in their fraction (52, 23); None for too few results."""
    found = [value for value in results if math.isfinite(value)]
    full = (bits + 1) * math.log10(2)
    if len(found) < FEWEST:
        return None
    mean, sigma = fmean(found), stdev(found)
    if sigma == 0:
        return Digits(len(found), mean, 0.0, full, full, full)
    spread = sigma / abs(mean) if mean else math.inf
    own = min(-math.log10(spread), full) if spread < math.inf else 0.0
    return Digits(len(found), mean, spread, own, own - doubt(len(found)), full)


def doubt(runs: int, probability: float = PROBABILITY, confidence: float = CONFIDENCE) -> float:
    """Decimal digits that a sample of so many results cannot answer for: the bracket above."""
    quantile = chi_squared((1 - confidence) / 2, runs - 1)
    bits = 0.5 * math.log2((runs - 1) / quantile) + math.log2(NormalDist().inv_cdf((probability + 1) / 2))
    return bits * math.log10(2)


@cache
def chi_squared(p: float, degrees: int) -> float:
    """The p quantile of the chi-squared distribution, by bisection."""
    low, high = 0.0, degrees + 20 * math.sqrt(2 * degrees) + 50
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if _gamma(degrees / 2, middle / 2) < p else (low, middle)
    return (low + high) / 2


def _gamma(a: float, x: float) -> float:
    """The regularised lower incomplete gamma function (Abramowitz and Stegun 6.5.29)."""
    if x <= 0:
        return 0.0
    term = total = 1 / a
    n = a
    while term > total * 1e-17:
        n += 1
        term *= x / n
        total += term
    return total * math.exp(a * math.log(x) - x - math.lgamma(a))
