"""Force sums after SPLIT or DELETE between two cycles."""

from __future__ import annotations

from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.contact.force_sums import sum_all_forces
from udec_ia.ops.common.soft import soft


def renew_forces(array: MainArray) -> None:
    """Make every block's force sums the sums of the forces stored in its contacts.

    A block that was cut or has lost a neighbour must not feel in the next cycle what it felt before.
    """
    sum_all_forces(array.h, soft(array))
