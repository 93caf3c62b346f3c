"""Reals of groups, all of them together."""

from __future__ import annotations

import math
from typing import Any

from udec_ia.heap.kernel import over_arrays


@over_arrays
def all_finite(reals: Any, groups: Any, ratio: int, first: int, last: int) -> bool:
    """True if the reals `first` to `last` of the groups at these addresses, counted from 1, are numbers."""
    for k in range(len(groups)):
        base = (groups[k] - 1) // ratio
        for i in range(base + first - 1, base + last):
            if not math.isfinite(reals[i]):
                return False
    return True
