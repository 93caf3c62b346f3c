"""HISTORY: what is to be recorded stands in IA(), a group for each history, and so outlives SAVE and RESTART.

A history points to its group. The pointer moves with the group when groups change places, and becomes 0
when the group is given back (heap.find_lose.unwatch): it never shows another group's numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, iget, puti, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.history_recording import DOUBLE, INTEGER, REAL
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.number_limits import whole
from udec_ia.reader.list_walks import chain
from udec_ia.reader.recordable_numbers import Recordable, by_codes, recordable

CODES = {"int": INTEGER, "real": REAL, "double": DOUBLE}


class Definition(NamedTuple):
    """One history as IA() holds it. address: of its group; 0 when that has gone, or where there is none."""

    what: Recordable
    address: int
    every: int

    @property
    def lost(self) -> bool:
        """True if the group has gone."""
        return bool(self.what.group) and self.address == 0


def named(name: str) -> Recordable:
    """What is recorded under `name`, in any case; error 10 if there is nothing of that name."""
    found = recordable().get(name.upper())
    if found is None:
        detail = f"{name} is not a quantity that can be recorded"
        raise UdecError(10, detail, "field is a name of offsets/groups.table", parameter="field")
    return found


def define(array: MainArray, what: Recordable, groups: Sequence[int], every: int) -> None:
    """New histories of `what`, one for each of the addresses in `groups`, at the end of the list.

    Error 28 for an interval that is none, error 1 without memory; then nothing is changed.
    """
    limit = array.scheme.top_address
    if not 1 <= whole(n=every) <= limit:
        raise UdecError(
            28, f"n is {every}", f"a history is recorded every 1 to {limit} cycles", parameter="n"
        )
    require(array, len(groups) * size_of(array.h, g.NVHI))
    h, before = array.h, next(reversed(addresses(array)), 0)
    for group in groups:
        ih = int(find(h, g.NVHI))
        numbers = (HEAD, g.MHIS), (g.KHG, group), (g.KHK, what.kind), (g.KHF, what.number), (g.KHN, every)
        for offset, number in numbers:
            puti(h, ih, offset, number)
        if before:
            puti(h, before, g.KH, ih)
            puti(h, ih, g.KHB, before)
        else:
            h.ci[g.IHPNT] = ih
        before = ih


def addresses(array: MainArray) -> list[int]:
    """Addresses of the history groups, in the order of their numbers."""
    return list(chain(array.h, int(array.h.ci[g.IHPNT]), g.KH))


def definitions(array: MainArray) -> list[Definition]:
    """All histories, in the order of their numbers."""
    h = array.h
    return [
        Definition(by_codes()[iget(h, ih, g.KHK), iget(h, ih, g.KHF)], iget(h, ih, g.KHG), iget(h, ih, g.KHN))
        for ih in addresses(array)
    ]


def places(array: MainArray) -> np.ndarray:
    """For the recording kernel: where in its group each history's number stands, and the code of its type."""
    which = array.scheme.ratio >> 1
    found = np.zeros((len(addresses(array)), 2), np.int64)
    for row, (what, _, _) in zip(found, definitions(array), strict=True):
        if what.kind >= g.COMMON_BLOCK:
            offset = getattr(g, what.field.name)
            row[:] = offset[which] if what.group else offset, CODES[what.field.type]
        else:
            row[0] = what.number
    return found
