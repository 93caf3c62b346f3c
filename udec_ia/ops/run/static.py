"""SOLVE ... STATIC: what leads to rest in few cycles, for one run; then all is as it was.

LOCAL damping takes from whatever swings, at all frequencies alike; scaled masses let all of the model answer
within the same number of cycles; and the step is the greatest that is safe, but for what contacts that are
yet to be made need. What nothing holds would drift on for ever, so there is a little mass damping, too, which
takes a fifth of a per cent of every velocity in a cycle. There is no other damping. What a model passes
through on the way is not what it would pass through: friction and plastic strain may remember it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from udec_ia.heap.array import MainArray
from udec_ia.kernels.drive.peaks import halt_all
from udec_ia.kernels.links.relaxations import lose_relaxations
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.settings import set_fraction, set_relaxation
from udec_ia.ops.run.cycle import prepare

DAMPED = 0.8  # of the unbalanced force
SHARE = 0.8  # of the safe time-step
DRAG = 0.002  # of a velocity in a cycle
STATIC = (
    f"STATIC: LOCAL damping {DAMPED:g}, {SHARE:g} of the safe time-step with scaled masses, "
    "for this SOLVE alone"
)
INTEGERS = (g.LREST, g.LSAFE, g.LSCALE)
REALS = (g.RESTF, g.ALPHA, g.ALPB, g.BETA, g.FRAC)


@contextmanager
def statically(array: MainArray) -> Iterator[None]:
    """A run to rest of `array`. Error 26 while an account of the energy is kept, and those of CYCLE."""
    ci, cr = array.h.ci, array.h.cr
    kept = [int(ci[k]) for k in INTEGERS], [cr[k] for k in REALS], float(array.h.cd[g.EMOVES])
    set_fraction(array, SHARE, scaled=True)
    set_relaxation(array, "local", DAMPED)
    cr[g.BETA] = 0
    try:
        ci[g.LREADY] = 0
        prepare(array)  # finds the time-step
        cr[g.ALPHA] = DRAG / cr[g.TDEL]
        ci[g.LREADY] = 0
        yield
    finally:
        h = array.h
        halt_all(h)  # how fast scaled masses were says nothing of true ones
        lose_relaxations(h)
        h.ci[list(INTEGERS)], h.cr[list(REALS)], h.cd[g.EMOVES] = kept
        h.ci[g.LREADY] = 0
