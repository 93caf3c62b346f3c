"""Corners of blocks that match, from the same corner on: KP may name another one in the other state.

Corner for corner from KP on is what is meant, unless corners of the other block from another one on lie where
those of this one do: all of them, or, of a block that was cut, most. Only then its ring is turned.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from udec_ia.heap_tools.compared_heap import Side
from udec_ia.heap_tools.row_matching import Pairs


def turned(sides: Sequence[Side], rings: Pairs, many: Any, needed: Any) -> Any:
    """The corners (n,) of the other's blocks in the order of those of the one. rings: both, from KP on.

    many: corners of each block (m,). needed: how many of them must lie in one place when its ring is turned.
    """
    first = np.cumsum(many) - many
    best, found = np.zeros(len(many), np.int64), needed - 1
    places = [_places(side, at) for side, at in zip(sides, rings, strict=True)]
    rows = np.arange(len(many))
    turn = 0
    while len(rows := rows[many[rows] > turn]):
        now = _together(places, first[rows], many[rows], turn)
        good = now > found[rows]
        best[rows[good]], found[rows[good]] = turn, now[good]
        rows = rows[now < many[rows]]
        turn += 1
    place = np.arange(len(rings[0])) - np.repeat(first, many)
    return rings[1][np.repeat(first, many) + (place + np.repeat(best, many)) % np.repeat(many, many)]


def _places(side: Side, at: Any) -> Any:
    """Where the corners (n,) lie, to 32-bit reals: columns that are equal for one place (2, n)."""
    with np.errstate(over="ignore"):
        return np.array([side.column("corner", name, at).astype(np.float32) for name in ("KXP", "KYP")])


def _together(places: Sequence[Any], first: Any, many: Any, turn: int) -> Any:
    """How many corners of each block (m,) lie in one place, if those of the other are so many places on."""
    starts = np.cumsum(many) - many
    place = np.arange(int(many.sum())) - np.repeat(starts, many)
    base = np.repeat(first, many)
    there = base + (place + turn) % np.repeat(many, many)
    same = (places[0][:, base + place] == places[1][:, there]).all(0)
    return np.add.reduceat(same.astype(np.int64), starts)
