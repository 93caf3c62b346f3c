"""The damping modes that only lead to rest: LOCAL, COMBINED, KINETIC, ADAPTIVE (DAMPING in the field table).

DAMPING, the passes of a run, the safe time-step, warnings and `udec info` read them. The effect of a mode on
forces and velocities is in damped_forces.py and kinetic_damping.py. At most one mode acts at a time
(LREST, RESTF). Rayleigh damping (ALPHA, BETA) is separate.
"""

from __future__ import annotations

from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import DampingMode, read_table

MODES = read_table().damping
BY_CODE = {one.code: one for one in MODES}


def mode_of(h: Memory) -> DampingMode | None:
    """The active mode, None if there is none."""
    return BY_CODE.get(int(h.ci[g.LREST]))
