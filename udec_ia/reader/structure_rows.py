"""Structures as lines with the forces that they carry."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups


def structure_rows(h: Memory) -> Any:
    """All structures: a structured array with `line` (2, 2) in m, `force` and `broken`.

    force: axial, in N/m, tension positive. Unsound if a list is damaged.
    """
    at: Any = np.array(list(groups(h, "bolt")), np.int64)
    rows = np.zeros(len(at), [("line", float, (2, 2)), ("force", float), ("broken", bool)])
    for end, place in enumerate(((g.KAX1, g.KAY1), (g.KAX2, g.KAY2))):
        for axis, k in enumerate(place):
            rows["line"][:, end, axis] = getr(h, at, k)
    rows["force"] = getr(h, at, g.KAFN)
    rows["broken"] = integers(h, at, g.KASTAT) & g.BROKEN != 0
    return rows
