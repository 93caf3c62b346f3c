"""Whether two states of a run are still the same: a number counts by its share of the greatest of its unit.

A velocity that is rounding noise beside the others has no digit in common with that of another word scheme.
So a real differs if it is off by more than a share of the greatest number with its unit in either state:
1e-6, or TIMES last digits of the narrower reals if that is more, which is 1e-5 for 32 bits. Angles and
moments count with the size of the greatest block. Groups that only one has, codes and pointers differ always.
The common block does not count: it holds what commands said, and sums over the whole run.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.block_matching import Side
from udec_ia.heap_tools.state_comparison import Compared, Differing, compare
from udec_ia.reader.atlas import KINDS

SHARE, TIMES = 1e-6, 100
ARMS = {"rad/s": ("m/s", -1), "N": ("N/m", 1)}  # units that are others times or over a length


class Off(NamedTuple):
    """A number in which two states differ, or a group that only one has: then field is made or deleted.

    group: its name in the state that has it. share: of the greatest number of the unit.
    """

    group: str
    field: str
    first: Any
    second: Any
    share: float


class Judge:
    """Compares states. share: of the greatest number of a unit, by which a real may be off."""

    def __init__(self, share: float | None = None) -> None:
        self.share = share

    def off(self, one: MainArray, two: MainArray) -> Off | None:
        """The worst difference that counts, None if there is none."""
        found = compare(one.h, two.h, KINDS)
        for k, what in enumerate(("deleted", "made")):
            for kind, alone in found.alone.items():
                if len(alone[k]):
                    return Off(f"{kind}@{alone[k][0]}", what, "", "", np.inf)
        bits = min(one.scheme.real_bits, two.scheme.real_bits)
        limit = self.share
        if limit is None:
            limit = max(SHARE, TIMES * float(np.finfo(np.float32 if bits == 32 else np.float64).eps))
        worst = max(
            (self._worst(found, field) for field in found.fields), key=lambda off: off.share, default=None
        )
        return worst if worst is not None and worst.share > limit else None

    def _worst(self, found: Compared, field: Differing) -> Off:
        """The greatest difference of a field."""
        if field.field.real:
            greatest = _greatest(found.matching.sides, field.field.unit)
            with np.errstate(all="ignore"):
                shares = np.nan_to_num(field.apart.absolute / greatest, nan=np.inf)
        else:
            shares = np.full(len(field.one), np.inf)
        row = int(np.argmax(shares))
        one, two = (column[row].item() for column in field.values)
        return Off(f"{field.kind}@{field.one[row]}", field.name, one, two, float(shares[row]))


def _greatest(sides: tuple[Side, Side], unit: str) -> float:
    """The greatest number with a unit in two states."""
    found = max(_in_state(side, unit) for side in sides)
    if unit in ARMS:
        other, power = ARMS[unit]
        size = max(
            float(np.max(_finite(side.column("block", "KBRO", side.atlas.groups["block"])), initial=0))
            for side in sides
        )
        found = max(found, max(_in_state(side, other) for side in sides) * (size or 1.0) ** power)
    return found


def _in_state(side: Side, unit: str) -> float:
    greatest = 0.0
    for kind, words in side.atlas.shapes.items():
        for word in words:
            if word.field.real and word.field.unit == unit:
                values = _finite(side.atlas.gather(word, side.atlas.groups[kind]))
                greatest = max(greatest, float(np.max(np.abs(values), initial=0.0)))
    return greatest


def _finite(values: Any) -> Any:
    return values[np.isfinite(values)]
