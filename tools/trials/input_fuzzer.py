"""Fuzzing: random and mutated decks, and mutated restart files, must end in a result or in a numbered error.

    python tools/robustness.py fuzz --decks 20000 --files 20000 --seconds 600 --seed 1

Any other exception, a crash, a hang, or an unsound heap is a failure. After a file with mad numbers in it
only the links of the heap need to be sound; an RSET may of course damage all of it. Case k of seed s is
always the same. Cases run in processes of their own, a few hundred to each, so that a crash costs one case;
failures are printed with the case's number, and `--show decks 17 --seed 1` prints case 17. The exit status
is 1 if anything failed.
"""

from __future__ import annotations

import argparse
import io
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from case_processes import CaseRow, print_rows, run_batch

from udec_ia.checker import Violation, check, check_links
from udec_ia.deck.command_forms import required
from udec_ia.deck.command_monitor import RESTART_FILE, Monitor
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import Statement, statements
from udec_ia.errors import MESSAGES, UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME
from udec_ia.layout.offsets import MFREE
from udec_ia.model import Model
from udec_ia.ops.commands.corner_rounding import STRAINED
from udec_ia.output.plot_frames import Plots
from udec_ia.restart import save
from udec_ia.restart.file_seal import SIZE, seal
from udec_ia.running.solve_result import Solution

TOOL = Path(__file__).parents[1] / "robustness.py"
BATCH = 250  # cases to a process
UNEXPECTED = "-1"  # how a case ends that fails
MAX_CYCLES = 20
MAX_COMMANDS = 40
Rng = np.random.Generator

NUMBERS = [
    *(
        "0",
        "-0",
        "1",
        "-1",
        "2",
        "3",
        "5",
        "10",
        "0.5",
        ".5",
        "5.",
        "+3",
        "--3",
        "1E-3",
        "1.E08",
        "1d5",
        "1e",
    ),
    *("1e308", "-1e308", "1e-320", "1e400", "nan", "inf", "-inf", "999999999999999999999", "1.2.3", "0x10"),
    *("1e20", "1e37", "-3e38", "1e-40", "1e-20", "1e150", "-1e200", "1e-160"),
    *("2147483647", "-2147483648", "32768", "12abc", "\u00bd", "\u0663"),
]
REALS = [0.0, 1.0, -1.0, 1e-30, 1e30, np.nan, np.inf, -np.inf]
START = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E9 G=6E8
PROP MAT=2 DENS=1000 KN=2E8 KS=1E8 F=0 BULK=2E8 G=1E8
BLOCK 0,0 0,4 6,4 6,0
SPLIT -1 1 7 1
SPLIT -1 2 7 2
SPLIT 2 1 2 4
SPLIT 4 1 4 4
FIX 0 6 0 1
GRAVITY 0 -10""".splitlines()
SOFT = """CHANGE 0 6 2 4 SDEF
CHANGE 0 2 1 2 FDEF
GENERATE 0 2 1 2 MANUAL GRIDPOINTS 1,1.5 0,2 0,1 2,1 2,2 ZONES 1,2,5 2,3,5 3,4,5 4,1,5
BOUNDARY -1 0.1 0 5 XVEL=0""".splitlines()


class Tame(Model):
    """A model that cycles a little only, and keeps its files in its folder and its pictures to itself."""

    damaged = False  # an RSET was obeyed

    def __init__(self, build: str, mtop: int | None, out: Path) -> None:
        super().__init__(build, mtop, out)
        self._plots = Unseen(self.out, self.name)

    def cycle(self, n: int) -> int:
        return super().cycle(min(n, MAX_CYCLES))

    def solve(self, ratio: float, limit: int = MAX_CYCLES, **named: Any) -> Solution:
        return super().solve(ratio, min(limit, MAX_CYCLES), **named)

    def save(self, path: str | Path | None = None, *, force: bool = False) -> Path:
        return super().save(None, force=force)

    def restart(
        self, path: str | Path | None = None, *, force: bool = False, unchecked: bool = False
    ) -> None:
        super().restart(None, force=force, unchecked=unchecked)
        self.damaged |= force

    def rset(self, v: float, ia: int, ioff: int) -> None:
        super().rset(v, ia, ioff)
        self.damaged = True


class Unseen(Plots):
    """Pictures that are taken but not drawn."""

    def close(self) -> list[Path]:
        self.frame = None
        return []


# ---- decks


def number(rng: Rng) -> str:
    """A number: mostly one that fits the block of START, now and then anything."""
    if rng.random() < 0.1:
        return str(rng.choice(NUMBERS))
    return f"{rng.integers(-1, 8)}" if rng.random() < 0.5 else f"{rng.uniform(-1, 7):.4g}"


def command(rng: Rng) -> str:
    """A random command by its grammar."""
    entry = COMMANDS[int(rng.integers(len(COMMANDS)))]
    keyword = entry.keyword if rng.random() < 0.5 else required(entry.keyword)
    words = [number(rng) for _ in entry.numbers.split()]
    words += [number(rng) for _ in entry.optional.split() if rng.random() < 0.5]
    for word in entry.words:
        if rng.random() < 0.4:
            values = word.values.split() * (int(rng.integers(1, 4)) if word.repeated else 1)
            words += [word.keyword, *(number(rng) for _ in values)]
    for _ in range(int(rng.integers(0, 6)) if entry.list else 0):
        words += [number(rng) for _ in entry.list.split()]
    return " ".join([keyword, *words])


def poke(rng: Rng) -> str:
    """An RSET at a random address."""
    value = rng.choice(["0", "1", "-1", "1e300", "1e-300", number(rng)])
    return f"RSET {value} {int(rng.integers(1, 1200)) | 1} {rng.integers(1, 12)}"


def likely(rng: Rng) -> str:
    """A command that changes the scene and has a fair chance to be obeyed."""
    a, b, c, d = (f"{x:.3g}" for x in rng.uniform(-1, 7, 4))
    return str(
        rng.choice(
            [
                f"SPLIT {a} {b} {c} {d}",
                f"SPLIT {a} -1 {a} 5",
                f"SPLIT -1 {a} 7 {b}",
                f"DELETE {a} {c} {b} {d}",
                f"FIX {a} {c} {b} {d}",
                f"FREE {a} {c} {b} {d}",
                f"ROUND {abs(float(a)) / 20:.3g}",
                f"DAMP 0.1 {abs(float(b)) + 1}",
                "CHANGE 0 6 1 4 MAT=2",
                "SAVE",
                "RESTART",
                "PRINT B C COR D L DL",
                "DUMP 1 400",
                "CYCLE 10",
                "CYCLE 20",
            ]
        )
    )


def soft(rng: Rng) -> str:
    """A command for deformable blocks or boundaries that has a fair chance to be obeyed."""
    a, b, c, d = (f"{x:.3g}" for x in rng.uniform(-1, 7, 4))
    x, y, high = 2 * int(rng.integers(3)), *((1, 1) if rng.random() < 0.5 else (2, 2))
    points = f"{x + 1},{y + high / 2} {x},{y + high} {x},{y} {x + 2},{y} {x + 2},{y + high}"
    zones = "ZONES 1,2,5 2,3,5 3,4,5 4,1,5"
    place = f"{x} {x + 2} {y} {y + high}"
    return str(
        rng.choice(
            [
                f"CHANGE {place} {rng.choice(['SDEF', 'FDEF', 'RIGID'])}",
                f"CHANGE {place} FDEF\nGENERATE {place} MANUAL GRIDPOINTS {points} {zones}",
                f"GENERATE {place} MANUAL GRIDPOINTS {points} {zones} MIXED",
                f"GENERATE {place} AUTOMATIC EDGE {abs(float(a)) + 0.2:.3g}",
                f"BOUNDARY {a} {c} {b} {d} {rng.choice(['XVEL', 'YVEL', 'XFORCE', 'YFORCE'])}={a}",
                f"BOUNDARY -1 7 {a} {c} STRESS {b}E5 0 {d}E5 SINE 10 1",
                f"BOUNDARY -1 {a} -1 5 {rng.choice(['VISCOUS', 'FREE', 'XVEL=1 FUNCTION 1'])}",
                f"INSITU 0 6 0 4 {a}E5 {b}E4 {c}E5",
                f"FUNCTION 1 0 0 {abs(float(a)):.3g} {b}",
                "PRINT G Z BO",
                "PLOT 0 STRESSES PRESSURE VELOCITIES",
            ]
        )
    )


def mangle(rng: Rng, line: str) -> str:
    """`line` with a token swapped, lost, doubled or replaced, cut short, or with a stray character."""
    tokens = line.split()
    k, j = (int(rng.integers(len(tokens))) for _ in range(2)) if tokens else (0, 0)
    what = int(rng.integers(7))
    if what == 0 and tokens:
        tokens[k], tokens[j] = tokens[j], tokens[k]
    elif what == 1 and tokens:
        del tokens[k]
    elif what == 2 and tokens:
        tokens.insert(k, tokens[j])
    elif what == 3 and tokens:
        tokens[k] = number(rng)
    elif what == 4:
        return line[: int(rng.integers(len(line) + 1))]
    elif what == 5:
        at = int(rng.integers(len(line) + 1))
        return line[:at] + chr(int(rng.integers(1, 0x2000))) + line[at:]
    elif tokens:
        tokens[k] = "+" + tokens[k]
    return " ".join(tokens)


def deck(rng: Rng) -> str:
    """A deck: random bytes, random commands, or the sound start of a deck and what may follow."""
    kind = rng.random()
    if kind < 0.03:
        return rng.bytes(int(rng.integers(400))).decode("utf-8", errors="replace")
    lines = ["START"] if kind < 0.2 else list(START)
    kinds: list[Callable[[Rng], str]] = [command] if kind < 0.3 else [*[likely] * 4, soft, command]
    if kind > 0.8:
        kinds.append(poke)
    if kind > 0.3 and rng.random() < 0.3:
        lines += SOFT
    lines += [kinds[int(rng.integers(len(kinds)))](rng) for _ in range(int(rng.integers(1, MAX_COMMANDS)))]
    if rng.random() < 0.4:
        for k in rng.integers(0, len(lines), int(rng.integers(1, 4))):
            lines[k] = mangle(rng, lines[k])
    return "\n".join([*lines, "STOP", "END"])


def unsound(model: Model, check: Callable[[MainArray], list[Violation]]) -> str:
    """The first violation that `check` finds, or nothing."""
    return next(map(str, check(model.array)), "")


def run_deck(rng: Rng, folder: Path) -> tuple[int, str]:
    """Run one deck, most often past its errors: the number of the last one (0 for none), and what failed."""
    (folder / RESTART_FILE).unlink(missing_ok=True)
    text = io.StringIO(deck(rng), newline=None)
    build = str(rng.choice(list(ALL_SCHEMES))) if rng.random() < 0.5 else DEFAULT_SCHEME
    model = Tame(build, int(rng.integers(1, 4000)) if rng.random() < 0.1 else None, folder)
    monitor = Monitor(model, io.StringIO())
    stubborn = rng.random() < 0.7
    last: UdecError | None = None
    try:
        if not stubborn:
            monitor.run(text, "fuzz")
        for statement in statements(text, "fuzz"):
            last = obey(monitor, statement) or last
            if untidy(last) or monitor.ended:
                break
    except UdecError as error:
        last = error
    end = numbered(last) if last else 0
    if model.damaged or model.h.ci[MFREE] == 1:
        return end, ""
    return end, unsound(model, check_links if untidy(last) else check)


def obey(monitor: Monitor, statement: Statement) -> UdecError | None:
    """Obey a statement as at the terminal, where an error does not end the run. Returns the error, if any."""
    try:
        monitor.execute(statement)
    except UdecError as error:
        numbered(error)
        return error
    return None


def untidy(error: UdecError | None) -> bool:
    """True for an error that leaves blocks deeper in each other, farther or thinner than contacts can be."""
    if error is None:
        return False
    return error.number in (15, 32, 36) or (error.number == 14 and STRAINED in error.detail)


def numbered(error: UdecError) -> int:
    """Its number, which must be a known one, or the message could not be printed."""
    assert error.number in MESSAGES, error.number
    return error.number


# ---- restart files


def bases(folder: Path) -> list[bytes]:
    """Restart files to be mutated: before and after cycles, in another word scheme, with soft blocks."""
    found = []
    for build, lines, cycles in (
        ("i32r64", START, 0),
        ("i32r64", START, 30),
        ("i16r32", START, 0),
        ("i32r64", START + SOFT, 30),
    ):
        model = Model(build, out=folder)
        model.run("\n".join(lines))
        if cycles:
            model.cycle(cycles)
        found.append(model.save(folder / "base.h5").read_bytes())
    return found


def mutated(rng: Rng, base: bytes) -> bytes:
    """`base` with bytes changed, cut off, taken out, doubled, or moved."""
    data = bytearray(base)
    for _ in range(int(rng.integers(1, 4))):
        at, length = int(rng.integers(len(data) + 1)), int(rng.integers(1, 200))
        what = int(rng.integers(6))
        if what == 0:
            del data[at:]
        elif what == 1:
            del data[at : at + length]
        elif what == 2:
            data[at:at] = data[:length]
        elif what == 3:
            data[at : at + length] = rng.bytes(len(data[at : at + length]))
        elif at < len(data):
            data[at] ^= 1 << int(rng.integers(8))
    return bytes(data)


def forged(rng: Rng, base: bytes) -> bytes:
    """`base` mutated behind its seal, and sealed anew."""
    body = mutated(rng, base[SIZE:])
    return seal(memoryview(body)) + body


def damaged(rng: Rng, path: Path, base: bytes) -> None:
    """Write a restart file at `path` that was written from a damaged main array: its seal is whole."""
    path.write_bytes(base)
    array = Model.restore(path).array
    h, used = array.h, int(array.h.ci[MFREE]) - 1
    for _ in range(int(rng.integers(1, 4))):
        if rng.random() < 0.3:
            parts = h.cr, h.cd, h.ra[: used // array.scheme.ratio], h.ra[: used // array.scheme.ratio]
            reals = parts[rng.integers(len(parts))]
            reals[int(rng.integers(len(reals)))] = rng.choice(REALS)
        else:
            words = h.ci if rng.random() < 0.2 else h.ia[:used]
            words[int(rng.integers(len(words)))] = rng.choice([0, 1, -1, int(rng.integers(used)), 32767])
    save(array, path, [])


def run_file(rng: Rng, folder: Path, base: bytes) -> tuple[int, str]:
    """Restart from one mutated file: the number of the error (0 for none), and what failed."""
    path = folder / RESTART_FILE
    kind = rng.random()
    if kind < 0.5:
        path.write_bytes(mutated(rng, base) if kind < 0.25 else forged(rng, base))
    else:
        try:
            damaged(rng, path, base)
        except UdecError as error:
            return numbered(error), ""
    model = Tame(DEFAULT_SCHEME, None, folder)
    end = 0
    try:
        model.restart()
        model.cycle(3)
        model.split(-1, 3, 7, 3.1)
    except UdecError as error:
        end = numbered(error)
    return end, unsound(model, check_links) if model.session.started else ""


# ---- processes


def cases(kind: str, seed: int, first: int, last: int) -> Iterator[CaseRow]:
    """Run the cases from `first` to before `last`. How one ends is the number of its error, or UNEXPECTED."""
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = bases(folder) if kind == "files" else []
        for case in range(first, last):
            rng = np.random.default_rng([seed, case])
            yield CaseRow(case, kind, "", [])
            try:
                number, fault = (
                    run_deck(rng, folder)
                    if kind == "decks"
                    else run_file(rng, folder, files[case % len(files)])
                )
            except Exception as error:
                number, fault = 0, f"{type(error).__name__}: {error}"
            yield CaseRow(case, kind, UNEXPECTED if fault else str(number), [fault] if fault else [])


def fuzz(kind: str, seed: int, many: int, until: float) -> list[str]:
    """Run up to `many` cases before the time `until`; prints the counts and returns the failures."""
    found: Counter[int] = Counter()
    failed: list[str] = []

    def report(row: CaseRow) -> None:
        if row.ended:
            found[int(row.ended)] += 1
        failed.extend(f"{kind} case {row.case} of seed {seed}: {fault}" for fault in row.faults)

    case = 0
    while case < many and time.monotonic() < until:
        last = min(case + BATCH, many)
        work = [str(TOOL), "fuzz", "--work", kind, str(case), str(last), "--seed", str(seed)]
        case = run_batch(work, case, last, report)
    counts = ", ".join(f"error {n}: {count}" for n, count in sorted(found.items()) if n > 0)
    print(f"{kind}: {case} cases, {found[0]} without error, {counts}")
    for failure in failed:
        print(f"FAILED {failure}")
    return failed


def main() -> int:
    """Play decks and read files until enough, or until one ends as none may; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--decks", type=int, default=2000, help="number of decks")
    parser.add_argument("--files", type=int, default=2000, help="number of restart files")
    parser.add_argument("--seconds", type=float, default=600, help="begin no batch after so many seconds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--show", nargs=2, metavar=("decks", "CASE"), help="print one deck and stop")
    parser.add_argument("--work", nargs=3, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.show:
        print(deck(np.random.default_rng([options.seed, int(options.show[1])])))
        return 0
    if options.work:
        kind, first, last = options.work
        print_rows(cases(kind, options.seed, int(first), int(last)))
        return 0
    begun = time.monotonic()
    failed = fuzz("decks", options.seed, options.decks, begun + options.seconds * 0.6)
    failed += fuzz("files", options.seed, options.files, begun + options.seconds)
    return 1 if failed else 0
