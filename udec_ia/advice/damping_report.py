"""What damps a model, how much and on what."""

from __future__ import annotations

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, integers
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.remark_key import Remark

UNDAMPED = Remark("undamped", "damping: none; only friction takes energy")


def what_damps(h: Memory) -> list[str]:
    """Each kind of damping that acts, with its numbers and on what."""
    found, mode = [], mode_of(h)
    if mode:
        found.append(f"{mode.name} damping {mode.report.format(f=float(h.cr[g.RESTF]))}")
    elif h.cr[g.ALPHA]:
        found.append(f"MASS damping takes ALPHA = {h.cr[g.ALPHA]:.3g} 1/s of every velocity")
    if h.cr[g.BETA]:
        found.append(f"STIFFNESS damping, BETA = {h.cr[g.BETA]:.3g} s, acts on contacts that do not slip")
    if h.cr[g.ALPB] and _has_simply_deformable(h):
        found.append(f"INTERNAL damping takes {h.cr[g.ALPB]:.3g} 1/s of the strain rates of SDEF blocks")
    if _has_dashpots(h):
        found.append("dashpots of BOUNDARY act where they are")
    return found


def describe_damping(h: Memory) -> Remark:
    """One line for the beginning of a run: what damps, how much and on what, or UNDAMPED.

    For MASS damping also the frequency at which it is critical: nothing swings more slowly.
    """
    found = what_damps(h)
    if h.cr[g.ALPHA] and not h.ci[g.LREST]:
        found[0] += f", critical at {h.cr[g.ALPHA] / (4 * np.pi):.3g} Hz"
    return Remark("damping", f"damping: {'; '.join(found)}") if found else UNDAMPED


def _has_dashpots(h: Memory) -> bool:
    """True if boundary conditions are viscous."""
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    return bool(len(bounds)) and any(bool(np.any(getr(h, bounds, k))) for k in (g.KUCXX, g.KUCYY))


def _has_simply_deformable(h: Memory) -> bool:
    """True if there are simply-deformable blocks."""
    if not h.ci[g.NSOFT]:
        return False
    return bool((integers(h, addresses(h, int(h.ci[g.IBPNT]), g.KB), HEAD) == g.MSDEF).any())
