"""What damps, how much and on what: for remarks, for runs that do not come to rest, for the time-step."""

from __future__ import annotations

import math

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, integers
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.layout import offsets as g


def has_dashpots(h: Memory) -> bool:
    """True if boundary conditions are viscous."""
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    return bool(len(bounds)) and any(bool(np.any(getr(h, bounds, k))) for k in (g.KUCXX, g.KUCYY))


def has_simply_deformable(h: Memory) -> bool:
    """True if there are simply-deformable blocks."""
    if not h.ci[g.NSOFT]:
        return False
    return bool((integers(h, addresses(h, int(h.ci[g.IBPNT]), g.KB), HEAD) == g.MSDEF).any())


def what_damps(h: Memory) -> list[str]:
    """Each kind of damping that acts, with its numbers and on what."""
    found, mode = [], mode_of(h)
    if mode:
        found.append(f"{mode.name} damping {mode.report.format(f=float(h.cr[g.RESTF]))}")
    elif h.cr[g.ALPHA]:
        found.append(f"MASS damping takes ALPHA = {h.cr[g.ALPHA]:.3g} 1/s of every velocity")
    if h.cr[g.BETA]:
        found.append(f"STIFFNESS damping, BETA = {h.cr[g.BETA]:.3g} s, acts on contacts that do not slip")
    if h.cr[g.ALPB] and has_simply_deformable(h):
        found.append(f"INTERNAL damping takes {h.cr[g.ALPB]:.3g} 1/s of the strain rates of SDEF blocks")
    if has_dashpots(h):
        found.append("dashpots of BOUNDARY act where they are")
    return found


UNDAMPED = "damping: none; only friction takes energy"


def damping(h: Memory) -> str:
    """One line for the beginning of a run: what damps, how much and on what, or UNDAMPED.

    Of MASS damping also the frequency at which it is critical: nothing swings more slowly.
    """
    found = what_damps(h)
    if h.cr[g.ALPHA] and not h.ci[g.LREST]:
        found[0] += f", critical at {h.cr[g.ALPHA] / (4 * np.pi):.3g} Hz"
    return f"damping: {'; '.join(found)}" if found else UNDAMPED


def fraction_of_critical(h: Memory, w: float) -> float:
    """Of Rayleigh damping, for what swings at `w` (rad/s)."""
    return float(h.cr[g.ALPHA]) / (2 * w) + float(h.cr[g.BETA]) * w / 2 if w > 0 else 0.0


def damped(h: Memory, step: float) -> float:
    """The critical time-step with the damping of `h`, `step` being that without it.

    A dashpot lowers it from 2/w to (2/w)(sqrt(1 + L^2) - L), where L = BETA w/2 is its fraction of critical
    damping at the frequency w. What swings as fast as the step lets it turns about in each cycle: LOCAL and
    COMBINED damping then add f times the force that turns it, so that joints are 1 + f times as stiff.
    """
    if step == 0:
        return 0.0
    step /= _stiffened(h)
    share = float(h.cr[g.BETA]) / step
    return step / (math.hypot(1, share) + share)


def undamped(h: Memory, step: float) -> float:
    """The critical time-step without damping, where `step` is that with it."""
    beta = float(h.cr[g.BETA])
    return math.sqrt((step + beta) ** 2 - beta**2) * _stiffened(h)


def _stiffened(h: Memory) -> float:
    """By how much LOCAL and its kind of damping raise the frequency of what turns about in every cycle."""
    mode = mode_of(h)
    return math.sqrt(1 + float(h.cr[g.RESTF])) if mode and mode.stiffens else 1.0
