"""The kind of the group that begins at each word of an array.

A word of IA() has no type of its own. So the checked build keeps another array beside IA(), with a small
number for each word: the kind of the group that begins there. FIND and LOSE keep it up to date
(access_checks.py). Where the words came from elsewhere, from a restart file or from a copy that was put back,
it is made anew from the pointers: groups with a head code first, so that a wrong pointer makes no other kind
of them.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from typing import Any

import numpy as np

from udec_ia.checked_build.tagged_offsets import KINDS, NOTHING, SPARE, TABLE
from udec_ia.heap.census import census
from udec_ia.heap.junk_list import junk_chains
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts

NOTES = 5  # what an access that was refused leaves behind: routine, address, field, element, 1 if it writes
MARKS = g.MFREE, g.JUNK, g.IBPNT, g.ICPNT, g.IDPNT  # what only kernels change
HEADED = {head.group for head in TABLE.heads}  # kinds that their head code gives away


class Shadow:
    """Beside an array of `size` words. kinds: by address - 1; known: False if they have to be found anew.

    left: MARKS when kernels were last left. What differs was put there by somebody else.
    """

    def __init__(self, size: int) -> None:
        self.kinds = np.zeros(size, np.int8)
        self.notes = np.zeros(NOTES, np.int64)
        self.known = False
        self.left: tuple[int, ...] = ()


_SHADOWS: dict[tuple[int, int], Shadow] = {}


def shadow(ia: Any) -> Shadow:
    """That of the words `ia`, through whatever view of them."""
    own = getattr(ia, "array", ia)
    key = own.__array_interface__["data"][0], own.nbytes
    if key not in _SHADOWS:
        while isinstance(own.base, np.ndarray):
            own = own.base
        _SHADOWS[key] = Shadow(len(ia))
        weakref.finalize(own, _SHADOWS.pop, key, None)
    return _SHADOWS[key]


def forget(ia: Any) -> None:
    """Other groups have come to lie in `ia`."""
    shadow(ia).known = False


def follow(old: Any, new: Any) -> None:
    """The groups of `old` lie at the same addresses of `new`."""
    was, now = shadow(old), shadow(new)
    size = min(len(old), len(new))
    now.kinds[:size], now.known, now.left = was.kinds[:size], was.known, was.left


def enter(h: Any) -> None:
    """Kernels are about to work on `h`: see to it that the kinds are known."""
    here = shadow(h.ia)
    here.notes[:] = 0
    if not here.known or here.left != _marks(h):
        here.kinds[:] = NOTHING
        _find(h, here.kinds)
        here.known = True


def leave(h: Any) -> None:
    """They have done."""
    shadow(h.ia).left = _marks(h)


def _marks(h: Any) -> tuple[int, ...]:
    return tuple(int(h.ci[mark]) for mark in MARKS)


def _find(h: Any, kinds: Any) -> None:
    """Put the kinds of all groups into `kinds`; of groups that lie in each other, that of the surest one."""
    taken = np.zeros(len(kinds) + 2, np.int64)  # by address: groups that begin there less those that end
    for number, at, size in _groups(h):
        before = np.concatenate(([0], np.cumsum(np.cumsum(taken) > 0)))  # words of groups below an address
        free = before[at + size] == before[at]
        free[1:] &= at[1:] >= (at + size)[:-1]
        kinds[at[free] - 1] = number
        np.add.at(taken, at[free], 1)
        np.add.at(taken, (at + size)[free], -1)


def _groups(h: Any) -> Iterator[tuple[int, Any, Any]]:
    """Number of the kind, addresses, and words of the groups: junk, then what its head code gives away."""
    layout, words = layouts(int(h.ra.itemsize // h.ia.itemsize)), getattr(h.ia, "array", h.ia)
    top = max(1, min(int(h.ci[g.MFREE]), len(words) + 1))
    junk = sorted(group for chain in junk_chains(words[: top - 1], int(h.ci[g.JUNK])) for group in chain)
    yield SPARE, np.array([at for at, _ in junk], np.int64), np.array([size for _, size in junk], np.int64)
    for kind, at in sorted(census(h).items(), key=lambda item: item[0] not in HEADED):
        yield KINDS.index(kind), at, np.full(len(at), layout[kind].size)
