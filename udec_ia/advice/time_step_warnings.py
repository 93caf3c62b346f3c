"""What the time-step of a run is, and the warnings of one that may be unstable."""

from __future__ import annotations

import math

from udec_ia.advice.damping_report import what_damps
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.damping_modes import BY_CODE
from udec_ia.layout import offsets as g
from udec_ia.remark_key import Remark
from udec_ia.running.critical_step import estimate
from udec_ia.running.group_names import name_and_place
from udec_ia.running.stiffness_bound import StepLimit, damped_step

NEAR = 0.8  # of the safe bound: warn of steps from here on if nothing damps
IMPACTS = 0.5  # of the safe bound: what is advised then
LAST_DIGITS = 1e-6  # by which a step in 32-bit reals may be above the bound that it was made of


def is_safe(h: Memory, safe: StepLimit) -> bool:
    """True if the time-step is not above what damping leaves of the bound `safe`."""
    return bool(h.cr[g.TDEL] <= damped_step(h, safe.step) * (1 + LAST_DIGITS))


def fraction_line(h: Memory, fraction: float) -> str:
    """The command FRACTION with another number, of what it is a fraction now."""
    words = " SCALED" if h.ci[g.LSCALE] else " SAFE" if h.ci[g.LSAFE] else ""
    return f"FRACTION {fraction:.2g}{words}"


def safe_fraction(array: MainArray, share: float) -> float:
    """FRACTION of a step that is safe, where the present one is `share` of the critical one.

    It is just below that, or well below it if nothing damps what impacts give.
    """
    return (0.95 if what_damps(array.h) else IMPACTS) * float(array.h.cr[g.FRAC]) / share


def step_warning(array: MainArray, safe: StepLimit) -> Remark | None:
    """A warning of a time-step above what damping leaves of the bound `safe`, or near it; else None."""
    step = float(array.h.cr[g.TDEL])
    critical = damped_step(array.h, safe.step)
    if is_safe(array.h, safe):
        return _near_bound(array, step / critical) if step > NEAR * critical else None
    place = name_and_place(array.h, safe.address)
    if safe.step == 0:
        text = f"no time-step is safe: a mass or a stiffness of {place} is zero, infinite or no number"
        return Remark("no-safe-step", text)
    share = step / critical if critical else math.inf
    fraction = f"{fraction_line(array.h, safe_fraction(array, share))} is safe"
    if step <= safe.step:
        cause, cure = _damping(array.h)
        text = f"{cause} may make the time-step of {step:.3g} s unstable: {fraction}, or {cure}"
        return Remark("step-above-damped-bound", text)
    return Remark(
        "step-above-bound",
        f"the time-step of {step:.3g} s is {share:.3g} of the safe bound, which {place} sets, and may be "
        f"unstable: {fraction}",
    )


def _near_bound(array: MainArray, share: float) -> Remark | None:
    """A warning of a time-step that is just below the safe bound, if nothing damps.

    The bound is that of joints that stay closed. One that closes within a step is pressed by as much as if it
    had been closed all the time, and gives back more than it took.
    """
    if what_damps(array.h):
        return None
    return Remark(
        "step-near-bound",
        f"nothing damps, and the time-step is {share:.2g} of the safe bound, which is that of joints that "
        "stay closed: those that open and close may throw blocks ever higher; take "
        f"{fraction_line(array.h, safe_fraction(array, share))}, or DAMPING",
    )


def _damping(h: Memory) -> tuple[str, str]:
    """The damping that lowers the safe time-step, and what to do instead of taking a shorter one."""
    if h.cr[g.BETA]:
        beta = float(h.cr[g.BETA])
        return f"stiffness damping BETA = {beta:.3g} s", "a smaller fcrit, or MASS damping alone"
    name = BY_CODE[int(h.ci[g.LREST])].name
    return f"{name} damping {float(h.cr[g.RESTF]):g}", "a smaller fraction of it, or ADAPTIVE damping"


def describe_step(array: MainArray, safe: StepLimit) -> str:
    """One line: the time-step, its shares of estimate and safe bound, and which groups set these.

    The bound is what damping leaves of it, as FRACTION ... SAFE takes it.
    """
    step = float(array.h.cr[g.TDEL])
    left = StepLimit(damped_step(array.h, safe.step), safe.address) if math.isfinite(safe.step) else safe
    named = "safe bound" + (" with its damping" if left.step < safe.step else "")
    parts = [
        f"{step / limit.step if limit.step else math.inf:.3g} of the {name} {limit.step:.4g} s "
        f"({name_and_place(array.h, limit.address)})"
        for name, limit in (("estimate", estimate(array)), (named, left))
        if math.isfinite(limit.step)
    ]
    return f"time-step {step:.4g} s, {', '.join(parts)}"
