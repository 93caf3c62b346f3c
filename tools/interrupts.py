"""Interrupts anywhere: whatever ends a command, the model is as after it or exactly as before it, and sound.

    python tools/interrupts.py --lines 2000 --signals 500 --kills 200 --seed 1

First KeyboardInterrupt (Ctrl-C that does not wait) or MemoryError is raised at random lines of Python inside
every command of a model with blocks of all types, conditions, histories and pictures, typed, in Python, and
two of them obeyed as one. Words, common block and what the model holds in Python are compared with those
before and after bit for bit; a CYCLE may also have ended between two cycles. Lines of signals.py are left
out: what holds interrupts back is not interrupted itself.

Then SIGINT or SIGTERM is sent to processes that run random decks, at random moments. The restart file that
they name has to be sound, and the exit status true.

At last processes that SAVE two states by turns under one name are killed at random moments (SIGKILL, which
nothing can hold back): the name must stand for one of the two, whole. Failures are printed; with one the exit
status is 1.
"""

from __future__ import annotations

import argparse
import io
import os
import re
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from udec_ia import Model, UdecError, cli, signals
from udec_ia.deck.monitor import Monitor
from udec_ia.deck.reader import statements
from udec_ia.heap.array import MainArray
from udec_ia.layout.offsets import MCTOT, MFREE, NCYC
from udec_ia.restart import load, save

PACKAGE = str(Path(sys.modules["udec_ia"].__file__ or "").parent)
NOT_COUNTED = str(Path(PACKAGE) / "signals.py")
RAISED: tuple[type[BaseException], ...] = (KeyboardInterrupt, MemoryError)
SCENE = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E9 G=6E8
PROP MAT=2 DENS=1000 KN=2E8 KS=1E8 F=0.1 BULK=2E8 G=1E8
BLOCK 0,0 0,4 6,4 6,0
SPLIT -1 1 7 1
SPLIT -1 2 7 2
SPLIT 2 1 2 4
SPLIT 4 1 4 4
ROUND 0.05
FIX 0 6 0 1
GRAVITY 0 -10
ENERGY ON
FUNCTION 3 0 0 0.01 1
CHANGE 2 4 1 2 SDEF
CHANGE 0 2 2 4 SDEF
GENERATE 0 2 1 2 AUTOMATIC EDGE 0.8
BOUNDARY 1.9 6 3.9 4.1 STRESS 0 0 -1E4 FUNCTION 3
BOUNDARY 2 4 2 4 XVEL 0.01 SINE 20 1
HISTORY 5 KYD AT 1,3 5,3
HISTORY 3 UNBALANCED"""
COMMANDS = """BLOCK 0,0 0,4 1,5 6,4 6,0
SPLIT 4 3.1 7 3.3
SPLIT -1 3 7 3.5
SPLIT 3 1.5 3 9
DELETE 4 6 2 4
DELETE 0 2 1 2
FIX 0 9 2 9
FREE 0 9 0 9
CHANGE 2 6 1 4 FDEF MAT 2
CHANGE 0 2 1 2 RIGID
CHANGE 0 6 0 4 CONS 1 MAT 2
GENERATE 4 6 1 2 AUTOMATIC EDGE 0.7
GENERATE 4 6 1 2 MANUAL GRIDPOINTS 4,1 4,2 6,2 6,1 ZONES 1,2,3 1,3,4
GENERATE 2 4 1 2 AUTOMATIC EDGE 1.1 MIXED
BOUNDARY 0 6 1 4 XVEL 0.01
BOUNDARY -1 7 -1 5 VISCOUS
BOUNDARY -1 7 -1 5 FREE
FUNCTION 3 0 0 0.5 1 2 -1
FUNCTION 4 0 1
INSITU 0 6 0 4 -1E4 0 -2E4
ROUND 0.04
RSET 0.25 1 3
PROP MAT=1 DENS=2100 KN=2E8 F=0.3 BULK=2E9
GRAVITY 1 -9
DAMPING 0.1 5
ENERGY OFF
FRACTION 0.2
SCALE 0.1
CYCLE 23
CYCLE 0
SOLVE 0.001 LIMIT 30
HISTORY 4 KXD AT 1,1.5 3,3
PRINT BLOCKS CONTACTS
PRINT ENERGY HISTORIES
DUMP 1 40
PLOT 0
PLOT 1
SAVE other.h5
RESTART
START
STOP""".splitlines()

ALONE = ("BLOCK", "CYCLE", "SOLVE", "PRINT", "DUMP", "PLOT", "SAVE", "RESTART", "START", "STOP")
PAIRED = [line for line in COMMANDS if not line.startswith(ALONE)]  # of which two may be obeyed as one
PAIRS = 0.25


# ---- what a model holds


def state(model: Model) -> dict[str, Any]:
    """All that a command may change, bit for bit."""
    h, plots = model.array.h, model._plots
    frame = None if plots is None or plots.frame is None else plots.frame
    return {
        "words": h.ia[: int(h.ci[MFREE]) - 1].tobytes(),
        "integers": h.ci.tobytes(),
        "reals": h.cr.tobytes(),
        "doubles": h.cd.tobytes(),
        "size": (len(h.ia), model.array.scheme.name, model.array.fixed),
        "deck": tuple(model.deck_log),
        "series": tuple((str(one), one.lost, one.numbers.tobytes()) for one in model._recorder.series),
        "solutions": tuple(model._recorder.solutions),
        "files": tuple(model._files),
        "frame": None if plots is None else (plots.count, len(frame.states) if frame else -1),
        "flags": (model.started, model._touched, model._unproved, model.explain_step),
        "remarks": (
            sorted(model._said),
            model._runaway._judged,
            model._runaway._warned,
            model._runaway._account,
        ),
    }


def between(model: Model, before: Callable[[], Model], line: str) -> bool:
    """True if a CYCLE or SOLVE that was cut short has left what one of as many cycles leaves."""
    twin = before()
    done = int(model.array.h.ci[MCTOT]) - int(twin.array.h.ci[MCTOT])
    if not line.startswith(("CYCLE", "SOLVE")) or done < 0:
        return False
    twin.cycle(done)
    for one in (model, twin):
        one.array.h.ci[NCYC] = 0
    mine, other = state(model), state(twin)
    return all(mine[part] == other[part] for part in ("words", "integers", "reals", "series"))


# ---- exceptions at lines of Python


class Injector:
    """Raises `exception` at line number `k` of the package, counted from 1, or only counts. raised: where."""

    def __init__(self, k: int = 0, exception: type[BaseException] = KeyboardInterrupt) -> None:
        self.k, self.exception = k, exception
        self.count = 0
        self.raised = ""

    def __enter__(self) -> Injector:
        sys.settrace(self.called)
        return self

    def __exit__(self, *exception: object) -> None:
        sys.settrace(None)

    def called(self, frame: FrameType, event: str, _: Any) -> Any:
        """Look at the lines of a function of the package."""
        file = frame.f_code.co_filename
        return self.line if file.startswith(PACKAGE) and file != NOT_COUNTED else None

    def line(self, frame: FrameType, event: str, _: Any) -> Any:
        """Count a line."""
        if event == "line":
            self.count += 1
            if self.count == self.k:
                self.raised = f"{frame.f_code.co_filename}:{frame.f_lineno}"
                raise self.exception
        return self.line


def forget_holds(depth: int) -> None:
    """Close the holds that were left open beyond `depth`.

    What is raised here at the line of a `with` on the way out comes before its end, which is then left out.
    No signal raises there: it waits until that end.
    """
    signals._waiting.depth = depth
    signals._waiting.passing = signals._waiting.firm = False


class Lines:
    """A model in `folder` whose commands are interrupted. cycled: it has been cycled before."""

    def __init__(self, folder: Path, cycled: bool, build: str = "i32r64") -> None:
        self.folder, self.cycled, self.build = folder, cycled, build
        self.counts: dict[tuple[str, bool], int] = {}
        self.fresh()
        self.model.save(folder / "restart.h5")

    def scene(self, line: str = "") -> Model:
        """A new model, as it is before the command `line`."""
        model = Model(self.build, out=self.folder)
        model.tell = model.inform = lambda _: None
        monitor = Monitor(model, io.StringIO())
        lines = SCENE if not line.startswith("BLOCK") else "START\nPROP MAT=1 DENS=2000\nFUNCTION 1 0 0 1 1"
        for statement in statements(lines.splitlines(), "scene"):
            monitor.obey(statement)
        if self.cycled and not line.startswith("BLOCK"):
            model.cycle(30)
        return model

    def fresh(self, line: str = "") -> None:
        """Begin with a new model."""
        self.model = self.scene(line)
        self.of = line.startswith("BLOCK")

    def one(self, line: str, typed: bool, k: int, exception: type[BaseException]) -> str:
        """Interrupt `line` at line `k` of Python; returns what is wrong then, or ""."""
        if self.of != line.startswith("BLOCK"):
            self.fresh(line)
        key = line, typed
        before = state(self.model)
        if key not in self.counts:
            # the second of two may refuse what the first has left
            with Injector() as counter, suppress(UdecError):
                self.obey(line, typed)
            self.counts[key] = counter.count
            self.fresh(line)
            before = state(self.model)
        k = 1 + k % self.counts[key]
        depth = signals._waiting.depth
        with Injector(k, exception) as injector:
            try:
                self.obey(line, typed)
            except BaseException as error:
                if not isinstance(error, (exception, UdecError)):
                    return f"{line}: {error!r} at {injector.raised}"
        forget_holds(depth)
        now = state(self.model)
        wrong = ""
        if now != before:
            after = self.scene(line)
            self.model, kept = after, self.model
            self.obey(line, typed)
            self.model = kept
            differs = [part for part in now if now[part] != before[part]]
            other = [part for part in now if now[part] != state(after)[part]]
            if other and not between(kept, lambda: self.scene(line), line):
                wrong = f"before: {differs}, after: {other}"
        faults = [] if self.model._touched else self.model.check()
        if now != before or faults:
            self.fresh(line)
        if faults:
            wrong += f" {faults[0]}"
        return wrong and f"{line} ({'typed' if typed else 'Python'}): {injector.raised}: {wrong}"

    def obey(self, line: str, typed: bool) -> None:
        """Obey `line`, as the monitor does or by the method alone; several lines are obeyed as one."""
        if "\n" in line:
            self.model.whole(lambda: [self.obey(one, False) for one in line.split("\n")])
            return
        model, monitor = self.model, Monitor(self.model, io.StringIO())
        (statement,) = statements([line], "line")
        if typed:
            monitor.obey(statement)
        else:
            from udec_ia.deck.parser import parse

            call = parse(statement)
            named = dict(call.named)
            if "path" in named:
                named["path"] = self.folder / named["path"]
            getattr(model, call.command.name)(*call.positional, **named)


def interrupt_lines(n: int, seed: int, seconds: float, build: str = "i32r64") -> list[str]:
    """Raise exceptions at `n` random lines; returns the failures."""
    rng, failures, ends = np.random.default_rng(seed), [], time.monotonic() + seconds
    with tempfile.TemporaryDirectory() as folder:
        scenes = [Lines(Path(folder) / f"{cycled:d}", cycled, build) for cycled in (False, True)]
        for done in range(n):
            if time.monotonic() > ends:
                print(f"{done} lines, then the time was over")
                break
            lines = scenes[int(rng.integers(2))]
            line = COMMANDS[int(rng.integers(len(COMMANDS)))]
            if line.startswith("PLOT 0") and rng.random() < 0.8:
                line = "PLOT 1"
            if rng.random() < PAIRS:
                line = "\n".join(str(one) for one in rng.choice(PAIRED, 2))
            typed, k = bool(rng.integers(2)), int(rng.integers(10**9))
            failure = lines.one(line, typed, k, RAISED[int(rng.integers(2))])
            if failure:
                failures.append(failure)
                print(failure, flush=True)
    return failures


# ---- signals to processes

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


# ---- kills while files are written


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


if __name__ == "__main__":
    sys.exit(main())
