"""What is watched from one CYCLE of a model to the next, beside its heap.

Of a run it is asked whether it gains energy from nowhere (runaway.py), whether its contacts chatter
(chatter.py), what rounding has done to its places (drift.py, strides.py), what friction has taken since it
was at rest, and whether a safe time-step is to be found anew. Each knows how things stood before; none of it
is a part of the state.
"""

from __future__ import annotations

from collections.abc import Callable

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.run.chatter import Chatter
from udec_ia.ops.run.drift import Drift
from udec_ia.ops.run.renewal import renew
from udec_ia.ops.run.runaway import Runaway
from udec_ia.ops.run.strides import Strides
from udec_ia.ops.run.timestep import is_safe, shortened


class Guard:
    """Watches one model. tell: takes warnings.

    rested: work of friction until the model was at rest last, or was first looked at, in J/m; None before.
    """

    def __init__(self, tell: Callable[[str], None] = lambda warning: None) -> None:
        self.tell = tell
        self.runaway = Runaway(tell)
        self.chatter = Chatter(tell)
        self.drift = Drift()
        self.strides = Strides()
        self.rested: float | None = None
        self._shortened = False

    def since_rest(self, array: MainArray) -> float:
        """Work of friction until the model was at rest last. ENERGY ON begins its sum anew."""
        taken = float(array.h.cd[g.WFRIC])
        if self.rested is None or taken < self.rested:
            self.rested = taken
        return self.rested

    def ahead(self, h: Memory) -> int:
        """Cycles until the next look. It depends on the number of the cycle alone."""
        return self.runaway.ahead(h)

    def look(self, array: MainArray) -> None:
        """What a run is watched for, every some cycles. Error 37 if it gains energy from nowhere.

        A SAFE time-step and scaled masses are renewed if that is due; that a step is shorter is told once.
        """
        self.chatter.judge(array, is_safe(array.h, self.runaway.safe))
        self.runaway.look(array)
        self.strides.look(array)
        before = float(array.h.cr[g.TDEL])
        safe = renew(array)
        said = "" if safe is None or self._shortened else shortened(array, before, safe)
        if said:
            self._shortened = True
            self.tell(said)
