"""The time-step of a run in words, and the warnings of one that may be unstable."""

from __future__ import annotations

import math

from udec_ia.advice.damping_report import what_damps
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.damping_modes import BY_CODE
from udec_ia.layout import offsets as g
from udec_ia.remark import Remark
from udec_ia.running.critical_step import estimate
from udec_ia.running.group_names import name_and_place
from udec_ia.running.stiffness_bound import StepLimit, damped_step

NEAR = 0.8  # of the safe bound: least step that is reported if nothing damps
IMPACTS = 0.5  # of the safe bound: step that is then recommended
LAST_DIGITS = 1e-6  # relative error of a step in 32-bit reals that was calculated from the bound


def is_safe(h: Memory, safe: StepLimit) -> bool:
    """True if the time-step is not above the bound `safe`, reduced by damping."""
    return bool(h.cr[g.TDEL] <= damped_step(h, safe.step) * (1 + LAST_DIGITS))


def fraction_line(h: Memory, fraction: float) -> str:
    """The command FRACTION with another number and the present word."""
    words = " SCALED" if h.ci[g.LSCALE] else " SAFE" if h.ci[g.LSAFE] else ""
    return f"FRACTION {fraction:.2g}{words}"


def safe_fraction(array: MainArray, share: float) -> float:
    """FRACTION of a safe step, where the present step is `share` of the critical one.

    The step is just below the critical one, or well below it if nothing damps impacts.
    """
    return (0.95 if what_damps(array.h) else IMPACTS) * float(array.h.cr[g.FRAC]) / share


def step_warning(array: MainArray, safe: StepLimit) -> Remark | None:
    """A warning of a time-step above the bound `safe`, reduced by damping, or near it; else None.

    Near it a joint that closes within a step may return more energy than it received, as the bound is that of
    joints that stay closed. This counts only if nothing damps.
    """
    h, step = array.h, float(array.h.cr[g.TDEL])
    critical = damped_step(h, safe.step)
    if is_safe(h, safe) and (step <= NEAR * critical or what_damps(h)):
        return None
    place = name_and_place(h, safe.address)
    if safe.step == 0:
        text = f"no time-step is safe: a mass or a stiffness of {place} is zero, infinite or not a number"
        return Remark("no-safe-step", text)
    share = step / critical if critical else math.inf
    fraction = fraction_line(h, safe_fraction(array, share))
    if is_safe(h, safe):
        return Remark(
            "step-near-bound",
            f"there is no damping, and the time-step is {share:.2g} of the safe bound: joints that open and "
            f"close may add energy at each impact; take {fraction}, or DAMPING",
        )
    if step <= safe.step:
        damping = f"stiffness damping BETA = {h.cr[g.BETA]:.3g} s"
        if not h.cr[g.BETA]:
            damping = f"{BY_CODE[int(h.ci[g.LREST])].name} damping {h.cr[g.RESTF]:g}"
        text = f"{damping} may make the time-step of {step:.3g} s unstable: take {fraction} or less damping"
        return Remark("step-above-damped-bound", text)
    return Remark(
        "step-above-bound",
        f"the time-step of {step:.3g} s is {share:.3g} of the safe bound, which {place} sets, and may be "
        f"unstable: {fraction} is safe",
    )


def describe_step(array: MainArray, safe: StepLimit) -> str:
    """One line: the time-step, its shares of estimate and damped safe bound, and which groups set these."""
    step = float(array.h.cr[g.TDEL])
    damped = StepLimit(damped_step(array.h, safe.step), safe.address) if math.isfinite(safe.step) else safe
    named = "safe bound" + (" with its damping" if damped.step < safe.step else "")
    parts = [
        f"{step / limit.step if limit.step else math.inf:.3g} of the {name} {limit.step:.4g} s "
        f"({name_and_place(array.h, limit.address)})"
        for name, limit in (("estimate", estimate(array)), (named, damped))
        if math.isfinite(limit.step)
    ]
    return f"time-step {step:.4g} s, {', '.join(parts)}"
