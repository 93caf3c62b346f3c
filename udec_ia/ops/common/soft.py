"""What the passes of the cycle need to know of deformable blocks and boundary conditions (report 4.2)."""

from __future__ import annotations

from typing import Any

from udec_ia.heap.accessors import Memory
from udec_ia.heap.array import MainArray
from udec_ia.layout import offsets as g


def soft(array: MainArray) -> Any:
    """None if all blocks are rigid and no condition acts on them: the rest is not compiled then."""
    return soft_in(array.h)


def soft_in(h: Memory) -> Any:
    """The same of a memory."""
    return True if h.ci[g.NSOFT] or h.ci[g.IBNPNT] else None
