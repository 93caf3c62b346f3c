"""The monitors of a model, from one CYCLE to the next: of the time-step and the energy, and of chatter.

They also remember the work of friction until the last state of rest. None of this is saved with the state.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from udec_ia.advice.contact_chatter_monitor import ChatterMonitor
from udec_ia.advice.energy_monitor import EnergyMonitor
from udec_ia.advice.time_step_warnings import is_safe
from udec_ia.advice.water_report import check_held, held_pressures
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.cycle_observer import Observer, between_cycles


class RunMonitors(Observer):
    """Monitors one model. laws: the user's laws. tell: takes warnings.

    rested: work of friction until the last state of rest, or until the first run, in J/m; None before.
    """

    def __init__(self, laws: LawBook, tell: Callable[[str], None] = lambda warning: None) -> None:
        self.laws = laws
        self.energy = EnergyMonitor(tell)
        self.chatter = ChatterMonitor(tell)
        self.tell = tell
        self.held: Any = ()
        self.rested: float | None = None

    def friction_until_rest(self, array: MainArray) -> float:
        """Work of friction until the last state of rest. ENERGY ON resets the sum to 0."""
        taken = float(array.h.cd[g.WFRIC])
        if self.rested is None or taken < self.rested:
            self.rested = taken
        return self.rested

    def begin(self, array: MainArray, solves: bool) -> None:
        """Begin the energy account of the run, and list the pressures that are held."""
        self.held = held_pressures(array)
        self.energy.begin(array, self.laws.bind(array).own_blocks)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the next check, which depends on the number of the cycle alone."""
        return min(n, self.energy.cycles_ahead(array.h))

    def look(self, array: MainArray, cycles: int) -> None:
        """Check contacts and energy. Error 37 if the run gains energy from nowhere."""
        if between_cycles(array.h):
            self.chatter.check_window(array, is_safe(array.h, self.energy.safe))
            self.energy.look(array)

    def end(self, array: MainArray) -> None:
        """End the energy account of the run; report held pressures that have ended."""
        for remark in check_held(array, self.held):
            self.tell(remark)
        self.energy.end(array)
