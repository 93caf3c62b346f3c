"""A state as words that belong to a table and a word scheme, and what is said of words that find no place."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import Scheme
from udec_ia.layout.table import Table, read_table

JUNK, FREE, TOP = "JUNK", "MFREE", "MTOP"  # variables of the memory
AT_FAULT = "IERAD"  # a note of an address, which is no pointer
COMMON = ""  # kind of what is in no group


class Words(NamedTuple):
    """A state as words. ia: those of IA() in use, from address 1 on; common: the common block by names."""

    table: Table
    scheme: Scheme
    ia: Any
    common: Mapping[str, Any]

    def integer(self, name: str) -> int:
        """A variable of the common block; 0 if there is none of the name."""
        return int(np.ravel(self.common.get(name, 0))[0])


def words_of(array: MainArray) -> Words:
    """The state of `array`; its words are not copied."""
    table, h = read_table(), array.h
    common = {field.name: variable(h, field) for field in table.common}
    return Words(table, array.scheme, h.ia[: int(common[FREE][0]) - 1], common)


class TranslationError(ValueError):
    """What of a state cannot be told by another table: `faults`, each a phrase."""

    def __init__(self, faults: list[str]) -> None:
        self.faults = faults
        super().__init__("; ".join(faults))


class Rows(NamedTuple):
    """Groups of one kind at the addresses `at`; of the kind COMMON the common block, as the only one."""

    kind: str
    at: Any

    def __len__(self) -> int:
        return len(self.at) if self.kind else 1

    def called(self, name: str, row: int) -> str:
        """The field `name` of one of them: KXD of block@88."""
        return f"{name} of {self.kind}@{self.at[row]}" if self.kind else name


class Faults:
    """Phrases; of those that differ in the group alone the first is told, and how many there are."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, ...], tuple[str, int]] = {}

    def __bool__(self) -> bool:
        return bool(self._found)

    def add(self, phrase: str, many: int = 1, *alike: str) -> None:
        """`many` faults, of which the first is `phrase`. alike: what they have in common with others."""
        first, before = self._found.get(alike or (phrase,), (phrase, 0))
        self._found[alike or (phrase,)] = first, before + many

    def told(self) -> list[str]:
        """A phrase for each sort of fault."""
        return [
            first + (f", and {many - 1} more" if many > 1 else "") for first, many in self._found.values()
        ]
