"""SOLVE ... STATIC: damping, masses and time-step that lead to rest in few cycles, for one run.

ADAPTIVE damping is near critical for all motion that is left. With scaled masses the whole model responds
within the same number of cycles. The step is the greatest safe one, with a reserve for new contacts. There is
no other damping. The path to rest is not the physical one: friction and plastic strain may remember it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.damping_modes import BY_CODE
from udec_ia.kernels.drive.kinetic_damping import halt_all
from udec_ia.kernels.links.relaxation_groups import lose_relaxations
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.model_settings import set_damping_mode, set_fraction

DAMPED = 0.8  # of critical
SHARE = 0.9  # of the safe time-step
STATIC = (
    f"STATIC: ADAPTIVE damping {DAMPED:g}, {SHARE:g} of the safe time-step with scaled masses, "
    "for this SOLVE alone"
)
INTEGERS = (g.LREST, g.LSAFE, g.LSCALE)
REALS = (g.RESTF, g.ALPHA, g.ALPB, g.BETA, g.FRAC)


@contextmanager
def static_settings(array: MainArray) -> Iterator[None]:
    """The settings of STATIC within this context. Error 26 with an account of the energy."""
    ci, cr = array.h.ci, array.h.cr
    before = [int(ci[k]) for k in INTEGERS], [cr[k] for k in REALS], float(array.h.cd[g.EMOVES])
    set_fraction(array, SHARE, scaled=True)
    set_damping_mode(array, BY_CODE[g.ADAPTIVE], DAMPED)
    cr[g.BETA] = 0
    ci[g.LREADY] = 0
    try:
        yield
    finally:
        h = array.h
        halt_all(h)  # velocities of scaled masses have no meaning
        lose_relaxations(h)
        h.ci[list(INTEGERS)], h.cr[list(REALS)], h.cd[g.EMOVES] = before
        h.ci[g.LREADY] = 0
