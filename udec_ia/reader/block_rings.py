"""The lists around blocks: clockwise through corners and contacts, and back from corner to corner.

Those that close are walked all at once, each of the others by itself, and what breaks is reported. A block
whose lists do not close has the corners that they lead to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.accessors import Memory
from udec_ia.heap.untrusted_lists import closed_lists
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import FORWARD, HOSTS, INDEX, KL, KP, KR, Numbers, Reading
from udec_ia.reader.list_walks import Unsound, boundary, kind_of, reverse

CLOSED_LISTS = InterpretWhenSmall(closed_lists, 1e7)  # places where a group could begin


class Boundaries(NamedTuple):
    """The lists around blocks.

    row, item: of each item of the clockwise lists that close, block by block, the row of its block and its
    address. corner, owner: the corners of all lists, each with the address of its block.
    """

    row: Numbers
    item: Numbers
    corner: Numbers
    owner: Numbers


def boundaries(heap: Reading, blocks: Numbers) -> Boundaries:
    """Those of the blocks at the addresses `blocks`. What breaks is reported."""
    walker = _Walker(heap)
    row, item, broken = walker.closed(blocks)
    is_corner = heap.h.ia[item - 1] == g.MCOR
    corner, owner = item[is_corner], row[is_corner]
    turned = heap.read(corner, KR) != corner[one_before(owner)]
    again = [*broken, *blocks[np.unique(owner[turned])].tolist()]
    return Boundaries(row, item, *walker.with_others(corner, blocks[owner], again))


class _Walker:
    """Walks round blocks with a number of steps for all lists together, so that time is in proportion."""

    def __init__(self, heap: Reading) -> None:
        self.heap = heap
        self._left = heap.free // 2  # more than all items of sound lists together

    def closed(self, blocks: Numbers) -> tuple[Numbers, Numbers, list[int]]:
        """Row of the block and item, for the clockwise lists that close; and the blocks of the others."""
        heap = self.heap
        room = (heap.free - 1) // heap.ratio + 1
        row, item, closed = np.empty(room, INDEX), np.empty(room, np.int64), np.zeros(len(blocks), bool)
        limits = heap.last("corner"), heap.last("contact"), heap.ratio
        steps = tuple(heap.offset[name] - 1 for name in (KP, KL, *HOSTS, *FORWARD))
        found = CLOSED_LISTS(room, heap.h.ia, blocks, limits, steps, row, item, closed)
        row, item, broken = row[:found].copy(), item[:found].copy(), list[int]()
        for k in np.flatnonzero(~closed).tolist():
            ring, closes = self._walk(int(blocks[k]), "clockwise", boundary)
            if closes:
                at = int(np.searchsorted(row, k))
                row, item = np.insert(row, at, [k] * len(ring)), np.insert(item, at, ring)
            else:
                broken.append(int(blocks[k]))
        return row, item, broken

    def with_others(self, corner: Numbers, owner: Numbers, again: list[int]) -> tuple[Numbers, Numbers]:
        """The corners, and those of the lists of the blocks `again` that are not among them."""
        corners, owners = [corner], [owner]
        for block in again:
            items = self._walk(block, "clockwise", boundary)[0] + self._walk(block, "reverse", reverse)[0]
            found = [iad for iad in items if kind_of(self.heap.h, iad) == "corner"]
            corners.append(np.array(found, np.int64))
            owners.append(np.full(len(found), block))
        at, owner = np.concatenate(corners), np.concatenate(owners)
        there = np.zeros((self.heap.free - 1) // self.heap.ratio + 1, bool)
        there[self.heap.place(at)] = True
        if np.count_nonzero(there) < len(at):  # the first list that a corner stands in has it
            once = np.sort(np.unique(at, return_index=True)[1])
            at, owner = at[once], owner[once]
        return at, owner

    def _walk(
        self, block: int, name: str, along: Callable[[Memory, int], Iterator[int]]
    ) -> tuple[list[int], bool]:
        """A list of `block` as far as it can be followed, and whether it closes; if not, that is reported."""
        items: list[int] = []
        try:
            for iad in along(self.heap.h, block):
                if self._left <= 0:
                    raise Unsound("the broken lists are longer than the heap")
                items.append(iad)
                self._left -= 1
        except Unsound as error:
            self.heap.report(3, f"the {name} list of block@{block} breaks: {error.detail}")
            return items, False
        return items, True


def one_before(owner: Numbers) -> Numbers:
    """The index of the corner before each one on its block. owner: block of each; block by block."""
    before = np.arange(-1, len(owner) - 1)
    if len(owner):
        first = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
        before[first] = np.append(first[1:], len(owner)) - 1
    return before
