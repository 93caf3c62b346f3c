"""What every command costs, at models of growing size, and whether that grows with what it touches.

    python tools/bench.py commands                           with 1000, 10,000 and 100,000 blocks
    python tools/bench.py commands --blocks 1000 10000       with these
    python tools/bench.py commands PRINT PLOT --limit 60     commands whose names contain one of these words

A command finds its scene as it was. Times are processor times, the best of up to three turns; the first turn
at the least size, which may compile, does not count. The growth is the exponent between the last two sizes:
1 is in proportion to the size. What grows faster than size to the power of 1.2 is marked with `!`, and then
the exit status is 1. A command that is not done within the limit, or would not be at the next size, is left
out from there on.
"""

from __future__ import annotations

import argparse
import gc
import math
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import process_time
from types import FrameType
from typing import Any, NamedTuple

from speed.cycle_speed import FAR, slab

from udec_ia import Model
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.offsets import IBPNT, KXD, MFREE

ALL = (-FAR, FAR, -FAR, FAR)
STEEP = 1.2  # exponent of the growth that is marked
NOISE = 0.1  # s: a command that takes less is not marked
TURNS, LONG = 3, 1.0  # what takes longer (s) has one turn

Run = Callable[[Model, int], Any]


class Command(NamedTuple):
    """name: as in the table. scene: key of SCENES. run: what is timed; its number is that of blocks."""

    name: str
    scene: str
    run: Run
    before: Run | None = None


class TimeIsUpError(Exception):
    """A command has not ended within the limit."""


def empty(n: int) -> Model:
    """A model in which a material has its properties, and nothing else."""
    model = Model()
    model.start()
    model.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    return model


def cut(n: int) -> Model:
    """A slab of unit blocks, just cut, the lowest row fixed."""
    model = slab(n)
    model.property(1, bulk=1e9, g=6e8)
    model.fix(-FAR, FAR, 0, 1)
    return model


def cycled(n: int) -> Model:
    """The same after some cycles."""
    model = cut(n)
    model.cycle(5)
    return model


def soft(n: int) -> Model:
    """The same with simply-deformable blocks."""
    model = cut(n)
    model.change(*ALL, type="sdef")
    model.cycle(5)
    return model


def plate(n: int) -> Model:
    """A square block above a base, to be divided into n zones."""
    model, cells = empty(n), cells_of(n)
    model.round(0.1)
    model.block(0, -1, 0, cells, cells, cells, cells, -1)
    model.split(-1, 0, cells + 1, 0)
    model.fix(0, cells, -1, 0)
    return model


def zoned(n: int) -> Model:
    """The same block, divided."""
    model = plate(n)
    by_hand(model, n)
    model.cycle(5)
    return model


def loaded(n: int) -> Model:
    """The same with a condition on each of its grid-points."""
    model = zoned(n)
    model.boundary(*ALL, xforce=1.0)
    return model


def pair(n: int) -> Model:
    """Two blocks on each other."""
    model = empty(n)
    model.block(0, 0, 0, 2, 2, 2, 2, 0)
    model.split(-1, 1, 3, 1)
    model.fix(0, 2, 0, 1)
    return model


SCENES = {f.__name__: f for f in (empty, cut, cycled, soft, plate, zoned, loaded, pair)}


def cells_of(n: int) -> int:
    """Cells along a side of a square block with n zones, two a cell."""
    return round(math.sqrt(n / 2))


def by_hand(model: Model, n: int) -> None:
    """GENERATE MANUAL: two zones a cell."""
    cells = cells_of(n)
    row = cells + 1
    points = [(float(i), float(j)) for j in range(row) for i in range(row)]
    first = [j * row + i + 1 for j in range(cells) for i in range(cells)]
    zones = [zone for k in first for zone in ((k, k + row, k + 1), (k + 1, k + row, k + row + 1))]
    model.generate(0, cells, 0, cells, "manual", gridpoints=points, zones=zones)


def saw(model: Model, n: int) -> None:
    """BLOCK with n corners."""
    teeth = [xy for i in range(n - 2) for xy in (i, 10 + i % 2)]
    model.block(0, 0, *teeth, n - 3, 0)


def lines(model: Model, n: int) -> None:
    """A slab cut line by line: SPLIT."""
    ny = round(math.sqrt(n / 1.2))
    nx = round(n / ny)
    model.block(0, 0, 0, ny, nx, ny, nx, 0)
    for j in range(1, ny):
        model.split(-1, j, nx + 1, j)
    for i in range(1, nx):
        model.split(i, -1, i, ny + 1)


def draw(**words: Any) -> Run:
    """PLOT 0, or with displacements PLOT 1 over it, and the files."""

    def plot(model: Model, n: int) -> None:
        model.plot(0, **words)
        if "displacements" in words:
            model.plot(1, **words)
        model.stop()

    return plot


def patch(model: Model, n: int) -> None:
    """RSET of a velocity, and a command, before which the heap is proved sound."""
    model.rset(0.0, int(model.h.ci[IBPNT]), KXD[1])
    model.fix(*ALL)


def short_cycles(model: Model, n: int) -> None:
    """Many CYCLEs of ten cycles: n numbers in all."""
    for _ in range(n // 10):
        model.cycle(10)


def numbers(count: int) -> str:
    """Continuation lines with two numbers each."""
    return "".join(f"+ {k} {k % 7}\n" for k in range(1, count))


def deck(text: str) -> Run:
    """Lines of a deck."""
    return lambda model, n: model.run(text)


def call(name: str, *numbers: Any, **words: Any) -> Run:
    """The method of Model for a command."""
    return lambda model, n: getattr(model, name)(*numbers, **words)


COMMANDS = (
    Command("BLOCK", "empty", saw),
    Command("SPLIT, all lines", "empty", lines),
    Command("SPLIT, one line", "cut", call("split", -1, 3.5, 4.5, 3.5)),
    Command("SPLIT, one line in a run", "cycled", call("split", -1, 3.5, 4.5, 3.5)),
    Command("DELETE half", "cut", call("delete", -FAR, FAR, 5.2, FAR)),
    Command("DELETE half in a run", "cycled", call("delete", -FAR, FAR, 5.2, FAR)),
    Command("DELETE one", "cycled", call("delete", 4, 5, 4, 5)),
    Command("FIX", "cycled", call("fix", *ALL)),
    Command("FREE", "cycled", call("free", *ALL)),
    Command("FIX SDEF", "soft", call("fix", *ALL)),
    Command("FREE with conditions", "cycled", call("free", *ALL), call("boundary", *ALL, yvel=0.0)),
    Command("CHANGE material", "cycled", call("change", *ALL, material=2)),
    Command("CHANGE to SDEF", "cut", call("change", *ALL, type="sdef")),
    Command("CHANGE to SDEF in a run", "cycled", call("change", *ALL, type="sdef")),
    Command("CHANGE to FDEF", "cut", call("change", *ALL, type="fdef")),
    Command("CHANGE zones to RIGID", "zoned", call("change", *ALL, type="rigid")),
    Command("GENERATE MANUAL", "plate", by_hand),
    Command("GENERATE AUTOMATIC", "plate", lambda m, n: m.generate(*ALL[:2], 0, FAR, "automatic", edge=1.0)),
    Command("INSITU SDEF", "soft", call("insitu", *ALL, -1e6, 0, -1e6)),
    Command("INSITU zones", "zoned", call("insitu", *ALL, -1e6, 0, -1e6)),
    Command("BOUNDARY velocities", "cycled", call("boundary", *ALL, yvel=0.0)),
    Command("BOUNDARY again", "cycled", call("boundary", *ALL, yvel=0.0), call("boundary", *ALL, yvel=0.0)),
    Command("BOUNDARY stress", "cycled", call("boundary", *ALL, stress=(-1e3, 0, -1e3))),
    Command("BOUNDARY VISCOUS", "cycled", call("boundary", *ALL, viscous=True)),
    Command("BOUNDARY on grid-points", "zoned", call("boundary", *ALL, yvel=0.0)),
    Command("BOUNDARY again there", "loaded", call("boundary", *ALL, yvel=0.0)),
    Command("BOUNDARY FREE", "loaded", call("boundary", *ALL, free=True)),
    Command("FUNCTION", "empty", lambda m, n: m.function(1, *(v for k in range(n) for v in (k, k % 7)))),
    Command("FUNCTION in a deck", "empty", lambda m, n: m.run(f"FUNCTION 1 0 0\n{numbers(n)}")),
    Command("a deck of n lines", "empty", lambda m, n: m.run("GRAVITY 0 -10\n" * n)),
    Command("HISTORY", "cycled", call("history", 1, "KYD", at=(4, 4))),
    Command("HISTORY of a contact", "cycled", call("history", 1, "KCFN", at=(4, 4))),
    Command("ROUND", "cycled", call("round", 0.04)),
    Command("PROPERTY", "cycled", call("property", 1, density=2100)),
    Command("RSET and a FIX", "cycled", patch),
    Command("ENERGY ON", "cycled", call("energy", "on")),
    Command("CYCLE 0, first", "cut", call("cycle", 0)),
    Command("CYCLE 0", "cycled", call("cycle", 0)),
    Command("CYCLE 1", "cycled", call("cycle", 1)),
    Command("CYCLE 1 in a deck", "cycled", deck("CYCLE 1")),
    Command("CYCLE 1, SDEF, in a deck", "soft", deck("CYCLE 1")),
    Command("CYCLE 1, zones, in a deck", "zoned", deck("CYCLE 1")),
    Command("CYCLE 1 with conditions", "loaded", call("cycle", 1)),
    Command("SOLVE, no cycle", "cycled", call("solve", 0.0, 0)),
    Command("CYCLE 10, n/10 times, HISTORY", "pair", short_cycles, call("history", 1, "KYD", at=(1, 1.5))),
    Command("PRINT BLOCKS", "cycled", call("print", "blocks")),
    Command("PRINT CONTACTS", "cycled", call("print", "contacts")),
    Command("PRINT CORNERS", "cycled", call("print", "corners")),
    Command("PRINT DOMAINS", "cycled", call("print", "domains")),
    Command("PRINT LIST", "cycled", call("print", "list")),
    Command("PRINT DLIST", "cycled", call("print", "dlist")),
    Command("PRINT BLOCKS, SDEF", "soft", call("print", "blocks")),
    Command("PRINT GRIDPOINTS", "zoned", call("print", "gridpoints")),
    Command("PRINT ZONES", "zoned", call("print", "zones")),
    Command("PRINT BOUNDARIES", "loaded", call("print", "boundaries")),
    Command("DUMP", "cycled", lambda m, n: m.dump(1, int(m.h.ci[MFREE]) - 1)),
    Command("DUMP of one group", "cycled", call("dump", 1, 20)),
    Command("PLOT", "cycled", draw()),
    Command("PLOT CONTACTS", "cycled", draw(contacts=True)),
    Command("PLOT DOMAINS", "cycled", draw(domains=True)),
    Command("PLOT ADDRESSES", "cycled", draw(addresses=True)),
    Command("PLOT STRESSES", "soft", draw(stresses=True)),
    Command("PLOT VELOCITIES", "cycled", draw(velocities=True)),
    Command("PLOT DISPLACEMENTS", "cycled", draw(displacements=True)),
    Command("PLOT S22", "zoned", draw(contour="s22")),
    Command("PLOT VELOCITIES, zones", "zoned", draw(velocities=True)),
    Command("SAVE", "cycled", call("save")),
    Command("RESTART", "cycled", call("restart"), call("save")),
    Command("check", "cycled", call("check")),
    Command("STOP", "cycled", call("stop")),
    Command("table of contacts", "cycled", call("table", "contact")),
    Command("table of zones", "zoned", call("table", "zone")),
)


def prepared(scene: MainArray, folder: Path) -> Model:
    """A model of its own in the state of the scene."""
    model = Model(out=folder)
    model.session.array = scene.copy()
    model.session.started = True
    return model


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """TimeIsUpError when the processor has worked for so long."""

    def stop(signum: int, frame: FrameType | None) -> None:
        raise TimeIsUpError

    signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def measure(command: Command, scene: MainArray, n: int, limit: float, warm: bool) -> float:
    """Processor time in s; infinite if the command is not done within the limit."""
    best, turn = math.inf, 0
    while turn < TURNS:
        with tempfile.TemporaryDirectory() as folder:
            model = prepared(scene, Path(folder))
            if command.before is not None:
                command.before(model, n)
            gc.collect()
            start = process_time()
            try:
                with limited(limit):
                    command.run(model, n)
            except TimeIsUpError:
                return math.inf
            seconds = process_time() - start
        if turn or warm:
            best = min(best, seconds)
        turn += TURNS if best > LONG and best < math.inf else 1
    return best


def growth(sizes: list[int], times: list[float]) -> float:
    """Exponent between the last two sizes; infinite where the limit was met, nan if too quick to tell."""
    if math.inf in times:
        return math.inf
    if len(times) < 2 or times[-1] < NOISE:
        return math.nan
    return math.log(times[-1] / max(times[-2], NOISE / 100)) / math.log(sizes[-1] / sizes[-2])


def row(name: str, sizes: list[int], times: list[float]) -> str:
    """A line of the table."""
    cells = [f"{t:.3g}" if t < 10 else f"{t:.0f}" if t < math.inf else "no end" for t in times]
    cells += ["-"] * (len(sizes) - len(times))
    done = [(t, n) for t, n in zip(times, sizes, strict=False) if t < math.inf]
    each = f"{done[-1][0] / done[-1][1] * 1e6:.3g}" if done else "-"
    how = growth(sizes, times)
    mark = "-" if math.isnan(how) else f"{how:.2f}{' !' if how > STEEP else ''}"
    return f"| {name} | {' | '.join(cells)} | {each} | {mark} |"


def main() -> int:
    """The table; 1 if a command is not in proportion to the size."""
    parser = argparse.ArgumentParser(description="Measure what every command costs.")
    parser.add_argument("words", nargs="*", help="only commands with one of these words in their names")
    parser.add_argument("--blocks", type=int, nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--limit", type=float, default=60.0, help="s that a command may take")
    args = parser.parse_args()
    sizes = sorted(args.blocks)
    chosen = [one for one in COMMANDS if not args.words or any(word in one.name for word in args.words)]
    times: dict[str, list[float]] = {one.name: [] for one in chosen}
    for n in sizes:
        for scene in dict.fromkeys(one.scene for one in chosen):
            kept = None
            for one in (one for one in chosen if one.scene == scene):
                if math.inf in times[one.name]:
                    continue
                kept = SCENES[scene](n).array if kept is None else kept
                times[one.name].append(measure(one, kept, n, args.limit, n > sizes[0]))
                print(f"{n} {one.name}: {times[one.name][-1]:.3g} s", file=sys.stderr, flush=True)
    print(f"| command | {' | '.join(f'{n}, s' for n in sizes)} | us each | growth |")
    print("|---" * (len(sizes) + 3) + "|")
    for name, found in times.items():
        print(row(name, sizes, found))
    return any(growth(sizes, found) > STEEP for found in times.values())
