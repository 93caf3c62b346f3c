"""One of the two heaps that are compared: its groups, and the number that a matched group has in both.

Groups go by number, that of their pair, counted from 1: so the pointers of two heaps are compared by what
they lead to, wherever that stands.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.interpreting import InterpretWhenSmall
from udec_ia.heap.accessors import Memory
from udec_ia.heap.untrusted_lists import groups_along
from udec_ia.layout import offsets as g
from udec_ia.reader.atlas import KINDS, TABLE, Atlas, Word

GROUPS_ALONG = InterpretWhenSmall(groups_along, 1e7)  # words
LOST = -1  # the number of a group that matches none, and of what is no group


class Side:
    """The groups that the lists of a heap reach, sound or damaged."""

    def __init__(self, h: Memory) -> None:
        self.h = h
        self.atlas = Atlas(h)
        self._number = np.zeros(self.atlas.free // self.atlas.ratio + 1, np.int32)  # groups begin on reals

    def word(self, kind: str, name: str) -> Word:
        """Where a field stands in a group at address 0, its first element."""
        return next(word for word in self.atlas.shapes[kind] if word.field.name == name)

    def column(self, kind: str, name: str, at: Any) -> Any:
        """What a field holds in the groups of a kind at the addresses (n,)."""
        return self.atlas.gather(self.word(kind, name), at)

    def numbers(self, addresses: Any) -> Any:
        """The numbers (n,) of the groups at the addresses (n,), which may be anything; 0 for none."""
        before = addresses.astype(np.int64) - 1
        place = before // self.atlas.ratio
        within = (before >= 0) & (before < self.atlas.free - 1) & (place * self.atlas.ratio == before)
        return np.where(within, self._number[np.where(within, place, 0)], 0)

    def give_numbers(self, addresses: Any, first: int) -> None:
        """Number the groups at the addresses (n,), from `first` on."""
        self._number[(addresses - 1) // self.atlas.ratio] = np.arange(first, first + len(addresses))

    def meant(self, word: Word, at: Any) -> Any:
        """What a field of the groups at (n,) says in both heaps: a number, or that of the group it leads to.

        A pointer to a group that matches none is LOST, 0 is 0.
        """
        values = self.atlas.gather(word, at)
        if not word.field.target:
            return values
        found = self.numbers(values).astype(np.int64)
        found[(found == 0) & (values != 0)] = LOST
        return found

    def left(self, kind: str) -> Any:
        """Addresses of the groups of a kind that have no number yet, ascending."""
        at = self.atlas.groups[kind]
        return at[self.numbers(at) == 0]

    def along(self, kind: str, heads: Any, link: str) -> tuple[Any, Any]:
        """Groups of a kind in the lists from `heads` (n,) by the field `link`, and how many each has (n,).

        A list ends where it leads to no group of the kind, or to one that was in a list before.
        """
        starts, step = self.atlas.starts, self.word(kind, link).first - 1
        found, many = np.empty(len(starts), np.int64), np.zeros(len(heads), np.int64)
        seen, number = np.zeros(len(starts), bool), KINDS.index(kind) + 1
        n = GROUPS_ALONG(len(starts), self.h.ia, starts, number, heads, step, seen, found, many)
        return found[:n].copy(), many

    def listed(self, kind: str) -> Any:
        """All groups of a kind in the order of their main list; others after them, by address.

        A list that is broken is taken up again from its end, if it has links to the one before.
        """
        groups, group = self.atlas.groups[kind], TABLE.group(kind)
        if group.list_head is None:
            return groups
        head = np.array([int(self.h.ci[getattr(g, group.list_head)])])
        links = {field.role: field.name for field in group.fields}
        at, _ = self.along(kind, head, links["next"])
        if "back" in links and len(at) < len(groups):
            last = groups[self.column(kind, links["next"], groups) == 0]
            ends, _ = self.along(kind, last, links["back"])
            at = np.concatenate((at, ends[~np.isin(ends, at)][::-1]))
        return np.concatenate((at, groups[~np.isin(groups, at)])) if len(at) < len(groups) else at
