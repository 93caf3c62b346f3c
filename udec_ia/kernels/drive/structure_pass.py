"""The pass of structures (BOLT): what blocks strain in a step, and its forces on them.

It runs after the contact pass, when blocks have moved and their force sums have begun: its forces add to these.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import outlined
from udec_ia.heap.accessors import Memory
from udec_ia.kernels.structures.bolts import move_bolts


@outlined
def structure_pass(h: Memory) -> bool:
    """All structures, after the step of the blocks."""
    move_bolts(h)
    return True
