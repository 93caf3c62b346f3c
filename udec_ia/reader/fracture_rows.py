"""Cracks that runs have made, as a table (BREAKAGE, PRINT CRACKS)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups

CAUSES = ("forces", "tension", "shear")  # by KFRK, from 1 on
CRACKS = {  # columns: unit and type
    "crack": ("", "i8"),
    "cycle": ("", "i8"),
    "time": ("s", "f8"),
    "x1": ("m", "f8"),
    "y1": ("m", "f8"),
    "x2": ("m", "f8"),
    "y2": ("m", "f8"),
    "cause": ("", "U7"),
    "energy": ("J/m", "f8"),
}
ENDS = ("x1", "y1", "x2", "y2")
FIELDS = g.KFRC, g.KFRT, g.KFRX1, g.KFRY1, g.KFRX2, g.KFRY2


def cracks_made(h: Memory) -> NDArray[np.void]:
    """All cracks as a structured array (n,) with the columns CRACKS, the earliest first."""
    at: Any = np.array([*groups(h, "fracture")][::-1], np.int64)
    rows = np.zeros(len(at), [(name, kind) for name, (_, kind) in CRACKS.items()])
    rows["crack"] = at
    for name, field in zip([*CRACKS][1:7], FIELDS, strict=True):
        rows[name] = getr(h, at, field)
    rows["cause"] = [CAUSES[k - 1] for k in integers(h, at, g.KFRK).tolist()]
    rows["energy"] = getr(h, at, g.KFRE)
    return rows


def crack_text(row: Any) -> str:
    """A crack in one line."""
    ends = f"from ({row['x1']:.6g}, {row['y1']:.6g}) to ({row['x2']:.6g}, {row['y2']:.6g})"
    return f"cycle {row['cycle']}: crack by {row['cause']} {ends}, takes {row['energy']:.4g} J/m"
