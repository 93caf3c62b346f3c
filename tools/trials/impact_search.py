"""A search for impacts that the program misses, and for errors 15 that nothing has deserved.

Draws random scenes from a seed, plays them in processes of their own, and looks at them from outside
(tests/support/watched_model.py, tests/naive/overlaps.py). Modules of tests/support draw the kinds of scenes:
impacts of two bodies or three by their corners (acute, right, obtuse, concave, needles: random_impacts), many
blocks that move for long (long, extreme: random_piles), corners of deformable blocks that bend (bends:
random_corner_bends), and faces of slight bends that slide over one another (grazes: random_sliding_faces).

    python tools/robustness.py impacts --count 1000 --jobs 2
    python tools/robustness.py impacts --kinds concave --play 17

What counts as a failure:

    bare         an overlap of more than FTOL without a contact
    deep         one of more than DTOL2 without error 15
    phantom      a contact that overlaps by more than FTOL, of bodies that do not
    through      bodies that went through each other within one step
    late alarm   error 15 without an overlap in the last step; there was one some cycles before
    false alarm  error 15 without any
    unsound      violations that check() finds; and tracebacks and hangs

Other numbered errors end a scene and are counted.
"""

from __future__ import annotations

import argparse
import json
import logging
import multiprocessing
import os
import sys
import time
import traceback
import warnings
from collections import Counter, defaultdict
from dataclasses import asdict, dataclass, field
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

import numpy as np
from support.random_corner_bends import bend
from support.random_impacts import SHAPES, strike
from support.random_piles import PILES, pile
from support.random_sliding_faces import graze
from support.watched_model import Over, WatchedModel, Wrong

SCHEMES = {"i16r32": 0.15, "i32r32": 0.1, "i16r64": 0.15, "i32r64": 0.5, "i64r64": 0.1}
FACES = {"bends": bend, "grazes": graze}
KINDS = (*SHAPES, *PILES, *FACES)
WARM = 1800.0  # seconds in which the first scene of every scheme must end: it compiles
SECONDS = 120.0  # for a scene
TELL = 60.0  # seconds from one line on the progress to the next
SHOWN = 2  # failures of a class that are printed in full


@dataclass
class Outcome:
    """How a scene ended: in a failure, a numbered error or nothing of the kind."""

    kind: str
    number: int
    failure: str = ""
    detail: str = ""
    error: int = 0
    build: str = ""
    cycles: int = 0
    d: float = 0.0
    fastest: float = 0.0
    stopped: float = np.inf
    refused: dict[int, int] = field(default_factory=dict)
    snippet: str = ""


def play(kind: str, seed: int, number: int, build: str | None = None) -> Outcome:
    """Play one scene."""
    rng = np.random.default_rng([seed, KINDS.index(kind), number])
    drawn = str(rng.choice(list(SCHEMES), p=list(SCHEMES.values())))
    stage = WatchedModel(build or drawn)
    found = Outcome(kind, number, build=stage.build)
    try:
        if kind in FACES:
            FACES[kind](stage, rng)
        else:
            (strike if kind in SHAPES else pile)(stage, kind, rng)
    except Wrong as wrong:
        found.failure, found.detail = wrong.kind, wrong.detail
    except Over as over:
        found.error = over.number
    except Exception as error:
        found.failure = f"traceback: {type(error).__name__}"
        found.detail = "".join(traceback.format_exception(error)[-3:])
    found.cycles, found.d, found.fastest, found.stopped = stage.cycles, stage.d, stage.fastest, stage.stopped
    found.refused = dict(stage.errors)
    found.snippet = stage.snippet if found.failure else ""
    return found


# ---- processes


def quiet() -> None:
    """Warnings are failures; what a model has to say otherwise is not wanted."""
    warnings.simplefilter("error")
    logging.disable(logging.CRITICAL)


def work(pipe: Connection) -> None:
    """What a process does: plays the scenes that it is sent, until it is sent None."""
    quiet()
    while (job := pipe.recv()) is not None:
        pipe.send(play(*job))


@dataclass
class Worker:
    """A process, our end of its pipe, the scene that it plays and until when it may."""

    process: Any
    pipe: Connection
    job: tuple[str, int, int, str | None] | None = None
    until: float = 0.0


def hire() -> Worker:
    """A new process."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=work, args=(there,), daemon=True)
    process.start()
    there.close()
    return Worker(process, here)


def outcomes(jobs: list[tuple[str, int, int, str | None]], many: int, seconds: float) -> Any:
    """Play all scenes in `many` processes; yields how each ended."""
    left, workers = jobs[::-1], [hire() for _ in range(min(many, len(jobs)))]
    while left or any(worker.job for worker in workers):
        for worker in workers:
            if worker.job is None and left:
                worker.job, worker.until = left.pop(), time.monotonic() + seconds
                worker.pipe.send(worker.job)
        busy = {worker.pipe: worker for worker in workers if worker.job}
        for ready in wait(list(busy), timeout=1.0):
            worker = busy[ready]
            try:
                yield worker.pipe.recv()
                worker.job = None
            except EOFError:
                yield lost(workers, worker, "the process died")
        for worker in workers:
            if worker.job and time.monotonic() > worker.until:
                worker.process.kill()
                yield lost(workers, worker, f"hang: more than {seconds:g} s")
    for worker in workers:
        worker.pipe.send(None)
        worker.process.join()


def lost(workers: list[Worker], worker: Worker, why: str) -> Outcome:
    """The outcome of the scene of a process that is no more; another process takes its place."""
    assert worker.job is not None
    workers[workers.index(worker)] = hire()
    kind, _, number, build = worker.job
    return Outcome(kind, number, failure=why, build=build or "")


# ---- the report


def table(found: list[Outcome]) -> str:
    """One line for each kind: scenes, cycles, how they ended."""
    kinds = [kind for kind in KINDS if any(one.kind == kind for one in found)]
    failures = sorted({one.failure for one in found if one.failure})
    heads = ["kind", "scenes", "cycles", "to the end", "error 15", "other errors", *failures]
    rows = [heads]
    for kind in [*kinds, "all"]:
        here = [one for one in found if kind in (one.kind, "all")]
        others = Counter(one.error for one in here if one.error not in (0, 15))
        rows.append(
            [
                kind,
                str(len(here)),
                str(sum(one.cycles for one in here)),
                str(sum(not one.failure and not one.error for one in here)),
                str(sum(one.error == 15 for one in here)),
                " ".join(f"{n}:{count}" for n, count in sorted(others.items())) or "-",
                *(str(sum(one.failure == name for one in here)) for name in failures),
            ]
        )
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)


def describe(one: Outcome, seed: int) -> str:
    """One line on a failure."""
    what = " ".join(one.detail.split("\n")[-2:] if "traceback" in one.failure else [one.detail])
    place = f"{one.kind} {one.number} of seed {seed} ({one.build}, D {one.d:.4g}, cycle {one.cycles}"
    return f"{one.failure}: {place}, {one.fastest:.2f} D a step): {what}"


def report(found: list[Outcome], seed: int) -> int:
    """Print what was found; returns the number of failures."""
    print(table(found))
    refused = sum((Counter(one.refused) for one in found), Counter[int]())
    print("errors by number: " + ", ".join(f"{n}: {many}" for n, many in sorted(refused.items())))
    stops = sorted(one.stopped for one in found if one.error == 15)
    if stops:
        print(f"least depth that error 15 stopped: {', '.join(f'{depth:.3f}' for depth in stops[:5])} D")
    classes: dict[str, list[Outcome]] = defaultdict(list)
    for one in found:
        if one.failure:
            classes[one.failure].append(one)
    for failures in classes.values():
        for one in failures:
            print(describe(one, seed))
        for one in sorted(failures, key=lambda one: len(one.snippet))[:SHOWN]:
            print(f"\n# {describe(one, seed)}\n{one.snippet}\n")
    return sum(map(len, classes.values()))


def main() -> int:
    """Search; the exit status is 1 if anything failed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100, help="scenes of each kind")
    parser.add_argument("--first", type=int, default=0, help="number of the first scene of each kind")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(SHAPES))
    parser.add_argument("--build", choices=SCHEMES, help="one word scheme, instead of all of them")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="that a scene may take")
    parser.add_argument("--play", type=int, help="play this scene of the first kind, and print it")
    parser.add_argument("--out", type=Path, help="append every failure to this file, as JSON")
    options = parser.parse_args()
    if options.play is not None:
        quiet()
        one = play(options.kinds[0], options.seed, options.play, options.build)
        print(f"# {describe(one, options.seed)}\n{one.snippet}" if one.failure else one)
        return int(bool(one.failure))
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    schemes = [options.build] if options.build else list(SCHEMES)
    for one in outcomes([(PILES[0], 0, 0, scheme) for scheme in schemes], 1, WARM):
        print(f"ready: {one.build}", flush=True)
    numbers = range(options.first, options.first + options.count)
    jobs = [(kind, options.seed, number, options.build) for number in numbers for kind in options.kinds]
    found, told = [], time.monotonic()
    for one in outcomes(jobs, options.jobs, options.seconds):
        found.append(one)
        if time.monotonic() > told + TELL:
            told = time.monotonic()
            print(f"{len(found)} of {len(jobs)} scenes", file=sys.stderr, flush=True)
        if one.failure:
            print(describe(one, options.seed), flush=True)
            if options.out:
                with options.out.open("a") as file:
                    file.write(json.dumps(asdict(one), default=float) + "\n")
    return int(report(found, options.seed) > 0)
