"""Walks along the lists of a sound heap, for what happens once a command."""

from __future__ import annotations

from collections.abc import Iterator

from udec_ia.heap.accessors import Memory, Offset, iget
from udec_ia.kernels.links.lists import nextcp
from udec_ia.layout import offsets as g


def items(h: Memory, ib: int) -> Iterator[int]:
    """Corners and contacts of block `ib`, clockwise."""
    first = item = iget(h, ib, g.KP)
    while True:
        yield item
        item = nextcp(h, ib, item)
        if item == first:
            return


def chain(h: Memory, first: int, link: Offset) -> Iterator[int]:
    """Groups of a list from `first` on, linked by `link`; the one at hand may be given back."""
    while first:
        following = iget(h, first, link)
        yield first
        first = following
