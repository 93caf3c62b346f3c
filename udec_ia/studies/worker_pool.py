"""Many runs: in this process, in worker processes (joblib's loky), or on workers of dask.distributed.

A run with a kept result of the same input is not repeated. A run whose process has died is tried once more,
alone; if it dies again, that is its result. Kernels are compiled before the runs begin, by a rehearsal.
"""

from __future__ import annotations

import os
import signal
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from pathlib import Path
from queue import Empty
from time import sleep
from typing import Any, TextIO
from urllib.parse import urlsplit

from udec_ia.deck.deck_statements import at
from udec_ia.errors import UdecError
from udec_ia.printable_text import MESSAGE, counted, printable
from udec_ia.studies.execute_run import execute, record_death, rehearse
from udec_ia.studies.run_folder import check_replaceable, clear, incomplete, lock_folder
from udec_ia.studies.study_run import RunResult, StudyRun, kept_result

RUNS = "runs"  # folder of the folders of runs
KEPT = "kept"
CHECKED = 1.0  # seconds between two checks whether the study still lives
CONNECT = 30  # seconds to wait for a scheduler
SCHEMES = ("", "tcp", "tls", "ucx", "ws", "wss")  # of its address
PRINTED = "give the address that the scheduler prints when it starts, as in tcp://10.0.0.1:8786"
Report = Callable[[RunResult, str], None]


class WorkerPool:
    """Executes runs in folders of `folder`/runs, which no other study can use until the end of `with`.

    jobs: processes, by default one for each processor; 0 executes one after the other in this process.
    dask: address of a scheduler; `folder` must be one that its workers have as well. timed: the seconds of
    results are to be compared, so each process rehearses its first run. Raises ValueError for wrong jobs and
    addresses; UdecError 31 if the folder cannot be written or another study uses it.
    """

    def __init__(
        self, folder: str | Path, *, jobs: int | None = None, dask: str = "", timed: bool = False
    ) -> None:
        if jobs is not None and jobs < 0:
            raise ValueError(f"{jobs} jobs: give 1 or more, or 0 for this process")
        if dask:
            _check_address(dask)
        self.folder = Path(folder).absolute() / RUNS
        self.jobs = (os.cpu_count() or 1) if jobs is None else jobs
        self._dask, self._timed = dask, timed
        self._executor: Any = None
        self._compiled: set[str] = set()  # word schemes whose kernels have been compiled
        self._lock = lock_folder(self.folder)

    def __enter__(self) -> WorkerPool:
        self._lock.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        self._end_processes()
        self._lock.__exit__(None, None, None)

    def results(self, runs: Sequence[StudyRun], report: Report = lambda result, why: None) -> list[RunResult]:
        """The results of `runs`, in the same order.

        report: takes each result as it comes, and where it comes from: "" if it is new, "kept", or what has
        changed since a kept one was made. ValueError if two runs have one name; UdecError 31, before any run,
        if two save to one file, or if something that is not of the program is in the place of one.
        """
        for name, count in Counter(run.name for run in runs).most_common(1):
            if count > 1:
                raise ValueError(f"two runs are called {name}: give each a name of its own")
        check_saves(runs)
        done: dict[str, RunResult] = {}
        rest, why = list[StudyRun](), dict[str, str]()
        for run in runs:
            result, why[run.name] = kept_result(run, self.folder)
            if result is None:
                check_replaceable(self.folder / run.name)
                rest.append(run)
            else:
                done[run.name] = result
        for result in done.values():
            report(result, KEPT)
        for result in self._executed(rest) if rest else ():
            done[result.name] = result
            report(result, why[result.name])
        return [done[run.name] for run in runs]

    def _executed(self, runs: list[StudyRun]) -> Iterator[RunResult]:
        """The results of `runs` as they come."""
        if self._dask:
            return _on_dask(runs, self.folder, self._dask, self._timed)
        if self.jobs == 0:
            return (execute(run, self.folder, self._timed) for run in runs)
        return self._in_processes(runs)

    def _in_processes(self, runs: list[StudyRun]) -> Iterator[RunResult]:
        left = {run.name: run for run in runs}
        while left:
            try:
                for result in self._submitted([*left.values()]):
                    del left[result.name]
                    yield result
            except BrokenProcessPool:
                self._end_processes()
                suspects = [run for run in left.values() if incomplete(run.name, self.folder)]
                clear(self.folder)
                for run in suspects or [*left.values()][:1]:
                    yield self._alone(run)
                    del left[run.name]

    def _alone(self, run: StudyRun) -> RunResult:
        """The result of a run that may have ended its process, as the only one in another."""
        try:
            return next(self._submitted([run]))
        except BrokenProcessPool:
            self._end_processes()
            return record_death(run, self.folder)

    def _submitted(self, runs: list[StudyRun]) -> Iterator[RunResult]:
        """The results of `runs`, as they come."""
        from joblib.externals.loky import ProcessPoolExecutor

        if self._executor is None:
            self._executor = ProcessPoolExecutor(
                self.jobs, initializer=_begin_worker, initargs=(os.getpid(),)
            )
        if self.jobs > 1 and len(runs) > 1 and runs[0].build not in self._compiled:
            self._executor.submit(rehearse, runs[0]).result()
            self._compiled.add(runs[0].build)
        futures = [self._executor.submit(execute, run, self.folder, self._timed) for run in runs]
        for future in as_completed(futures):
            yield future.result()

    def _end_processes(self) -> None:
        if self._executor is not None:
            with suppress(Empty):  # loky prints a traceback if one that has not begun is left in its queue
                while True:
                    self._executor._work_ids.get_nowait()
            self._executor.shutdown(wait=True, kill_workers=True)
            self._executor = None


def run_all(
    runs: Sequence[StudyRun],
    folder: str | Path,
    *,
    jobs: int | None = None,
    dask: str = "",
    report: Report = lambda result, why: None,
) -> list[RunResult]:
    """The results of `runs`, each in a folder of its name in `folder`/runs: see WorkerPool."""
    with WorkerPool(folder, jobs=processes(jobs, runs), dask=dask) as pool:
        return pool.results(runs, report)


def processes(jobs: int | None, runs: Sequence[StudyRun]) -> int:
    """As many processes as are asked for, by default one for each processor, but no more than runs."""
    return min((os.cpu_count() or 1) if jobs is None else jobs, max(len(runs), 1))


def check_saves(runs: Sequence[StudyRun]) -> None:
    """Error 31, at the statement, if runs save to one file: to an absolute path, or out of their folders."""
    saved: dict[str, str] = {}
    for run in runs:
        for call in run.calls("save"):
            path = str(call.named.get("path", ""))
            file = os.path.realpath(path) if os.path.isabs(path) else os.path.normpath(path)
            is_outside = os.path.isabs(file) or file.split(os.sep)[0] == os.pardir
            if is_outside and saved.setdefault(file, run.name) != run.name:
                error = UdecError(
                    31,
                    f"the runs {saved[file]} and {run.name} of this study would both write it",
                    "save without a folder: each run has one of its own; or put a variable into the name",
                )
                raise at(error, call.places.get("path", call.head))


def _begin_worker(parent: int) -> None:
    """A worker leaves Ctrl-C to the process that has started it, and ends with that process."""

    def end_with_parent() -> None:
        while os.getppid() == parent:
            sleep(CHECKED)
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=end_with_parent, daemon=True).start()


def _check_address(address: str) -> None:
    """ValueError for what cannot be the address of a scheduler: to try it takes long."""
    scheme, _, place = address.rpartition("://")
    try:
        parts = urlsplit(f"//{place}")
        good = scheme == "inproc" or (scheme in SCHEMES and bool(parts.hostname) and bool(parts.port))
    except ValueError:
        good = False
    if not good:
        raise ValueError(f"no dask scheduler at {address}: it needs a host and a port; {PRINTED}")


def _on_dask(runs: list[StudyRun], folder: Path, address: str, timed: bool) -> Iterator[RunResult]:
    """The results of `runs` by the workers of a scheduler. If one dies, others do its run."""
    try:
        import distributed
    except ImportError as error:
        advice = 'install its packages: python -m pip install "udec-ia[dask]"'
        raise UdecError(23, "--dask needs dask.distributed", advice) from error
    try:
        client = distributed.Client(address, timeout=CONNECT, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise ValueError(f"no dask scheduler at {address}: {error}; {PRINTED}") from error
    with client:
        futures = {client.submit(execute, run, folder, timed, pure=False): run for run in runs}
        for future in distributed.as_completed([*futures], loop=client.loop):
            try:
                yield future.result()
            except distributed.KilledWorker:
                yield record_death(futures[future], folder)


class StudyProgress:
    """Shows results of `total` runs on `stream` as they come, a line for each."""

    def __init__(self, stream: TextIO, total: int) -> None:
        self.stream, self.total = stream, total
        self.results: list[RunResult] = []
        self._reasons = Counter[str]()  # where the results come from: see WorkerPool.results

    def show(self, result: RunResult, why: str) -> None:
        """A result has come. why: see WorkerPool.results."""
        self.results.append(result)
        self._reasons[why] += 1
        again = {"": "", KEPT: " (kept)"}.get(why, f" (done again: {why})")
        message = f", {result.message}" if result.message else ""
        line = f"{result.name} {result.status}{message}, {counted(result.cycles, 'cycle')}"
        line = printable(f"{line}, {result.seconds:.1f} s", MESSAGE) + again
        print(f"{len(self.results)} of {self.total}: {line}", file=self.stream, flush=True)

    @property
    def summary(self) -> list[str]:
        """How many runs there are of each status, and how many were kept or repeated."""
        states = Counter(one.status for one in self.results)
        counts = ", ".join(f"{n} {state}" for state, n in states.items())
        found = [f"{len(self.results)} of {self.total} runs: {counts}"]
        if kept := self._reasons[KEPT]:
            found.append(f"{counted(kept, 'run')} kept, as the input is the same")
        again = ((why, n) for why, n in self._reasons.items() if why not in ("", KEPT))
        return found + [f"{counted(n, 'run')} done again: {why}" for why, n in again]
