"""Reactions of what is held, as a table (kernels.drive.reactions)."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.kernels.drive.reactions import reactions_of

COLUMNS = {  # of the table: unit and type
    "block": ("", "i8"),
    "gridpoint": ("", "i8"),
    "x": ("m", "f8"),
    "y": ("m", "f8"),
    "fx": ("N/m", "f8"),
    "fy": ("N/m", "f8"),
    "moment": ("N", "f8"),
}


def reactions(h: Memory, within: tuple[float, float, float, float] | None = None) -> Any:
    """All reactions as a structured array (n,), or those in a range x1, x2, y1, y2.

    A row is a block that is fixed or has a prescribed velocity or rotation, or a grid-point of a block that
    has not: `gridpoint` is 0 for a block. `x` and `y` are its centroid or its place. `fx` and `fy` hold it,
    its own weight included, and `moment` holds it about the centroid; they are 0 where it is free.
    """
    numbers = reactions_of(h)
    rows = np.zeros(len(numbers), [(name, kind) for name, (_, kind) in COLUMNS.items()])
    for name, column in zip(COLUMNS, numbers.T, strict=True):
        rows[name] = column + 0.0  # no -0
    if within is None:
        return rows
    x1, x2, y1, y2 = within
    return rows[(x1 < rows["x"]) & (rows["x"] < x2) & (y1 < rows["y"]) & (rows["y"] < y2)]
