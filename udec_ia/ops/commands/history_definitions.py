"""HISTORY: each history is a group of IA(), so SAVE and RESTART keep it.

A history points to the group that it records. The pointer follows the group when groups change places, and
becomes 0 when the group is given back (heap.find_lose.unwatch): it never shows the numbers of another group.
A sum of reactions has a summand for each block or grid-point that was held in its range.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

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
    """One history of IA(). address: of the group that it records; 0 if that has gone or does not exist."""

    what: Recordable
    address: int
    every: int

    @property
    def lost(self) -> bool:
        """True if the group has gone."""
        return bool(self.what.group) and self.address == 0


def named(name: str) -> Recordable:
    """The number that is recorded under `name`, in any case. Error 10 for an unknown name."""
    found = recordable().get(name.upper())
    if found is None:
        detail = f"{name} is not a quantity that can be recorded"
        raise UdecError(10, detail, "field is a name of offsets/groups.table", parameter="field")
    return found


def define(array: MainArray, what: Recordable, groups: Sequence[int], every: int) -> None:
    """New histories of `what`, one for each of the addresses in `groups`, at the end of the list.

    Error 28 for a wrong interval, error 1 without memory; then nothing is changed.
    """
    limit = array.scheme.top_address
    if not 1 <= whole(n=every) <= limit:
        advice = f"a history is recorded every 1 to {limit} cycles"
        raise UdecError(28, f"n is {every}", advice, parameter="n")
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


def define_sum(array: MainArray, what: Recordable, held: Any, every: int) -> None:
    """A new history of a sum of reactions over what is held: rows of reader.reaction_rows.reactions.

    Errors as `define`.
    """
    require(array, size_of(array.h, g.NVHI) + len(held) * size_of(array.h, g.NVSM))
    define(array, what, [0], every)
    h, ih = array.h, addresses(array)[-1]
    for ib, ig in zip(held["block"].tolist(), held["gridpoint"].tolist(), strict=True):
        iq = int(find(h, g.NVSM))
        numbers = (HEAD, g.MSMD), (g.KQ, int(h.ci[g.ISMPNT])), (g.KQH, ih), (g.KQB, ib), (g.KQG, ig)
        for offset, number in numbers:
            puti(h, iq, offset, number)
        h.ci[g.ISMPNT] = iq


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
    """For the recording kernel, per history: offset of the number in its group, and code of its type."""
    which = array.scheme.ratio >> 1
    found = np.zeros((len(addresses(array)), 2), np.int64)
    for row, (what, _, _) in zip(found, definitions(array), strict=True):
        if what.kind >= g.COMMON_BLOCK:
            offset = getattr(g, what.field.name)
            row[:] = offset[which] if what.group else offset, CODES[what.field.type]
        else:
            row[0] = what.number
    return found
