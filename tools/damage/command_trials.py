"""Damaged restart files given to every command that reads one: each must end in a result or in a message.

    python tools/damaged_files.py commands --files 1000 --seed 1
    python tools/damaged_files.py commands --files 1000 --only check diff      these commands alone

A file holds groups of every kind, in one of the five word schemes, and is damaged in one of three ways:

    words    some words of IA() and of the common block are others, and the file is sealed again
    bytes    some bytes of the file are others
    HDF5     the file is edited through HDF5 or in its bytes, and sealed again (hostile_files.py)

Each goes through all commands, as on the command line but in one process, which may take little memory and
time. A command must end with the status 0, 1 or 2; say something, in lines that can be printed; leave the
file as it is, and nothing half-written. Case k of seed s is always the same. The exit status is 1 if
anything failed.
"""

from __future__ import annotations

import argparse
import io
import logging
import os
import signal
import tempfile
import time
import traceback
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import numpy as np
from case_processes import CaseRow, limit_memory, peak_memory, print_rows, run_batch
from damage.changed_words import every_kind
from damage.hostile_files import SECRET, hostile
from damage.storage_edits import one

from udec_ia import cli
from udec_ia.compiling.compile_duration import working_time
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.word_map import KINDS
from udec_ia.restart import info, load, save

TOOL = Path(__file__).parents[1] / "damaged_files.py"
BATCH = 1000  # cases to a process
MEMORY = 64 * 2**20  # bytes that a command may take; a picture takes as much by itself
TIMES = 3  # as much as the damaged file, if that is more
SECONDS = 5.0  # of the processor for one command
MOMENT = 0.1  # seconds of compiling that count
PICTURES = 0.02  # share of the files of which pictures and pages are made, which takes long
LONGEST = 5000  # characters of a line
TABLE = read_table()
HEADS = [getattr(g, field.name) for field in TABLE.common if field.target] + [g.JUNK]
NUMBERS = [getattr(g, field.name) for field in TABLE.common if field.type == "int" and field.count == 1]
FIELDS = [(group.name, field.name) for group in TABLE.groups for field in group.fields]
Rng = np.random.Generator


class TimeIsUpError(BaseException):
    """A command has not ended in time."""


# ---- what is done to a file


def spoil(array: MainArray, rng: Rng) -> None:
    """Change some words: pointers, counts, reals, heads of lists, and at times MFREE and other integers."""
    h, used = array.h, int(array.h.ci[g.MFREE]) - 1
    top = int(np.iinfo(h.ia.dtype).max)
    for _ in range(int(rng.integers(0, 4) if rng.random() < 0.5 else rng.integers(0, 40))):
        at, other = int(rng.integers(used)), int(rng.integers(1, used))
        was, its = int(h.ia[at]), int(h.ia[other])
        h.ia[at] = rng.choice([0, 1, -1, other, its, min(-was, top), max(was - 1, -top), top, -top - 1])
    for _ in range(int(rng.integers(0, 4))):
        h.ra[int(rng.integers(used // array.scheme.ratio))] = rng.choice(
            [np.nan, np.inf, -np.inf, -1e30, 1e-30, 1e12, 0.0]
        )
    if rng.random() < 0.3:
        h.ci[rng.choice(HEADS)] = rng.choice([0, -1, 1, int(rng.integers(used)), 10**9])
    if rng.random() < 0.2:
        h.ci[rng.choice(NUMBERS)] = rng.choice([0, -1, 7, 10**9, 2**62, -(2**63)])
    if rng.random() < 0.1:
        h.ci[g.MFREE] = rng.choice([1, used // 2, used, used + 2, int(h.ci[g.MTOP]) + 1])
    if rng.random() < 0.1:
        h.cr[rng.integers(len(h.cr))] = rng.choice([np.nan, np.inf, -1.0, 1e30, 0.0])


def damage_file(rng: Rng, sound: Path, into: Path, secret: Path) -> str:
    """Write a damaged copy of a file; returns what was done."""
    what = int(rng.integers(5))
    into.unlink(missing_ok=True)
    if what < 3:
        state = load(sound)
        spoil(state.array, rng)
        mark = ["marked"] if rng.random() < 0.3 else []
        with suppress(OverflowError):  # a number that its words cannot hold cannot be in a file
            save(state.array, into, state.deck, state.laws, state.series, mark)
            return "words"
    image = sound.read_bytes()
    if what == 3:
        body = bytearray(image)
        for _ in range(int(rng.integers(1, 6))):
            body[int(rng.integers(len(body)))] ^= 1 << int(rng.integers(8))
        into.write_bytes(bytes(body[: int(rng.integers(len(body)))] if rng.random() < 0.2 else body))
        return "bytes"
    into.write_bytes(hostile(rng, image, secret)[1])
    return "HDF5"


# ---- the commands


def looks(rng: Rng, bad: str) -> Iterator[list[str]]:
    """Every look into a file, in one of its ways, at words chosen at random."""
    a, kind = str(int(rng.integers(-2, 4000))), one(rng, KINDS)
    of, field = one(rng, FIELDS)
    yield ["info", bad]
    yield ["check", bad]
    part = one(rng, [[], [], ["common"], [a], [f"{a}/200"], ["1-300"]])
    yield ["dump", bad, *part, *one(rng, [["--radix", "16"], ["--raw"], []])]
    yield ["what", bad, a]
    yield ["who", bad, a]
    along = one(rng, ["block", "contact", "domain", "bound", "signal", "history"])
    yield ["walk", bad, *one(rng, [[along], [one(rng, ["block", "domain", "KR", "KG", "KZ", field]), a]])]
    yield ["junk", bad, "--json"]
    yield ["map", bad]
    yield ["graph", bad, a, "--depth", "2"]
    yield ["telescope", bad, a, "-n", "4"]
    wanted = [
        [f"{of} where {field} > 0 and address / 2 < {abs(int(a))}"],
        [f"{kind} where not abs(address) == 3", "--limit", "50"],
        ["corner where KL.KXP > KNB.KP.KXP or KNB.KBEX.KFG.KXG < 1"],
        ["--value", one(rng, ["0", "1", "nan", "1e300"]), "--limit", "50"],
        ["--points-to", a],
    ]
    yield ["find", bad, *one(rng, wanted)]


def pictures(rng: Rng, bad: str) -> Iterator[list[str]]:
    """What draws, or writes a page."""
    a = str(int(rng.integers(1, 3000)))
    yield ["map", bad, "--out", "map.png"]
    yield ["graph", bad, a, "--out", "graph.dot"]
    yield ["view", bad, "--out", "page.html"]


def changes(rng: Rng, bad: str, good: str) -> Iterator[list[str]]:
    """Comparisons, and all that makes another file."""
    force = ["--force"] if rng.random() < 0.5 else []
    of, field = one(rng, FIELDS)
    a, value = int(rng.integers(1, 3000)), one(rng, ["0", "1", "-1", "1e30", "nan", "412"])
    what = one(rng, [f"{of}@{a}.{field}", "FRAC", "MFREE", "IBPNT", "JUNK", str(a)])
    yield ["diff", *one(rng, [[bad, good], [good, bad], [bad, good, "--raw"]])]
    yield ["convert", bad, "to.h5", "--build", one(rng, [*ALL_SCHEMES]), *force]
    yield ["renumber", bad, "to.h5"]
    yield ["patch", bad, "to.h5", f"{what} = {value}", *force]
    yield ["diverge", bad, good, "--cycles", "2", "--tolerance", "1"]


def runs(rng: Rng, bad: str) -> Iterator[list[str]]:
    """Decks that go on from it."""
    rest = ["PRINT BLOCKS", "PRINT HISTORIES", "CYCLE 2", "FIX -9 9 -9 9", "DELETE 2 3 0 1", "SAVE on.h5"]
    text = "".join(f"{line}\n" for line in rng.permutation(rest))
    for name, lines in (("restart", f"RESTART {bad}\n{text}"), ("force", f"RESTART {bad} FORCE\n{text}")):
        Path(f"{name}.dat").write_text(lines)
        yield ["run", f"{name}.dat"]
    looks = "goto 3\ncheck\njunk\nwalk block\nwatch IBPNT.KP.KXP\nbreak unsound\nreverse-step\nwrites IBPNT\n"
    Path("looks.txt").write_text(f"{looks}record run.udecrec\ncontinue\nquit\n")
    yield ["debug", one(rng, ["restart.dat", "force.dat"]), "--commands", "looks.txt"]


class Ended(NamedTuple):
    """How a command ended. status: its exit status, as text; wrong: what failed."""

    status: str
    wrong: list[str]


def obey(command: list[str], memory: int) -> Ended:
    """Run a command line here, within its time and so many bytes. What compiles a kernel is allowed any."""
    out, err = io.StringIO(), io.StringIO()
    peak_memory()
    before, clock, waited = peak_memory(), time.process_time(), compiled()
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    wrong: list[str] = []
    status: Any = ""
    try:
        with redirect_stdout(out), redirect_stderr(err):
            status = cli.main(command)
    except SystemExit as left:
        status = left.code
    except BaseException as failure:
        wrong.append("".join(traceback.format_exception(failure)[-6:]))
    signal.setitimer(signal.ITIMER_PROF, 0)
    used, took = peak_memory() - before, time.process_time() - clock
    warmed = compiled() - waited > MOMENT
    output = out.getvalue() + err.getvalue()
    if not wrong and status not in (0, 1, 2):
        wrong.append(f"the status {status}: {output[-300:]}")
    if took > SECONDS and not warmed:
        wrong.append(f"{took:.1f} s")
    if used > memory and not warmed:
        wrong.append(f"{used / 2**20:.0f} MB of memory")
    if not output:
        wrong.append("nothing was printed")
    if not all(line.isprintable() for line in output.splitlines()) or "Traceback" in output:
        wrong.append(
            f"output {[line for line in output.splitlines() if not line.isprintable()][:2]}, {output[-300:]}"
        )
    if any(len(line) > LONGEST for line in err.getvalue().splitlines()):
        wrong.append(f"a line of {max(map(len, err.getvalue().splitlines()))} characters")
    return Ended(str(status), wrong)


def compiled() -> float:
    """Seconds that this process has compiled kernels for."""
    return time.monotonic() - working_time()


def clear(bad: Path, kept: bytes) -> list[str]:
    """Take away what a command has written. What is wrong with that."""
    wrong = [] if bad.read_bytes() == kept else ["the file itself was changed"]
    for path in Path().iterdir():
        if path.suffix == ".h5" and path != bad and not path.stem.endswith("-history"):
            try:
                info(path)
            except Exception as error:
                wrong.append(f"{path} cannot be read: {error}")
        if path.suffix not in (".dat", ".txt") and path != bad:
            path.unlink()
    return wrong


def cases(seed: int, first: int, last: int, sound: Path, only: list[str]) -> Iterator[CaseRow]:
    """The cases from `first` to before `last`; their labels are damage and command."""
    warnings.simplefilter("ignore")
    parser = cli.arguments()
    cli.arguments = lambda: parser  # to make it takes longer than most commands
    logging.disable(logging.CRITICAL)
    outside = sound / "outside"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        warm(sound, only)
        limit_time()
        limit_memory()
        for case in range(first, last):
            rng = np.random.default_rng([seed, case])
            good, bad = sound / f"{list(ALL_SCHEMES)[case % 5]}.h5", Path("bad.h5")
            what = damage_file(rng, good, bad, outside / "secret")
            kept = bad.read_bytes()
            given = [*looks(rng, "bad.h5"), *changes(rng, "bad.h5", str(good)), *runs(rng, "bad.h5")]
            if rng.random() < PICTURES:
                given += pictures(rng, "bad.h5")
            for command in given:
                if only and command[0] not in only:
                    continue
                yield CaseRow(case, [what, command], "", [])
                ended = obey(command, max(MEMORY, TIMES * len(kept)))
                yield CaseRow(case, [what, command], ended.status, ended.wrong + clear(bad, kept))


def warm(sound: Path, only: list[str]) -> None:
    """Have all that commands need loaded, so that it does not count."""
    for build in ALL_SCHEMES:
        rng, good = np.random.default_rng(0), str(sound / f"{build}.h5")
        for command in (*looks(rng, good), *changes(rng, good, good), *runs(rng, good), *pictures(rng, good)):
            if not only or command[0] in only:
                with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
                    cli.main(command)
    for path in Path().iterdir():
        path.unlink()


def limit_time() -> None:
    """Limit the time of each command of this process."""

    known = 0.0

    def stop(signum: int, frame: FrameType | None) -> None:
        nonlocal known
        if compiled() - known > MOMENT:  # a command that has to wait for that may begin anew
            known = compiled()
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
        else:
            raise TimeIsUpError

    signal.signal(signal.SIGPROF, stop)


def main() -> int:
    """Give damaged files to all commands and say how each ended; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--files", type=int, default=1000, help="number of files")
    parser.add_argument("--first", type=int, default=0, help="the first case")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", default=[], help="commands to be tried")
    parser.add_argument("--work", nargs=2, type=int, help=argparse.SUPPRESS)
    parser.add_argument("--sound", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work:
        print_rows(cases(options.seed, *options.work, options.sound, options.only))
        return 0
    ends: dict[str, Counter[str]] = defaultdict(Counter)
    failed: list[str] = []
    damage: dict[str, set[int]] = defaultdict(set)

    def report(row: CaseRow) -> None:
        what, command = row.label or ("", [])
        damage[what].add(row.case)
        if row.ended:
            ends[command[0]][row.ended] += 1
        for fault in row.faults:
            failed.append(
                f"case {row.case} of seed {options.seed}, {what}, udec {' '.join(command)}: {fault}"
            )
            print(f"FAILED {failed[-1]}", flush=True)

    with tempfile.TemporaryDirectory() as name:
        sound = Path(name)
        (sound / "outside").mkdir()
        (sound / "outside" / "secret").write_bytes(SECRET)
        for build in ALL_SCHEMES:
            model = every_kind(build, sound)
            model.change(4, 5, 0, 1, type="rigid")  # as it has no zones, it could not be cycled
            model.cycle(3)
            laws = {"cl2": ("law.py", "0" * 64)}
            save(model.array, sound / f"{build}.h5", model.session.log.lines, laws, model.histories())
        arguments = ["--seed", str(options.seed), "--sound", name]
        arguments += ["--only", *options.only] if options.only else []
        case, last = options.first, options.first + options.files
        while case < last:
            end = min(case + BATCH, last)
            work = [str(TOOL), "commands", "--work", str(case), str(end)]
            case = run_batch([*work, *arguments], case, end, report)
    print(", ".join(f"{what}: {len(these)} files" for what, these in sorted(damage.items())))
    for command, counts in sorted(ends.items()):
        print(f"{command:10}" + "".join(f"{counts[status]:7} with status {status}" for status in "012"))
    print(f"{sum(sum(counts.values()) for counts in ends.values())} commands, {len(failed)} failures")
    return 1 if failed else 0
