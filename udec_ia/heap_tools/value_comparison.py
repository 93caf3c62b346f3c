"""How far two numbers lie apart: absolute, as a share of the greater, and in last digits (ulp).

Reals are compared in the words of the narrower scheme: what these cannot tell apart is one number.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np

from udec_ia.reader.atlas import TABLE

RELATIVE, ULPS = "relative", "ulp"
UNITS = sorted({f.unit for part in (*(one.fields for one in TABLE.groups), TABLE.common) for f in part})


class Apart(NamedTuple):
    """Numbers that differ: which rows (n,), and how far; of numbers that are no reals, 0. ulps as reals."""

    rows: Any
    absolute: Any
    relative: Any
    ulps: Any


class Tolerance(NamedTuple):
    """What does not count as a difference of reals. units: by unit; relative, ulps: for all of them."""

    units: dict[str, float]
    relative: float = 0.0
    ulps: float = 0.0

    def allows(self, unit: str, apart: Apart) -> Any:
        """True for each difference that does not count."""
        good = np.zeros(len(apart.rows), bool)
        limits = (
            (apart.absolute, self.units.get(unit)),
            (apart.relative, self.relative),
            (apart.ulps, self.ulps),
        )
        for distance, limit in limits:
            if limit:
                good |= distance <= limit
        return good


NONE = Tolerance({})


def tolerance(texts: Iterable[str]) -> Tolerance:
    """Of texts such as m=1e-6, N/m=10, relative=1e-9, ulp=4. ValueError for what is none."""
    units: dict[str, float] = {}
    for text in texts:
        name, sign, number = text.partition("=")
        try:
            limit = float(number)
        except ValueError:
            limit = -inf
        if name not in (*UNITS, RELATIVE, ULPS) or not sign or not (isfinite(limit) and limit >= 0):
            known = ", ".join((RELATIVE, ULPS, *UNITS))
            raise ValueError(f"tolerance {text}: give NAME=NUMBER, such as m=1e-6, of {known}")
        units[name] = limit
    return Tolerance(units, units.pop(RELATIVE, 0.0), units.pop(ULPS, 0.0))


def whole_apart(differ: Any) -> Apart:
    """Whole numbers or groups (n,), which differ or not."""
    rows = np.flatnonzero(differ)
    return Apart(rows, *(np.zeros(len(rows)),) * 3)


def reals_apart(one: Any, two: Any) -> Apart:
    """Reals (n,) and (n,) of one width or two. NaN is NaN, and -0 is 0."""
    narrow = min(one.dtype, two.dtype, key=lambda kind: kind.itemsize)
    with np.errstate(all="ignore"):
        a, b = one.astype(narrow, copy=False), two.astype(narrow, copy=False)
        rows = np.flatnonzero((a != b) & ~((a != a) & (b != b)))
        x, y = one[rows].astype(np.float64), two[rows].astype(np.float64)
        absolute = np.abs(x - y)
        relative = absolute / np.maximum(np.abs(x), np.abs(y))
    return Apart(rows, absolute, relative, _ulps(a[rows], b[rows]))


def _ulps(one: Any, two: Any) -> Any:
    """How many reals of their width lie between two, as reals of 64 bits."""
    a, b = (_order(values) for values in (one, two))
    return (np.maximum(a, b) - np.minimum(a, b)).astype(np.float64)


def _order(values: Any) -> Any:
    """Whole numbers in the order of the reals, one for each; -0 and 0 are the same."""
    bits = values.view(f"u{values.itemsize}").astype(np.uint64)
    sign = np.uint64(1) << np.uint64(8 * values.itemsize - 1)
    return np.where(bits >= sign, sign - (bits - sign), sign + bits)
