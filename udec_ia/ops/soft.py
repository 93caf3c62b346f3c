"""What the passes of the cycle need to know of deformable blocks (report 4.2)."""

from __future__ import annotations

from typing import Any

from offsets.generated import NSOFT
from udec_ia.heap.array import MainArray


def soft(array: MainArray) -> Any:
    """None if all blocks are rigid: the passes are then compiled without anything else."""
    return (0, 0, 0, 0) if array.h.ci[NSOFT] else None
