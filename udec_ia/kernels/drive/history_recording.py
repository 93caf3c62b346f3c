"""Recording of histories after a cycle (HISTORY): a number of a group, the common block, the whole model."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.compiling.non_inlined_calls import call_entry, entry
from udec_ia.heap.accessors import Memory, at_offset, getr, iget, int64
from udec_ia.kernels.drive.reactions import sum_of_reactions
from udec_ia.kernels.drive.unbalanced_force import force_ratio, unbalanced_force
from udec_ia.kernels.energy.stored_energy import (
    kinetic_energy,
    potential_energy,
    strain_energy,
)
from udec_ia.layout import offsets as g

INTEGER, REAL, DOUBLE = 0, 1, 2  # types of recorded numbers


@outlined
def measure_unbalanced(h: Memory, row: Any, i: int) -> bool:
    """Put the greatest unbalanced force into `row`, at `i`."""
    row[i] = unbalanced_force(h, True)[0]
    return True


@outlined
def measure_ratio(h: Memory, row: Any, i: int) -> bool:
    """The same for the force ratio."""
    row[i] = force_ratio(h, True)
    return True


@outlined
def measure_kinetic(h: Memory, row: Any, i: int) -> bool:
    """The same for the kinetic energy."""
    row[i] = kinetic_energy(h, True)
    return True


@outlined
def measure_strain(h: Memory, row: Any, i: int) -> bool:
    """The same for the strain energy."""
    row[i] = strain_energy(h, True)
    return True


@outlined
def measure_potential(h: Memory, row: Any, i: int) -> bool:
    """The same for the potential of gravity against that at ENERGY ON."""
    row[i] = potential_energy(h) - h.cd[g.EREF]
    return True


@kernel
def history_of_sum(h: Memory, i: int) -> int:
    """The history in column `i` of a row if it is a sum over summands; 0 if it is of the whole model."""
    ih = int64(h.ci[g.IHPNT])
    for _ in range(i - 2):
        ih = iget(h, ih, g.KH)
    return ih if i >= 2 and iget(h, ih, g.KHK) == g.SUMMANDS else int64(0)


@outlined
def measure_x_reaction(h: Memory, row: Any, i: int) -> bool:
    """The same for the sum of reactions in x, of a history or of the whole model."""
    row[i] = sum_of_reactions(h, history_of_sum(h, i))[0]
    return True


@outlined
def measure_y_reaction(h: Memory, row: Any, i: int) -> bool:
    """The same in y."""
    row[i] = sum_of_reactions(h, history_of_sum(h, i))[1]
    return True


@outlined
def measure_moment(h: Memory, row: Any, i: int) -> bool:
    """The same for their moment about the origin."""
    row[i] = sum_of_reactions(h, history_of_sum(h, i))[2]
    return True


# Of the whole model, in the order of reader.recordable_numbers.QUANTITIES.
MEASURED = (
    *(measure_unbalanced, measure_ratio, measure_kinetic, measure_strain, measure_potential),
    *(measure_x_reaction, measure_y_reaction, measure_moment),
)
NOT_MEASURED = (0,) * len(MEASURED)


def measures(h: Memory) -> tuple[Any, ...]:
    """Addresses of these (compiling.non_inlined_calls), 0 for those that no history records."""
    asked, ih = set(), h.ci[g.IHPNT]
    while ih != 0:
        if iget(h, ih, g.KHK) < g.COMMON_BLOCK:
            asked.add(int(iget(h, ih, g.KHF)))
        ih = iget(h, ih, g.KH)
    row = np.empty(0)
    return tuple(entry(one, h, row, 0) if k in asked else 0 for k, one in enumerate(MEASURED))


def measured(h: Memory, which: int) -> float:
    """Quantity `which` of the whole model, in that order."""
    row = np.empty(1)
    MEASURED[which](h, row, 0)
    return float(row[0])


@kernel
def number_now(h: Memory, ih: int, offset: int, type_code: int) -> float:
    """The number of a group or of the common block that history `ih` records.

    NaN if its group does not exist any more.
    """
    kind, group = iget(h, ih, g.KHK), iget(h, ih, g.KHG)
    if kind == g.COMMON_BLOCK:
        if type_code == DOUBLE:
            return float(h.cd[offset])
        return float(h.cr[offset]) if type_code == REAL else float(h.ci[offset])
    if group == 0:
        return np.nan
    k = at_offset(offset, kind, g.KHG)
    return float(getr(h, group, k)) if type_code == REAL else float(iget(h, group, k))


@outlined
def record(h: Memory, places: Any, rows: Any, count: Any, measures: Any) -> bool:
    """Add a row with the numbers to record after this cycle: cycle, time, and NaN for all others.

    Returns True if anything was. places: see ops.commands.history_definitions.places. count: number of rows,
    in an array. measures: addresses of kernels that measure the whole model, as `measures` returns them.
    """
    row = rows[count[0]]
    due = False
    i = 0
    ih = int64(h.ci[g.IHPNT])
    while ih != 0:
        row[2 + i] = np.nan
        if h.ci[g.MCTOT] % iget(h, ih, g.KHN) == 0:
            if iget(h, ih, g.KHK) < g.COMMON_BLOCK:
                call_entry(measures[places[i, 0]], h, row, int64(2 + i))
            else:
                row[2 + i] = number_now(h, ih, places[i, 0], places[i, 1])
            due = True
        i += 1
        ih = iget(h, ih, g.KH)
    if due:
        row[0], row[1] = h.ci[g.MCTOT], h.cd[g.TIME]
        count[0] += 1
    return due
