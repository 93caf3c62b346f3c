"""What is done with a run while it goes on: progress is shown and pictures are taken."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TextIO

from udec_ia.compiling.compile_time import working_time
from udec_ia.heap.accessors import Memory
from udec_ia.kernels.drive.unbalanced_force import unbalanced
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft_or_loaded_in
from udec_ia.running.critical_step import fraction_in_words

if TYPE_CHECKING:
    from udec_ia.output.animate import Animation
    from udec_ia.output.progress import Progress


class Report:
    """Called by CYCLE now and then with the number of cycles done.

    memory: gives the memory of the model as it is now. total: cycles of the command. stream: where progress
    shows; None for nowhere. animation: where pictures go; None for nowhere.
    """

    def __init__(
        self, memory: Callable[[], Memory], total: int, stream: TextIO | None, animation: Animation | None
    ) -> None:
        self.memory = memory
        self.total = total
        self.stream = stream
        self.animation = animation
        self.progress: Progress | None = None
        self.shown = 0  # cycles done when progress was shown last
        self.before = int(memory().ci[g.MCTOT])
        self.started = working_time()

    def __call__(self, done: int) -> None:
        if self.animation is not None:
            self.animation.add(self.memory())
        if self.stream is not None:
            self._show(done, self.stream)

    def _show(self, done: int, stream: TextIO) -> None:
        h = self.memory()
        if self.progress is None:
            from udec_ia.output.progress import Progress

            tdel = float(h.cr[g.TDEL])
            self.progress = Progress(stream, self.total, tdel, fraction_in_words(h), self.started)
        self.shown = done
        made, broken = int(h.ci[g.NMADE]), int(h.ci[g.NBROKE])
        self.progress.update(
            done, float(h.cd[g.TIME]), float(unbalanced(h, soft_or_loaded_in(h))[0]), made, broken
        )

    def close(self) -> None:
        """Take the progress off the screen; the last line tells how far a command came that was cut short."""
        done = int(self.memory().ci[g.MCTOT]) - self.before
        if self.stream is not None and done != self.shown:
            self._show(done, self.stream)
        if self.progress is not None:
            self.progress.close()
