"""Cycles that are watched: numbers are recorded (HISTORY), and the balance of forces ends them (SOLVE).

The compiled loop runs from one cycle at which something is due to the next, writes what is due into the
caller's arrays, and comes back when these are full. What is due depends on the total number of cycles alone:
a history with KHN 10 is recorded after the cycles 10, 20, 30 ... however the run is cut into commands.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.compiling.outlined_calls import call_entry
from udec_ia.heap.accessors import Memory, iget, int64
from udec_ia.kernels.drive.cycle import has_to_judge, run_cycles
from udec_ia.kernels.drive.openings import LOOK
from udec_ia.kernels.drive.passes import MEASURES, OPENINGS, RECORD, REST
from udec_ia.layout import offsets as g

CHECK = 10  # cycles between two looks at the force ratio


@kernel
def until_due(h: Memory, limit: int) -> int:
    """Cycles until the next history is due, or `limit` if that comes first."""
    cycles = int64(limit)
    ih = int64(h.ci[g.IHPNT])
    while ih != 0:
        every = iget(h, ih, g.KHN)
        cycles = min(cycles, every - h.ci[g.MCTOT] % every)
        ih = iget(h, ih, g.KH)
    return cycles


@kernel
def run_watched(
    h: Memory, n: int, laws: Any, ratio: float, places: Any, rows: Any, count: Any, marks: Any, passes: Any
) -> tuple[int, bool]:
    """Up to `n` cycles; returns how many were completed, and whether the model is at rest to within `ratio`.

    laws: three arguments of run_cycles. passes: see drive.passes. places: without rows if nothing is
    recorded. marks: of drive.openings, without any if nobody looks at them.
    Stops early when NERR is set, when `rows` is full, when a safe time-step has to be judged, and at rest,
    which is looked at every CHECK cycles of the run; to within a negative ratio it never is.
    """
    recorded = len(places) > 0
    done = 0
    while done < n and count[0] < len(rows):
        ahead = min(int64(n - done), CHECK - h.ci[g.MCTOT] % CHECK) if ratio >= 0 else int64(n - done)
        if len(marks) > 0:
            ahead = min(ahead, int64(LOOK - h.ci[g.MCTOT] % LOOK))
        before = h.ci[g.MCTOT]
        asked = until_due(h, ahead) if recorded else ahead
        completed = run_cycles(h, asked, laws[0], laws[1], laws[2], passes)
        done += completed
        if recorded and h.ci[g.MCTOT] > before:
            call_entry(passes[RECORD], h, places, rows, count, passes[MEASURES])
        if len(marks) > 0 and h.ci[g.MCTOT] > before and h.ci[g.MCTOT] % LOOK == 0:
            call_entry(passes[OPENINGS], h, marks)
        if completed < asked or h.ci[g.NERR] != 0:
            return done, False
        if ratio >= 0 and h.ci[g.MCTOT] % CHECK == 0 and call_entry(passes[REST], h, ratio):
            return done, True
        if has_to_judge(h):
            return done, False
    return done, False
