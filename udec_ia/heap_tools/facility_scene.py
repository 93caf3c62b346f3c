"""A state, field by field: what tells which facilities are in use.

Groups are found as in a damaged heap (heap/census.py), so that nothing here follows a link.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.atlas import Atlas

LISTS = {"block": ("KB", g.IBPNT), "contact": ("KC", g.ICPNT), "bound": ("KU", g.IBNPNT)}
LISTS |= {"signal": ("KT", g.ISGPNT), "history": ("KH", g.IHPNT)}


class Scene:
    """The groups of `array` and what stands in them."""

    def __init__(self, array: MainArray) -> None:
        self.array = array
        self.h = array.h
        self.atlas = Atlas(array.h)

    def count(self, kind: str) -> int:
        """How many groups of a kind there are."""
        return len(self.atlas.groups[kind])

    def found(self, _: MainArray, kind: str) -> Any:
        """Addresses of all groups of a kind, as remarks.py wants them told: no kernel is called for them."""
        return self.atlas.groups[kind]

    def words(self, *kinds: str) -> int:
        """Words of IA() that groups of some kinds take."""
        return sum(self.count(kind) * self.atlas.layout[kind].size for kind in kinds)

    @property
    def in_use(self) -> int:
        """Words of IA() that are in use: below MFREE, and not on the junk list."""
        given = sum(size for chain in self.atlas.chains for _, size in chain)
        return self.atlas.free - 1 - given

    def column(self, kind: str, field: str) -> Any:
        """What a field holds in all groups of a kind, by rising address."""
        word = next(one for one in self.atlas.shapes[kind] if one.field.name == field)
        return self.atlas.gather(word, self.atlas.groups[kind])

    def of_blocks(self, addresses: Any, field: str) -> Any:
        """The same in the blocks at some addresses, as far as there are blocks; 0 elsewhere."""
        blocks, values = self.atlas.groups["block"], self.column("block", field)
        at = np.minimum(np.searchsorted(blocks, addresses), max(len(blocks) - 1, 0))
        return np.where(blocks[at] == addresses, values[at], 0) if len(blocks) else np.zeros_like(addresses)

    @cached_property
    def moves(self) -> bool:
        """True if a block is not fixed."""
        return bool((self.column("block", "KBFIX") != g.FIXED).any())

    @cached_property
    def touching(self) -> Any:
        """True for each contact that is not virtual."""
        return self.column("contact", "KCCOD") != g.VIRTUAL

    @cached_property
    def lists_end(self) -> bool:
        """True if a walk along any of the main lists comes to its end: no two links lead to one group."""
        for kind, (link, head) in LISTS.items():
            after, first = self.column(kind, link), int(self.h.ci[head])
            leads = np.append(after[after != 0], first) if first else after[after != 0]
            if len(np.unique(leads)) < len(leads) or not np.isin(leads, self.atlas.groups[kind]).all():
                return False
        return True
