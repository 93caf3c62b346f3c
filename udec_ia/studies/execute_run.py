"""Executes one run of a study, on a new model and in a folder of its own; measures its time and memory.

Nothing that it writes names the place where it was executed.
"""

from __future__ import annotations

import logging
import os
import shutil
import tempfile
import threading
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from pathlib import Path
from time import monotonic, perf_counter, thread_time
from typing import TextIO

from udec_ia.compiling.compile_time import compile_seconds
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.deck_variables import Variables
from udec_ia.errors import UdecError
from udec_ia.running.solve_result import in_short, worth_reporting
from udec_ia.studies.observer import ModelWithWarnings, StudyObserver
from udec_ia.studies.quantity_syntax import read_quantities
from udec_ia.studies.run_folder import BEGUN, incomplete, new_folder, publish
from udec_ia.studies.study_run import DECK, DIED, ENDED, ERROR, RunResult, StudyRun, write_result

LOG = "log.txt"
NOT_OF_DECK = (23, 31)  # a package is missing, a file cannot be written
STATUS, CLEAR = Path("/proc/self/status"), Path("/proc/self/clear_refs")
PEAK = "5"  # written to CLEAR to measure the peak memory anew (Linux, proc(5))
log = logging.getLogger("udec_ia")


class _Process:
    """State of this process. run: held during a run, whatever threads there are. warm: it has done one."""

    def __init__(self) -> None:
        self.run = threading.Lock()
        self.warm = False


_process = _Process()


def execute(run: StudyRun, folder: Path, timed: bool = False) -> RunResult:
    """Execute `run` in its folder in `folder`; an earlier folder of the program is replaced.

    timed: in a process that has executed no run yet it is rehearsed first, so that its seconds are those of
    the run and not of loading the program. Errors of the run are part of its result. OSError if nothing can
    be written, error 31 if something that is not of the program is in the place.
    """
    if timed and not _process.warm:
        rehearse(run)
    with _process.run:
        here = new_folder(folder, run.name)
        try:
            (here / BEGUN).touch()
            result = _result(run, here)
            write_result(result, here)
            publish(here, folder / run.name)
            _process.warm = True
        except BaseException:
            shutil.rmtree(here, ignore_errors=True)
            raise
    return result


def rehearse(run: StudyRun) -> None:
    """Execute `run` with one cycle for each CYCLE or SOLVE, to compile its kernels; the result is dropped."""
    with _process.run, tempfile.TemporaryDirectory() as folder:
        _result(run, Path(folder), rehearsal=True)
    _process.warm = True


def record_death(run: StudyRun, folder: Path) -> RunResult:
    """Write the result of a run whose process has died into its folder in `folder`."""
    result = RunResult(
        run.name,
        dict(run.values),
        DIED,
        message="its process died, perhaps because memory ran out",
        quantities=_no_values(run),
        made_of=run.made_of,
        limit=run.limit,
        of_system=True,
    )
    left = incomplete(run.name, folder)
    here = left[0] if left else new_folder(folder, run.name)
    write_result(result, here)
    (here / BEGUN).touch()
    publish(here, folder / run.name)
    return result


def _no_values(run: StudyRun) -> dict[str, float]:
    return dict.fromkeys((one.name for one in read_quantities(run.quantities)), float("nan"))


def _result(run: StudyRun, here: Path, rehearsal: bool = False) -> RunResult:
    """The result of `run`, whose files go to the folder `here`."""
    clock, observer, at_rest = perf_counter(), None, True
    status, error, message, of_system = ENDED, 0, "", False
    warnings: list[str] = []
    found, remarks = _no_values(run), list[str]()
    _restart_peak_memory()
    with _Log(here) as out, _logging_to(out):
        (here / DECK).write_text(_deck_with_values(run), encoding="utf-8")
        try:
            name = Path(run.file or DECK).stem
            laws = run.constitutive or None
            model = ModelWithWarnings(warnings.append, run.build, out=here, constitutive=laws, name=name)
            observer = StudyObserver(run, model, CpuTime(), rehearsal)
            observer.obey(out)
            solutions = model.solutions()
            status, message = observer.over or ENDED, observer.why or "; ".join(in_short(solutions))
            at_rest = all(one.reached for one in worth_reporting(solutions))
            found, remarks = observer.quantities()
        except UdecError as failure:
            print(failure, file=out)
            status, error, message = ERROR, failure.number, str(failure).partition("\n")[0]
            of_system = error in NOT_OF_DECK or isinstance(failure.__cause__, OSError | MemoryError)
        except Exception as failure:  # of the system, or a fault of the program: it ends this run only
            traceback.print_exc(file=out)
            status, message, of_system = ERROR, f"{type(failure).__name__}: {failure}", True
        print(*(f"{remark}\n" for remark in remarks), sep="", end="", file=out)
    cycles, time, words = observer.size if observer else (0, 0.0, 0)
    return RunResult(
        run.name,
        dict(run.values),
        status,
        error,
        out.without_folder(message),
        found,
        tuple(remarks),
        cycles,
        time,
        words,
        seconds=observer.seconds if observer else 0.0,
        wall_seconds=perf_counter() - clock,
        peak_memory=_peak_memory(),
        made_of=run.made_of,
        limit=run.limit,
        warnings=tuple(dict.fromkeys(map(out.without_folder, warnings))),
        of_system=of_system,
        at_rest=at_rest,
    )


def _deck_with_values(run: StudyRun) -> str:
    """The deck with the values of the run, if they are complete."""
    with suppress(UdecError):
        filled = Variables(run.values).filled(statements(run.deck.splitlines(), run.file))
        return "".join(f"{line.text}\n" for statement in filled for line in statement.lines)
    return run.deck


class _Log(TextIOWrapper):
    """The file for what a run prints, in the folder `here`, without the name of that folder."""

    def __init__(self, here: Path) -> None:
        super().__init__((here / LOG).open("wb"), encoding="utf-8", errors="replace")
        self._prefix = str(here) + os.sep

    def without_folder(self, text: str) -> str:
        """`text` without the name of the folder."""
        return text.replace(self._prefix, "")

    def write(self, text: str) -> int:
        """As of any text file."""
        return super().write(self.without_folder(text))


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


# ---- time and memory


class CpuTime:
    """Processor time of a thread since now, without the time that compiling kernels takes.

    Of compiling only the time by the clock is known. On a busy machine a process does not have the processor
    all of that time: where something was compiled it counts with the same share of the processor as the rest.
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


def _restart_peak_memory() -> None:
    """Measure the peak memory anew, where the system can do that."""
    with suppress(OSError):
        CLEAR.write_text(PEAK)


def _peak_memory() -> int:
    """The greatest memory of the process since then, or since it began (bytes); 0 if unknown."""
    with suppress(OSError, ValueError, IndexError):
        for line in STATUS.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    try:
        import resource
    except ImportError:
        return 0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
