"""The clockwise lists that close, as arrays: what stands before and behind each item, and on which block."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from udec_ia.compiling.interpreting import InterpretWhenSmall
from udec_ia.heap.untrusted_lists import lay_out_lists
from udec_ia.layout import offsets as g
from udec_ia.reader.block_rings import Boundaries, one_before
from udec_ia.reader.field_reading import HOSTS, INDEX, Numbers
from udec_ia.reader.group_lists import Lists

LAY_OUT = InterpretWhenSmall(lay_out_lists, 1e6)  # items


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
    near, owner = np.empty((3, len(item)), INDEX), np.empty(len(item), INDEX)
    side, at = np.empty(len(item), np.int8), np.full((2, len(lists.address["contact"])), -1, INDEX)
    of_lists, to_host = np.column_stack((block, first, count)), lists.offset[HOSTS[0]] - 1
    LAY_OUT(len(item), lists.h.ia, to_host, of_lists, item, row, near, owner, side, at)
    before, after, corner = near
    return Rings(block, first, count, item, owner, contact, row, side, before, after, corner, at)


def corner_before(rings: Rings) -> Numbers:
    """For each corner of the lists the index of the corner before it, clockwise."""
    corner = np.flatnonzero(~rings.contact)
    return np.asarray(corner[one_before(rings.owner[corner])])
