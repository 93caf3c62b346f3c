"""Structures as lines with the forces that they carry."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, integers
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups


def structure_rows(h: Memory) -> Any:
    """All bolts and elements: structured array with `address`, `HEAD`, `line`, `force`, `moment`, `broken`.

    HEAD: code of the group, a bolt or an element. line: (2, 2), both ends, m. force: axial, in N/m, tension
    positive. moment: (2,), of a beam at both ends of its element, in N, positive if the left side is in
    tension: KMM1 and -KMM2. Unsound if a list is damaged.
    """
    bolts: Any = np.array(list(groups(h, "bolt")), np.int64)
    elements: Any = np.array(list(groups(h, "element")), np.int64)
    fields: list[Any] = [("address", np.int64), ("HEAD", np.int64), ("line", float, (2, 2))]
    fields += [("force", float), ("moment", float, (2,)), ("broken", bool)]
    rows = np.zeros(len(bolts) + len(elements), fields)
    rows["address"] = np.concatenate([bolts, elements])
    rows["HEAD"] = integers(h, rows["address"], HEAD)
    n = len(bolts)
    for end, (place, node) in enumerate((((g.KAX1, g.KAY1), g.KMN1), ((g.KAX2, g.KAY2), g.KMN2))):
        for axis, k in enumerate(place):
            rows["line"][:n, end, axis] = getr(h, bolts, k)
            rows["line"][n:, end, axis] = getr(h, integers(h, elements, node), (g.KNX, g.KNY)[axis])
    rows["force"] = np.concatenate([getr(h, bolts, g.KAFN), getr(h, elements, g.KMFN)])
    rows["moment"][n:] = np.stack([getr(h, elements, g.KMM1), -getr(h, elements, g.KMM2)], axis=1)
    states = [integers(h, bolts, g.KASTAT), integers(h, elements, g.KMSTAT)]
    rows["broken"] = np.concatenate(states) & g.BROKEN != 0
    return rows
