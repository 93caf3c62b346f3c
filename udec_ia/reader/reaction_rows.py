"""Reactions of what is held, as a table (kernels.drive.reactions)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.reactions import reactions_of
from udec_ia.reader.group_ranges import Range, holds

COLUMNS = {  # of the table: unit and type
    "block": ("", "i8"),
    "gridpoint": ("", "i8"),
    "x": ("m", "f8"),
    "y": ("m", "f8"),
    "fx": ("N/m", "f8"),
    "fy": ("N/m", "f8"),
    "moment": ("N", "f8"),
}


def reactions(h: Memory) -> NDArray[np.void]:
    """All reactions as a structured array (n,).

    A row is a block that is fixed or has a prescribed velocity or rotation, or a grid-point of a block that
    has not: `gridpoint` is 0 for a block. `x` and `y` are its centroid or its place. `fx` and `fy` hold it,
    its own weight included, and `moment` holds it about the centroid; they are 0 where it is free.
    """
    numbers = reactions_of(h)
    rows = np.zeros(len(numbers), [(name, kind) for name, (_, kind) in COLUMNS.items()])
    for name, column in zip(COLUMNS, numbers.T, strict=True):
        rows[name] = column + 0.0  # no -0
    return rows


def reactions_in(array: MainArray, where: Range) -> NDArray[np.void]:
    """Those whose centroid or place is in the range."""
    rows: NDArray[np.void] = reactions(array.h)
    found: NDArray[np.void] = rows[holds(array, where, rows["x"], rows["y"], rows["block"])]
    return found
