"""Kernels run as Python, in a process where they are compiled; and a memory that tells what is done with it.

    with interpreted():
        run_unwatched(observe(h, tell), 1, laws)

All kernels that are called within run their Python source, bit for bit as compiled, a thousand times slower.
So a debugger can see a cycle at work while all the others run at full speed: `observe` gives a memory of the
same words that tells of each word that is read or written. A kernel that is called with it is interpreted
anyway.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, ClassVar

import numpy as np

from udec_ia.heap.loading import DISABLED
from udec_ia.heap.views import Memory

Tell = Callable[[str, Any, Any, bool], None]


class _Mode:
    """python: kernels that are called run as Python."""

    python = DISABLED


mode = _Mode()


@contextmanager
def interpreted() -> Iterator[None]:
    """Within, kernels run as Python."""
    before, mode.python = mode.python, True
    try:
        with np.errstate(all="ignore"):  # as compiled code does
            yield
    finally:
        mode.python = before


class Patience:
    """For how many seconds kernels may run as Python in this process, all together that share it."""

    def __init__(self, seconds: float) -> None:
        self.left = seconds


LOOKS = Patience(0.3)  # of what goes through a heap without changing it: census, checker, comparison


class Sparing:
    """A kernel that a small model has little for: what it would cost to compile, Python does many times over.

    It runs as Python as long as there is `patience`, of its own if none is given, and from then on compiled.
    rate: groups that Python goes through in a second. at_once: all of them run compiled from the first group
    on, which is how tools/ahead.py wants it.
    """

    at_once: ClassVar[bool] = False

    def __init__(self, kernel: Callable[..., Any], rate: float, patience: Patience | None = None) -> None:
        self.kernel, self.rate = kernel, rate
        self.patience = patience or Patience(0.1)

    def __call__(self, groups: int, *args: Any) -> Any:
        """Call the kernel with `args`. groups: how many it goes through."""
        self.patience.left -= groups / self.rate
        if self.patience.left < 0 or self.at_once:
            return self.kernel(*args)
        with interpreted():
            return self.kernel(*args)


class Observed:
    """One array of a memory, whose elements are read and written through it. name: ia, ra, ci, cr or cd."""

    def __init__(self, name: str, array: Any, tell: Tell) -> None:
        self.name, self.array, self.tell = name, array, tell
        self.dtype, self.itemsize = array.dtype, array.itemsize

    def __len__(self) -> int:
        return len(self.array)

    def __getitem__(self, where: Any) -> Any:
        value = self.array[where]
        self.tell(self.name, where, value, False)
        return value

    def __setitem__(self, where: Any, value: Any) -> None:
        self.array[where] = value
        self.tell(self.name, where, value, True)


class ObservedMemory(Memory):
    """A memory of observed arrays."""

    __slots__ = ()


def observe(h: Memory, tell: Tell) -> ObservedMemory:
    """The words of `h`, for kernels that are interpreted.

    tell: called after each access with the name of the array, the index, the value, and True if it was
    written. A word of IA() is told by that view of it through which the kernel has gone.
    """
    arrays = (Observed(name, array, tell) for name, array in zip(Memory._fields, h, strict=True))
    return ObservedMemory(*arrays)
