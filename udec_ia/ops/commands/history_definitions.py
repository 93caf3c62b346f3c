"""HISTORY: what is to be recorded stands in IA(), a group for each history, and so outlives SAVE and RESTART.

A history points to its group. The pointer moves with the group when groups change places, and becomes 0
when the group is given back (heap.memory.unwatch): it never shows another group's numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, iget, puti, size_of
from udec_ia.heap.array import MainArray
from udec_ia.heap.memory import find
from udec_ia.kernels.drive.recording import DOUBLE, INTEGER, REAL
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field, read_table
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.number_limits import whole

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
    found = []
    ih = int(array.h.ci[g.IHPNT])
    while ih != 0:
        found.append(ih)
        ih = iget(array.h, ih, g.KH)
    return found


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


# ---- What HISTORY can record: every single number that has a name

HISTORY = "history"
QUANTITIES = {  # keyword: unit and meaning, in the order of kernels.drive.recording.MEASURED
    "UNBalanced": ("N/m", "greatest unbalanced force"),
    "RATio": ("-", "unbalanced force ratio, as in SOLVE"),
    "KINetic": ("J/m", "kinetic energy"),
    "STRain": ("J/m", "strain energy of contacts and deformable blocks"),
    "POTential": ("J/m", "potential of gravity against that at ENERGY ON"),
}


class Recordable(NamedTuple):
    """A number that a history can record. kind and number: as a history group holds them (KHK, KHF)."""

    group: str  # name of the kind of group; "" if there is none to choose
    kind: int
    number: int
    field: Field


@cache
def recordable() -> dict[str, Recordable]:
    """All that can be recorded, by name; head codes, arrays and histories themselves cannot."""
    table = read_table()
    found = [
        Recordable(group.name, kind, number, field)
        for kind, group in enumerate(table.groups, 1)
        for number, field in enumerate(group.fields)
        if group.name != HISTORY and field.role != "head"
    ]
    found += [Recordable("", g.COMMON_BLOCK, number, field) for number, field in enumerate(table.common)]
    found += [
        Recordable(
            "", g.WHOLE_MODEL, number, Field(word.upper(), "real", 1, None, "data", unit, "ours", text)
        )
        for number, (word, (unit, text)) in enumerate(QUANTITIES.items())
    ]
    return {r.field.name: r for r in found if r.field.count == 1}


@cache
def by_codes() -> dict[tuple[int, int], Recordable]:
    """The same by what a history group holds, (KHK, KHF)."""
    return {(r.kind, r.number): r for r in recordable().values()}
