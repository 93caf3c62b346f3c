"""The map of a block system from the lists around its blocks: loops of domains, pieces, areas.

`lists` has two columns, the first item of each list and how many there are. Of each item: whether it is a
contact, its row among the contacts in use (-1 for none), and the side (0 or 1) of the block on it.
"""

from __future__ import annotations

import math
from typing import Any

from udec_ia.compiling.kernel_decorators import over_arrays

UNKNOWN = -2  # of a place that no walk has reached


@over_arrays
def link_passages(lists: Any, contact: Any, row: Any, side: Any, following: Any) -> None:
    """The next passage around a domain for each known passage: see checker/contact_map.py."""
    for r in range(len(lists)):
        start, end = lists[r, 0], lists[r, 0] + lists[r, 1]
        first = last = -1
        for k in range(start, end):
            if contact[k]:
                if last < 0:
                    first = k
                else:
                    _join(row, side, last, k, following)
                last = k
        if last >= 0:
            _join(row, side, last, first, following)


@over_arrays
def _join(row: Any, side: Any, one: int, two: int, following: Any) -> None:
    """Enter that contact `two` follows contact `one` of a list."""
    if row[one] >= 0 and row[two] >= 0:
        following[2 * row[one] + side[one]] = 2 * row[two] + 1 - side[two]


@over_arrays
def label_cycles(following: Any, smallest: Any) -> None:
    """The smallest place in the cycle of each place; -1 if it is in no cycle, or leads to the last place."""
    smallest[:] = UNKNOWN
    smallest[-1] = -1
    for start in range(len(following) - 1):
        k = start
        while smallest[k] == UNKNOWN:
            smallest[k] = start
            k = following[k]
        if k == start or smallest[start] != start:
            continue
        k = start
        while smallest[k] == start:
            smallest[k] = -1
            k = following[k]


@over_arrays
def label_pieces(one: Any, two: Any, smallest: Any) -> None:
    """The least row in the piece of each block. one, two: rows of blocks that are joined; -1 for none."""
    for k in range(len(smallest)):
        smallest[k] = k
    for k in range(len(one)):
        if one[k] >= 0 and two[k] >= 0:
            a, b = _root(smallest, one[k]), _root(smallest, two[k])
            smallest[max(a, b)] = min(a, b)
    for k in range(len(smallest)):
        smallest[k] = _root(smallest, k)


@over_arrays
def _root(smallest: Any, k: int) -> int:
    """The representative block of a piece; the path to it is halved for later calls."""
    while smallest[k] != k:
        smallest[k] = smallest[smallest[k]]
        k = smallest[k]
    return k


@over_arrays
def sum_areas(
    lists: Any, contact: Any, row: Any, side: Any, virtual: Any, domains: Any, places: Any, twice: Any
) -> bool:
    """Sum up twice the area of each domain; False if a piece of an outline has no domain or no place.

    virtual, domains: by rows of contacts, whether it is virtual, and the rows of its two domains. places: of
    each item (n x 2); a virtual contact gets that of the item before.
    """
    for r in range(len(lists)):
        start, end = lists[r, 0], lists[r, 0] + lists[r, 1]
        following = -1  # contact
        for k in range(end - 1, start - 1, -1):
            following = k if contact[k] else following
        for k in range(start + 1, end):
            if contact[k] and virtual[row[k]]:
                places[k, 0], places[k, 1] = places[k - 1, 0], places[k - 1, 1]
        for k in range(end - 1, start - 1, -1):
            if following < 0:
                return False
            domain = domains[side[following], row[following]]
            after = k + 1 if k + 1 < end else start
            moment = places[k, 0] * places[after, 1] - places[k, 1] * places[after, 0]
            if domain < 0 or not math.isfinite(moment):
                return False
            twice[domain] += moment
            following = k if contact[k] else following
    return True
