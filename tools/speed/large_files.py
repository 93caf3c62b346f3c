"""What the restart-file tools, SAVE and RESTART cost, at models of growing size.

    python tools/bench.py scale                                 with 1000, 10,000 and 100,000 blocks
    python tools/bench.py scale --blocks 1000000                with these
    python tools/bench.py scale check diff --blocks 100000      these commands alone

Each command is a process of its own, as a user starts it, of modules that were compiled to bytecode before,
and of kernels that were compiled. Times are processor times of the whole process, the least of some turns;
start-up is what it takes with four blocks. Memory is the most that the process has held; what it costs is
how much more that is than with ten thousand blocks, which load the same code, over how much larger the files
are that it reads, or the one that it writes, if that is larger. SAVE is a deck that reads the file and writes
it, less one that reads it. The exit status is 1 if a limit is missed: MEMORY, and of time LIMITS.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

TOOL = str(Path(__file__).parents[1] / "bench.py")
FEW, SMALL = (
    4,
    10_000,
)  # blocks of a model that takes no time; of one that takes the code that a large one does
TURNS = 3
MEMORY = 3.0  # bytes for each byte of the file
LIMITS = {"check": 2.0}  # s for 100,000 blocks, and ten times as much for ten times as many
LIMIT, BLOCKS = 3.0, 100_000
RESTART = "RESTART"
A, B = "a.h5", "b.h5"  # a state, and one of some cycles later, of the same blocks
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
COMMANDS = {
    "info": ["info", A],
    "what": ["what", A, "1"],
    "who": ["who", A, "1"],
    "walk": ["walk", A, "block", "--limit", "20"],
    "junk": ["junk", A],
    "map": ["map", A],
    "map --out": ["map", A, "--out", "map.png"],
    "graph": ["graph", A, "1"],
    "find": ["find", A, "contact where KCFN > 0 and KCCOD == CORNER_CORNER", "--limit", "20"],
    "find --value": ["find", A, "--value", "2000", "--limit", "20"],
    "find --points-to": ["find", A, "--points-to", "1"],
    "dump of a part": ["dump", A, "1/2000"],
    "dump": ["dump", A],
    "dump --raw": ["dump", A, "--raw"],
    "check": ["check", A],
    "diff": ["diff", A, B],
    "diff --raw": ["diff", A, B, "--raw"],
    "convert": ["convert", A, "to.h5", "--build", "i64r64"],
    "convert, narrower": ["convert", A, "to.h5", "--build", "i32r32"],
    "renumber": ["renumber", A, "to.h5"],
    "patch": ["patch", A, "to.h5", "GRAVY = -9"],
    RESTART: ["run", "restart.dat"],
    "SAVE": ["run", "save.dat"],
}
DECKS = {"restart.dat": f"RESTART {A}\nSTOP\n", "save.dat": f"RESTART {A}\nSAVE to.h5\nSTOP\n"}


class Cost(NamedTuple):
    """Of a process: processor time in s, and in bytes the most memory that it has held, and its files."""

    seconds: float
    memory: int
    files: int = 0


def make(blocks: int) -> None:
    """Write the two states. Done in a process of its own: the memory of this one counts for its children."""
    from speed.cycle_speed import FAR, slab

    model = slab(blocks)
    model.fix(-FAR, FAR, 0, 1)
    model.cycle(20)
    model.save(A)
    model.cycle(5)
    model.save(B)


def spawned(command: list[str]) -> Cost:
    """Run a command to its end. RuntimeError if it ends in trouble; 1 is that something differs."""
    with open("printed.txt", "wb") as printed:
        actions = [(os.POSIX_SPAWN_DUP2, printed.fileno(), 1), (os.POSIX_SPAWN_DUP2, printed.fileno(), 2)]
        process = os.posix_spawn(
            sys.executable, [sys.executable, *command], ENVIRONMENT, file_actions=actions
        )
        _, status, usage = os.wait4(process, 0)
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        raise RuntimeError(f"{command}: {Path('printed.txt').read_text()[-2000:]}")
    return Cost(usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024)


def cost(command: str, turns: int) -> Cost:
    """The least of some turns."""
    costs = []
    for _ in range(turns):
        Path("to.h5").unlink(missing_ok=True)
        costs.append(spawned(["-m", "udec_ia", *COMMANDS[command]]))
    read = Path(A).stat().st_size * len({A, B} & {*COMMANDS[command]} or {A})
    written = Path("to.h5").stat().st_size if Path("to.h5").exists() else 0
    return Cost(min(one.seconds for one in costs), min(one.memory for one in costs), max(read, written))


def measure(blocks: int, chosen: list[str], turns: int) -> dict[str, Cost]:
    """The commands at a model of about so many blocks, in this folder."""
    spawned([TOOL, "scale", "--make", str(blocks)])
    for name, text in DECKS.items():
        Path(name).write_text(text)
    return {command: cost(command, turns) for command in chosen}


def row(
    blocks: int, command: str, costs: dict[str, Cost], small: dict[str, Cost], begin: float
) -> tuple[str, bool]:
    """A line of the table, and whether a limit is missed. begin: time with four blocks."""
    size, here, less = Path(A).stat().st_size, costs[command], small[command]
    seconds, times = here.seconds, (here.memory - less.memory) / max(here.files - less.files, 1)
    if command == "SAVE":
        seconds, begin = seconds - costs[RESTART].seconds, 0.0
    limit = LIMITS.get(command, LIMIT) * max(blocks / BLOCKS, 1)
    missed = (seconds > limit, blocks >= BLOCKS and times > MEMORY)
    cells = (
        f"{command} | {seconds:.2f}{' !' * missed[0]} | {begin:.2f} | "
        f"{here.memory / 1e6:.0f} | {max(times, 0):.1f}{' !' * missed[1]}"
    )
    return f"| {blocks} | {size / 1e6:.1f} | {cells} |", any(missed)


def main() -> int:
    """The table; 1 if a limit is missed."""
    parser = argparse.ArgumentParser(
        description="Measure restart-file tools, SAVE and RESTART at large models."
    )
    parser.add_argument("commands", nargs="*", help=f"any of: {', '.join(COMMANDS)}; all if left off")
    parser.add_argument("--blocks", type=int, nargs="+", default=[1000, 10_000, 100_000])
    parser.add_argument("--turns", type=int, default=TURNS)
    parser.add_argument("--make", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.make:
        make(options.make)
        return 0
    chosen = options.commands or [*COMMANDS]
    if unknown := {*chosen} - {*COMMANDS}:
        parser.error(f"{', '.join(unknown)}: choose from {', '.join(COMMANDS)}")
    if "SAVE" in chosen and RESTART not in chosen:
        chosen = [RESTART, *chosen]
    missed = False
    print("| blocks | file, MB | command | s | of that start-up | peak, MB | bytes a byte of the files |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        start, small = (measure(blocks, chosen, options.turns) for blocks in (FEW, SMALL))
        for blocks in options.blocks:
            costs = measure(blocks, chosen, options.turns)
            for command in chosen:
                line, bad = row(blocks, command, costs, small, start[command].seconds)
                print(line, flush=True)
                missed = missed or bad
    return 1 if missed else 0
