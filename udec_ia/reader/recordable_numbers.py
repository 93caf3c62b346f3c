"""What HISTORY can record: a field of a group, a variable of the common block, or a quantity of the model.

A history group holds the number of the kind in the order of the table, from 1, or COMMON_BLOCK,
WHOLE_MODEL or SUMMANDS.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, read_table

HISTORY = "history"
QUANTITIES = {  # keyword: unit and meaning, in the order of kernels.drive.history_recording.MEASURED
    "UNBalanced": ("N/m", "greatest unbalanced force"),
    "RATio": ("-", "unbalanced force ratio, as in SOLVE"),
    "KINetic": ("J/m", "kinetic energy"),
    "STRain": ("J/m", "strain energy of contacts, deformable blocks and structures"),
    "POTential": ("J/m", "potential of gravity against that at ENERGY ON"),
    "XREAction": ("N/m", "sum of the reactions in x on what is held"),
    "YREAction": ("N/m", "sum of the reactions in y on what is held"),
    "MREAction": ("N", "moment of the reactions about the origin"),
}
OF_REACTIONS = "XREAction", "YREAction", "MREAction"  # may be sums over summands


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
    found = [*recordable().values(), *(over_summands(word) for word in OF_REACTIONS)]
    return {(r.kind, r.number): r for r in found}


def over_summands(word: str) -> Recordable:
    """The sum over summands that is recorded under the keyword `word`."""
    return recordable()[word.upper()]._replace(kind=g.SUMMANDS)
