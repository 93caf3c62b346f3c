"""The state that is checked: all groups in use, the clockwise lists that close, and the violations found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.block_rings import Boundaries, one_before
from udec_ia.reader.field_reading import HOSTS, INDEX, KIND_CODE, LISTED, TABLE, Numbers, names
from udec_ia.reader.group_lists import Lists


@dataclass(frozen=True)
class Rings:
    """The clockwise lists that close, block after block; arrays with one element for each item of a list.

    block: addresses of the blocks; first, count: where their items stand. item: address; owner: index into
    `block`; contact: True for a contact; row: row among the contacts or corners in use, -1 for none; side: 0
    if the block is KB1 of the contact, 1 if it is KB2. before, after: index of the neighbours; corner: index
    of the first corner at or after the item. at: two rows, the index of each contact in use in the list of
    its block KB1 and of its block KB2; -1 where it does not stand there.
    """

    block: Numbers
    first: Numbers
    count: Numbers
    item: Numbers
    owner: Numbers
    contact: Numbers
    row: Numbers
    side: Numbers
    before: Numbers
    after: Numbers
    corner: Numbers
    at: Numbers

    @property
    def lists(self) -> Numbers:
        """Where each list begins and how many items it has: two columns."""
        return np.column_stack((self.first, self.count))


def lay_out(lists: Lists, boundaries: Boundaries, rows: Callable[[str, Numbers], Numbers]) -> Rings:
    """The lists of `boundaries` that close. rows: gives rows of groups of a kind by their addresses."""
    blocks = lists.address["block"]
    count = np.bincount(boundaries.row, minlength=len(blocks)).astype(INDEX)
    block, count, item = blocks[count > 0], count[count > 0], boundaries.item
    first = np.cumsum(count, dtype=INDEX) - count
    contact = lists.h.ia[item - 1] == g.MCON
    row = rows("contact", item)
    row[~contact] = rows("corner", item[~contact])
    index, last = np.arange(len(item), dtype=INDEX), first + count - 1
    owner = np.repeat(np.arange(len(block), dtype=INDEX), count)
    before, after = index - 1, index + 1
    before[first], after[last] = last, first
    corner = np.minimum.accumulate(np.where(contact, len(item), index)[::-1])[::-1]
    corner = np.where(corner > last[owner], first[owner], corner).astype(INDEX)  # a list begins with one
    side = np.zeros(len(item), np.int8)
    side[contact] = lists.read(item[contact], HOSTS[0]) != block[owner[contact]]
    at = np.full((2, len(lists.address["contact"])), -1, INDEX)
    backward = (first + last)[owner] - index  # of what stands in a list twice, the first place counts
    listed = backward[(contact & (row >= 0))[backward]]
    at[side[listed], row[listed]] = listed
    return Rings(block, first, count, item, owner, contact, row, side, before, after, corner, at)


def corner_before(rings: Rings) -> Numbers:
    """For each corner of the lists the index of the corner before it, clockwise."""
    corner = np.flatnonzero(~rings.contact)
    return np.asarray(corner[one_before(rings.owner[corner])])


STRETCH = 256  # places in which groups are counted by a byte
LOST = "are in no group"  # ends the message on words that no list leads to


@dataclass(frozen=True)
class Violation:
    """One broken relation: the number of the invariant, and a message that names both its ends."""

    invariant: int
    message: str

    def __str__(self) -> str:
        return f"invariant {self.invariant}: {self.message}"

    @property
    def misleads(self) -> bool:
        """False for words that no list leads to: they are lost, and no routine will ever come to them."""
        return not self.message.endswith(LOST)


class State(Lists):
    """All groups in use, and the violations found so far. rings: the clockwise lists that close."""

    def __init__(self, array: MainArray) -> None:
        super().__init__(array)
        self.found: list[Violation] = []
        self._columns: dict[str, Numbers] = {}
        self._nth_at = np.zeros(len(self.kind_at), np.uint8)  # among those of its kind in the stretch
        self._before: dict[str, Numbers] = {}  # by kind: groups that begin before each stretch
        self._row: dict[str, Numbers] = {}  # by kind: row of the groups in the order of their addresses
        for kind in LISTED:
            self._check_links_back(kind, self.addresses(kind))
        self.addresses("corner")
        assert self.boundaries is not None
        self.rings = lay_out(self, self.boundaries, self.rows)
        self.boundaries = None  # it takes room
        for group in TABLE.groups:
            self.addresses(group.name)

    def report(self, invariant: int, message: str) -> None:
        """Add a violation."""
        self.found.append(Violation(invariant, message))

    def report_rows(
        self, invariant: int, kind: str, name: str, wrong: Numbers, why: Callable[[int], str]
    ) -> None:
        """Add a violation for each group of `kind` of which the field `name` is wrong. why: what, by row."""
        addresses, values = self.address[kind], self.column(kind, name)
        for k in np.flatnonzero(wrong).tolist():
            self.report(invariant, f"{name} of {kind}@{addresses[k]} is {values[k]}, {why(k)}")

    def report_invalid_pointer(self, source: str, iad: int, kind: str) -> None:
        """Nothing: all invalid pointers are reported together."""

    def violations(self) -> list[Violation]:
        """What was found, each once, in the order of the invariants; words that no list leads to last."""
        return sorted(dict.fromkeys(self.found), key=lambda one: (not one.misleads, one.invariant))

    def tolerance(self, name: str) -> float:
        """A real of the common block."""
        return float(self.h.cr[getattr(g, name)])

    def column(self, kind: str, name: str, i: int = 0) -> Numbers:
        """The same of all groups of `kind` in use; it is read only once."""
        key = f"{name}+{i}"
        if key not in self._columns:
            self._columns[key] = self.read(self.address[kind], name, i)
        return self._columns[key]

    def forget(self) -> None:
        """Keep no column, to save memory."""
        self._columns.clear()

    def leave_lists(self) -> None:
        """Keep no list either, nor where groups begin."""
        del self.rings, self.kind_at, self._nth_at, self._before, self._row
        self.forget()

    def rows(self, kind: str, addresses: Numbers) -> Numbers:
        """Row of each address among the groups of `kind` in use; -1 where it is no such group."""
        found = np.full(addresses.shape, -1, INDEX)
        place = self.place_or_end(addresses)
        there = self.kind_at[place] == KIND_CODE[kind]
        place = place[there]
        found[there] = self._row[kind][self._before[kind][place // STRETCH] + self._nth_at[place]]
        return found

    def _enter(self, kind: str, at: Numbers) -> None:
        """Groups of `kind` are in use at the addresses `at`, all different."""
        super()._enter(kind, at)
        place = self.place(at)
        order = np.argsort(place, kind="stable")
        in_order = place[order]
        before = np.searchsorted(in_order, np.arange(0, len(self.kind_at), STRETCH)).astype(INDEX)
        self._nth_at[in_order] = np.arange(len(at)) - before[in_order // STRETCH]
        self._before[kind], self._row[kind] = before, order.astype(INDEX)

    def _check_links_back(self, kind: str, at: Numbers) -> None:
        """Those of a main list, if it has any."""
        for back in names(kind, "back"):
            (link,) = names(kind, "next")
            before, found = np.concatenate(([0], at[:-1])), self.read(at, back)
            for row in np.flatnonzero(found != before[: len(at)]).tolist():
                source = f"{link} of {kind}@{at[row - 1]}" if row else TABLE.group(kind).list_head
                text = f"{back} of {kind}@{at[row]} is {found[row]}"
                self.report(2, f"{text}, but {source} leads here from {before[row]}")
