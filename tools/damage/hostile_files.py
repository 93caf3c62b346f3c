"""Hostile restart files: made to read other files, to take all memory or time, to crash, to fool a terminal.

    python tools/damaged_files.py hostile --files 1000 --seed 1

Each is a good restart file with one thing changed through HDF5 or in its bytes, and sealed again. It is read
by `info` and by RESTART, in processes that may take little memory and time; between two files is looked at
what the last one took. No file outside may be opened, every line that is printed must be plain, and what
hides or leads elsewhere must be refused. Case k of seed s is always the same. The exit status is 1 if
anything failed.
"""

from __future__ import annotations

import argparse
import ctypes
import io
import os
import resource
import tempfile
import time
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
from case_processes import CaseRow, limit_memory, peak_memory, print_rows, run_batch
from damage import content_edits, storage_edits
from damage.storage_edits import Rng

from udec_ia.errors import UdecError
from udec_ia.model import Model
from udec_ia.restart import info, save
from udec_ia.restart.file_seal import SIZE, seal

BATCH = 200  # cases to a process
MEMORY = 32 * 2**20, 20  # bytes that reading may take: so many, and so many for each byte of the file
SECONDS = 5.0  # of the processor for one file
LONGEST, LINE = 2500, 1000  # characters of a line, and of what is shown of a violation
SECRET = b"START\n* what stands in another file of the user's\n"
TOOL = Path(__file__).parents[1] / "damaged_files.py"
EDITS = storage_edits.EDITS + content_edits.EDITS


def base(folder: Path) -> bytes:
    """A good restart file that has all that a restart file can have."""
    model = Model(out=folder)
    model.run(
        "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5\nBLOCK 0,0 0,2 2,2 2,0\nSPLIT -1 1 3 1\n"
        "FIX 0 2 0 1\nGRAVITY 0 -10\nHISTORY 1 KXD AT 1 1.5\n" + "HISTORY 1 TIME\n" * 4
    )
    model.cycle(3)
    laws = {"cl2": ("law.py", "0" * 64)}
    return save(
        model.array, folder / "base.h5", model.session.log.lines, laws, model.histories()
    ).read_bytes()


def hostile(rng: Rng, image: bytes, secret: Path) -> tuple[str, bytes, bool]:
    """What was done, the file, and whether it must be refused."""
    what = int(rng.integers(len(EDITS) + len(content_edits.BYTE_EDITS)))
    if what < len(EDITS):
        buffer = io.BytesIO(image)
        with h5py.File(buffer, "r+") as file:
            refused = EDITS[what](rng, file, secret)
        body, name = bytearray(buffer.getvalue()[SIZE:]), EDITS[what].__name__
    else:
        edit = content_edits.BYTE_EDITS[what - len(EDITS)]
        body, refused, name = bytearray(image[SIZE:]), False, edit.__name__
        edit(rng, body)
    return name, seal(memoryview(body)) + bytes(body), refused


def read(path: Path) -> tuple[bool, list[str]]:
    """Was the file taken by RESTART, and all that was printed about it. Raises errors other than 29."""
    output: list[str] = []
    model = Model()
    model.tell = model.inform = output.append

    def histories(path: Path) -> str:
        model.restart(path)
        return model.print("histories")

    def forced(path: Path) -> str:
        model.restart(path, force=True)
        return model.print("histories") + "".join(f"{one.message[:LINE]}\n" for one in model.check())

    taken = True
    for look in (info, histories, forced):
        try:
            output.append(look(path))
        except UdecError as error:
            if error.number != 29:
                raise
            taken = taken and look is not histories
            output.append(str(error))
    return taken, output


class Watch:
    """Sees which files of a folder are opened, by the kernel's own account (inotify)."""

    OPEN, NONBLOCK = 0x20, 0o4000

    def __init__(self, folder: Path) -> None:
        libc = ctypes.CDLL(None)
        self.handle = libc.inotify_init1(self.NONBLOCK)
        libc.inotify_add_watch(self.handle, os.fsencode(folder), self.OPEN)

    def seen(self) -> bool:
        """Was a file opened since the last look?"""
        try:
            return bool(os.read(self.handle, 65536))
        except BlockingIOError:
            return False


def faults(path: Path, watch: Watch, refused: bool) -> tuple[bool, list[str]]:
    """Read a file: was it taken, and what went wrong."""
    size, found = path.stat().st_size, []
    peak_memory()
    before, clock = peak_memory(), time.process_time()
    watch.seen()
    taken, output = read(path)
    took, used = time.process_time() - clock, peak_memory() - before
    if watch.seen():
        found.append("another file was opened")
    if used > MEMORY[0] + MEMORY[1] * size:
        found.append(f"{used} bytes of memory for a file of {size}")
    if took > SECONDS:
        found.append(f"{took:.1f} s")
    lines = [line for one in output for line in one.splitlines()]
    if not all(line.isprintable() and len(line) < LONGEST for line in lines) or "another file" in str(output):
        found.append(f"output {output}")
    if taken and refused:
        found.append("it was taken")
    return taken, found


def cases(seed: int, first: int, last: int) -> Iterator[CaseRow]:
    """Run the cases from `first` to before `last`."""
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        outside = folder / "outside"
        outside.mkdir()
        secret = outside / "secret"
        secret.write_bytes(SECRET * 1000)
        with h5py.File(secret.with_suffix(".h5"), "w") as file:
            file["x"] = np.frombuffer(SECRET, np.uint8)
        image, path = base(folder), folder / "hostile.h5"
        path.write_bytes(image)
        read(path)
        watch = Watch(outside)
        limit_memory()
        for case in range(first, last):
            rng = np.random.default_rng([seed, case])
            what, content, refused = hostile(rng, image, secret)
            path.write_bytes(content)
            yield CaseRow(case, what, "", [])
            try:
                taken, wrong = faults(path, watch, refused)
            except Exception as error:
                taken, wrong = False, [f"{type(error).__name__}: {error}"]
            yield CaseRow(case, what, "taken" if taken else "refused", wrong)


def main() -> int:
    """Read hostile files and say how each kind of them ended; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--files", type=int, default=1000, help="number of files")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", nargs=2, type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work:
        resource.setrlimit(resource.RLIMIT_CPU, (600, 600))
        print_rows(cases(options.seed, *options.work))
        return 0
    ends: dict[str, Counter[str]] = defaultdict(Counter)
    failed: list[str] = []
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}

    def report(row: CaseRow) -> None:
        if row.ended:
            ends[row.label][row.ended] += 1
        failed.extend(f"case {row.case} of seed {options.seed}, {row.label}: {one}" for one in row.faults)

    case = 0
    while case < options.files:
        last = min(case + BATCH, options.files)
        arguments = [str(TOOL), "hostile", "--work", str(case), str(last), "--seed", str(options.seed)]
        case = run_batch(arguments, case, last, report, environment)
    for what, counts in sorted(ends.items()):
        print(f"{what:14}{counts['refused']:5} refused{counts['taken']:5} taken")
    for failure in failed:
        print(f"FAILED {failure}")
    print(f"{case} files, {len(failed)} failures")
    return 1 if failed else 0
