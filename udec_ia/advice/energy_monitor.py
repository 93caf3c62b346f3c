"""The monitor of energy from nowhere: it judges the time-step before a run, and the energy on the way.

No mode is faster than the safe bound, so a step below it makes no vibration grow (timestep.py). Even then a
block that strikes another may leave faster than it came: a mass m that meets a stiffness K at the very
beginning of a step dt has lost K v dt dt/m of its velocity v by the next one, and leaves with v (K dt dt/m -
1). That is more than v for a step above 0.7 of the critical one. So a step up to 0.7 of the bound is not
suspected of anything, and costs nothing but the bound, once for each step, and again when contacts have been
made.

Of a suspected run the energy is looked at every 100 cycles. What there can be is what there was, what
commands and boundary conditions have put in (WDRIVE), and what gravity has given. Damping and friction only
take. What there is,

    kinetic energy + strain energy + work of friction + what has been lifted

may be more, by errors of the formulation (docs/energy.md) and as velocities are known at half steps: a
vibration with w dt below 1.8, 0.9 of the critical step, has up to ten times the energy that a small step
would give it. If there is more, no load has made it. The work of friction counts, so that a stack that
rattles is found as well as one that is thrown off; a user's joint law that gives energy reduces it by
as much (constitutive.joint_laws). Nothing is known of a user's block law: blocks that follow one may swell by
themselves, and such runs are not suspected.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
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
    height,
    liveliest,
    strain_of_blocks,
    strain_of_contacts,
)
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft_in
from udec_ia.ops.common.number_limits import last_digit
from udec_ia.running.critical_step import bound
from udec_ia.running.group_names import name_of
from udec_ia.running.stiffness_bound import StepLimit, damped_step

SUSPECT = 0.7  # share of the safe bound from which on a run is suspected
FACTOR = 10  # what there is over what there can be
LOOK = 100  # cycles between two looks at the energy; JUDGE of them at the contacts made, and at chatter
OTHER_STEP = 1.05  # step that the bound is found anew for, over that of before


class Stock(NamedTuple):
    """Energy in J/m: kinetic and strain, lost to friction, and potential of gravity against the origin."""

    stored: float
    friction: float
    potential: float


@dataclass(frozen=True)
class Account:
    """What a suspected run began with. driven: WDRIVE. grain: what no look can tell from nothing.

    begun: with what commands have changed between two CYCLEs. ended: when the last CYCLE ended.
    """

    begun: Stock
    ended: Stock
    driven: float
    grain: float


class EnergyMonitor:
    """Monitors one model. tell: takes warnings. safe: the safe bound of the time-step, as found last."""

    def __init__(self, tell: Callable[[str], None] = lambda warning: None) -> None:
        self.tell = tell
        self.safe = StepLimit(np.inf, 0)
        self._judged = (0.0, 0.0, -1)  # step, what damping left of it, and contacts made at that time
        self._warned = (0.0, 0.0)  # step, and what damping left of it
        self._suspected = self._own_laws = False
        self._account: Account | None = None

    def judge(self, array: MainArray, anew: bool = False) -> None:
        """Find the safe bound if it may have changed, or `anew`; warn of a step above it, once for each."""
        h = array.h
        step, made = float(h.cr[g.TDEL]), int(h.ci[g.NMADE])
        left = damped_step(h, step)  # of a critical step like this one
        if _alike(step, left, *self._judged[:2]) and made == self._judged[2] and not anew:
            return
        self._judged = step, left, made
        self.safe = bound(array)
        self._suspected = step > SUSPECT * damped_step(h, self.safe.step)
        warning = step_warning(array, self.safe)
        if warning is not None and not _alike(step, left, *self._warned):
            self._warned = step, left
            self.tell(warning)

    def begin(self, array: MainArray, own_laws: bool) -> None:
        """A CYCLE begins, whose step was judged. own_laws: deformable blocks follow the user's laws."""
        self._own_laws = own_laws
        if not self._suspected or own_laws:
            self._account = None
            return
        now, account = _stock(array.h), self._account
        if account is None:
            self._account = Account(now, now, float(array.h.cd[g.WDRIVE]), _grain(array))
            return
        begun, ended = account.begun, account.ended
        changed = Stock(
            begun.stored + max(now.stored - ended.stored, 0.0),
            begun.friction + now.friction - ended.friction,
            begun.potential + now.potential - ended.potential,
        )
        self._account = replace(account, begun=changed)

    def end(self, array: MainArray) -> None:
        """A CYCLE has ended."""
        if self._account is not None:
            self._account = replace(self._account, ended=_stock(array.h))

    def cycles_ahead(self, h: Memory) -> int:
        """Cycles until the next look. It depends on the number of the cycle alone."""
        every = JUDGE if self._account is None else LOOK
        return every - int(h.ci[g.MCTOT]) % every

    def look(self, array: MainArray) -> None:
        """Error 37 if there is more energy than there can be. A run not suspected is judged again."""
        h, account = array.h, self._account
        if account is None and h.ci[g.MCTOT] % JUDGE == 0:
            self.judge(array)
            self.begin(array, self._own_laws)
        if account is None or h.ci[g.MCTOT] % LOOK:
            return
        now, begun = _stock(h), account.begun
        lifted = now.potential - begun.potential
        there = now.stored + now.friction - begun.friction + max(lifted, 0.0)
        driven = float(h.cd[g.WDRIVE]) - account.driven + float(power_of_loads(h)) * float(h.cr[g.TDEL])
        came = begun.stored + driven + max(-lifted, 0.0)
        if there > FACTOR * (came + account.grain):
            raise self._error(array, there, came)

    def _error(self, array: MainArray, there: float, came: float) -> UdecError:
        h = array.h
        _, largest, at = liveliest(h, soft_in(h))
        step = float(h.cr[g.TDEL])
        share = step / damped_step(h, self.safe.step)
        self._account = None
        fraction = min(safe_fraction(array, share), float(h.cr[g.FRAC]) / 2)  # a safe step was not enough
        detail = (
            f"there are {there:.3g} J/m in cycle {int(h.ci[g.MCTOT])}, and loads, gravity and commands have "
            f"put in {came:.3g}: {name_of(h, int(at))} leads with {largest:.3g}. The time-step "
            f"of {step:.3g} s was {share:.3g} of the safe bound"
        )
        advice = f"go back to where you began or saved, and take {fraction_line(h, fraction)}"
        return UdecError(OUT_OF_NOWHERE, detail, advice, group=int(at))


def _alike(step: float, beta: float, other_step: float, other_beta: float) -> bool:
    """True if time-steps are the same but for what deformable blocks make of them, and BETA is the same."""
    return other_step / OTHER_STEP < step < other_step * OTHER_STEP and beta == other_beta


def _stock(h: Memory) -> Stock:
    """What there is now."""
    soft = soft_in(h)
    moving = liveliest(h, soft)[0] if h.ci[g.LSCALE] == 0 else energy_of_motion(h)
    strained = float(strain_of_contacts(h)) + float(strain_of_blocks(h, soft))
    return Stock(float(moving) + strained, float(h.cd[g.WFRIC]), float(height(h)))


def _grain(array: MainArray) -> float:
    """Energy that blocks can gain or lose between a place and the next that the reals know, or within a step.

    Where places are rounded to the digit d, a block moves by d in a step or not at all; and at rest under
    gravity g its velocity is g dt half a step later.
    """
    h, dt = array.h, float(array.h.cr[g.TDEL])
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    mass, x, y = (np.asarray(getr(h, blocks, k), np.float64) for k in (g.KBM, g.KX, g.KY))
    digit = last_digit(array, float((np.abs(x) + np.abs(y)).max()))
    gravity = np.hypot(np.float64(h.cr[g.GRAVX]), np.float64(h.cr[g.GRAVY]))
    with np.errstate(over="ignore"):
        return float(mass.sum() * (digit / dt + gravity * dt) ** 2)
