"""What compiled code has found, however much it is: nearly always nothing."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.interpreting import InterpretWhenSmall
from udec_ia.reader.field_reading import Numbers

ROOM = 100  # rows that are expected


def told(kernel: InterpretWhenSmall, groups: int, columns: int, *args: Any, of: type = int) -> Numbers:
    """The rows that `kernel` finds with `args` and room for some rows; it returns how many there are.

    groups: how many it goes through; of: int or float.
    """
    found = room = ROOM
    while found >= room:  # once more, if there are more than had room
        room = found + 1
        rows: Numbers = np.empty((room, columns), of)
        found = kernel(groups, *args, rows)
    return rows[:found]
