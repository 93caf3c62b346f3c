"""One run of a study is run: on a new model, in a folder of its own, watched.

Nothing of what it writes names the place where it was run.
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
from time import perf_counter
from typing import TextIO

from udec_ia.deck.deck_statements import statements
from udec_ia.deck.deck_variables import Variables
from udec_ia.errors import UdecError
from udec_ia.running.solve_result import in_short
from udec_ia.study.folders import BEGUN, begun, new, publish
from udec_ia.study.keeping import write
from udec_ia.study.memory import peak_memory, restart_peak
from udec_ia.study.reading import read
from udec_ia.study.runs import DECK, DIED, ENDED, ERROR, Result, Run
from udec_ia.study.watching import Heard, Observer

LOG = "log.txt"
NOT_OF_DECK = (23, 31)  # a package is missing, a file cannot be written
log = logging.getLogger("udec_ia")


class _Process:
    """Of this one. run: held while it does one, whatever threads it has. warm: it has done one before."""

    def __init__(self) -> None:
        self.run = threading.Lock()
        self.warm = False


_one = _Process()


def obey(run: Run, folder: Path, timed: bool = False) -> Result:
    """Run `run`, and leave all that it writes in its folder in `folder`; a former one of the program goes.

    timed: in a process that has done no run yet it is rehearsed first, so that its seconds are those of the
    run, and not those of loading the program. Whatever is wrong with the run is told by its result. OSError
    if nothing can be written there, error 31 if what stands there is not ours.
    """
    if timed and not _one.warm:
        rehearse(run)
    with _one.run:
        here = new(folder, run.name)
        try:
            (here / BEGUN).touch()
            result = _result(run, here)
            write(result, here)
            publish(here, folder / run.name)
            _one.warm = True
        except BaseException:
            shutil.rmtree(here, ignore_errors=True)
            raise
    return result


def rehearse(run: Run) -> None:
    """Run `run` with a single cycle for each CYCLE or SOLVE, and forget it: its kernels are compiled then."""
    with _one.run, tempfile.TemporaryDirectory() as folder:
        _result(run, Path(folder), rehearsal=True)
    _one.warm = True


def bury(run: Run, folder: Path) -> Result:
    """Leave the result of a run in `folder` whose process has died."""
    message = "its process died, perhaps because memory ran out"
    names = [one.name for one in read(run.quantities)]
    result = Result(
        run.name,
        dict(run.values),
        DIED,
        message=message,
        quantities=dict.fromkeys(names, float("nan")),
        made_of=run.made_of,
        limit=run.limit,
        of_system=True,
    )
    left = begun(run.name, folder)
    here = left[0] if left else new(folder, run.name)
    write(result, here)
    (here / BEGUN).touch()
    publish(here, folder / run.name)
    return result


def _result(run: Run, here: Path, rehearsal: bool = False) -> Result:
    """What comes of `run`, whose files go to the folder `here`."""
    clock, observer = perf_counter(), None
    status, error, message, of_system = ENDED, 0, "", False
    warnings: list[str] = []
    found, remarks = dict.fromkeys((one.name for one in read(run.quantities)), float("nan")), list[str]()
    restart_peak()
    with _Log(here) as out, _logged(out):
        (here / DECK).write_text(_with_values(run), encoding="utf-8")
        try:
            name = Path(run.file or DECK).stem
            laws = run.constitutive or None
            model = Heard(warnings.append, run.build, out=here, constitutive=laws, name=name)
            observer = Observer(run, model, rehearsal)
            observer.obey(out)
            status, message = observer.over or ENDED, observer.why or "; ".join(in_short(model.solutions()))
            found, remarks = observer.quantities()
        except UdecError as failure:
            print(failure, file=out)
            status, error, message = ERROR, failure.number, str(failure).partition("\n")[0]
            of_system = error in NOT_OF_DECK or isinstance(failure.__cause__, OSError | MemoryError)
        except Exception as failure:  # of the system, or of ours: it ends this run, and no other
            traceback.print_exc(file=out)
            status, message, of_system = ERROR, f"{type(failure).__name__}: {failure}", True
        print(*(f"{remark}\n" for remark in remarks), sep="", end="", file=out)
    cycles, time, words = observer.size if observer else (0, 0.0, 0)
    return Result(
        run.name,
        dict(run.values),
        status,
        error,
        out.freed(message),
        found,
        tuple(remarks),
        cycles,
        time,
        words,
        seconds=observer.seconds if observer else 0.0,
        wall_seconds=perf_counter() - clock,
        peak_memory=peak_memory(),
        made_of=run.made_of,
        limit=run.limit,
        warnings=tuple(dict.fromkeys(map(out.freed, warnings))),
        of_system=of_system,
    )


def _with_values(run: Run) -> str:
    """The deck with the values of the run, as far as it has them all."""
    variables = Variables()
    with suppress(UdecError):
        variables = Variables(run.values)
        filled = variables.filled(statements(run.deck.splitlines(), run.file))
        return "".join(f"{line.text}\n" for statement in filled for line in statement.lines)
    return run.deck


class _Log(TextIOWrapper):
    """The file that takes what a run prints, in the folder `here`, without the name of that folder."""

    def __init__(self, here: Path) -> None:
        super().__init__((here / LOG).open("wb"), encoding="utf-8", errors="replace")
        self._prefix = str(here) + os.sep

    def freed(self, text: str) -> str:
        """`text` without the name of the folder."""
        return text.replace(self._prefix, "")

    def write(self, text: str) -> int:
        """As of any text file."""
        return super().write(self.freed(text))


@contextmanager
def _logged(out: TextIO) -> Iterator[None]:
    """What the program has to say besides goes to `out`, and nowhere else."""
    handler = logging.StreamHandler(out)
    propagated, log.propagate = log.propagate, False
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.propagate = propagated
