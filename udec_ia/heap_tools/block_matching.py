"""Which block of one state is which of the other, by the main list.

If both lists have equally many blocks, pairwise with the same corners and mass, they match one by one. Else
the only blocks of their mass, and blocks that have hardly moved, match first, as long as their order is the
same in both lists. Between two of these, blocks match from the front and from the back as far as corners and
mass agree. Blocks left over were made or deleted. Before there are masses, sizes replace them.

Matched groups have one number in both heaps, from 1, by which pointers are compared.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.accessors import Memory
from udec_ia.heap.untrusted_lists import groups_along
from udec_ia.heap_tools.row_matching import Pairs, fold, longest_rising, unique_pairs
from udec_ia.layout import offsets as g
from udec_ia.reader.word_map import KINDS, TABLE, Atlas, Word

GROUPS_ALONG = InterpretWhenSmall(groups_along, 1e7)  # words
LOST = -1  # the number of a group that matches none, and of an address without a group


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

    def comparable(self, word: Word, at: Any) -> Any:
        """What a field of groups says in both heaps: a number, or that of a group; LOST if it has none."""
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


ALIKE = 0.01  # share of its size or mass by which a block may be another
MASSES = 1e5  # steps of mass, to a factor of e, by which blocks are distinguished
CELLS = (1e-3, 0.03, 0.5, 1.0)  # of cells that blocks are looked for in, as shares of the median size
SHIFTS = (*product((0.0, 0.5), repeat=2),)  # of the cells: near a border of one, within another
FAR = 2.0**30  # cells


class Blocks(NamedTuple):
    """Blocks (n,) in the order of their list. rings: corners of all, block by block, from KP on by KR."""

    at: Any
    corners: Any
    size: Any
    mass: Any
    x: Any
    y: Any
    rings: Any

    def some(self, rows: Any) -> Blocks:
        """Those of some rows, with the rings of all."""
        at, corners, size, mass, x, y = (column[rows] for column in self[:-1])
        return Blocks(at, corners, size, mass, x, y, self.rings)

    def ring(self, rows: Any) -> Any:
        """The corners of the blocks of some rows, ascending."""
        chosen = np.zeros(len(self.at), bool)
        chosen[rows] = True
        return self.rings[np.repeat(chosen, self.corners)]


def blocks_of(side: Side) -> Blocks:
    """The blocks of a heap."""
    at = side.listed("block")
    rings, corners = side.along("corner", side.column("block", "KP", at), "KR")
    fields = ("KBRO", "KBM", "KX", "KY")
    size, mass, x, y = (side.column("block", name, at).astype(np.float64) for name in fields)
    return Blocks(at, corners, size, mass, x, y, rings)


def match_blocks(one: Blocks, two: Blocks) -> Pairs:
    """Rows of the one (n,) and of the other (n,) that are the same block, ascending."""
    count = len(one.at)
    if not all(bool((blocks.mass > 0).all()) for blocks in (one, two)):  # there are none before CYCLE
        one, two = (blocks._replace(mass=blocks.size) for blocks in (one, two))
    if count == len(two.at) and bool(same_shape(one, two, "mass").all()):
        return np.arange(count), np.arange(count)
    a, b = _anchors(one, two)
    parts: list[tuple[Any, Any]] = [(a, b)]
    ends = np.append(a, count), np.append(b, len(two.at))
    starts = np.append(0, a + 1), np.append(0, b + 1)
    for k in np.flatnonzero((ends[0] > starts[0]) & (ends[1] > starts[1])).tolist():
        rows = np.arange(starts[0][k], ends[0][k]), np.arange(starts[1][k], ends[1][k])
        parts.append(_between(one, two, *rows))
    a, b = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    order = np.argsort(a)
    return a[order], b[order]


def same_shape(one: Blocks, two: Blocks, what: str = "size") -> Any:
    """True for each row where both have the same corners and size, or mass."""
    a, b = getattr(one, what), getattr(two, what)
    with np.errstate(invalid="ignore"):
        near = np.abs(a - b) <= ALIKE * np.maximum(np.abs(a), np.abs(b))
    return (one.corners == two.corners) & near


@np.errstate(all="ignore")
def _anchors(one: Blocks, two: Blocks, cut: bool = False) -> Pairs:
    """Rows that are matched whatever lies between them. cut: of blocks that may have another shape."""
    rows = np.arange(len(one.at)), np.arange(len(two.at))
    found: list[Pairs] = [(rows[0][:0], rows[1][:0])]
    for keys in _keys(one, two):
        if not (len(rows[0]) and len(rows[1])):
            break
        a, b = unique_pairs(keys[0][rows[0]], keys[1][rows[1]])
        a, b = rows[0][a], rows[1][b]
        good = same_shape(one.some(a), two.some(b), "mass") | cut
        found.append((a[good], b[good]))
        rows = np.setdiff1d(rows[0], a[good], True), np.setdiff1d(rows[1], b[good], True)
    a, b = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = np.argsort(a)
    a, b = a[order], b[order]
    rising = longest_rising(b)
    return a[rising], b[rising]


def _keys(one: Blocks, two: Blocks) -> Iterator[tuple[Any, Any]]:
    """By mass, and by cells, small ones first: keys (n,) and (m,) that may belong to one block of each."""
    yield fold(*((blocks.corners, _whole(MASSES * np.log(blocks.mass))) for blocks in (one, two)))
    size = float(np.median(np.concatenate((one.size, two.size))))
    for cell, (by_x, by_y) in product(CELLS, SHIFTS):
        step = cell * size
        yield fold(*((_whole(at.x / step + by_x), _whole(at.y / step + by_y)) for at in (one, two)))


def _whole(values: Any) -> Any:
    """Reals as whole numbers; NaN and far ones as one that is far away."""
    return np.floor(np.clip(np.nan_to_num(values, nan=FAR), -FAR, FAR)).astype(np.int64)


def _between(one: Blocks, two: Blocks, a: Any, b: Any) -> Pairs:
    """Rows of `a` and of `b`, two stretches without an anchor, that are the same block."""
    if len(a) == len(b):
        return a, b
    few = min(len(a), len(b))
    front = int(np.append(same_shape(one.some(a[:few]), two.some(b[:few]), "mass"), False).argmin())
    back = same_shape(one.some(a[len(a) - few :]), two.some(b[len(b) - few :]), "mass")[::-1]
    last = min(int(np.append(back, False).argmin()), few - front)
    rest = a[front : len(a) - last], b[front : len(b) - last]
    cut = _anchors(one.some(rest[0]), two.some(rest[1]), cut=True)
    found = [
        np.concatenate((rows[:front], left[some], rows[len(rows) - last :]))
        for rows, left, some in zip((a, b), rest, cut, strict=True)
    ]
    return found[0], found[1]
