"""The damping modes that only lead to rest, in one table: LOCAL, COMBINED, KINETIC, ADAPTIVE.

DAMPING, the passes of a run, the safe time-step, warnings and `udec info` read it. The effect of a mode on
forces and velocities is in dynamic_relaxation.py and kinetic_damping.py. At most one mode acts at a time
(LREST, RESTF). Rayleigh damping (ALPHA, BETA) is separate.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from udec_ia.heap.accessors import Memory
from udec_ia.kernels.drive.kinetic_damping import damp_by_motion
from udec_ia.layout import offsets as g


class DampingMode(NamedTuple):
    """One damping mode.

    keyword: in DAMPING; its upper-case letters must be typed. code: value of LREST. help: for HELP DAMPING.
    report: for the beginning of a run, with {f} for the fraction RESTF. fraction: name of its number, 0 to 1;
    "" without a number. motion_pass: kernel that evaluates the motion of the whole model before each step;
    None if not needed. changes_forces: kernels/drive/dynamic_relaxation.py replaces the unbalanced forces.
    keeps_forces: it needs those of the previous cycle. stiffens: for motion that reverses in every cycle
    joints are 1 + f times as stiff, so the safe step is shorter. sets_alpha: the mode calculates ALPHA and
    ALPB.
    """

    keyword: str
    code: int
    help: str
    report: str
    fraction: str = ""
    motion_pass: Any = None
    changes_forces: bool = False
    keeps_forces: bool = False
    stiffens: bool = False
    sets_alpha: bool = False

    @property
    def name(self) -> str:
        """The name in messages."""
        return self.keyword.upper()

    @property
    def argument(self) -> str:
        """The argument of Model.damping."""
        return self.keyword.lower()


MODES = (
    DampingMode(
        "Local",
        g.LOCAL,
        help="opposes the velocity with the fraction f of every unbalanced force",
        report="takes {f:g} of every unbalanced force",
        fraction="f",
        changes_forces=True,
        stiffens=True,
    ),
    DampingMode(
        "Combined",
        g.COMBINED,
        help="takes half of that, and half against the change of the force",
        report="takes {f:g} of every unbalanced force that swings",
        fraction="f",
        changes_forces=True,
        keeps_forces=True,
        stiffens=True,
    ),
    DampingMode(
        "Kinetic",
        g.KINETIC,
        help="stops all motion when the kinetic energy has passed a peak",
        report="stops all when the kinetic energy has passed a peak",
        motion_pass=damp_by_motion,
        changes_forces=True,
    ),
    DampingMode(
        "Adaptive",
        g.ADAPTIVE,
        help="is mass damping, with f the fraction of critical damping for what moves",
        report="is {f:g} of critical for what still moves",
        fraction="f",
        motion_pass=damp_by_motion,
        keeps_forces=True,
        sets_alpha=True,
    ),
)
BY_CODE = {one.code: one for one in MODES}


def mode_of(h: Memory) -> DampingMode | None:
    """The active mode, None if there is none."""
    return BY_CODE.get(int(h.ci[g.LREST]))
