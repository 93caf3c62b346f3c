"""What histories record after a cycle (HISTORY): a number of a group, the common block, the whole model."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, at_offset, getr, iget, int64
from udec_ia.heap.jit import apart, kernel
from udec_ia.kernels.drive.unbalanced import force_ratio, unbalanced
from udec_ia.kernels.energy.stored import height, kinetic, strain_of_blocks, strain_of_contacts
from udec_ia.layout import offsets as g

UNBALANCED, RATIO, KINETIC, STRAIN = 0, 1, 2, 3
INTEGER, REAL, DOUBLE = 0, 1, 2  # types of what is recorded


@kernel
def quantity(h: Memory, which: int) -> float:
    """Quantity `which` of the whole model, in the order of ops.commands.recordable.QUANTITIES."""
    if which == UNBALANCED:
        return float(unbalanced(h, True)[0])
    if which == RATIO:
        return float(force_ratio(h, True))
    if which == KINETIC:
        return kinetic(h, True)
    if which == STRAIN:
        return strain_of_contacts(h) + strain_of_blocks(h, True)
    return height(h) - h.cd[g.EREF]


@kernel
def number_now(h: Memory, ih: int, offset: int, type_code: int) -> float:
    """What history `ih` has to record now; not a number if its group has gone."""
    kind, group = iget(h, ih, g.KHK), iget(h, ih, g.KHG)
    if kind == g.WHOLE_MODEL:
        return quantity(h, offset)
    if kind == g.COMMON_BLOCK:
        if type_code == DOUBLE:
            return float(h.cd[offset])
        return float(h.cr[offset]) if type_code == REAL else float(h.ci[offset])
    if group == 0:
        return np.nan
    k = at_offset(offset, kind, g.KHG)
    return float(getr(h, group, k)) if type_code == REAL else float(iget(h, group, k))


@apart
def record(h: Memory, places: Any, rows: Any, count: Any) -> bool:
    """Add a row with what is due after this cycle: cycle, time, and NaN for what is not due.

    Returns True if anything was. places: see ops.commands.history.places. count: number of rows, in an array.
    """
    row = rows[count[0]]
    due = False
    i = 0
    ih = int64(h.ci[g.IHPNT])
    while ih != 0:
        row[2 + i] = np.nan
        if h.ci[g.MCTOT] % iget(h, ih, g.KHN) == 0:
            row[2 + i] = number_now(h, ih, places[i, 0], places[i, 1])
            due = True
        i += 1
        ih = iget(h, ih, g.KH)
    if due:
        row[0], row[1] = h.ci[g.MCTOT], h.cd[g.TIME]
        count[0] += 1
    return due
