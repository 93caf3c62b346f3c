"""Which contacts open and close again and again: a look at all of them, every LOOK cycles.

A mark holds whether its contact bore a force at the last look, and twice how often that has been another way
than at the look before. Two contacts are never so near to each other in IA() that they share a mark.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import outlined
from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.layout import offsets as g

LOOK = 100  # cycles from one look to the next
STRIDE = min(g.NVCN[:3])  # words of IA() that share a mark; behind the three sizes there may be more


@outlined
def note_openings(h: Memory, marks: Any) -> bool:
    """Look at all contacts. marks: one byte for STRIDE words of IA(); none for those behind."""
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        k = ic // STRIDE
        if k < len(marks):
            closed = 1 if getr(h, ic, g.KCFN) != 0 else 0
            if marks[k] % 2 != closed:
                marks[k] += 3 if closed == 1 else 1
        ic = iget(h, ic, g.KC)
    return True
