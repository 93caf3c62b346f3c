"""Reals of many groups at once, which come as a bare array: for looks at a heap, as walks.py is."""

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


@over_arrays
def place_items(reals: Any, items: Any, contact: Any, ratio: int, offsets: Any, places: Any) -> None:
    """The place of each item (n x 2), from that of the first, a corner.

    offsets: of x and y among the reals, counted from 1, of a corner and of a contact.
    """
    for k in range(len(items)):
        base, of_kind = (items[k] - 1) // ratio - 1, 2 if contact[k] else 0
        for axis in range(2):
            places[k, axis] = reals[base + offsets[of_kind + axis]]
    x, y = places[0, 0], places[0, 1]
    for k in range(len(items)):
        places[k, 0], places[k, 1] = places[k, 0] - x, places[k, 1] - y
