"""How much processor time a run takes, without what compiling its kernels takes.

Of compiling only the time by the clock is known, and on a busy machine a process does not have the processor
all of that time. So where something was compiled, it is taken to have had the same share of the rest.
"""

from __future__ import annotations

from time import monotonic, thread_time

from udec_ia.compiling.compile_time import compile_seconds


class Clock:
    """Runs from now on, in the thread that asks it."""

    def __init__(self) -> None:
        self._seconds = 0.0
        self._last = self._now()

    @property
    def seconds(self) -> float:
        """Processor seconds until now, without compiling. Asked often, it is the more exact."""
        now = self._now()
        spent, passed, compiled = (new - old for new, old in zip(now, self._last, strict=True))
        self._last = now
        self._seconds += spent * max(1 - compiled / passed, 0.0) if compiled > 0 else spent
        return self._seconds

    def _now(self) -> tuple[float, float, float]:
        return thread_time(), monotonic(), compile_seconds()
