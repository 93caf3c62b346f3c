"""The progress of a run on the screen, its pictures for an animation, and the line that sums it up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, MofNCompleteColumn, TimeRemainingColumn
from rich.progress import Progress as Bar
from rich.text import Text

from udec_ia.compiling.compile_duration import working_time
from udec_ia.heap.accessors import Memory
from udec_ia.kernels.drive.unbalanced_force import unbalanced
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft_or_loaded_in
from udec_ia.printable_text import counted, printable
from udec_ia.running.critical_step import fraction_in_words

if TYPE_CHECKING:
    from udec_ia.output.animation import Animation

LINES = 10  # plain lines for one CYCLE command, at most
QUIET = 2.0  # seconds that a command must have lasted before it says how far it is
SHOWN = 0.05  # seconds of compiling, from which on the summary tells them
NAMED_FILES = 4  # files that the summary names; of more, their number


class Progress:
    """Progress of one CYCLE command.

    stream: where it shows; a bar if it is a terminal (in colour unless NO_COLOR is set), else plain lines.
    total: cycles of the command. tdel: time-step in s. share: which part it is, and of what.
    started: reading of `working_time` when the command began; None for now.
    """

    def __init__(
        self, stream: TextIO, total: int, tdel: float, share: str, started: float | None = None
    ) -> None:
        self.stream = stream
        self.total = total
        self.step = f"dt {tdel:.3g} s ({share})"
        self.started = working_time() if started is None else started
        self.lines = 0
        self.last = ""  # line on how far the command is
        self.shown = ""  # line that was printed last
        columns = BarColumn(None), MofNCompleteColumn(), TimeRemainingColumn()
        self.bar = Bar(*columns, expand=True, get_time=working_time)
        self.task = self.bar.add_task("cycles", total=total)
        self.live: Live | None = None
        if stream.isatty():
            self.live = Live(
                self._view(self.step), console=Console(file=stream, highlight=False), transient=True
            )
            self.live.start()

    def _view(self, state: str) -> Group:
        """The bar, and below it the numbers, on as many lines as the terminal needs."""
        return Group(self.bar, Text(state))

    def update(self, done: int, time: float, unbalanced: float, made: int, broken: int) -> None:
        """`done` cycles of the command are over.

        time: in s since the first cycle; unbalanced: largest force sum of a free block in N/m; made, broken:
        contacts made and broken so far.
        """
        elapsed = working_time() - self.started
        rate = done / elapsed if elapsed > 0.0 else 0.0
        state = (
            f"{rate:,.0f} cycles/s, t = {time:.4g} s, {self.step}, unbalanced force {unbalanced:.3g} N/m, "
            f"contacts +{made} -{broken}"
        )
        self.last = f"cycle {done} of {self.total}: {state}"
        if self.live is not None:
            self.bar.update(self.task, completed=done)
            self.live.update(self._view(state))
        elif elapsed >= QUIET and done * LINES >= (self.lines + 1) * self.total:
            self.lines = done * LINES // self.total
            self._print()

    def close(self) -> None:
        """Take the bar away and leave the last line; safe to call again."""
        if self.live is not None:
            self.live.stop()
            self.live = None
        self._print()

    def _print(self) -> None:
        if self.last != self.shown:
            self.shown = self.last
            print(self.last, file=self.stream, flush=True)


def summary(
    cycles: int,
    time: float,
    blocks: int,
    contacts: int,
    force: float,
    files: list[Path],
    wall: float,
    compiling: float = 0.0,
    solutions: Sequence[str] = (),
) -> str:
    """The line that ends every run.

    cycles: all of the run; time: in s; force: largest normal force of a contact in N/m; wall: wall time in s,
    `compiling` of it spent on compiling; solutions: sentences on the SOLVEs.
    """
    names = ", ".join(printable(path.name) for path in files[:NAMED_FILES])
    more = f" and {len(files) - NAMED_FILES} more" if len(files) > NAMED_FILES else ""
    written = f"wrote {names}{more}" if files else "no file written"
    compiled = f", {compiling:.1f} s of it compiling" if compiling >= SHOWN else ""
    solve = "".join(f"; {one}" for one in solutions)
    return (
        f"{counted(cycles, 'cycle')} (t = {time:.4g} s), {counted(blocks, 'block')}, "
        f"{counted(contacts, 'contact')}, largest normal force {force:.4g} N/m{solve}; {written}; "
        f"{wall:.1f} s{compiled}"
    )


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
