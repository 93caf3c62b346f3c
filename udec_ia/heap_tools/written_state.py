"""The words of a state of any table and word scheme, and where its groups lie and go.

If no kind of group in use changes its size, every group keeps its address and the junk list stays. Else the
groups are laid side by side in their order, without junk: the new size of a junk group would be unknown.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from udec_ia.checker.memory_words import gaps
from udec_ia.heap.group_census import CHOICES, list_heads, reached
from udec_ia.heap.junk_list import junk_chains
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import Scheme
from udec_ia.layout.field_table import Table, lay_out, read_table

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
    """What of a state has no place in another table: `faults`, each a phrase."""

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


class Faults(dict[tuple[str, ...], tuple[str, int]]):
    """The first phrase of each sort of fault, and how many there are, by what they have in common."""

    def add(self, phrase: str, many: int = 1, *alike: str) -> None:
        """`many` faults, of which the first is `phrase`. alike: what they have in common with others."""
        first, before = self.get(alike or (phrase,), (phrase, 0))
        self[alike or (phrase,)] = first, before + many

    def phrases(self) -> list[str]:
        """A phrase for each sort of fault."""
        return [first + (f", and {many - 1} more" if many > 1 else "") for first, many in self.values()]


class Places:
    """Old and new addresses of the groups of a state.

    at: the old addresses of every kind, start: the new ones. old: the layouts of the kinds as they were.
    stays: no group has a new address. used: words in use afterwards.
    """

    def __init__(self, state: Words, found: dict[str, Any] | None) -> None:
        """found: addresses of the groups of every kind, if it is proved that they and junk fill the words,
        and that all pointers lead to them.
        """
        table, self.ratio, self.words = state.table, state.scheme.ratio, len(state.ia)
        self.old = {group.name: lay_out(group, self.ratio) for group in table.groups}
        self.known, self.stays, self.used = found is not None, False, self.words
        if found is None:
            heads = ((str(one.target), state.integer(one.name)) for one in list_heads(table))
            found = reached(table, self.ratio, state.ia, heads, table.behind(state.integer), strict=True)
        self.at: dict[str, Any] = found
        self.rows = table.rows
        self.start: dict[str, Any] = {}
        chains = [] if self.known else junk_chains(state.ia, state.integer(JUNK))
        self.junk = np.array([one for chain in chains for one in chain], np.int64).reshape(-1, 2)

    def move(self, sizes: dict[str, int], faults: Faults) -> None:
        """Give every group its new address.

        sizes: of the kinds in the new table. Faults are groups of other kinds, groups that lie in each other,
        and, where groups move, words that are in none.
        """
        for kind, at in self.at.items():
            if len(at) and kind not in sizes:
                faults.add(f"{kind}@{at[0]} is of a kind that is not known here", len(at))
        if not self.known:
            junk = set(self.junk[:, 1].tolist())  # may be taken again if groups of its sizes can be
            rows = {sum(sizes.get(kind, 0) for kind in row) for row in self.rows}
            self.stays = junk <= {*sizes.values(), *rows} and all(
                sizes.get(kind) == self.old[kind].size for kind, at in self.at.items() if len(at)
            )
            self._check_spans(faults)
        if not faults:
            self._lay_out(sizes)

    def _check_spans(self, faults: Faults) -> None:
        """Groups must not lie in each other; where they move, every word must be in one."""
        sizes = [np.full(len(at), self.old[kind].size) for kind, at in self.at.items()]
        first = np.concatenate([*self.at.values(), self.junk[:, 0]])
        size = np.concatenate([*sizes, self.junk[:, 1]])
        order = np.argsort(first, kind="stable")
        wrong = gaps(first[order], size[order], self.words + 1)
        for _, _, start in wrong[wrong[:, 1] > wrong[:, 2]][:1]:
            faults.add(f"word {start} is in two groups")
        for _, after, start in wrong[wrong[:, 1] < wrong[:, 2]][: 0 if self.stays else 1]:
            faults.add(f"words {after} to {start - 1} are in no group")

    def _lay_out(self, sizes: dict[str, int]) -> None:
        """Side by side in the order of the old addresses, or where they are."""
        counts = [len(at) for at in self.at.values()]
        at = np.concatenate([*self.at.values()]).astype(np.int64)
        start = at
        if not self.stays:
            size = np.repeat([sizes.get(kind, 0) for kind in self.at], counts)
            order = np.argsort(at)
            ends = np.cumsum(size[order])
            start = np.empty_like(at)
            start[order] = 1 + ends - size[order]
            self.used = int(size.sum())
        self.start = dict(zip(self.at, np.split(start, np.cumsum(counts)[:-1]), strict=True))
        places = self.words // self.ratio + 2
        self._moved = np.zeros(places, np.int32 if self.used < 2**31 else np.int64)
        self._kind = np.zeros(places, np.min_scalar_type(len(self.at)))
        for number, (kind, addresses) in enumerate(self.at.items(), 1):
            here = self._places(addresses)
            self._moved[here], self._kind[here] = self.start[kind], number

    def _places(self, addresses: Any) -> Any:
        """Numbers of the places, each of a real, at which the groups at `addresses` begin; 0 of 0."""
        return (addresses.astype(np.int64) + (self.ratio - 1)) // self.ratio

    def followed(self, pointers: Any, target: str) -> tuple[Any, Any]:
        """The new addresses of what `pointers` lead to, and where they lead to no `target` (nor are 0)."""
        if self.known:  # which was proved of all pointers
            return self._moved[self._places(pointers)], np.broadcast_to(np.False_, pointers.shape)
        kinds = list(self.at) if target == "any" else CHOICES.get(target, (target,))
        leads = np.zeros(len(self.at) + 1, bool)
        leads[[number for number, kind in enumerate(self.at, 1) if kind in kinds]] = True
        begins = (pointers > 0) & (pointers <= self.words) & ((pointers - 1) % self.ratio == 0)
        place = np.where(begins, self._places(pointers), 0)
        return self._moved[place], ~leads[self._kind[place]] & (pointers != 0)
