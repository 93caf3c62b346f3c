"""The monitors of a model: what its runs are watched for, from one CYCLE to the next.

They warn of a time-step that may be unstable and of contacts that chatter, stop a run that gains energy from
nowhere, and know the work of friction until the model was at rest last. None of it is a part of the state.
"""

from __future__ import annotations

from collections.abc import Callable

from udec_ia.advice.contact_chatter_monitor import ChatterMonitor
from udec_ia.advice.energy_monitor import EnergyMonitor
from udec_ia.advice.time_step_warnings import is_safe
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.cycle_observer import Observer, between_cycles


class RunMonitors(Observer):
    """Monitors one model. laws: the user's laws. tell: takes warnings.

    rested: work of friction until the model was at rest last, or was first looked at, in J/m; None before.
    """

    def __init__(self, laws: LawBook, tell: Callable[[str], None] = lambda warning: None) -> None:
        self.laws = laws
        self.energy = EnergyMonitor(tell)
        self.chatter = ChatterMonitor(tell)
        self.rested: float | None = None

    def friction_until_rest(self, array: MainArray) -> float:
        """Work of friction until the model was at rest last. ENERGY ON begins its sum anew."""
        taken = float(array.h.cd[g.WFRIC])
        if self.rested is None or taken < self.rested:
            self.rested = taken
        return self.rested

    def begin(self, array: MainArray, solves: bool) -> None:
        """See Observer."""
        self.energy.begin(array, self.laws.bind(array).own_blocks)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the next look. They depend on the number of the cycle alone."""
        return min(n, self.energy.cycles_ahead(array.h))

    def look(self, array: MainArray, cycles: int) -> None:
        """See Observer. Error 37 if the run gains energy from nowhere."""
        if between_cycles(array.h):
            self.chatter.judge(array, is_safe(array.h, self.energy.safe))
            self.energy.look(array)

    def end(self, array: MainArray) -> None:
        """See Observer."""
        self.energy.end(array)
