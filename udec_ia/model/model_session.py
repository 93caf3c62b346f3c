"""The session of a model: its array, and everything that belongs to the model but is not in the array.

That is: laws, log, histories, pictures, files, warnings, the undo copy, and what has been proved of the
array. The modules that draw, report and write files are imported when they are first needed: a run without
pictures does not wait for matplotlib.
"""

from __future__ import annotations

import operator
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, SupportsIndex, TextIO

import numpy as np

from udec_ia.advice.run_monitors import RunMonitors
from udec_ia.checker import check, check_shapes
from udec_ia.compiling.compile_duration import compile_seconds
from udec_ia.compiling.second_compiler import compile_ahead
from udec_ia.errors import UdecError
from udec_ia.file_replacement import last_number
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.heap.write_tracking import Writes, track
from udec_ia.interrupt_signals import defer_signals
from udec_ia.layout import offsets as g
from udec_ia.model.command_log import CommandLog, Step
from udec_ia.model.history_recorder import HistoryRecorder
from udec_ia.model.undo import Undo
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.history_definitions import definitions
from udec_ia.ops.commands.split_blocks import Boxes
from udec_ia.ops.laws.law_file import Given
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.printable_text import counted, is_of_notebook
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import Unsound
from udec_ia.remark import Remark, give_warning, log
from udec_ia.running.cycle_observer import Observer
from udec_ia.running.history_series import Recording, Series
from udec_ia.running.solve_result import in_short

if TYPE_CHECKING:
    from udec_ia.output.animation import Animation
    from udec_ia.output.history_graph import Wanted
    from udec_ia.output.plot_frames import Plots, StoredStage, What
    from udec_ia.output.run_progress import RunProgress

NAME = "udec"  # names of files begin with this
GIVEN_ONCE = ("coarse-reals",)  # keys of remarks whose numbers change with every cycle
NOT_COPIED = (
    "progress",
    "tell",
    "inform",
    "observers",
    "undo",
    "writes",
    "_tracked",
    "_start",
    "_compiled",
)


class Session:
    """The session of one Model, which explains the arguments.

    array: the main array. laws: the user's laws. started: START or RESTART was given. undo: undoes commands.
    written: words were written by RSET or through `h` since the state was last proved. unproved: the state
    comes from a restart file, and not all of it was proved. split_boxes: block boxes between SPLITs.
    monitors: watch runs from one CYCLE to the next. recorder: histories and SOLVE results. log: commands.
    progress, animate, tell, inform, explain_step: see Model. observers: of all runs, for a debugger
    or a study. logs_calls: False while a monitor logs the lines of its deck. continued: the state is from a
    restart file, and pictures of the run before it stay. pictures_wait: a deck is being read, and a picture
    is written at most every few seconds. plots: frames of PLOT. files: those that STOP names.
    addresses_since: for each stage new addresses of groups by old ones, or None if they are the same.
    """

    def __init__(
        self,
        build: str = DEFAULT_SCHEME,
        mtop: SupportsIndex | None = None,
        out: str | Path = ".",
        constitutive: Given | Iterable[Given] | None = None,
        name: str = NAME,
    ) -> None:
        self.out = out
        self.name = name
        self.mtop = None if mtop is None else _checked_size(mtop)
        self.scheme = scheme(build)
        compile_ahead(build)
        self.array = MainArray(self.scheme, self.mtop)
        self.laws = LawBook(constitutive)
        self.started = self.written = self.unproved = self.continued = False
        self.explain_step = self.animate = False
        self.safety_pictures = 0
        self.logs_calls = True
        self.split_boxes = Boxes()
        self.monitors = RunMonitors(self.laws, self.warn)
        self.log = CommandLog()
        self.recorder = HistoryRecorder()
        self.files: list[Path] = []
        self.plots: Plots | None = None
        self.pictures_wait = False
        self.addresses_since: dict[str, Any] = {}
        self.animation: Animation | None = None
        self._remarks: set[str] = set()  # which are not repeated
        self._set_process()
        model_settings.set_fraction(self.array, model_settings.DEFAULT_FRACTION)

    def _set_process(self) -> None:
        """Set what belongs to this process: functions for messages, undo copy, start time."""
        self.progress: TextIO | None = sys.stdout if is_of_notebook(sys.stdout) else None
        self.tell: Callable[[str], None] = give_warning
        self.inform: Callable[[str], None] = log.info
        self.observers: Sequence[Observer] = ()
        self.undo = Undo()
        self.writes = Writes()
        self._tracked: tuple[Memory, Memory] | None = None  # memory of IA(), and its tracked arrays
        self._start, self._compiled = perf_counter(), compile_seconds()

    def __getstate__(self) -> dict[str, Any]:
        """For pickle and copy: all but what belongs to this process."""
        if self.writes.pending:
            self.note_writes()
        return {name: value for name, value in vars(self).items() if name not in NOT_COPIED}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._set_process()
        vars(self).update(state)

    @property
    def out(self) -> Path:
        """The folder for files; a str becomes a path."""
        return self._out

    @out.setter
    def out(self, folder: str | Path) -> None:
        self._out = Path(folder)

    @property
    def h(self) -> Memory:
        """The memory of the array as tracked arrays: assignments to them are recorded."""
        if self._tracked is None or self._tracked[0] is not self.array.h:
            self._tracked = self.array.h, track(self.array.h, self.writes)
        return self._tracked[1]

    def parts(self) -> Iterator[object]:
        """The objects that hold what is not in the main array."""
        frame = None if self.plots is None else self.plots.frame
        parts = self, self.log, self.recorder, self.plots, frame, self.animation, self.laws
        for part in (*parts, *self.recorder.series, self.monitors, self.monitors.energy):
            if part is not None:
                yield part

    # ---- the array, and what is proved of it

    def start(self) -> None:
        """START: a cold start; everything before it is discarded."""
        self.array = MainArray(self.scheme, self.mtop)
        model_settings.set_fraction(self.array, model_settings.DEFAULT_FRACTION)
        self.laws.note({})
        self.recorder.series, self.recorder.solutions, self.recorder.safety = [], [], []
        self._remarks, self.continued, self.addresses_since = set(), False, {}
        self.replace_state(written=False, unproved=False)
        self.started = True

    def replace_state(self, *, written: bool, unproved: bool) -> None:
        """Forget all facts about the former state: the array is another one."""
        self.forget_boxes()
        self.written, self.unproved = written, unproved
        self.monitors = RunMonitors(self.laws, self.warn)
        if self.plots is not None:
            self.plots.origin = None

    def return_to(self, array: MainArray, lines: Sequence[str]) -> None:
        """Continue from a former state of this run, reached by `lines`; everything later is forgotten."""
        with defer_signals():
            self.undo.release()
            self.array = array
            series = self.recorder.series[: len(definitions(array))]
            for one in series:
                one.truncate_after(int(array.h.ci[g.MCTOT]))
            self.continue_from(lines, series)
            self.replace_state(written=False, unproved=True)

    def continue_from(self, lines: Sequence[str], series: list[Series]) -> None:
        """Continue a run that has logged `lines` and recorded `series`."""
        self.log, self.continued = CommandLog(lines), True
        self.recorder.replace(series)
        if self.plots is not None:
            self.plots.count = max(self.plots.count, self._last_picture("-plot"))

    def note_writes(self) -> None:
        """Record that words were written through `h`: commands that follow them prove them first."""
        self.array.h.ci[g.LREADY] = 0
        self.forget_boxes()
        self.undo.release()  # repeated commands would not give these words
        self.written = True

    def forget_boxes(self) -> None:
        """Forget the boxes of SPLIT: blocks may have moved."""
        self.split_boxes.forget()

    def ensure_ready(self, sound: bool = True, shapes: bool = False) -> None:
        """Start a model that was not started; with `sound`, prove the heap first if it has been written to.

        A routine that follows pointers must never meet one that RSET or Python has damaged, nor one that cuts
        or loads outlines (`shapes`) one of a restart file that crosses itself: error 20.
        """
        if not self.started:
            self.start()
            self.log_lines(["START"])
        if self.writes.pending:  # by the function that runs as one command; these writes are not undone
            self.note_writes()
        if (sound and self.written) or (shapes and self.unproved):
            self.prove()

    def is_sound(self) -> bool:
        """True if routines may follow the lists of the heap; proved, if words have been written to."""
        try:
            self.ensure_ready()
        except UdecError:
            return False
        return True

    def prove(self) -> None:
        """Error 20 with the first violation of links, numbers, outlines, or the use of memory.

        All of a state from a file is proved, as RESTART does, unless an error has ended a run of it.
        """
        proof = check if self.unproved and not self.array.h.ci[g.NSPOIL] else check_shapes
        for broken in proof(self.array):
            raise UdecError(20, str(broken), "undo the change, or RESTART from a sound file")
        self.written = self.unproved = False

    def prove_before_save(self) -> None:
        """Error 20 unless the state is sound, as far as it was written to or not yet proved."""
        if self.written or (self.unproved and not self.array.h.ci[g.NSPOIL]):
            self.prove()

    # ---- the log

    def log_call(self, method: Callable[..., object], args: Sequence[Any], named: dict[str, Any]) -> None:
        """Log what was done, to be written as a deck on request."""
        if self.logs_calls:
            self.log.add(method, args, named)

    def log_lines(self, lines: Sequence[str | Step]) -> None:
        """Log the lines of a deck."""
        self.log.add_lines(lines)

    # ---- warnings and information

    def warn(self, text: str) -> None:
        """Report `text` as a warning."""
        self.tell(text)  # not bound beforehand: a monitor changes it

    def report_lost_structures(self, lost: int) -> None:
        """Tell that so many bolts and elements were given back with the blocks at their ends."""
        if lost > 0:
            text = (
                f"{counted(lost, 'structure', ',')} removed: the bolt or element has lost the block at an end"
            )
            self.tell(Remark("structures-removed", text))

    def report_remarks(self, remarks: Iterable[Remark], tell: Callable[[str], None] | None = None) -> None:
        """Report `remarks`, each once, by `tell` if they are not warnings.

        Of those whose numbers change with every cycle one is reported.
        """
        for one in remarks:
            mark = one.key if one.key in GIVEN_ONCE else one
            if mark not in self._remarks:
                self._remarks = self._remarks | {mark}
                (tell or self.tell)(one)

    def mark_as_reported(self, remark: Remark) -> None:
        """Do not report `remark`, which was reported elsewhere."""
        self._remarks = self._remarks | {remark}

    def summary(self) -> str:
        """The line that sums up the run until now, of files that are written by now."""
        from udec_ia.output.run_progress import summary

        try:
            forces = table(self.array, "contact")["KCFN"]
        except Unsound:  # RSET has damaged the contact list, and the run ends all the same
            forces = np.zeros(0)
        h = self.array.h
        return summary(
            int(h.ci[g.MCTOT]),
            float(h.cd[g.TIME]),
            int(h.ci[g.NBLK]),
            int(h.ci[g.NCON]),
            float(forces.max(initial=0)),
            self.files,
            perf_counter() - self._start,
            compile_seconds() - self._compiled,
            in_short(self.recorder.solutions),
        )

    # ---- files

    def add_files(self, files: Iterable[Path]) -> None:
        """Have STOP name `files`, each once."""
        self.files += [path for path in files if path not in self.files]

    def _last_picture(self, kind: str) -> int:
        """The last number of a picture of the run that this one continues, or 0."""
        return last_number(self.out, self.name + kind) if self.continued else 0

    def write_histories(self, recording: Recording) -> None:
        """Write the files of the histories."""
        self.add_files(self.recorder.write(recording, self.out / f"{self.name}-history", self.tell))

    def run_progress(self, n: int) -> RunProgress:
        """Shows the progress of `n` cycles, and takes pictures of them on request."""
        from udec_ia.output.run_progress import RunProgress

        if self.animate and self.animation is None:
            from udec_ia.output.animation import Animation

            self.animation = Animation(self.name)
        return RunProgress(lambda: self.array.h, n, self.progress, self.animation)

    def renumber(self, moved: Any) -> None:
        """Give the open frame, the stages of this run and the observers the new addresses of groups."""
        self.forget_boxes()
        self.monitors.chatter.forget()
        for one in self.observers:
            one.renumber(moved)
        if self.plots is not None:
            self.plots.renumber(moved)
        self.addresses_since = {
            stage: moved if before is None else moved[before]
            for stage, before in self.addresses_since.items()
        }

    def draw(self, n: int, what: What, stage: StoredStage | None = None) -> list[Path]:
        """Start a frame (0), with a stage below the present state, or draw over it (1); the files written."""
        plots, h = self._all_plots(), self.array.h
        plots.waits = self.pictures_wait
        files = plots.draw(h, n, what, stage)
        for remark in plots.remarks(h, what):
            self.inform(remark)
        self.add_files(plots.files)
        return files

    def _all_plots(self) -> Plots:
        from udec_ia.output.plot_frames import Plots

        if self.plots is None:
            self.plots = Plots(self.out, self.name, self._last_picture("-plot"))
        return self.plots

    def reset_displacements(self) -> None:
        """Measure the displacements of plots from the present state."""
        self._all_plots().reset_displacements(self.array.h)

    def draw_histories(self, wanted: Wanted) -> list[Path]:
        """Draw histories. Error 26 if nothing was recorded, and those of history_graph.curves_of."""
        files = self.recorder.plot(self.name, self.out, wanted, self._last_picture("-history"))
        self.add_files(files)
        return files

    def write_rest_of_pictures(self) -> list[Path]:
        """Write the open frame if its files are not up to date; the files written."""
        return [] if self.plots is None else self.plots.write_rest()

    def close_files(self) -> None:
        """Write the open frame and the animation."""
        if self.plots is not None:
            self.add_files(self.plots.close())
        if self.animation is not None:
            path = self.out / f"{self.name}.gif"
            if self.continued and path.exists():
                path = self.out / f"{self.name}-{max(self._last_picture(''), 1) + 1}.gif"
            self.add_files([self.animation.save(path, self.array.h)])
            self.animation = None


def _checked_size(mtop: SupportsIndex) -> int:
    """`mtop` as an integer; TypeError if it is not one."""
    try:
        return operator.index(mtop)
    except TypeError:
        raise TypeError(f"mtop is a number of words, an integer, not {mtop!r}") from None
