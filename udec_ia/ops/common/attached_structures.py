"""Structures between two cycles: points that belong to blocks are found again, and forces are summed again.

A command may cut blocks, merge them, delete them or divide them into zones. The points of structures keep
their places, and belong to what is there then. A structure without a block at one of its ends is given back.
"""

from __future__ import annotations

from udec_ia.heap.accessors import Memory, integers
from udec_ia.kernels.structures.bolts import attach_bolts, push_by_bolts
from udec_ia.layout import offsets as g
from udec_ia.ops.common.listed_groups import drop, list_of


def has_structures(h: Memory) -> bool:
    """True if there is any structure."""
    return bool(h.ci[g.IBTPNT])


def number_of_structures(h: Memory) -> int:
    """How many there are."""
    return len(list_of(h, "bolt"))


def attach(h: Memory) -> bool:
    """Find the blocks of all points of structures again; True if one has changed."""
    changed, bolts = attach_bolts(h), list_of(h, "bolt")
    lost = bolts[(integers(h, bolts, g.KAB1) == 0) | (integers(h, bolts, g.KAB2) == 0)]
    drop(h, "bolt", lost.tolist())
    return bool(changed)


def push_by_structures(h: Memory) -> None:
    """Add the forces of all structures to the force sums of the blocks to which they belong now."""
    if has_structures(h):
        attach(h)
        push_by_bolts(h)
