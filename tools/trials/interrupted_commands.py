"""Exceptions raised at lines of Python inside every command: the model is as after it or as before it."""

from __future__ import annotations

import io
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from udec_ia import Model, UdecError, interrupt_signals
from udec_ia.deck.command_monitor import Monitor
from udec_ia.deck.deck_statements import statements
from udec_ia.layout.offsets import MCTOT, MFREE, NCYC

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


def state(model: Model) -> dict[str, Any]:
    """All that a command may change, bit for bit."""
    h, plots = model.array.h, model.session.plots
    frame = None if plots is None or plots.frame is None else plots.frame
    return {
        "words": h.ia[: int(h.ci[MFREE]) - 1].tobytes(),
        "integers": h.ci.tobytes(),
        "reals": h.cr.tobytes(),
        "doubles": h.cd.tobytes(),
        "size": (len(h.ia), model.array.scheme.name, model.array.fixed),
        "deck": tuple(model.session.log.lines),
        "series": tuple((str(one), one.lost, one.numbers.tobytes()) for one in model.session.recorder.series),
        "solutions": tuple(model.session.recorder.solutions),
        "files": tuple(model.session.files),
        "frame": None if plots is None else (plots.count, len(frame.states) if frame else -1),
        "flags": (model.session.started, model.session.written, model.session.unproved, model.explain_step),
        "remarks": (
            sorted(model.session._remarks),
            model.session.monitors.energy._checked,
            model.session.monitors.energy._warned,
            model.session.monitors.energy._account,
        ),
    }


PACKAGE = str(Path(sys.modules["udec_ia"].__file__ or "").parent)
NOT_COUNTED = str(Path(PACKAGE) / "interrupt_signals.py")
RAISED: tuple[type[BaseException], ...] = (KeyboardInterrupt, MemoryError)
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
    """Close each `defer_signals` that was left open beyond `depth`.

    What is raised here at the line of a `with` on the way out comes before its end, which is then left out.
    No signal raises there: it waits until that end.
    """
    interrupt_signals._waiting.depth = depth
    interrupt_signals._waiting.allowed = interrupt_signals._waiting.also_second = False


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
            monitor.execute(statement)
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
        depth = interrupt_signals._waiting.depth
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
        faults = [] if self.model.session.written else self.model.check()
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
            monitor.execute(statement)
        else:
            from udec_ia.deck.lines_and_calls import parse

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
