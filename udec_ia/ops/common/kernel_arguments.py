"""Arguments that tell kernels whether there are deformable blocks and boundary conditions (report 4.2).

Code for an argument of None is not compiled.
"""

from __future__ import annotations

from typing import Any

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.contact.ford import sum_all_forces
from udec_ia.kernels.water.water_pressure import press_present
from udec_ia.layout import offsets as g
from udec_ia.ops.common.attached_structures import push_by_structures


def soft(h: Memory) -> Any:
    """None if all blocks are rigid, else True."""
    return True if h.ci[g.NSOFT] else None


def soft_or_loaded_in(h: Memory) -> Any:
    """None if all blocks are rigid, without boundary conditions, in no GROUP and not breakable, else True."""
    return True if h.ci[g.NSOFT] or h.ci[g.IBNPNT] or h.ci[g.IMBPNT] or h.ci[g.IBRPNT] else None


def renew_forces(array: MainArray) -> None:
    """Sum forces of contacts, pressures and structures again, after a change of blocks between two cycles."""
    sum_all_forces(array.h, soft(array.h))
    if array.h.ci[g.LWATER]:
        press_present(array.h)
    push_by_structures(array.h)
