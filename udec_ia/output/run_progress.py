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
from udec_ia.kernels.drive.unbalanced_force import unbalanced_force
from udec_ia.layout import offsets as g
from udec_ia.ops.common.kernel_arguments import soft_or_loaded_in
from udec_ia.printable_text import counted, is_of_notebook, printable
from udec_ia.running.critical_step import fraction_in_words

if TYPE_CHECKING:
    from udec_ia.output.animation import Animation

LINES = 10  # plain lines for one CYCLE command, at most
REWRITTEN = 200  # times that the line of a notebook is written
QUIET = 2.0  # seconds that a command must have lasted before it says how far it is
SHOWN = 0.05  # seconds of compiling from which the summary reports them
NAMED_FILES = 4  # files that the summary names; of more, their number


class RunProgress:
    """Shows the progress of one CYCLE, which calls it now and then with the number of cycles done.

    memory: returns the memory of the model as it is now. total: cycles of the command. stream: where progress
    shows, or None: a bar if it is a terminal (in colour unless NO_COLOR is set), one line that is rewritten
    if it is the output of a notebook, else plain lines. animation: takes pictures, or None.
    """

    def __init__(
        self, memory: Callable[[], Memory], total: int, stream: TextIO | None, animation: Animation | None
    ) -> None:
        self.memory, self.total, self.stream, self.animation = memory, total, stream, animation
        self.before = int(memory().ci[g.MCTOT])
        self.started = working_time()
        self.shown = 0  # cycles done when progress was shown last
        self.lines = 0  # parts of the command for which a line was printed
        self.last = ""  # line on how far the command is
        self.printed = ""  # line that was printed last
        columns = BarColumn(None), MofNCompleteColumn(), TimeRemainingColumn()
        self.bar = Bar(*columns, expand=True, get_time=working_time)
        self.task = self.bar.add_task("cycles", total=total)
        self.live: Live | None = None

    def __call__(self, done: int) -> None:
        if self.animation is not None:
            self.animation.add(self.memory())
        if self.stream is not None:
            self._show(done, self.stream)

    def _show(self, done: int, stream: TextIO) -> None:
        state = self._state(done)
        self.shown, self.last = done, f"cycle {done} of {self.total}: {state}"
        if stream.isatty():
            if self.live is None:
                self.live = Live(console=Console(file=stream, highlight=False), transient=True)
                self.live.start()
            self.bar.update(self.task, completed=done, total=self.total)
            self.live.update(Group(self.bar, Text(state)))
        elif working_time() - self.started >= QUIET:
            times = REWRITTEN if is_of_notebook(stream) else LINES
            if done * times >= (self.lines + 1) * self.total:
                self.lines = done * times // self.total
                self._print(stream)

    def _state(self, done: int) -> str:
        """Speed, time, time-step, largest force sum of a free block, and contacts made and broken so far."""
        h, elapsed = self.memory(), working_time() - self.started
        rate = done / elapsed if elapsed > 0.0 else 0.0
        force = float(unbalanced_force(h, soft_or_loaded_in(h))[0])
        return (
            f"{rate:,.0f} cycles/s, t = {h.cd[g.TIME]:.4g} s, "
            f"dt {h.cr[g.TDEL]:.3g} s ({fraction_in_words(h)}), "
            f"unbalanced force {force:.3g} N/m, contacts +{h.ci[g.NMADE]} -{h.ci[g.NBROKE]}"
        )

    def _print(self, stream: TextIO) -> None:
        if self.last != self.printed:
            if is_of_notebook(stream):
                print("\r" + self.last.ljust(len(self.printed)), end="", file=stream, flush=True)
            else:
                print(self.last, file=stream, flush=True)
            self.printed = self.last

    def close(self) -> None:
        """Remove the bar and print the last line, also of a command that ended early; safe to call again.

        In a notebook a command that showed nothing yet leaves nothing: a loop may give thousands of them.
        """
        if self.stream is None:
            return
        done = int(self.memory().ci[g.MCTOT]) - self.before
        if done != self.shown:
            self._show(done, self.stream)
        if self.live is not None:
            self.live.stop()
            self.live = None
        if not is_of_notebook(self.stream):
            self._print(self.stream)
        elif self.lines:
            self._print(self.stream)
            print(file=self.stream)
            self.lines = 0


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
