"""Signals to processes that run random decks: what they save is sound, and the exit status true."""

from __future__ import annotations

import os
import re
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from interrupted.scene import SCENE
from udec_ia import Model, UdecError, cli

MEANT = {signal.SIGINT: 130, signal.SIGTERM: 143}
SAVED = re.compile(r"(?:is|are) saved in (\S+)")
TYPED = """SPLIT -1 {0:.3f} 7 {1:.3f}
CYCLE {2}
FIX 0 {3} 0 {3}
FREE 0 {3} 1.2 4
CHANGE {3} 6 1 4 SDEF
CHANGE {3} 6 1 4 RIGID
BOUNDARY 0 {3} 1 4 XFORCE {2}
BOUNDARY -1 7 -1 5 FREE
FUNCTION 3 0 0 0.5 {1}
HISTORY {2} KYD AT {3},3
INSITU 0 6 0 4 -{2} 0 -{2}
PROP MAT=2 F=0.{2}
ROUND 0.04{2}
SAVE
PRINT BLOCKS
PLOT 1
CYCLE {2}0""".splitlines()


def deck(rng: np.random.Generator) -> str:
    """A deck of some seconds that may end with an error."""
    lines = [
        TYPED[int(rng.integers(len(TYPED)))].format(*rng.uniform(1, 4, 2), *rng.integers(1, 60, 2) // (1, 10))
        for _ in range(60)
    ]
    return "\n".join([SCENE, *lines, "SAVE", "STOP", "END", ""])


_obey_arguments = cli._main


def _let_signals_come(argv: Sequence[str]) -> int:
    """What the command line does once its handlers are there."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, MEANT)
    return _obey_arguments(argv)


def child(folder: Path) -> None:
    """Run the deck in `folder` as the command line does, and leave. Signals are blocked before."""
    status = 99
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        for number, name in ((1, "out"), (2, "err")):
            os.dup2(os.open(folder / name, os.O_WRONLY), number)
        sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
        cli._main = _let_signals_come
        status = cli.main(["run", "--out", str(folder), str(folder / "deck.dat")])
    except BaseException:
        traceback.print_exc()
    finally:
        for number in MEANT:
            signal.signal(number, signal.SIG_IGN)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def one_process(folder: Path, number: int, wait: float, ended: Counter[str]) -> str:
    """Send the signal after `wait` seconds; returns what is wrong with what is left, or ""."""
    for name in ("out", "err"):
        (folder / name).touch()
    signal.pthread_sigmask(signal.SIG_BLOCK, MEANT)
    process = os.fork()
    if process == 0:
        child(folder)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, MEANT)
    ends = time.monotonic() + wait
    while time.monotonic() < ends and os.waitpid(process, os.WNOHANG) == (0, 0):
        time.sleep(0.002)
    try:
        os.kill(process, number)
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    except (ProcessLookupError, ChildProcessError):
        ended["before the signal"] += 1
        return ""
    out, err = (folder / "out").read_text(), (folder / "err").read_text()
    ended[f"status {status}"] += 1
    named = SAVED.search(err)
    if "Traceback" in err or status not in (0, 1, MEANT[number]):  # type: ignore[index]
        return f"status {status}: {err}"
    if status == MEANT[number] and named is None and "> PROP" in out:  # type: ignore[index]
        return f"nothing was saved: {out[-300:]} {err}"
    for path in {folder / "restart.h5", *([Path(named[1])] if named else [])}:
        if path.exists():
            try:
                if found := Model.check_file(path):
                    return f"status {status}, {path.name}: {found[0]}"
            except UdecError as error:
                return f"status {status}, {path.name}: {error}"
    return ""


def interrupt_processes(n: int, seed: int, seconds: float) -> list[str]:
    """Send signals to `n` processes; returns the failures."""
    rng, failures, ends = np.random.default_rng(seed), [], time.monotonic() + seconds
    ended: Counter[str] = Counter()
    longest = 2.0  # s, about as long as such a deck takes
    for done in range(n):
        if time.monotonic() > ends:
            print(f"{done} processes, then the time was over")
            break
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "deck.dat").write_text(deck(rng))
            number = (signal.SIGINT, signal.SIGTERM)[int(rng.integers(2))]
            failure = one_process(Path(folder), number, float(rng.uniform(0, longest)), ended)
        if failure:
            failures.append(f"process {done}: {failure}")
            print(failures[-1], flush=True)
    print(dict(ended))
    return failures
