"""Groups change places in IA() while everything they say stays the same.

Where a group lies means nothing to the program (report 3.5), but much to the machine: memory is read in
lines and ahead in straight runs, so groups that are used together should lie together. The field table
knows which words are addresses; nothing else has to change when groups move.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from udec_ia.compiling.build_choice import forget_kinds
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Group, Layout, layouts, read_table

PIECE = 16384  # groups that are copied together: they fit in the machine's caches


def relocate(array: MainArray, order: dict[str, Any]) -> Any:
    """Lay out all groups afresh from address 1: kind by kind, and within a kind in the given order.

    order: for every kind of group in use the addresses of all its groups. The main lists follow the new
    order; the junk list is empty afterwards. Returns the new address of the group at each old address, 0
    where there was none.
    """
    h, table = array.h, read_table()
    kinds = {kind: (table.group(kind), layouts(array.scheme.ratio)[kind]) for kind in order}
    moved = np.zeros(int(h.ci[g.MFREE]) + 1, h.ia.dtype)  # new address of the group at an address; 0 stays 0
    free = 1
    for kind, (_, layout) in kinds.items():
        moved[order[kind]] = free + layout.size * np.arange(len(order[kind]))
        free += layout.size * len(order[kind])
    words = np.zeros_like(h.ia[: free - 1])
    for kind, (group, layout) in kinds.items():
        start, size = int(moved[order[kind][0]]) - 1, layout.size
        rows = words[start : start + size * len(order[kind])].reshape(-1, size)
        for first in range(0, len(rows), PIECE):
            rows[first : first + PIECE] = _copies(
                h.ia, order[kind][first : first + PIECE], group, layout, moved
            )
        _relink(rows, group, layout, moved[order[kind]])
    h.ia[: free - 1] = words
    h.ia[free - 1 : int(h.ci[g.MFREE]) - 1] = 0
    for field in table.common:
        if field.role == "head":
            i = getattr(g, field.name)
            h.ci[i] = moved[h.ci[i]]
    for kind, (group, _) in kinds.items():
        if group.list_head is not None:
            h.ci[getattr(g, group.list_head)] = moved[order[kind][0]]
    h.ci[g.JUNK], h.ci[g.MFREE] = 0, free
    forget_kinds(h.ia)
    return moved


def _copies(ia: Any, addresses: Any, group: Group, layout: Layout, moved: Any) -> Any:
    """The words of the groups at `addresses`, one row each, with all addresses in them renewed."""
    rows = sliding_window_view(ia, layout.size)[addresses - 1]
    for field in group.fields:
        if field.target is not None:
            column = slice(layout.offset[field.name], layout.offset[field.name] + field.count)
            rows[:, column] = moved[rows[:, column]]
    return rows


def _relink(rows: Any, group: Group, layout: Layout, addresses: Any) -> None:
    """Make the main list of a kind run through its rows in order."""
    if group.list_head is None:
        return
    for field in group.fields:
        column = layout.offset[field.name]
        if field.role == "next":
            rows[:-1, column], rows[-1, column] = addresses[1:], 0
        elif field.role == "back":
            rows[1:, column], rows[0, column] = addresses[:-1], 0
