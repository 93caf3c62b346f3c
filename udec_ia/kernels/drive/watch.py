"""Cycles that are watched: numbers are recorded (HISTORY), and the balance of forces ends them (SOLVE).

The compiled loop runs from one cycle at which something is due to the next, writes what is due into the
caller's arrays, and comes back when these are full. What is due depends on the total number of cycles alone:
a history with KHN 10 is recorded after the cycles 10, 20, 30 ... however the run is cut into commands.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.heap.jit import kernel
from udec_ia.kernels.drive.cycle import run_cycles
from udec_ia.kernels.drive.unbalanced import at_rest, force_ratio, unbalanced
from udec_ia.kernels.energy.stored import height, kinetic, strain_of_blocks, strain_of_contacts
from udec_ia.layout import offsets as g

CHECK = 10  # cycles between two looks at the force ratio
COMMON_BLOCK = 0
UNBALANCED, RATIO, KINETIC, STRAIN = 0, 1, 2, 3
INTEGER, REAL, DOUBLE = 0, 1, 2  # types of what is recorded


@kernel
def quantity(h: Memory, which: int, soft: Any) -> float:
    """Quantity `which` of the whole model, in the order of ops.commands.recordable.QUANTITIES."""
    if which == UNBALANCED:
        return float(unbalanced(h, soft)[0])
    if which == RATIO:
        return float(force_ratio(h, soft))
    if which == KINETIC:
        return kinetic(h, soft)
    if which == STRAIN:
        return strain_of_contacts(h) + strain_of_blocks(h, soft)
    return height(h) - h.cd[g.EREF]


@kernel
def number_now(h: Memory, ih: int, offset: int, type_code: int, soft: Any) -> float:
    """What history `ih` has to record now; not a number if its group has gone."""
    kind, group = iget(h, ih, g.KHK), iget(h, ih, g.KHG)
    if kind < COMMON_BLOCK:
        return quantity(h, offset, soft)
    if kind == COMMON_BLOCK:
        if type_code == DOUBLE:
            return float(h.cd[offset])
        return float(h.cr[offset]) if type_code == REAL else float(h.ci[offset])
    if group == 0:
        return np.nan
    k = (offset, offset, offset)
    return float(getr(h, group, k)) if type_code == REAL else float(iget(h, group, k))


@kernel
def until_due(h: Memory, at_most: int) -> int:
    """Cycles until the next history is due, or `at_most` if that comes first."""
    least = int64(at_most)
    ih = int64(h.ci[g.IHPNT])
    while ih != 0:
        every = iget(h, ih, g.KHN)
        least = min(least, every - h.ci[g.MCTOT] % every)
        ih = iget(h, ih, g.KH)
    return least


@kernel
def record(h: Memory, soft: Any, places: Any, rows: Any, count: Any) -> bool:
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
            row[2 + i] = number_now(h, ih, places[i, 0], places[i, 1], soft)
            due = True
        i += 1
        ih = iget(h, ih, g.KH)
    if due:
        row[0], row[1] = h.ci[g.MCTOT], h.cd[g.TIME]
        count[0] += 1
    return due


@kernel
def run_watched(
    h: Memory, n: int, laws: Any, ratio: float, places: Any, rows: Any, count: Any, update: Any
) -> tuple[int, bool]:
    """Up to `n` cycles; returns how many were completed, and whether the model is at rest to within `ratio`.

    laws: four arguments of run_cycles. update: its last one. places: without rows if nothing is recorded.
    Stops early when NERR is set, when `rows` is full, and at rest, which is looked at every CHECK cycles of
    the run; to within a negative ratio it never is.
    """
    recorded = len(places) > 0
    done = 0
    while done < n and count[0] < len(rows):
        ahead = min(int64(n - done), CHECK - h.ci[g.MCTOT] % CHECK) if ratio >= 0 else int64(n - done)
        before = h.ci[g.MCTOT]
        asked = until_due(h, ahead) if recorded else ahead
        completed = run_cycles(h, asked, laws[0], laws[1], laws[2], laws[3], update)
        done += completed
        if recorded and h.ci[g.MCTOT] > before:
            record(h, laws[0], places, rows, count)
        if completed < asked or h.ci[g.NERR] != 0:
            return done, False
        if ratio >= 0 and h.ci[g.MCTOT] % CHECK == 0 and at_rest(h, laws[0], ratio):
            return done, True
    return done, False
