"""The clockwise lists that close, as arrays: what stands before and behind each item, and on which block."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from udec_ia.inspect.boundaries import Boundaries, one_before
from udec_ia.inspect.lists import Lists
from udec_ia.inspect.reading import HOSTS, INDEX, Numbers
from udec_ia.layout import offsets as g


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


def lay_out(lists: Lists, boundaries: Boundaries, rows: Callable[[str, Numbers], Numbers]) -> Rings:
    """The lists of `boundaries` that close. rows: gives rows of groups of a kind by their addresses."""
    blocks = lists.address["block"]
    count = np.bincount(boundaries.row, minlength=len(blocks))
    block, count, item = blocks[count > 0], count[count > 0], boundaries.item
    end = np.cumsum(count, dtype=INDEX)
    first = (end - count).astype(INDEX)
    owner = np.repeat(np.arange(len(block), dtype=INDEX), count)
    here = np.arange(len(item), dtype=INDEX)
    contact = lists.h.ia[item - 1] == g.MCON
    row = rows("contact", item)
    row[~contact] = rows("corner", item[~contact])
    side = np.zeros(len(item), np.int8)
    side[contact] = lists.read(item[contact], HOSTS[0]) != block[owner[contact]]
    at = np.full((2, len(lists.address["contact"])), -1, INDEX)
    listed = contact & (row >= 0)
    at[side[listed], row[listed]] = here[listed]
    corner = np.where(contact, INDEX(len(item)), here)
    corner = np.minimum.accumulate(corner[::-1])[::-1]
    return Rings(
        block=block,
        first=first,
        count=count,
        item=item,
        owner=owner,
        contact=contact,
        row=row,
        side=side,
        before=np.where(here == first[owner], end[owner] - 1, here - 1),
        after=np.where(here == end[owner] - 1, first[owner], here + 1),
        corner=np.where(corner < end[owner], corner, first[owner]),  # a list begins with a corner
        at=at,
    )


def corner_before(rings: Rings) -> Numbers:
    """For each corner of the lists the index of the corner before it, clockwise."""
    corner = np.flatnonzero(~rings.contact)
    return np.asarray(corner[one_before(rings.owner[corner])])
