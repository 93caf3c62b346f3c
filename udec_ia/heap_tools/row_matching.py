"""Rows of two tables that belong together: by equal keys, and by what most of their neighbours say."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

import numpy as np

Pairs = tuple[Any, Any]  # rows of the one table (n,) and of the other (n,)


def fold(one: Sequence[Any], two: Sequence[Any]) -> tuple[Any, Any]:
    """Columns of whole numbers as one key a row, for each of two tables: equal for equal rows only."""
    keys = [np.zeros(len(table[0]), np.int64) for table in (one, two)]
    room = 1
    for columns in zip(one, two, strict=True):
        both = np.concatenate(columns).astype(np.int64)
        low, high = (int(both.min()), int(both.max())) if len(both) else (0, 0)
        if room * (high - low + 1) >= 2**63:  # else the key would not fit a word
            both = np.unique(both, return_inverse=True)[1]
            low, high = 0, len(both)
            keys, room = _narrowed(keys)
        parts = np.split(both - low, [len(columns[0])])
        keys = [key * (high - low + 1) + part for key, part in zip(keys, parts, strict=True)]
        room *= high - low + 1
    return keys[0], keys[1]


def _narrowed(keys: Sequence[Any]) -> tuple[list[Any], int]:
    """The same keys as places among all that there are, and how many of these there are at most."""
    places = np.unique(np.concatenate(keys), return_inverse=True)[1]
    return np.split(places, [len(keys[0])]), len(places)


def pairs_in_order(one: Any, two: Any, as_many: bool = False) -> Pairs:
    """Rows with equal keys (n,) and (m,): the first of the one with the first of the other, and so on.

    as_many: only of keys that both have equally often.
    """
    order = np.argsort(one, kind="stable"), np.argsort(two, kind="stable")
    a, b = one[order[0]], two[order[1]]
    first, mine = np.searchsorted(b, a), np.searchsorted(a, a)
    partner = first + np.arange(len(a)) - mine
    there = partner < len(b)
    there[there] = b[partner[there]] == a[there]
    if as_many:
        there &= np.searchsorted(a, a, "right") - mine == np.searchsorted(b, a, "right") - first
    return order[0][there], order[1][partner[there]]


def unique_pairs(one: Any, two: Any) -> Pairs:
    """Rows whose key (n,) and (m,) comes once in each."""
    single = []
    for keys in (one, two):
        values, first, times = np.unique(keys, return_index=True, return_counts=True)
        single.append((values[times == 1], first[times == 1]))
    (a, rows_a), (b, rows_b) = single
    _, i, j = np.intersect1d(a, b, assume_unique=True, return_indices=True)
    return rows_a[i], rows_b[j]


def votes(one: Any, two: Any) -> tuple[Any, Any, Any]:
    """Different pairs of the numbers (n,) and (n,), and how often each comes."""
    if not len(one):
        return one, two, one
    keys, _ = fold((one, two), (one[:0], two[:0]))
    _, first, times = np.unique(keys, return_index=True, return_counts=True)
    return one[first], two[first], times


def frequent_pairs(one: Any, two: Any) -> Pairs:
    """Pairs of the numbers (n,) and (n,) that come together more often than either does with another."""
    a, b, times = votes(one, two)
    best = np.lexsort((b, a, -times))
    a, b = a[best], b[best]
    mine = np.zeros(len(a), bool)
    mine[np.unique(a, return_index=True)[1]] = True
    theirs = np.zeros(len(b), bool)
    theirs[np.unique(b, return_index=True)[1]] = True
    return a[mine & theirs], b[mine & theirs]


def exclusive_pairs(one: Any, two: Any) -> Pairs:
    """Pairs of the numbers (n,) and (n,) of which neither comes with another, 0 for none being one."""
    a, b, _ = votes(one, two)
    alone = [np.unique(side, return_counts=True) for side in (a, b)]
    once = [values[times == 1] for values, times in alone]
    good = np.isin(a, once[0]) & np.isin(b, once[1]) & (a > 0) & (b > 0)
    return a[good], b[good]


def longest_rising(numbers: Any) -> Any:
    """Places of a longest part of the whole `numbers` (n,) that rises."""
    if not len(numbers) or bool((np.diff(numbers) > 0).all()):
        return np.arange(len(numbers))
    values = numbers.tolist()
    tails, ends = (
        list[int](),
        list[int](),
    )  # the least number that a part of a length ends with, and its place
    before = np.full(len(values), -1)
    for place, value in enumerate(values):
        length = bisect_left(tails, value)
        before[place] = ends[length - 1] if length else -1
        tails[length : length + 1] = [value]
        ends[length : length + 1] = [place]
    found, place = [], ends[-1]
    while place >= 0:
        found.append(place)
        place = int(before[place])
    return np.array(found[::-1])
