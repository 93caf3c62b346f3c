"""Which group of one heap is which of the other: by its place in the map, and not by its address.

    block      by its place in the block list, allowing for insertions and deletions (block_matching.py)
    corner     by where it lies on its block, else by its place round the block, counted from KP
    extension  that of a block or a domain that matches
    gridpoint  by its place in the list of its block, as zones are; if their number has changed, by its corner
    contact    by the two corners that name its segments, else by the two blocks and one of these, else by the
               blocks alone; of several in the order of the contact list
    domain     by the contacts around it: the two that have most of them in common
    bound      by what it acts on, a signal by its number, a history by what it records, a relaxation by
               its subject, a follower by its number, a summand by its history and subject, bolts and
               nodes by their blocks, elements by their nodes; of several in the order of their list
    tabpoint   by its place in its signal

Groups with equally many of one key on both sides match first. What is left matches if all pointers of matched
groups that lead to the one lead to the other. Addresses only serve to follow pointers, so renumbered states
and other word schemes match. Damaged heaps are matched as far as the census reaches.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.heap_tools.block_matching import Side, blocks_of, match_blocks
from udec_ia.heap_tools.table_row_matching import Pairs, exclusive_pairs, fold, frequent_pairs, pairs_in_order
from udec_ia.layout import offsets as g
from udec_ia.reader.word_map import KINDS, TABLE, choices

ROUNDS = 20  # of looking for what is left over, each from what the one before has found
KEYS: dict[str, list[tuple[str, ...]]] = {  # fields that tell which group it is, the best ones first
    "gridpoint": [("KCOR",)],
    "contact": [("KCP1", "KCP2"), ("KB1", "KB2", "KCP1"), ("KB1", "KB2", "KCP2"), ("KB1", "KB2")],
    "signal": [("KTNUM",)],
    "bound": [("KUB", "KUG", "KUP", "KUQ")],
    "history": [("KHK", "KHF", "KHG")],
    "relax": [("KRXB", "KRXG")],
    "follower": [("KWN",)],
    "summand": [("KQH", "KQB", "KQG")],
    "outside": [("KOKIND", "KOS")],
    "crack": [("KKJ",)],
    "member": [("KIB",)],
    "bolt": [("KAB1", "KAB2")],
    "node": [("KNBL",)],
    "element": [("KMN1", "KMN2")],
    "breakable": [("KBKB",)],
    "fracture": [("KFRC", "KFRX1", "KFRY1")],
}
# Kinds whose keys may be 0.
OPTIONAL = ("signal", "bound", "history", "relax", "follower", "summand", "outside", "crack", "node")


class Matching:
    """The groups of two heaps, matched. pairs: by kind, addresses (n,) in both of groups that match."""

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
        self._behind()
        self._by_keys("signal")
        self._chains("tabpoint", "signal", "KTP", "KTPN")
        self._by_keys("bound")
        self._by_keys("history")
        self._by_keys("relax")
        self._by_keys("follower")
        self._by_keys("summand")
        self._rest()
        for kind in KEYS:
            self._by_keys(kind, as_many=False)
        self._rest()
        self._behind()

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
        self._corners_in_place()
        same = one.corners[a] == two.corners[b]
        rings = one.ring(a[same]), two.ring(b[same])
        left = [side.numbers(at) == 0 for side, at in zip(self.sides, rings, strict=True)]
        self._join("corner", *(at[left[0] & left[1]] for at in rings))

    def _corners_in_place(self) -> None:
        """Corners of one block that lie in one place, to 32-bit reals."""
        left = self.left("corner")
        keys, known = [], []
        for side, at in zip(self.sides, left, strict=True):
            with np.errstate(over="ignore"):
                xy = [side.column("corner", name, at).astype(np.float32) for name in ("KXP", "KYP")]
            host = side.comparable(side.word("corner", "KNB"), at)
            keys.append([host, *((values + 0).view(np.int32) for values in xy)])
            known.append(host > 0)
        self._with_equal("corner", left, keys, known)

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
        there = [side.atlas.holding(kind, to) for side, to in zip(self.sides, at, strict=True)]
        both = there[0] & there[1]
        once = [np.unique(to[both], return_index=True)[1] for to in at]
        first = np.intersect1d(once[0], once[1])
        self._join(kind, at[0][both][first], at[1][both][first])

    def _behind(self) -> None:
        """What lies behind matched groups and is left, where it lies there in both heaps."""
        for host, kind in TABLE.behind(lambda _: 1).items():
            one, two = (
                self._if_left(side, kind, to + side.atlas.layout[host].size)
                for side, to in zip(self.sides, self.pairs[host], strict=True)
            )
            both = (one > 0) & (two > 0)
            self._join(kind, one[both], two[both])

    def _by_keys(self, kind: str, as_many: bool = True) -> None:
        """Match groups by KEYS, in the order of their list. as_many: if both have as many groups of a key."""
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
            outer = side.h.ci[g.IODPNT : g.IODPNT + 1]
            found.append(
                np.concatenate([*(side.column("contact", name, at) for name in ("KD1", "KD2")), outer])
            )
        one, two = (self._if_left(side, "domain", at) for side, at in zip(self.sides, found, strict=True))
        both = (one > 0) & (two > 0)
        self._join("domain", *frequent_pairs(one[both], two[both]))

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
        pointers = [self._heads(kind)]
        for owner in KINDS:
            for words in zip(*(side.atlas.shapes[owner] for side in self.sides), strict=True):
                if words[0].field.target and kind in choices(words[0].field.target):
                    of_sides = zip(self.sides, words, self.pairs[owner], strict=True)
                    pointers.append([side.atlas.gather(word, at) for side, word, at in of_sides])
        one, two = (
            np.concatenate([self._if_left(side, kind, to[k]) for to in pointers])
            for k, side in enumerate(self.sides)
        )
        some = (one != 0) | (two != 0)
        return exclusive_pairs(one[some], two[some])

    def _heads(self, kind: str) -> list[Any]:
        """Where the pointers of the common block to groups of a kind lead, in both."""
        heads = [getattr(g, field.name) for field in TABLE.common if field.target == kind]
        return [side.h.ci[heads] for side in self.sides]

    def _if_left(self, side: Side, kind: str, addresses: Any) -> Any:
        """The addresses (n,) at which a group of a kind is left; 0 in the place of others."""
        return np.where(side.atlas.holding(kind, addresses) & (side.numbers(addresses) == 0), addresses, 0)
