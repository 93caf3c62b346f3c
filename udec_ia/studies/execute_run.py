"""Executes one run of a study, on a new model and in a folder of its own; measures its processor time."""

from __future__ import annotations

import logging
import os
import shutil
import tempfile
import threading
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from time import monotonic, thread_time
from typing import Any, TextIO

from udec_ia.compiling.compile_duration import compile_seconds
from udec_ia.deck.command_monitor import Monitor
from udec_ia.deck.deck_statements import Statement, statements
from udec_ia.deck.deck_variables import Variables
from udec_ia.deck.lines_and_calls import command_of
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.model import Model
from udec_ia.running.cycle_observer import Observer, between_cycles
from udec_ia.running.solve_result import in_short, worth_reporting
from udec_ia.studies.quantities import InitialState, NoValue, State, read_quantities, read_rule
from udec_ia.studies.run_folder import incomplete, new_folder, publish
from udec_ia.studies.study_run import DIED, ENDED, ERROR, LATE, STOPPED, RunResult, StudyRun, write_result

DECK, LOG = "deck.dat", "log.txt"  # in the folder of a run
NOT_OF_DECK = (23, 31)  # a package is missing, a file cannot be written
log = logging.getLogger("udec_ia")
_run_lock = threading.Lock()  # held during a run, however many threads the process has
_warm: set[str] = set()  # word schemes of the runs that this process has done


def execute(run: StudyRun, folder: Path, timed: bool = False) -> RunResult:
    """Execute `run` in its folder in `folder`; an earlier folder of the program is replaced.

    timed: a run that is the first of its word scheme in this process is rehearsed before, so that its seconds
    are those of the run and not of loading the program. Errors of the run are part of its result. OSError if
    nothing can be written, error 31 if something that is not of the program is in the place.
    """
    if timed and run.build not in _warm:
        rehearse(run)
    with _run_lock:
        here = new_folder(folder, run.name)
        try:
            result = _result(run, here)
            write_result(result, here)
            publish(here, folder / run.name)
        except BaseException:
            shutil.rmtree(here, ignore_errors=True)
            raise
    _warm.add(run.build)
    return result


def rehearse(run: StudyRun) -> None:
    """Execute one cycle of each CYCLE and SOLVE, to compile the kernels; the result is dropped."""
    with _run_lock, tempfile.TemporaryDirectory() as folder:
        _result(replace(run, rehearsal=True), Path(folder))
    _warm.add(run.build)


def record_death(run: StudyRun, folder: Path) -> RunResult:
    """Write the result of a run whose process has died into its folder in `folder`."""
    message = "its process died, perhaps because memory ran out"
    result = replace(_no_result(run), status=DIED, message=message, of_system=True)
    left = incomplete(run.name, folder)
    here = left[0] if left else new_folder(folder, run.name)
    write_result(result, here)
    publish(here, folder / run.name)
    return result


def _no_result(run: StudyRun) -> RunResult:
    """The result of a run without cycles and quantities."""
    values = dict.fromkeys(read_quantities(run.quantities), float("nan"))
    return RunResult(
        run.name, dict(run.values), ENDED, quantities=values, made_of=run.made_of, limit=run.limit
    )


def _result(run: StudyRun, here: Path) -> RunResult:
    """The result of `run`, whose files go to the folder `here`."""
    observer, result = None, _no_result(run)
    with (here / LOG).open("w", encoding="utf-8", errors="replace") as out, _logging_to(out):
        (here / DECK).write_text(_deck_with_values(run), encoding="utf-8")
        try:
            name, laws = Path(run.file or DECK).stem, run.constitutive or None
            observer = StudyObserver(run, Model(run.build, out=here, constitutive=laws, name=name))
            observer.execute(out)
            result = observer.result(result)
        except UdecError as failure:
            print(failure, file=out)
            of_system = failure.number in NOT_OF_DECK or isinstance(failure.__cause__, OSError | MemoryError)
            message = str(failure).partition("\n")[0]
            result = replace(result, status=ERROR, error=failure.number, message=message, of_system=of_system)
        except Exception as failure:  # of the system, or a fault of the program: it ends this run only
            traceback.print_exc(file=out)
            message = f"{type(failure).__name__}: {failure}"
            result = replace(result, status=ERROR, message=message, of_system=True)
        print(*(f"{remark}\n" for remark in result.remarks), sep="", end="", file=out)
    if observer is not None:
        h = observer.model.array.h
        result = replace(
            result,
            cycles=int(h.ci[g.MCTOT]),
            time=float(h.cd[g.TIME]),
            words=int(h.ci[g.MFREE]) - 1,
            seconds=observer.clock.seconds,
            warnings=tuple(dict.fromkeys(observer.warnings)),
        )
    return _without_folder(result, here)


def _without_folder(result: RunResult, here: Path) -> RunResult:
    """The same without the name of the folder `here`; also the log."""
    name, file = str(here) + os.sep, here / LOG
    file.write_text(file.read_text(encoding="utf-8").replace(name, ""), encoding="utf-8")
    warnings = tuple(text.replace(name, "") for text in result.warnings)
    return replace(result, message=result.message.replace(name, ""), warnings=warnings)


def _deck_with_values(run: StudyRun) -> str:
    """The deck with the values of the run, if they are complete."""
    with suppress(UdecError):
        filled = Variables(run.values).filled(statements(run.deck.splitlines(), run.file))
        return "".join(f"{line.text}\n" for statement in filled for line in statement.lines)
    return run.deck


@contextmanager
def _logging_to(out: TextIO) -> Iterator[None]:
    """The log of the program goes to `out`, and nowhere else."""
    handler = logging.StreamHandler(out)
    propagated, log.propagate = log.propagate, False
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.propagate = propagated


class CpuTime:
    """Processor time of a thread since now, without the time that compiling kernels takes.

    Of compiling only the time by the clock is known: it counts with the share of the processor of the rest.
    """

    def __init__(self) -> None:
        self._seconds = 0.0
        self._last = self._now()

    @property
    def seconds(self) -> float:
        """Seconds until now. It is the more exact the more often it is read."""
        now = self._now()
        spent, passed, compiled = (new - old for new, old in zip(now, self._last, strict=True))
        self._last = now
        self._seconds += spent * max(1 - compiled / passed, 0.0) if compiled > 0 else spent
        return self._seconds

    def _now(self) -> tuple[float, float, float]:
        return thread_time(), monotonic(), compile_seconds()


class RunObserver(Observer):
    """An observer of cycles that is called between commands as well."""

    def after_command(self, array: MainArray) -> None:
        """A command was executed."""


class StudyObserver(RunObserver):
    """Observes `run`, which is executed on `model`: initial places, rules to stop, quantities.

    over: status with which the run is to end, "" to go on; why: in words. clock: its processor time.
    """

    def __init__(self, run: StudyRun, model: Model) -> None:
        self.run, self.model, self.clock = run, model, CpuTime()
        self.over = self.why = ""
        self.warnings: list[str] = []
        self._quantities, self._rules = read_quantities(run.quantities), [*map(read_rule, run.stop)]
        asked = [*self._quantities.values(), *(rule.quantity for rule in self._rules)]
        self._start = InitialState(frozenset(one.place for one in asked if one.place is not None))
        self._done = 0  # cycles of this CYCLE or SOLVE
        self._others: list[RunObserver] = run.observers(model)

    def execute(self, out: TextIO) -> None:
        """Execute the deck of the run, whose output goes to `out`."""
        name, text = self.run.file or DECK, self.run.deck
        monitor = _Monitor(self, out)
        monitor.variables.check(text.splitlines(), name)
        self.model.session.observers = (*self._others, self)
        monitor.run(text.splitlines(), name)
        monitor.stop()

    def result(self, empty: RunResult) -> RunResult:
        """The result of the run, which has ended: quantities, NaN for those without a value, and why."""
        found, remarks, state = dict[str, float](), list[str](), self._state()
        for name, quantity in self._quantities.items():
            try:
                found[name] = quantity.value(state)
            except (NoValue, UdecError) as reason:
                found[name] = float("nan")
                why = reason.detail if isinstance(reason, UdecError) else reason
                remarks.append(f"{name} has no value: {why}")
        return replace(
            empty,
            status=self.over or ENDED,
            message=self.why or "; ".join(in_short(state.solutions)),
            quantities=found,
            remarks=tuple(remarks),
            at_rest=all(one.reached for one in worth_reporting(state.solutions)),
        )

    def after_command(self, array: MainArray) -> None:
        """Drop deleted groups from the initial state, and call the other observers."""
        self._start.look(array)
        for one in self._others:
            one.after_command(array)

    def is_ended(self) -> bool:
        """True if the run is to end: a rule holds, or the time is up."""
        if self.run.limit is not None and self.clock.seconds > self.run.limit and not self.over:
            self.over, self.why = LATE, f"after {self.run.limit:g} s"
        return bool(self.over)

    def begin(self, array: MainArray, solves: bool) -> None:
        """Begin to count cycles, and save the initial state before the first run."""
        self._done = 0
        self._start.begin(array)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the next check of the rules."""
        if self.run.rehearsal:
            return min(n, 1)
        every = self.run.every
        return min(n, every - int(array.h.ci[g.MCTOT]) % every) if self._rules else n

    def look(self, array: MainArray, cycles: int) -> None:
        """Check the rules when they are due."""
        self._done += cycles
        if not (self._rules and between_cycles(array.h) and array.h.ci[g.MCTOT] % self.run.every == 0):
            return
        for rule in self._rules:
            with suppress(NoValue, UdecError):  # a quantity without a value
                if rule.holds(self._state()) and not self.over:
                    self.over, self.why = STOPPED, rule.text

    def renumber(self, moved: Any) -> None:
        """Follow the groups of the initial state to their new addresses."""
        self._start.renumber(moved)

    def is_over(self) -> bool:
        """True if the run is to end: a rule holds, or the time is up; or if the rehearsed cycle is done."""
        return self.is_ended() or (self.run.rehearsal and self._done > 0)

    def _state(self) -> State:
        recorder = self.model.session.recorder
        return State(
            self.model.array, self._start, self.model.histories(), self.model.solutions(), recorder.safety
        )


class _Monitor(Monitor):
    """Reports every command and warning to the observer, and ends when the observer does."""

    def __init__(self, observer: StudyObserver, out: TextIO) -> None:
        super().__init__(observer.model, out, values=observer.run.values)
        self._observer = observer

    def warn(self, command: str, text: str) -> None:
        """As Monitor.warn."""
        self._observer.warnings.append(text)
        super().warn(command, text)

    def execute(self, statement: Statement) -> None:
        """As Monitor.execute, but nothing that takes long is begun when the time is up."""
        command = command_of(statement)
        if statement.tokens and (command is None or command.is_work):
            self.ended = self._observer.is_ended()
        if self.ended:
            return
        super().execute(statement)
        self._observer.after_command(self._observer.model.array)
        if self._observer.over:
            self.ended = True
