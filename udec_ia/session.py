"""What goes with a model and is not in its array: name, folder, files, pictures, records, log, what is told.

The modules that draw, report and write files are loaded when they are first needed: a run without pictures
does not wait for matplotlib.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np

from udec_ia.compiling.compile_time import compile_seconds
from udec_ia.files import last_number
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.log import Log, Step
from udec_ia.ops.run.solution import in_short
from udec_ia.ops.run.watch import Series, Watch
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import Unsound
from udec_ia.recorder import Recorder

if TYPE_CHECKING:
    from udec_ia.output.animate import Animation
    from udec_ia.output.plot import Plots, What
    from udec_ia.output.report import Report

log = logging.getLogger("udec_ia")

NAME = "udec"  # what names of files begin with


class Session:
    """The base of Model, which explains out, name, tell and explain_step.

    progress: where CYCLE shows how far it is, None for nowhere. animate: whether it takes pictures. inform:
    takes what is good to know. logs_calls: False while a monitor logs, which knows the lines themselves.
    goes_on: from a restart file; pictures of the run before are left alone.
    """

    def __init__(self, out: str | Path, name: str) -> None:
        self.out = out
        self.name = name
        self.progress: TextIO | None = None
        self.animate = False
        self.tell: Callable[[str], None] = log.warning
        self.inform: Callable[[str], None] = log.info
        self.explain_step = False
        self.logs_calls = True
        self.goes_on = False
        self._log = Log()
        self._files: list[Path] = []
        self._recorder = Recorder()
        self._plots: Plots | None = None
        self._animation: Animation | None = None
        self._said: set[str] = set()  # remarks, which are not repeated
        self.around: Callable[[Watch | None], Watch | None] = lambda watch: watch  # for a debugger
        self._clock, self._compiled = perf_counter(), compile_seconds()

    @property
    def out(self) -> Path:
        """The folder for files; a str that it is set to becomes a path."""
        return self._out

    @out.setter
    def out(self, folder: str | Path) -> None:
        self._out = Path(folder)

    def parts(self) -> Iterator[object]:
        """The objects that hold what is not in the main array."""
        frame = None if self._plots is None else self._plots.frame
        held = self._log, self._recorder, self._plots, frame, self._animation
        for part in (self, *held, *self._recorder.series):
            if part is not None:
                yield part

    # ---- the log

    def log_call(self, method: Callable[..., object], args: Sequence[Any], named: dict[str, Any]) -> None:
        """Log what was done, to be said as a deck says it when somebody asks."""
        if self.logs_calls:
            self._log.add(method, args, named)

    def log_part(self, method: Callable[..., object], args: Sequence[Any], named: dict[str, Any]) -> None:
        """Log what stays of a run that has ended before its time, which no line of a deck says."""
        self._log.add(method, args, named)

    def log_lines(self, lines: Sequence[str | Step]) -> None:
        """Log what a deck says."""
        self._log.add_lines(lines)

    @property
    def deck_log(self) -> list[str]:
        """The lines of a deck that say what was done."""
        return self._log.lines

    def deck(self) -> str:
        """The deck that does what was done until now, in decks and in Python: all but SAVE and RESTART.

        What was given as `constitutive` is given with it again; of words that were written through `h` it
        says nothing. The deck of a model from a restart file begins as that of the model that was saved.
        """
        return "".join(line + "\n" for line in self.deck_log)

    # ---- what is told

    def warn(self, text: str) -> None:
        """Tell `text`."""
        self.tell(text)  # not bound beforehand: a monitor changes it

    def remark(
        self, remarks: Iterable[str], tell: Callable[[str], None] | None = None, what: str = ""
    ) -> None:
        """Tell `remarks`, each once, by `tell` if it is not a warning.

        what: what they are about, if their numbers change with every cycle; one such is told.
        """
        for text in remarks:
            if (what or text) not in self._said:
                self._said = self._said | {what or text}
                (tell or self.tell)(text)

    def summary_of(self, array: MainArray) -> str:
        """The line that sums up the run until now, of files that are written by now."""
        from udec_ia.output.progress import summary

        try:
            forces = table(array, "contact")["KCFN"]
        except Unsound:  # RSET has damaged the contact list, and the run ends all the same
            forces = np.zeros(0)
        h = array.h
        return summary(
            int(h.ci[g.MCTOT]),
            float(h.cd[g.TIME]),
            int(h.ci[g.NBLK]),
            int(h.ci[g.NCON]),
            float(forces.max(initial=0)),
            self._files,
            perf_counter() - self._clock,
            compile_seconds() - self._compiled,
            in_short(self._recorder.solutions),
        )

    # ---- files

    def begin(self) -> None:
        """A cold start: nothing is recorded yet, and all remarks may be made."""
        self._recorder.series, self._recorder.solutions = [], []
        self._said, self.goes_on = set(), False

    def go_on(self, lines: Sequence[str], series: list[Series]) -> None:
        """A restart file is read, of a run that has logged `lines` and recorded `series`."""
        self._log, self._recorder.series, self.goes_on = Log(lines), series, True
        if self._plots is not None:
            self._plots.count = max(self._plots.count, self.last_picture("-plot"))

    def note(self, files: Iterable[Path]) -> None:
        """Have STOP name `files`, each once."""
        self._files += [path for path in files if path not in self._files]

    def last_picture(self, kind: str) -> int:
        """The last number of a picture to be left alone: of the run that this one goes on from, or 0."""
        return last_number(self.out, self.name + kind) if self.goes_on else 0

    def keep(self, watch: Watch | None) -> None:
        """Write what was recorded."""
        self.note(self._recorder.keep(watch, self.out / f"{self.name}-history", self.tell))

    def report(self, array: MainArray, n: int) -> Report:
        """What shows how far `n` cycles are, and takes pictures of them if that is asked for."""
        from udec_ia.output.report import Report

        if self.animate and self._animation is None:
            from udec_ia.output.animate import Animation

            self._animation = Animation(self.name)
        return Report(lambda: array.h, n, self.progress, self._animation)

    def renumber(self, moved: Any) -> None:
        """Groups have new addresses: those of the frame that is open follow them."""
        if self._plots is not None:
            self._plots.renumber(moved)

    def draw(self, array: MainArray, n: int, what: What) -> list[Path]:
        """Start a frame (0) or draw over the last one (1); the files written."""
        from udec_ia.output.plot import Plots

        if self._plots is None:
            self._plots = Plots(self.out, self.name, self.last_picture("-plot"))
        files = self._plots.draw(array.h, n, what)
        for remark in self._plots.remarks(array.h, what):
            self.inform(remark)
        self.note(self._plots.files)
        return files

    def draw_histories(self) -> list[Path]:
        """Draw what was recorded. Error 26 if nothing was."""
        files = self._recorder.plot(self.name, self.out, self.last_picture("-history"))
        self.note(files)
        return files

    def close(self, array: MainArray) -> None:
        """Write what is still open."""
        if self._plots is not None:
            self.note(self._plots.close())
        if self._animation is not None:
            path = self.out / f"{self.name}.gif"
            if self.goes_on and path.exists():
                path = self.out / f"{self.name}-{max(self.last_picture(''), 1) + 1}.gif"
            self.note([self._animation.save(path, array.h)])
            self._animation = None
        self._recorder.close()
