"""IA() itself: its views, its common block, and how it grows.

1980 fixed the size of IA() when the program was compiled (MTOP). Here `mtop` does the same; without
it the array grows whenever a routine asks for room, up to the last address that an integer of the
word scheme can hold.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.build_choice import CHECKED, checked_build
from udec_ia.errors import OVERFLOW
from udec_ia.heap.accessors import Memory
from udec_ia.heap.word_scheme import Scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field

FIRST_SIZE = 8192
LARGE, AMPLE = 2**20, 2**27  # words: from LARGE on it grows to AMPLE at once, and then by doubling
LINE = 64  # bytes that the machine's memory hands out at a time


def _words(n: int, kind: Any) -> Any:
    """`n` words of the type `kind`, all zero, that begin where a line of memory does."""
    data = np.zeros(n * kind.itemsize + LINE, np.uint8)
    start = -data.ctypes.data % LINE
    return data[start : start + n * kind.itemsize].view(kind)


def variable(h: Memory, field: Field) -> Any:
    """The elements of a variable of the common block, in place."""
    first = getattr(g, field.name)
    return {"int": h.ci, "real": h.cr, "double": h.cd}[field.type][first : first + field.count]


class MainArray:
    """The main array and the common block of one model.

    `h` is the Memory that kernels work on; it is a new object after the array has grown.
    """

    def __init__(self, scheme: Scheme, mtop: int | None = None) -> None:
        if mtop is not None and not 1 <= mtop <= scheme.top_address:
            raise ValueError(
                f"mtop must lie between 1 and {scheme.top_address}, the last address of {scheme.name}"
            )
        self.scheme = scheme
        self.fixed = mtop is not None
        words = self._whole_reals(min(FIRST_SIZE, scheme.top_address) if mtop is None else mtop)
        common = (
            np.zeros(g.NCOMI, np.int64),
            np.zeros(g.NCOMR, scheme.real_type),
            np.zeros(g.NCOMD, np.float64),
        )
        self.h = self._views(_words(words, scheme.int_type), *common)
        self.h.ci[g.MFREE] = 1
        self.h.ci[g.MTOP] = words

    def _copied(self, size: int) -> Any:
        """`size` words, of which those below MFREE are as they are now and the others zero."""
        ia, used = _words(size, self.scheme.int_type), int(self.h.ci[g.MFREE]) - 1
        ia[:used] = self.h.ia[:used]
        if CHECKED:
            checked_build("group_kinds").follow(self.h.ia, ia)
        return ia

    def _whole_reals(self, words: int) -> int:
        return words // self.scheme.ratio * self.scheme.ratio

    def _views(self, ia: Any, ci: Any, cr: Any, cd: Any) -> Memory:
        return Memory(ia, ia.view(self.scheme.real_type), ci, cr, cd)

    @property
    def limit(self) -> int:
        """Largest size that the array can ever have."""
        return int(self.h.ci[g.MTOP]) if self.fixed else self._whole_reals(self.scheme.top_address)

    def grow(self) -> bool:
        """Make the room that an interrupted routine asked for; False if the limit forbids it.

        On success error 1 and the request are cleared, and the routine can be called again.
        """
        ci = self.h.ci
        need = int(ci[g.MFREE] + ci[g.NWANT])
        if need - 1 > self.limit:
            return False
        wanted = max(2 * need, FIRST_SIZE if need < LARGE else AMPLE)  # words not touched yet cost nothing
        size = min(self._whole_reals(wanted), self.limit)
        self.h = self._views(self._copied(size), ci, self.h.cr, self.h.cd)
        ci[g.MTOP] = size
        ci[g.NWANT] = 0
        if ci[g.NERR] == OVERFLOW:
            ci[g.NERR] = 0
        return True

    def refit(self, mtop: int | None) -> bool:
        """Let the array have `mtop` words and no more, or grow if that is None; False if it holds more."""
        if mtop is not None:
            size = self._whole_reals(mtop)
            if self.h.ci[g.MFREE] - 1 > size or mtop > self.scheme.top_address:
                return False
            self.h = self._views(self._copied(size), *self.h[2:])
            self.h.ci[g.MTOP] = size
        self.fixed = mtop is not None
        return True

    def __getstate__(self) -> tuple[Any, ...]:
        """For pickle: what counts, which are the words below MFREE and the common block."""
        used = int(self.h.ci[g.MFREE]) - 1
        return self.scheme, self.fixed, len(self.h.ia), self.h.ia[:used], *self.h[2:]

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self.scheme, self.fixed, size, words, *common = state
        ia = _words(size, self.scheme.int_type)
        ia[: len(words)] = words
        self.h = self._views(ia, *common)

    def __deepcopy__(self, _: Any) -> MainArray:
        return self.copy()

    def copy(self) -> MainArray:
        """An independent copy of the whole state."""
        other = object.__new__(MainArray)
        other.scheme, other.fixed = self.scheme, self.fixed
        other.h = self._views(self._copied(len(self.h.ia)), *(part.copy() for part in self.h[2:]))
        return other
