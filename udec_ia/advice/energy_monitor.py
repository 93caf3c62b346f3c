"""The energy monitor: it checks the time-step before a run, and ends a run that gains energy from nowhere.

A step below the safe bound makes no vibration grow. But a mass m that strikes a stiffness K at the beginning
of a step dt leaves with K dt dt/m - 1 times its velocity. That is more than 1 for a step above 0.7 of the
critical one. So runs with a step above 0.7 of the bound are monitored.

The energy is calculated every 100 cycles:

    kinetic energy + strain energy + work of friction + gravity potential gained

It cannot exceed the initial energy and the input by commands, boundary conditions (WDRIVE) and gravity,
except by errors of the formulation (docs/energy.md) and because velocities are those of half steps: a
vibration with w dt below 1.8, 0.9 of the critical step, appears to have up to ten times its energy. The work
of friction is included, so that a stack that rattles is found, too; a user's joint law that gives energy
reduces it by as much (constitutive.joint_laws). Models whose blocks follow a user's block law are not
monitored: the blocks may expand by themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from udec_ia.advice.contact_chatter_monitor import JUDGE
from udec_ia.advice.time_step_warnings import fraction_line, safe_fraction, step_warning
from udec_ia.errors import OUT_OF_NOWHERE, UdecError
from udec_ia.heap.accessors import Memory, getr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.boundary_conditions import power_of_loads
from udec_ia.kernels.energy.stored_energy import (
    energy_of_motion,
    greatest_motion,
    potential_energy,
    strain_energy,
)
from udec_ia.layout import offsets as g
from udec_ia.ops.common.kernel_arguments import soft
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.common.number_limits import last_digit
from udec_ia.running.critical_step import bound
from udec_ia.running.group_names import name_of
from udec_ia.running.stiffness_bound import StepLimit, damped_step

SUSPECT = 0.7  # share of the safe bound from which on a run is monitored
FACTOR = 10  # greatest energy over the input
LOOK = 100  # cycles between two checks of the energy


class EnergyState(NamedTuple):
    """Energy in J/m. stored: kinetic and strain. friction: its work.

    potential: of gravity, from a reference that changes with gravity that follows a FUNCTION.
    """

    stored: float
    friction: float
    potential: float


class Account(NamedTuple):
    """Energies of a monitored run, which may have several CYCLEs.

    begun: at its beginning, with the changes by commands since. ended: at the end of the last CYCLE.
    driven: WDRIVE at its beginning. rounding_energy: that blocks can gain by rounding.
    """

    begun: EnergyState
    ended: EnergyState
    driven: float
    rounding_energy: float


class EnergyMonitor:
    """Monitors one model. tell: takes warnings. safe: the last safe bound of the time-step."""

    def __init__(self, tell: Callable[[str], None] = lambda warning: None) -> None:
        self.tell = tell
        self.safe = StepLimit(np.inf, 0)
        self._checked = (0.0, 0.0, -1)  # step, the same with its damping, contacts made so far
        self._warned = (0.0, 0.0)  # step, the same with its damping
        self._suspected = self._own_laws = False
        self._account: Account | None = None

    def check_step(self, array: MainArray, anew: bool = False) -> None:
        """Calculate the safe bound if it may have changed, or `anew`; warn once of each step above it."""
        h, step = array.h, float(array.h.cr[g.TDEL])
        now = step, damped_step(h, step), int(h.ci[g.NMADE])
        if now == self._checked and not anew:
            return
        self._checked = now
        self.safe = bound(array)
        self._suspected = step > SUSPECT * damped_step(h, self.safe.step)
        warning = step_warning(array, self.safe)
        if warning is not None and now[:2] != self._warned:
            self._warned = now[:2]
            self.tell(warning)

    def begin(self, array: MainArray, own_laws: bool) -> None:
        """A CYCLE begins after `check_step`. own_laws: deformable blocks follow the user's laws."""
        self._own_laws = own_laws
        if not self._suspected or own_laws:
            self._account = None
            return
        now, account = _energy_state(array.h), self._account
        if account is None:
            self._account = Account(now, now, float(array.h.cd[g.WDRIVE]), _rounding_energy(array))
            return
        begun, ended = account.begun, account.ended
        stored = begun.stored + max(now.stored - ended.stored, 0.0)
        friction = begun.friction + now.friction - ended.friction
        potential = begun.potential + now.potential - ended.potential
        self._account = account._replace(begun=EnergyState(stored, friction, potential))

    def end(self, array: MainArray) -> None:
        """A CYCLE has ended."""
        if self._account is not None:
            self._account = self._account._replace(ended=_energy_state(array.h))

    def cycles_ahead(self, h: Memory) -> int:
        """Cycles until the next check, which depends on the number of the cycle alone."""
        every = JUDGE if self._account is None else LOOK
        return every - int(h.ci[g.MCTOT]) % every

    def look(self, array: MainArray) -> None:
        """Error 37 if there is more energy than was put in. Checks the step of a run not monitored again."""
        h, account = array.h, self._account
        if account is None and h.ci[g.MCTOT] % JUDGE == 0:
            self.check_step(array)
            self.begin(array, self._own_laws)
        if account is None or h.ci[g.MCTOT] % LOOK:
            return
        now, begun = _energy_state(h), account.begun
        lifted = now.potential - begun.potential
        present = now.stored + now.friction - begun.friction + max(lifted, 0.0)
        driven = float(h.cd[g.WDRIVE]) - account.driven + float(power_of_loads(h)) * float(h.cr[g.TDEL])
        supplied = begun.stored + driven + max(-lifted, 0.0)
        if present > FACTOR * (supplied + account.rounding_energy):
            raise self._error(array, present, supplied)

    def _error(self, array: MainArray, present: float, supplied: float) -> UdecError:
        h = array.h
        _, largest, at = greatest_motion(h, soft(h))
        step = float(h.cr[g.TDEL])
        share = step / damped_step(h, self.safe.step)
        self._account = None
        fraction = min(safe_fraction(array, share), float(h.cr[g.FRAC]) / 2)  # a safe step was not enough
        detail = (
            f"there are {present:.3g} J/m in cycle {int(h.ci[g.MCTOT])}, and loads, gravity and commands "
            f"have put in {supplied:.3g}: {name_of(h, int(at))} leads with {largest:.3g}. The time-step "
            f"of {step:.3g} s was {share:.3g} of the safe bound"
        )
        advice = f"run again from the beginning or a saved state, and take {fraction_line(h, fraction)}"
        return UdecError(OUT_OF_NOWHERE, detail, advice, group=int(at))


def _energy_state(h: Memory) -> EnergyState:
    """The energies of the model as it is."""
    kinds = soft(h)
    moving = greatest_motion(h, kinds)[0] if h.ci[g.LSCALE] == 0 else energy_of_motion(h)
    strained = float(strain_energy(h, kinds))
    potential = float(potential_energy(h)) - float(h.cd[g.EREF])
    return EnergyState(float(moving) + strained, float(h.cd[g.WFRIC]), potential)


def _rounding_energy(array: MainArray) -> float:
    """Energy that blocks can gain by rounding of their places to the digit d, or by gravity within a step."""
    h, dt = array.h, float(array.h.cr[g.TDEL])
    blocks = list_of(h, "block")
    mass, x, y = (np.asarray(getr(h, blocks, k), np.float64) for k in (g.KBM, g.KX, g.KY))
    digit = last_digit(array, float((np.abs(x) + np.abs(y)).max()))
    gravity = np.hypot(np.float64(h.cr[g.GRAVX]), np.float64(h.cr[g.GRAVY]))
    with np.errstate(over="ignore"):
        return float(mass.sum() * (digit / dt + gravity * dt) ** 2)
