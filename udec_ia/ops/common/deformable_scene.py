"""What kernels need to know of deformable blocks and boundary conditions (report 4.2).

What is None here is left out of the machine code: a rigid scene neither compiles nor tests what it has not.
"""

from __future__ import annotations

from typing import Any

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.contact.ford import sum_all_forces
from udec_ia.layout import offsets as g


def soft(array: MainArray) -> Any:
    """None if all blocks are rigid, else True: what the passes of the cycle look at."""
    return soft_in(array.h)


def soft_in(h: Memory) -> Any:
    """The same of a memory."""
    return True if h.ci[g.NSOFT] else None


def soft_or_loaded_in(h: Memory) -> Any:
    """None if no condition acts on blocks either: for what adds up loads, or cuts what they act on."""
    return True if h.ci[g.NSOFT] or h.ci[g.IBNPNT] else None


# ---- Force sums after SPLIT or DELETE between two cycles


def renew_forces(array: MainArray) -> None:
    """Make every block's force sums the sums of the forces stored in its contacts.

    A block that was cut or has lost a neighbour must not feel in the next cycle what it felt before.
    """
    sum_all_forces(array.h, soft(array))
