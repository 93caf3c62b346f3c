"""What kind of group begins at each word of an array: what the checked build looks at beside the words.

A word of IA() has no type of its own. So for each array whose kernels are checked there is another one, of a
small number a word: the kind of the group that begins there. FIND and LOSE keep it (guarding.py). Where the
words came from elsewhere, from a restart file or from a copy that was put back, it is made anew from the
pointers (entering.py): groups with a head code first, so that a wrong pointer makes no other kind of them.
"""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np

from udec_ia.heap.checked import CHECKED

NOTES = 5  # what an access that was refused leaves behind: routine, address, field, element, 1 if it writes


class Shadow:
    """Beside an array of `size` words. kinds: by address - 1; known: False if they have to be found anew.

    left: MARKS (entering.py) when kernels were last left. What differs was put there by somebody else.
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
    if CHECKED:
        shadow(ia).known = False


def follow(old: Any, new: Any) -> None:
    """The groups of `old` lie at the same addresses of `new`."""
    if CHECKED:
        was, now = shadow(old), shadow(new)
        size = min(len(old), len(new))
        now.kinds[:size], now.known, now.left = was.kinds[:size], was.known, was.left
