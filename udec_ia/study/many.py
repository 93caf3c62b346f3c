"""Many runs: in this process, side by side in processes of joblib's loky, or on workers of dask.distributed.

What has been done before, and is made of the same, is not done again. A run whose process has died is
tried once more, alone; if it dies again, that is its result. Kernels are compiled before the runs begin: by
a rehearsal, once for each machine.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager, suppress
from itertools import islice
from pathlib import Path
from time import sleep
from urllib.parse import urlsplit

from udec_ia.errors import UdecError
from udec_ia.study.folders import begun, check_replaceable, clear
from udec_ia.study.holding import held
from udec_ia.study.keeping import kept
from udec_ia.study.obeying import bury, obey, rehearse
from udec_ia.study.runs import Result, Run

RUNS = "runs"  # folder of the folders of runs
WATCHED = 1.0  # seconds between two looks whether the sweep is still there
CONNECT = 30  # seconds to wait for a scheduler
SCHEMES = ("", "tcp", "tls", "ucx", "ws", "wss")  # of its address
PRINTED = "give the address that the scheduler prints when it starts, as in tcp://10.0.0.1:8786"
Told = Callable[[Result, str], None]


def run_all(
    runs: Sequence[Run],
    folder: str | Path,
    *,
    jobs: int | None = None,
    dask: str = "",
    timed: bool = False,
    told: Told = lambda result, why: None,
) -> list[Result]:
    """Do all `runs`, each in a folder of its name in `folder`/runs. Returns their results in the same order.

    jobs: processes, by default as many as there are processors; 0 does them one after the other in this one.
    dask: address of a scheduler; `folder` must be one that its workers have as well. timed: the seconds of
    results are to be compared, so each process rehearses its first run before. told: takes each result, and
    why it is what it is: "" if it is new, "kept" if it was there, or what has changed since it was made.
    Raises ValueError if two runs have one name, jobs is below 0 or dask is no address; UdecError 31, before
    any run, if the folder cannot be written or is in use by another process, or if something stands in the
    place of a run that the program has not made. Whatever ends it, what is done stays.
    """
    names = [run.name for run in runs]
    if len({*names}) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two runs are called {twice}: give each a name of its own")
    if jobs is not None and jobs < 0:
        raise ValueError(f"{jobs} jobs: give 1 or more, or 0 for this process")
    if dask:
        _check_address(dask)
    here = Path(folder).absolute() / RUNS
    done: dict[str, Result] = {}
    with _prepared(here):
        rest, why = list[Run](), dict[str, str]()
        for run in runs:
            result, why[run.name] = kept(run, here)
            if result is None:
                check_replaceable(here / run.name)
                rest.append(run)
            else:
                done[run.name] = result
        for result in done.values():
            told(result, "kept")
        for result in _pool(rest, here, jobs, dask, timed) if rest else ():
            done[result.name] = result
            told(result, why[result.name])
    return [done[name] for name in names]


@contextmanager
def _prepared(folder: Path) -> Iterator[None]:
    """The folder of runs is there, and nobody else's, and nothing in it is half done. Error 31."""
    with ExitStack() as stack:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            stack.enter_context(held(folder))
            clear(folder)
        except OSError as error:
            raise UdecError(31, f"{folder}: {error.strerror or error}") from error
        yield


def _pool(runs: list[Run], folder: Path, jobs: int | None, dask: str, timed: bool) -> Iterator[Result]:
    """The results of `runs` as they come."""
    if dask:
        return _on_dask(runs, folder, dask, timed)
    if jobs == 0:
        return (obey(run, folder, timed) for run in runs)
    return _in_processes(runs, folder, min(jobs or os.cpu_count() or 1, len(runs)), timed)


# ---- joblib


def _in_processes(runs: list[Run], folder: Path, jobs: int, timed: bool) -> Iterator[Result]:
    """The same by processes of loky, which joblib brings along."""
    left = {run.name: run for run in runs}
    while left:
        try:
            for result in _submitted([*left.values()], folder, jobs, timed):
                del left[result.name]
                yield result
        except BrokenProcessPool:
            suspects = [run for run in left.values() if begun(run.name, folder)] or [*left.values()][:1]
            clear(folder)
            for run in suspects:
                yield _alone(run, folder, timed)
                del left[run.name]


def _alone(run: Run, folder: Path, timed: bool) -> Result:
    """The result of a run that may have ended its process, as the only one in another."""
    try:
        return next(_submitted([run], folder, 1, timed))
    except BrokenProcessPool:
        return bury(run, folder)


def _submitted(runs: list[Run], folder: Path, jobs: int, timed: bool) -> Iterator[Result]:
    """The results of `runs`, as they come. Whatever ends this ends the processes."""
    from joblib.externals.loky import ProcessPoolExecutor

    executor = ProcessPoolExecutor(jobs, initializer=_begin_worker, initargs=(os.getpid(),))
    waiting = iter(runs)
    try:
        if min(jobs, len(runs)) > 1:
            executor.submit(rehearse, runs[0]).result()
        going = {executor.submit(obey, run, folder, timed) for run in islice(waiting, jobs)}
        while going:
            done, going = wait(going, return_when=FIRST_COMPLETED)
            going |= {executor.submit(obey, run, folder, timed) for run in islice(waiting, len(done))}
            for future in done:
                yield future.result()
    finally:
        executor.shutdown(wait=True, kill_workers=True)


def _begin_worker(parent: int) -> None:
    """A worker leaves Ctrl-C to the process that has started it, and ends when that has gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_outlive_nobody, args=(parent,), daemon=True).start()


def _outlive_nobody(parent: int) -> None:
    while os.getppid() == parent:
        sleep(WATCHED)
    os._exit(1)


# ---- dask


def _check_address(address: str) -> None:
    """ValueError for what can be the address of no scheduler: to try it takes long."""
    scheme, _, place = address.rpartition("://")
    if scheme == "inproc":  # a scheduler in this process, which has no port
        return
    try:
        parts = urlsplit(f"//{place}")
        good = scheme in SCHEMES and bool(parts.hostname) and bool(parts.port)
    except ValueError:
        good = False
    if not good:
        raise ValueError(f"no dask scheduler at {address}: it needs a host and a port; {PRINTED}")


def _on_dask(runs: list[Run], folder: Path, address: str, timed: bool) -> Iterator[Result]:
    """The same by the workers of a scheduler. One that dies is made up for by the others."""
    try:
        from distributed import Client, KilledWorker
        from distributed import as_completed as completed
    except ImportError as error:
        advice = 'install its packages: python -m pip install "udec-ia[dask]"'
        raise UdecError(23, "--dask needs dask.distributed", advice) from error
    try:
        client = Client(address, timeout=CONNECT, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise ValueError(f"no dask scheduler at {address}: {error}; {PRINTED}") from error
    with client:
        machines = {urlsplit(worker).hostname: worker for worker in client.nthreads()}
        first = [client.submit(rehearse, runs[0], workers=[one], pure=False) for one in machines.values()]
        for future in first:
            with suppress(KilledWorker, CancelledError):  # the runs will tell
                future.result()
        futures = {client.submit(obey, run, folder, timed, pure=False): run for run in runs}
        for future in completed([*futures], loop=client.loop):
            try:
                yield future.result()
            except KilledWorker:
                yield bury(futures[future], folder)
