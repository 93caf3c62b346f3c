"""What kind of group begins at each word of an array: what the checked build looks at beside the words.

A word of IA() has no type of its own. So for each array whose kernels are checked there is another one, of a
small number a word: the kind of the group that begins there. FIND and LOSE keep it (guarding.py). Where the
words came from elsewhere, from a restart file or from a copy that was put back, it is made anew from the
pointers: groups with a head code first, so that a wrong pointer does not make another kind of them.
"""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np

from udec_ia.heap.checked import CHECKED, KINDS, NOTHING, SPARE, TABLE
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Group, layouts

NOTES = 5  # what an access that was refused leaves behind: routine, address, field, element, 1 if it writes
MARKS = g.MFREE, g.JUNK, g.IBPNT, g.ICPNT, g.IDPNT  # what only kernels change
HEADS = {(head.group, head.value) for head in TABLE.heads}
HEADED = {kind for kind, _ in HEADS}
SOFT = {head.value: (head.extension,) for head in TABLE.heads if head.extension}
CHOICES = {"item": ("corner", "contact"), "any": ()}  # what is of any kind is reached by its own lists


class Shadow:
    """Beside an array of `size` words. kinds: by address - 1; known: False if they have to be found anew.

    left: MARKS when kernels were last left. Others in their place were put there by somebody else.
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


def enter(h: Any) -> None:
    """Kernels are about to work on `h`: see to it that the kinds are known."""
    here = shadow(h.ia)
    here.notes[:] = 0
    if not here.known or here.left != _marks(h):
        here.kinds[:] = NOTHING
        _Walk(h, here.kinds)
        here.known = True


def leave(h: Any) -> None:
    """They have done."""
    shadow(h.ia).left = _marks(h)


def _marks(h: Any) -> tuple[int, ...]:
    return tuple(int(h.ci[mark]) for mark in MARKS)


class _Walk:
    """Through all pointers of the table, from those of the common block and the junk list on."""

    def __init__(self, h: Any, kinds: Any) -> None:
        self.words, self.kinds = memoryview(getattr(h.ia, "array", h.ia)), kinds
        self.ratio = int(h.ra.itemsize // h.ia.itemsize)
        self.layouts = layouts(self.ratio)
        self.top = max(1, min(int(h.ci[g.MFREE]), len(h.ia) + 1))
        self.taken = bytearray(self.top)
        self._junk(int(h.ci[g.JUNK]))
        self.sure: list[tuple[str, int]] = []  # where groups with a head code may be
        self.others: list[tuple[str, int]] = []
        for field in TABLE.common:
            if field.target:
                self._ahead(field.target, int(h.ci[getattr(g, field.name)]), 0)
        while self.sure or self.others:
            self._claim(*(self.sure or self.others).pop())

    def _take(self, kind: str, iad: int, size: int) -> bool:
        """A group begins at `iad`, unless another one lies there."""
        inside = 1 <= iad <= self.top - size and not (iad - 1) % self.ratio
        if not inside or self.taken.find(1, iad - 1, iad - 1 + size) >= 0:
            return False
        self.taken[iad - 1 : iad - 1 + size] = b"\1" * size
        self.kinds[iad - 1] = KINDS.index(kind)
        return True

    def _junk(self, first: int) -> None:
        while 1 <= first < self.top - 2:
            size, iad = self.words[first], first
            first = self.words[first + 1]
            while size > 0 and self._take(KINDS[SPARE], iad, size):
                iad = self.words[iad - 1]

    def _ahead(self, target: str, iad: int, code: int) -> None:
        """A pointer leads to `iad`. code: the head code of the group that has it."""
        if iad:
            for kind in SOFT.get(code, ()) if target == "soft" else CHOICES.get(target, (target,)):
                (self.sure if kind in HEADED else self.others).append((kind, iad))

    def _claim(self, kind: str, iad: int) -> None:
        """Let a group of `kind` be at `iad` if one can be, and go on from there."""
        group: Group = TABLE.group(kind)
        layout = self.layouts[kind]
        code = int(self.words[iad - 1]) if 1 <= iad < self.top else 0
        if (kind in HEADED and (kind, code) not in HEADS) or not self._take(kind, iad, layout.size):
            return
        for field in group.fields:
            if field.target:
                at = iad - 1 + layout.offset[field.name]
                for i in range(field.count):
                    self._ahead(field.target, int(self.words[at + i]), code)
