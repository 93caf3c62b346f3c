"""Rows of two tables that belong together: by equal keys, and by what most of their neighbours say."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

import numpy as np

Pairs = tuple[Any, Any]  # rows of the one table (n,) and of the other (n,)


def fold(one: Sequence[Any], two: Sequence[Any]) -> tuple[Any, Any]:
    """Columns of whole numbers as one key a row, for each of two tables: equal for equal rows only."""
    columns = [np.concatenate(both).astype(np.int64) for both in zip(one, two, strict=True)]
    order = np.lexsort(columns)
    new = np.zeros(len(order), bool)
    for column in columns:
        new[1:] |= column[order[1:]] != column[order[:-1]]
    keys = np.empty(len(order), np.int64)
    keys[order] = np.cumsum(new)
    return keys[: len(one[0])], keys[len(one[0]) :]


def pairs_in_order(one: Any, two: Any, as_many: bool = False) -> Pairs:
    """Rows with equal keys (n,) and (m,), in turn. as_many: only of keys that both have equally often."""
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
    first = [np.unique(side[best], return_index=True)[1] for side in (a, b)]
    both = best[np.intersect1d(first[0], first[1])]
    return a[both], b[both]


def exclusive_pairs(one: Any, two: Any) -> Pairs:
    """Pairs of the numbers (n,) and (n,) of which neither comes with another, 0 for none being one."""
    a, b, _ = votes(one, two)
    once = [values[times == 1] for values, times in (np.unique(side, return_counts=True) for side in (a, b))]
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
