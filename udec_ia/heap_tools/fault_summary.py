"""What is wrong with a state that a tool has made, in short; and whether its reals are too coarse."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from udec_ia.checker import Violation
from udec_ia.heap.accessors import getr
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.common.number_limits import ROUNDING_DIGITS, last_digit
from udec_ia.reader.group_tables import addresses

SHOWN = 3  # violations that are named


def in_short(broken: Sequence[Violation]) -> str:
    """Some violations in words: those that mislead go before the words that are lost because of them."""
    more = [f"and {len(broken) - SHOWN} more"] if len(broken) > SHOWN else []
    first = sorted(broken, key=lambda one: not one.misleads)
    return "; ".join([*map(str, first[:SHOWN]), *more])


def too_coarse(array: MainArray) -> list[Violation]:
    """Whether the reals resolve the rounding length where the blocks are as well as ROUND asks for."""
    at = addresses(array, "corner")
    size = float(sum(np.abs(getr(array.h, at, k)) for k in (g.KXP, g.KYP)).max(initial=0.0))
    d, digit = float(array.h.cr[g.DTOL]), last_digit(array, size)
    if d >= ROUNDING_DIGITS * digit:
        return []
    what = f"the rounding length is {d:g}, and {array.scheme.real_bits}-bit reals resolve {digit:g} there"
    return [Violation(7, f"{what}: it must be at least {ROUNDING_DIGITS * digit:g}")]
