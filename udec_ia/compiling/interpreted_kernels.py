"""Kernels that run as Python in a process where others are compiled: in a context, or for small models.

Within `with interpreted():` all kernels run their Python source, bit for bit as compiled, a thousand times
slower. `observe` makes a memory of the same words that reports each word that is read or written, so that a
debugger sees a cycle at work. A kernel that is called with it is interpreted anyway.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, ClassVar

import numpy as np

from udec_ia.compiling.build_choice import DISABLED
from udec_ia.compiling.kernel_memory import Memory

Report = Callable[[str, Any, Any, bool], None]


class _Mode:
    """python: kernels that are called run as Python. calls: what they are called with; None: unrecorded."""

    python = DISABLED
    calls: list[tuple[Any, tuple[Any, ...]]] | None = None


mode = _Mode()


@contextmanager
def interpreted(calls: list[tuple[Any, tuple[Any, ...]]] | None = None) -> Iterator[None]:
    """Within, kernels run as Python. calls: gets the kernels that Python calls, and their arguments."""
    before, mode.python, mode.calls = (mode.python, mode.calls), True, calls
    try:
        with np.errstate(all="ignore"):  # as compiled code does
            yield
    finally:
        mode.python, mode.calls = before


class InterpretWhenSmall:
    """A kernel that runs as Python for small models: to load numba and to compile it would take longer.

    rate: groups that Python goes through in a second. All such kernels of a process may together run as
    Python for `seconds_left`; then they run compiled. always_compiled: they do from the first group on.
    """

    seconds_left: ClassVar[float] = 0.3
    always_compiled: ClassVar[bool] = False

    def __init__(self, kernel: Callable[..., Any], rate: float) -> None:
        self.kernel, self.rate = kernel, rate

    def __call__(self, groups: int, *args: Any) -> Any:
        """Call the kernel with `args`. groups: how many it goes through."""
        InterpretWhenSmall.seconds_left -= groups / self.rate
        if self.seconds_left < 0 or self.always_compiled:
            return self.kernel(*args)
        with interpreted():
            return self.kernel(*args)


class Observed:
    """One array of a memory, whose elements are read and written through it. name: ia, ra, ci, cr or cd."""

    def __init__(self, name: str, array: Any, report: Report) -> None:
        self.name, self.array, self.report = name, array, report
        self.dtype, self.itemsize = array.dtype, array.itemsize

    def __len__(self) -> int:
        return len(self.array)

    def __getitem__(self, where: Any) -> Any:
        value = self.array[where]
        self.report(self.name, where, value, False)
        return value

    def __setitem__(self, where: Any, value: Any) -> None:
        self.array[where] = value
        self.report(self.name, where, value, True)


class ObservedMemory(Memory):
    """A memory of observed arrays."""

    __slots__ = ()


def observe(h: Memory, report: Report) -> ObservedMemory:
    """The words of `h`, for kernels that are interpreted.

    report: called after each access with name of the array (ia or ra as the kernel used it), index, value,
    and True if it was written.
    """
    arrays = (Observed(name, array, report) for name, array in zip(Memory._fields, h, strict=True))
    return ObservedMemory(*arrays)
