"""What a model lends of its memory: arrays that anybody may read, and that notice what is written into them.

Kernels follow the addresses in IA() without a further test, so a word that somebody has changed must be known
to be changed before the next of them runs. A lent array takes assignments, `h.ia[7] = 1` and
`h.cr[3:5] *= 2`, and notes them. To all other ways of writing, through another view of the same memory or by
a method such as `fill`, it is read-only, and NumPy says so.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_memory import Memory


class Writes:
    """made: true once something was written into what was lent, until it is looked at."""

    def __init__(self) -> None:
        self.made = False


class Lent(np.ndarray):
    """A read-only view of `own` that writes to it by assignment and notes that in `writes`."""

    own: Any
    writes: Any

    def __array_finalize__(self, source: Any) -> None:
        self.own, self.writes = getattr(source, "own", None), getattr(source, "writes", None)

    def __setitem__(self, where: Any, value: Any) -> None:
        self._to_write()[where] = value

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, out: Any = (), **named: Any) -> Any:
        """Results are ordinary arrays, or in the lent ones that are to take them."""
        given = [_plain(one) for one in inputs]
        if method == "at" and isinstance(inputs[0], Lent):
            given[0] = inputs[0]._to_write()
        if out:
            named["out"] = tuple(one._to_write() if isinstance(one, Lent) else one for one in out)
        result = getattr(ufunc, method)(*given, **named)
        return out[0] if len(out) == 1 else out or result

    def _to_write(self) -> Any:
        """The same words to be written; those of a copy are nobody else's."""
        if self.flags.writeable:
            return self.view(np.ndarray)
        self.writes.made = True
        first = self.ctypes.data - self.own.ctypes.data
        return np.ndarray(self.shape, self.dtype, self.own, first, self.strides)


def _plain(one: Any) -> Any:
    return one.view(np.ndarray) if isinstance(one, Lent) else one


def lend(h: Memory, writes: Writes) -> Memory:
    """`h` for others: what they write is noted in `writes`."""
    return Memory(*(_lend(array, writes) for array in h))


def _lend(array: Any, writes: Writes) -> Lent:
    lent: Lent = array.view(Lent)
    lent.own, lent.writes = array, writes
    lent.flags.writeable = False
    return lent
