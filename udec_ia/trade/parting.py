"""Where and when two runs part: the first block that is somewhere else, and stays so."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from udec_ia.trade.surveyed import tracks


class Parting(NamedTuple):
    """time: from which on a block is elsewhere (s). x, y: where it was at first. apart: at the end (m).

    moved: the greatest way of any block (m).
    """

    time: float
    x: float
    y: float
    apart: float
    moved: float


def parting(one: Path, two: Path, share: float) -> Parting | None:
    """Where the runs in two folders part by more than `share` of the greatest way; None if nowhere."""
    pairs = [*zip(tracks(one), tracks(two), strict=False)]
    if not pairs:
        return None
    first = pairs[0][0][1]
    apart = np.array([_apart(first, a, b) for (_, a), (_, b) in pairs])  # marks, blocks
    moved = max((float(np.nanmax(_apart(first, first, a), initial=0.0)) for (_, a), _ in pairs), default=0.0)
    off = apart > share * moved
    stays = np.flip(np.logical_and.accumulate(np.flip(off, 0), 0), 0)
    if moved == 0 or not stays.any():
        return None
    mark = int(np.argmax(stays.any(axis=1)))
    block = int(np.argmax(np.where(stays[mark], apart[mark], -1.0)))
    x, y = map(float, first[block, 1:])
    return Parting(pairs[mark][0][0], x, y, float(apart[-1, block]), moved)


def _apart(first: Any, a: Any, b: Any) -> Any:
    """How far each block of `first` is from itself in two states; 0 if one of them has it no more."""
    return np.where(
        _has(a, first) & _has(b, first), np.hypot(*(_places(a, first) - _places(b, first)).T), 0.0
    )


def _has(rows: Any, first: Any) -> Any:
    return np.isin(first[:, 0], rows[:, 0])


def _places(rows: Any, first: Any) -> Any:
    order = np.argsort(rows[:, 0])
    at = np.clip(np.searchsorted(rows[order, 0], first[:, 0]), 0, len(rows) - 1)
    return rows[order][at, 1:]
