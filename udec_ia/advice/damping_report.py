"""The damping that acts in a model, in words."""

from __future__ import annotations

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, integers
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.layout import offsets as g
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.remark import Remark

UNDAMPED = Remark("undamped", "damping: none; only friction takes energy")


def what_damps(h: Memory) -> list[str]:
    """One phrase for each kind of damping that acts."""
    found, mode = [], mode_of(h)
    if mode:
        found.append(f"{mode.name} damping {mode.report.format(f=float(h.cr[g.RESTF]))}")
    elif h.cr[g.ALPHA]:
        found.append(f"MASS damping reduces every velocity at the rate ALPHA = {h.cr[g.ALPHA]:.3g} 1/s")
    if h.cr[g.BETA]:
        found.append(f"STIFFNESS damping, BETA = {h.cr[g.BETA]:.3g} s, acts on contacts that do not slip")
    blocks, conditions = list_of(h, "block"), list_of(h, "bound")
    if h.cr[g.ALPB] and (integers(h, blocks, HEAD) == g.MSDEF).any():
        found.append(
            f"INTERNAL damping reduces the strain rates of SDEF blocks at the rate {h.cr[g.ALPB]:.3g} 1/s"
        )
    if any(np.any(getr(h, conditions, k)) for k in (g.KUCXX, g.KUCYY)):
        found.append("viscous boundaries damp at their edges")
    return found


def describe_damping(h: Memory) -> Remark:
    """One line for the beginning of a run, with the frequency at which MASS damping is critical."""
    found = what_damps(h)
    if h.cr[g.ALPHA] and not h.ci[g.LREST]:
        found[0] += f", critical at {h.cr[g.ALPHA] / (4 * np.pi):.3g} Hz"
    return Remark("damping", f"damping: {'; '.join(found)}") if found else UNDAMPED
