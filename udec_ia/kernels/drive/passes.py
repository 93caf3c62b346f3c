"""What a cycle calls by its address: what is long, and not needed in every cycle or scene.

Each is compiled once for a word scheme, and once it is needed, instead of in every kind of cycle there is:
rigid or deformable, with and without laws of the user's. `passes` finds what a run needs.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.outlined_calls import entry, entry_if
from udec_ia.heap.accessors import Memory
from udec_ia.kernels.body.bounds import apply_bounds
from udec_ia.kernels.contact.changes import NOBODY, change_map
from udec_ia.kernels.detect.tunnelling import gone_through
from udec_ia.kernels.detect.update import updating
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.drive.openings import note_openings
from udec_ia.kernels.drive.recording import NOT_MEASURED, measures, record
from udec_ia.kernels.drive.relax import relax
from udec_ia.kernels.drive.unbalanced import at_rest, at_rest_in_mean
from udec_ia.kernels.energy.contacts import note_contact
from udec_ia.kernels.energy.work import note_forces, note_loads, note_rigid, note_stresses
from udec_ia.layout import offsets as g

UPDATE, TUNNELLING, BOUNDS, MOTION, RELAX, FORCES, LOADS, STRESSES = range(8)
CONTACT, CHANGES, MEASURES, RECORD, REST, OPENINGS = range(8, 14)


def passes(
    h: Memory, soft: Any, recorded: tuple[Any, ...], ratio: float, mean: bool, marks: Any
) -> tuple[Any, ...]:
    """Addresses in the order above, 0 for what a run does not need; of MEASURES as many.

    soft: as in run_cycles. recorded: places, rows and count of `record`, () if nothing is recorded.
    ratio, marks: as in run_watched. mean: the mean unbalanced force counts, not the greatest.
    A run of slow blocks does not need TUNNELLING; one that does stops before it.
    """
    keeps, loaded, mode = h.ci[g.LENER] != 0, h.ci[g.IBNPNT] != 0, mode_of(h)
    asked = measures(h) if recorded else NOT_MEASURED
    none = h.cr.dtype.type(0)
    pair = none, none
    return (
        updating(h),
        entry_if(bool(h.ci[g.JPHASE] == g.AT_WAYS), gone_through, h),
        entry(apply_bounds, h) if loaded else 0,
        entry(mode.motion_pass, h) if mode and mode.motion_pass else 0,
        entry(relax, h) if (mode and mode.changes_forces) or h.ci[g.LSCALE] else 0,
        entry(note_rigid if soft is None else note_forces, h) if keeps else 0,
        entry(note_loads, h) if keeps and loaded else 0,
        entry(note_stresses, h) if keeps and soft is not None else 0,
        entry(note_contact, h, 0, False, none, pair, pair, pair, pair) if keeps else 0,
        entry(change_map, h, NOBODY, 0),
        asked,
        entry(record, h, *recorded, asked) if recorded else 0,
        entry(at_rest_in_mean if mean else at_rest, h, ratio) if ratio >= 0 else 0,
        entry(note_openings, h, marks) if len(marks) else 0,
    )
