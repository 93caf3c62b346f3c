"""Arrays that show the memory of a model to a user, and note what is written into them.

Kernels follow the addresses in IA() without a further test, so changed words must be known before the next of
them runs. A tracked array takes assignments, `h.ia[7] = 1` and `h.cr[3:5] *= 2`, and notes them. All other
ways of writing are refused by NumPy: the array is read-only, as is the buffer through which it shows the
memory.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_memory import Memory


class Writes:
    """pending: True once something was written into a tracked array, until a command looks at it."""

    def __init__(self) -> None:
        self.pending = False


class TrackedArray(np.ndarray):
    """A read-only view of the array `_own` that writes to it by assignment and notes that in `_writes`."""

    _own: Any
    _writes: Any

    def __array_finalize__(self, source: Any) -> None:
        self._own, self._writes = getattr(source, "_own", None), getattr(source, "_writes", None)

    def __setitem__(self, where: Any, value: Any) -> None:
        self._to_write()[where] = value

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, out: Any = (), **named: Any) -> Any:
        """Results are ordinary arrays, or go into tracked ones that are given as `out`."""
        given = [one.view(np.ndarray) if isinstance(one, TrackedArray) else one for one in inputs]
        if method == "at" and isinstance(inputs[0], TrackedArray):
            given[0] = inputs[0]._to_write()
        if out:
            named["out"] = tuple(one._to_write() if isinstance(one, TrackedArray) else one for one in out)
        result = getattr(ufunc, method)(*given, **named)
        return out[0] if len(out) == 1 else out or result

    def _to_write(self) -> Any:
        """The same words as an ordinary, writeable array. A copy of a tracked array is writeable itself."""
        if self.flags.writeable:
            return self.view(np.ndarray)
        self._writes.pending = True
        first = self.ctypes.data - self._own.ctypes.data
        return np.ndarray(self.shape, self.dtype, self._own, first, self.strides)


def track(h: Memory, writes: Writes) -> Memory:
    """The memory `h` in tracked arrays, which note in `writes` what is written into them."""
    return Memory(*(_tracked(array, writes) for array in h))


def _tracked(array: Any, writes: Writes) -> TrackedArray:
    view: TrackedArray = np.asarray(memoryview(array).toreadonly()).view(TrackedArray)
    view._own, view._writes = array, writes
    return view
