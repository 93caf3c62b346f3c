"""Which group of one heap is which of the other: by its place in the map, and not by its address.

    block      by its place in the block list, allowing for insertions and deletions (block_matching.py)
    corner     by its place round its block, counted from KP, else by where it lies
    extension  that of a block or a domain that matches
    gridpoint  by its place in the list of its block, as zones are; if their number has changed, by its corner
    contact    by the two corners that name its segments, else by the two blocks and one of these, else by the
               blocks alone; of several in the order of the contact list
    domain     by the contacts around it: the two that have most of them in common
    bound      by what it acts on, a signal by its number, a history by what it records, a relaxation by
               its subject; of several in the order of their list
    tabpoint   by its place in its signal

Groups with equally many of one key on both sides match first. What is left matches if all pointers of matched
groups that lead to the one lead to the other. A ring is turned where KP names another corner. Addresses only
serve to follow pointers, so renumbered states and other word schemes match. Damaged heaps are matched as far
as the census reaches.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.heap_tools.block_matching import Side, blocks_of, match_blocks, same_shape
from udec_ia.heap_tools.row_matching import Pairs, exclusive_pairs, fold, frequent_pairs, pairs_in_order
from udec_ia.layout import offsets as g
from udec_ia.reader.word_map import KINDS, TABLE, choices


def turned(sides: Sequence[Side], rings: Pairs, many: Any, needed: Any) -> Any:
    """The corners (n,) of the other's blocks in the order of those of the one. rings: both, from KP on.

    many: corners of each block (m,). needed: how many of them must lie in one place when its ring is turned.
    """
    first = np.cumsum(many) - many
    best, found = np.zeros(len(many), np.int64), needed - 1
    places = [_places(side, at) for side, at in zip(sides, rings, strict=True)]
    rows = np.arange(len(many))
    turn = 0
    while len(rows := rows[many[rows] > turn]):
        now = _together(places, first[rows], many[rows], turn)
        good = now > found[rows]
        best[rows[good]], found[rows[good]] = turn, now[good]
        rows = rows[now < many[rows]]
        turn += 1
    place = np.arange(len(rings[0])) - np.repeat(first, many)
    return rings[1][np.repeat(first, many) + (place + np.repeat(best, many)) % np.repeat(many, many)]


def _places(side: Side, at: Any) -> Any:
    """Where the corners (n,) lie, to 32-bit reals: columns that are equal for one place (2, n)."""
    with np.errstate(over="ignore"):
        return np.array([side.column("corner", name, at).astype(np.float32) for name in ("KXP", "KYP")])


def _together(places: Sequence[Any], first: Any, many: Any, turn: int) -> Any:
    """How many corners of each block (m,) lie in one place, if those of the other are so many places on."""
    starts = np.cumsum(many) - many
    place = np.arange(int(many.sum())) - np.repeat(starts, many)
    base = np.repeat(first, many)
    there = base + (place + turn) % np.repeat(many, many)
    same = (places[0][:, base + place] == places[1][:, there]).all(0)
    return np.add.reduceat(same.astype(np.int64), starts)


ROUNDS = 20  # of looking for what is left over, each from what the one before has found
KEYS: dict[str, list[tuple[str, ...]]] = {  # fields that tell which group it is, the best ones first
    "gridpoint": [("KCOR",)],
    "contact": [("KCP1", "KCP2"), ("KB1", "KB2", "KCP1"), ("KB1", "KB2", "KCP2"), ("KB1", "KB2")],
    "signal": [("KTNUM",)],
    "bound": [("KUB", "KUG", "KUP", "KUQ")],
    "history": [("KHK", "KHF", "KHG")],
    "relax": [("KRXB", "KRXG")],
}
OPTIONAL = ("signal", "bound", "history", "relax")  # kinds whose keys may be 0


class Matching:
    """The groups of two heaps, matched. sides: both.

    pairs: for each kind the addresses (n,) in the one and in the other of groups that match.
    """

    def __init__(self, one: Memory, two: Memory) -> None:
        self.sides = Side(one), Side(two)
        self.pairs: dict[str, Pairs] = {kind: (np.zeros(0, np.int64),) * 2 for kind in KINDS}
        self._count = 0
        self._blocks_and_corners()
        for kind, owner, field in (("sdef", "block", "KBEX"), ("fdef", "block", "KBEX")):
            self._extensions(kind, owner, field)
        self._chains("gridpoint", "fdef", "KFG", "KG")
        self._chains("zone", "fdef", "KFZ", "KZ")
        self._by_keys("gridpoint")
        self._by_keys("contact")
        self._domains()
        self._extensions("jointext", "domain", "KDEX")
        self._by_keys("signal")
        self._chains("tabpoint", "signal", "KTP", "KTPN")
        self._by_keys("bound")
        self._by_keys("history")
        self._by_keys("relax")
        self._rest()
        for kind in KEYS:
            self._by_keys(kind, as_many=False)
        self._rest()

    @cached_property
    def in_place(self) -> bool:
        """True if every group matches one of its own address: then equal pointers mean equal groups."""
        whole = all(not len(at) for kind in KINDS for at in self.left(kind))
        return whole and all(np.array_equal(a, b) for a, b in self.pairs.values())

    def left(self, kind: str) -> Pairs:
        """Addresses of groups that match none: those of the one (n,), and those of the other (m,)."""
        one, two = self.sides
        return one.left(kind), two.left(kind)

    def _join(self, kind: str, one: Any, two: Any) -> None:
        """The groups at the addresses (n,) and (n,) match."""
        for side, at in zip(self.sides, (one, two), strict=True):
            side.give_numbers(at, self._count + 1)
        self._count += len(one)
        before = self.pairs[kind]
        self.pairs[kind] = np.concatenate((before[0], one)), np.concatenate((before[1], two))

    def _blocks_and_corners(self) -> None:
        one, two = (blocks_of(side) for side in self.sides)
        a, b = match_blocks(one, two)
        self._join("block", one.at[a], two.at[b])
        same = one.corners[a] == two.corners[b]
        a, b = a[same], b[same]
        ours, many = one.ring(a), one.corners[a]
        needed = np.where(same_shape(one.some(a), two.some(b)), many, 1)
        self._join("corner", ours, turned(self.sides, (ours, two.ring(b)), many, needed))
        self._same_places()

    def _chains(self, kind: str, owner: str, head: str, link: str) -> None:
        """Groups in lists that begin at the field `head` of matched owners, where both are of one length."""
        found, many = [], []
        for side, at in zip(self.sides, self.pairs[owner], strict=True):
            groups, lengths = side.along(kind, side.column(owner, head, at), link)
            found.append(groups)
            many.append(lengths)
        same = many[0] == many[1]
        one, two = (at[np.repeat(same, lengths)] for at, lengths in zip(found, many, strict=True))
        self._join(kind, one, two)

    def _same_places(self) -> None:
        """Corners that are left over: those of one block that lie in one place, to 32-bit reals."""
        left = self.left("corner")
        keys, known = [], []
        for side, at in zip(self.sides, left, strict=True):
            with np.errstate(over="ignore"):
                xy = [side.column("corner", name, at).astype(np.float32) for name in ("KXP", "KYP")]
            host = side.comparable(side.word("corner", "KNB"), at)
            keys.append([host, *((values + 0).view(np.int32) for values in xy)])
            known.append(host > 0)
        self._with_equal("corner", left, keys, known)

    def _with_equal(
        self, kind: str, left: Sequence[Any], keys: Sequence[Any], known: Sequence[Any], as_many: bool = False
    ) -> None:
        """Of the groups that are left those with equal columns of `keys`, where they are known, in turn."""
        rows = [np.flatnonzero(one) for one in known]
        columns = [[column[some] for column in one] for one, some in zip(keys, rows, strict=True)]
        one, two = pairs_in_order(*fold(columns[0], columns[1]), as_many)
        self._join(kind, left[0][rows[0][one]], left[1][rows[1][two]])

    def _extensions(self, kind: str, owner: str, field: str) -> None:
        """What a pointer of matched owners leads to; once, as two of a damaged heap may share it."""
        at = [side.column(owner, field, to) for side, to in zip(self.sides, self.pairs[owner], strict=True)]
        held = [side.atlas.holding(kind, to) for side, to in zip(self.sides, at, strict=True)]
        both = held[0] & held[1]
        once = [np.unique(to[both], return_index=True)[1] for to in at]
        first = np.intersect1d(once[0], once[1])
        self._join(kind, at[0][both][first], at[1][both][first])

    def _by_keys(self, kind: str, as_many: bool = True) -> None:
        """Groups whose fields of some names say the same, in the order of their list.

        as_many: only where both heaps have equally many of these.
        """
        if not all(len(at) for at in self.left(kind)):
            return
        lowest = 0 if kind in OPTIONAL else 1
        left = [side.listed(kind) for side in self.sides]
        for names in KEYS[kind]:
            left = [at[side.numbers(at) == 0] for side, at in zip(self.sides, left, strict=True)]
            keys: list[list[Any]] = []
            known: list[Any] = []
            for side, at in zip(self.sides, left, strict=True):
                words = [side.word(kind, name) for name in names]
                keys.append([side.comparable(word, at) for word in words])
                good = [one >= lowest for one, word in zip(keys[-1], words, strict=True) if word.field.target]
                known.append(np.logical_and.reduce([np.ones(len(at), bool), *good]))
            self._with_equal(kind, left, keys, known, as_many)

    def _domains(self) -> None:
        """Those that have most contacts in common; the outer one of a block that has no contact."""
        found = []
        for side, at in zip(self.sides, self.pairs["contact"], strict=True):
            outer = np.array([int(side.h.ci[g.IODPNT])])
            found.append(
                np.concatenate([*(side.column("contact", name, at) for name in ("KD1", "KD2")), outer])
            )
        one, two = self.sides
        both = one.atlas.holding("domain", found[0]) & two.atlas.holding("domain", found[1])
        self._join("domain", *frequent_pairs(found[0][both], found[1][both]))

    def _rest(self) -> None:
        """What is left over, and all pointers of matched groups agree on."""
        for _ in range(ROUNDS):
            before = self._count
            for kind in KINDS:
                if kind != "block" and all(len(at) for at in self.left(kind)):
                    self._join(kind, *self._agreed(kind))
            if self._count == before:
                return

    def _agreed(self, kind: str) -> Pairs:
        """Groups of a kind that all pointers to them agree on."""
        ways = [self._heads(kind)]
        for owner in KINDS:
            for words in zip(*(side.atlas.shapes[owner] for side in self.sides), strict=True):
                if words[0].field.target and kind in choices(words[0].field.target):
                    ways.append(
                        [
                            side.atlas.gather(word, at)
                            for side, word, at in zip(self.sides, words, self.pairs[owner], strict=True)
                        ]
                    )
        found: list[Pairs] = []
        for way in ways:
            to = [self._if_left(side, kind, at) for side, at in zip(self.sides, way, strict=True)]
            some = (to[0] != 0) | (to[1] != 0)
            found.append((to[0][some], to[1][some]))
        one, two = zip(*found, strict=True)
        return exclusive_pairs(np.concatenate(one), np.concatenate(two))

    def _heads(self, kind: str) -> list[Any]:
        """Where the pointers of the common block to groups of a kind lead, in both."""
        heads = [getattr(g, field.name) for field in TABLE.common if field.target == kind]
        return [side.h.ci[heads] for side in self.sides]

    def _if_left(self, side: Side, kind: str, addresses: Any) -> Any:
        """The addresses (n,) at which a group of a kind is left; 0 in the place of others."""
        return np.where(side.atlas.holding(kind, addresses) & (side.numbers(addresses) == 0), addresses, 0)
