"""The lists around blocks: clockwise through corners and contacts, and back from corner to corner.

Those that close are walked all at once. What does not close is walked by itself, and told. A block whose
lists do not close still has the corners that they lead to.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from udec_ia.compiling.interpreting import InterpretWhenSmall
from udec_ia.heap.untrusted_lists import closed_lists
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import FORWARD, HOSTS, INDEX, KL, KP, KR, Numbers, Reading

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
    """Walks round blocks with a number of steps: each is paid for by at least one word of the heap."""

    def __init__(self, heap: Reading) -> None:
        self.heap = heap
        last = (heap.last(kind) for kind in ("corner", "contact"))
        self._steps = (*last, *(heap.offset[name] - 1 for name in (KL, *HOSTS, *FORWARD)))
        self._left = heap.free

    def closed(self, blocks: Numbers) -> tuple[Numbers, Numbers, list[int]]:
        """Row of the block and item, for the clockwise lists that close; and the blocks of the others."""
        row, item, closed = self._closed(blocks)
        if closed.all():
            return row, item, []
        rows, items = [row], [item]
        broken: list[int] = []
        for k in np.flatnonzero(~closed).tolist():
            ring, closes = self._ring(int(blocks[k]))
            self._left -= len(ring)
            if closes:
                rows.append(np.full(len(ring), k, row.dtype))
                items.append(np.array(ring, np.int64))
            else:
                broken.append(int(blocks[k]))
        order = np.argsort(np.concatenate(rows), kind="stable")
        return np.concatenate(rows)[order], np.concatenate(items)[order], broken

    def with_others(self, corner: Numbers, owner: Numbers, again: list[int]) -> tuple[Numbers, Numbers]:
        """The corners, and those of the lists of the blocks `again` that are not among them."""
        corners, owners = [corner], [owner]
        for block in again:
            found = self._ring_corners(block) + self._reverse(block)
            self._left -= len(found)
            corners.append(np.array(found, np.int64))
            owners.append(np.full(len(found), block))
        at, owner = np.concatenate(corners), np.concatenate(owners)
        there = np.zeros((self.heap.free - 1) // self.heap.ratio + 1, bool)
        there[self.heap.place(at)] = True
        if np.count_nonzero(there) < len(at):  # the first list that a corner stands in has it
            once = np.sort(np.unique(at, return_index=True)[1])
            at, owner = at[once], owner[once]
        return at, owner

    def _closed(self, blocks: Numbers) -> tuple[Numbers, Numbers, Numbers]:
        """Rows of blocks and items of the lists that close, and which blocks these are."""
        room = (self.heap.free - 1) // self.heap.ratio + 1
        row, item, closed = np.empty(room, INDEX), np.empty(room, np.int64), np.zeros(len(blocks), bool)
        last_corner, last_contact, *steps = self._steps
        limits, kp = (last_corner, last_contact, self.heap.ratio), self.heap.offset[KP] - 1
        found = CLOSED_LISTS(room, self.heap.h.ia, blocks, limits, (kp, *steps), row, item, closed)
        return row[:found].copy(), item[:found].copy(), closed

    def _ring(self, block: int) -> tuple[list[int], bool]:
        """Clockwise list of `block` as far as it can be followed, and whether it closes."""
        left = self._left
        words, ratio = self.heap.words, self.heap.ratio
        last_corner, last_contact, along, one, two, over_one, over_two = self._steps
        first = iad = self.heap.get(block, KP)
        ring: dict[int, None] = {}
        while iad not in ring and 0 < iad <= last_corner and not (iad - 1) % ratio and len(ring) < left:
            head = words[iad - 1]
            if head == g.MCOR:
                step = along
            elif head != g.MCON or iad > last_contact or not ring:
                break
            elif words[iad + one] == block:
                step = over_one
            elif words[iad + two] == block:
                step = over_two
            else:
                break
            ring[iad] = None
            iad = words[iad + step]
        if iad == first and ring:
            return list(ring), True
        self.heap.report(3, self._break(block, list(ring), iad, len(ring) >= left))
        return list(ring), False

    def _break(self, block: int, ring: list[int], iad: int, is_long: bool) -> str:
        """Why a clockwise list ends: it holds `ring` and leads on to `iad`."""
        if is_long:
            return f"the clockwise list of block@{block} is longer than the heap"
        if not ring:
            return f"{KP} of block@{block} points to {iad}, which is no corner"
        kind, source = self.heap.kind(iad), self.heap.link(block, ring[-1])
        if iad in ring:
            return f"{source} leads back to {kind}@{iad} and not to {KP} of block@{block}, {ring[0]}"
        if kind != "contact":
            return f"{source} leads to {iad}, which is no item of the list of block@{block}"
        named = " and ".join(f"{name} is {to}" for name, to in zip(HOSTS, self.heap.hosts(iad), strict=True))
        return f"{source} leads to contact@{iad} in the list of block@{block}, but its {named}"

    def _ring_corners(self, block: int) -> list[int]:
        """Corners of a clockwise list that does not close, which has been told."""
        ring, _ = self._ring(block)
        return [iad for iad in ring if self.heap.kind(iad) == "corner"]

    def _reverse(self, block: int) -> list[int]:
        """Corners along the reverse list of `block` as far as it can be followed."""
        first = iad = self.heap.get(block, KP)
        corners: dict[int, None] = {}
        for _ in range(self._left):
            if self.heap.kind(iad) != "corner" or iad in corners:
                break
            corners[iad] = None
            iad = self.heap.get(iad, KR)
        if iad != first or not corners:
            what = f"the reverse list of block@{block} leads to {iad} and not back to {KP}, {first}"
            self.heap.report(3, what)
        return list(corners)


def one_before(owner: Numbers) -> Numbers:
    """The index of the corner before each one on its block. owner: block of each; block by block."""
    before = np.arange(-1, len(owner) - 1)
    if len(owner):
        first = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
        before[first] = np.append(first[1:], len(owner)) - 1
    return before
