"""Interrupts anywhere: whatever ends a command, the model is as after it or exactly as before it, and sound.

    python tools/robustness.py interrupts --lines 2000 --signals 500 --kills 200 --seed 1

First KeyboardInterrupt (Ctrl-C that does not wait) or MemoryError is raised at random lines of Python inside
every command of a model with blocks of all types, conditions, histories and pictures, typed, in Python, and
two of them obeyed as one. Words, common block and what the model holds in Python are compared with those
before and after bit for bit; a CYCLE may also have ended between two cycles. Lines of interrupt_signals.py
are left out: what holds interrupts back is not interrupted itself.

Then SIGINT or SIGTERM is sent to processes that run random decks, at random moments. The restart file that
they name has to be sound, and the exit status true.

At last processes that SAVE two states by turns under one name are killed at random moments (SIGKILL, which
nothing can hold back): the name must stand for one of the two, whole. Failures are printed; with one the exit
status is 1.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from trials.interrupted_commands import SCENE, Lines, interrupt_lines

from udec_ia import Model, UdecError, cli
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.offsets import MCTOT
from udec_ia.restart import load, save

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


def two_states(folder: Path) -> list[MainArray]:
    """A state, and the same after some cycles: their numbers of cycles tell them apart."""
    model = Lines(folder, cycled=False).model
    states = [model.array.copy()]
    model.cycle(20)
    return [*states, model.array.copy()]


def save_for_ever(states: list[MainArray], path: Path, before: int) -> None:
    """SAVE by turns, beginning with the state that is not there; ended from outside."""
    try:
        while True:
            before = 1 - before
            save(states[before], path)
    finally:
        os._exit(99)


def kill_saves(n: int, seed: int, seconds: float) -> list[str]:
    """Kill `n` processes that SAVE; returns the failures."""
    rng, failures, ends = np.random.default_rng(seed), [], time.monotonic() + seconds
    ended: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        states, path = two_states(Path(name)), Path(name, "saved", "run.h5")
        cycles = [int(state.h.ci[MCTOT]) for state in states]
        save(states[0], path)
        start = time.perf_counter()
        save(states[0], path)
        longest = 3 * (time.perf_counter() - start)
        before = 0
        for done in range(n):
            if time.monotonic() > ends:
                print(f"{done} kills, then the time was over")
                break
            process = os.fork()
            if process == 0:
                save_for_ever(states, path, before)
            time.sleep(float(rng.uniform(0, longest)))
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            try:
                found = cycles.index(int(load(path).array.h.ci[MCTOT]))
                ended["the old file" if found == before else "the new file"] += 1
                before = found
            except (UdecError, ValueError) as error:
                failures.append(f"kill {done}: {error}")
                print(failures[-1], flush=True)
            for rest in {*path.parent.iterdir()} - {path}:
                ended["part of a file under another name"] += 1
                rest.unlink()
    print(dict(ended))
    return failures


def main() -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--lines", type=int, default=2000)
    parser.add_argument("--signals", type=int, default=500)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3600.0, help="time for each part")
    args = parser.parse_args()
    warnings.simplefilter("ignore")
    failures = interrupt_lines(args.lines, args.seed, args.seconds)
    failures += interrupt_processes(args.signals, args.seed, args.seconds)
    failures += kill_saves(args.kills, args.seed, args.seconds)
    tried = f"{args.lines} lines, {args.signals} signals, {args.kills} kills"
    print(f"{tried}, seed {args.seed}: {len(failures)} failures")
    return 1 if failures else 0
