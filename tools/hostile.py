"""Hostile restart files: made to read other files, to take all memory or time, to crash, to fool a terminal.

    python tools/hostile.py --files 1000 --seed 1

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
import json
import os
import resource
import struct
import subprocess
import sys
import tempfile
import time
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from h5py import h5d, h5p, h5s, h5t

from udec_ia.errors import UdecError
from udec_ia.layout.table import COMMON_TYPES, TABLE, Table, TableError, parse, read_table
from udec_ia.model import Model
from udec_ia.restart import info, save
from udec_ia.restart.layout import text
from udec_ia.restart.seal import SIZE, seal

BATCH = 200  # cases to a process
ROOM = 2**30  # bytes of addresses that a process may take beyond those that it begins with
MEMORY = 32 * 2**20, 20  # bytes that reading may take: so many, and so many for each byte of the file
SECONDS = 5.0  # of the processor for one file
LONGEST, LINE = 2500, 1000  # characters of a line, and of what is shown of a violation
SECRET = b"START\n* what stands in another file of the user's\n"
WORDS = [
    "\x1b[2J\x1b]0;mine\x07",
    "\u202egnp.exe",
    "\r\nsound",
    "\x9b31m",
    "\xff\xfe",
    "a" * 3000,
    "\x00\x07",
    "$\\frac$",
]
DATA = ["heap/IA", "deck", "layout/table", "common/AKN", "common/MFREE", "volatile/date", "volatile/host"]
DATA += ["recorded/1/cycle", "recorded/1/time", "recorded/1/value"]
GROUPS = ["heap", "common", "layout", "recorded", "recorded/1", "laws", "laws/cl2", "provenance", "volatile"]
TEXTS = [("layout", "sha256"), ("heap/IA", "sha256"), ("common", "sha256"), ("laws/cl2", "file")]
TEXTS += [("laws/cl2", "sha256"), ("provenance", "udec_ia"), ("provenance", "numpy"), ("", "format")]
TEXTS += [("recorded/1", "group"), ("recorded/1", "place")]
NUMBERS = [("", "format_version"), ("", "complete"), ("heap/IA", "int_bits"), ("heap/IA", "mtop_fixed")]
NUMBERS += [("recorded/1", "lost")]
ODD = [
    "int",
    "real",
    "double",
    "int*3",
    "real*1000000000",
    "int*-1",
    "9" * 4000,
    "-",
    "0..",
    "block!",
    "item",
]
ODD += [
    "any",
    "soft",
    "nowhere",
    "head",
    "next",
    "HEAD",
    "KB",
    "MFREE",
    "GROUP",
    "CODE",
    "COMMON",
    "4",
    "ours/9",
]
Rng = np.random.Generator
File = h5py.File


def one(rng: Rng, of: Any) -> Any:
    """One of several."""
    return of[int(rng.integers(len(of)))]


def take(file: File, place: str) -> tuple[dict[str, Any], Any]:
    """Take a dataset out: its attributes, and what it held."""
    node = file[place]
    kept, held = dict(node.attrs), node[()]
    del file[place]
    return kept, held


# ---- what is done to a file; each returns True if it must be refused


def link(rng: Rng, file: File, secret: Path) -> bool:
    """Objects that are links: to this file, to another one, to themselves."""
    place = one(rng, DATA + GROUPS)
    del file[place]
    file[place] = one(
        rng,
        [
            h5py.SoftLink("/volatile/date"),
            h5py.SoftLink(f"/{place}"),
            h5py.ExternalLink(str(secret.with_suffix(".h5")), "/x"),
            h5py.ExternalLink(one(rng, ["/dev/zero", "/proc/self/mem", "."]), "/x"),
        ],
    )
    return not place.startswith(("laws", "volatile", "provenance"))


def loop(rng: Rng, file: File, secret: Path) -> bool:
    """Groups that hold themselves."""
    place = one(rng, GROUPS)
    above = one(rng, ["/", place.split("/")[0]])
    if above == place:
        above = "/"
    node = file[above]
    del file[place]
    file[place] = node
    return not place.startswith(("laws", "volatile", "provenance"))


def external(rng: Rng, file: File, secret: Path) -> bool:
    """Numbers and texts that lie in another file."""
    place = one(rng, DATA)
    kept, held = take(file, place)
    node = file.create_dataset(
        place, np.shape(held), held.dtype, external=[(str(secret), 0, max(held.nbytes, 1))]
    )
    node.attrs.update(kept)
    return not place.startswith("volatile")


def virtual(rng: Rng, file: File, secret: Path) -> bool:
    """Datasets that are made of others, of this file or another one."""
    place = one(rng, DATA)
    kept, held = take(file, place)
    shape = np.shape(held) or (1,)
    layout = h5py.VirtualLayout(shape, held.dtype)
    layout[...] = h5py.VirtualSource(one(rng, [str(secret.with_suffix(".h5")), "."]), "/x", shape)
    file.create_virtual_dataset(place, layout).attrs.update(kept)
    return not place.startswith("volatile")


def bomb(rng: Rng, file: File, secret: Path) -> bool:
    """Much that is packed small, or that takes no room until it is read."""
    place = one(rng, DATA)
    kept, held = take(file, place)
    many = int(2.0 ** rng.uniform(16, 40))
    kind = np.dtype("S64") if held.dtype.kind == "S" else held.dtype
    packing: dict[str, Any] = one(
        rng, [{"compression": "gzip"}, {"compression": "lzf"}, {"scaleoffset": 0}, {"shuffle": True}, {}]
    )
    if kind.kind in "Sf":
        packing.pop("scaleoffset", None)
    node = file.create_dataset(place, (many,), kind, chunks=(min(many, 2**20),), **packing)
    if packing:
        node[: 2**20] = np.zeros(min(many, 2**20), kind)
    node.attrs.update(kept)
    return not place.startswith("volatile")


def paper(rng: Rng, file: File, secret: Path) -> bool:
    """Datasets in one piece that were never written, and that are said to be huge."""
    place = one(rng, DATA)
    kept, held = take(file, place)
    plist = h5p.create(h5p.DATASET_CREATE)
    plist.set_layout(h5d.CONTIGUOUS)
    plist.set_alloc_time(h5d.ALLOC_TIME_LATE)
    many = int(2.0 ** rng.uniform(4, 55))
    if held.dtype.kind == "S":
        kind = h5t.C_S1.copy()
        kind.set_size(min(many, 2**31 - 1))
        space = h5s.create(h5s.SCALAR)
    else:
        kind = h5t.py_create(held.dtype)
        space = h5s.create_simple((many,)) if np.shape(held) else h5s.create(h5s.SCALAR)
    h5d.create(file.id, place.encode(), kind, space, plist)
    file[place].attrs.update(kept)
    return bool(np.shape(held) or held.dtype.kind == "S") and not place.startswith("volatile")


def other_type(rng: Rng, file: File, secret: Path) -> bool:
    """Types that are not ours: of any length, of parts, of other widths, named, on the other end first."""
    place = one(rng, DATA)
    kept, held = take(file, place)
    kinds: list[Any] = [h5py.vlen_dtype("i8"), h5py.string_dtype(), np.dtype([("a", "<i8"), ("b", "S3")])]
    kinds += [h5py.ref_dtype, h5py.enum_dtype({"X": 1}), np.dtype("V8"), np.dtype((np.dtype("f8"), (3,)))]
    kinds += [np.dtype(">i8"), np.dtype(">f8"), np.dtype("<f2"), np.dtype("<u8"), np.dtype("?")]
    kind = one(rng, kinds)
    if rng.random() < 0.2:
        h5t.py_create(kind, logical=True).copy().commit(file.id, b"named")
        kind = file["named"]
    file.create_dataset(place, np.shape(held), kind).attrs.update(kept)
    return not place.startswith("volatile")


def other_shape(rng: Rng, file: File, secret: Path) -> bool:
    """Shapes that are not ours: of many dimensions, or of none."""
    place = one(rng, DATA)
    kept, held = take(file, place)
    shape = one(rng, [(1,) * 32, (0,), (2, 3), (0, 10**18), (3,), None])
    node = file.create_dataset(
        place, None if shape is None else shape, held.dtype if shape else h5py.Empty("f8").dtype
    )
    node.attrs.update(kept)
    return not place.startswith("volatile")


def same_numbers(rng: Rng, file: File, secret: Path) -> bool:
    """One dataset under many names: each is no larger than the file, together they are."""
    del file["deck"]
    file["deck"] = text(b"*\n" * int(rng.integers(1, 10**5)))
    many = int(rng.integers(10, 10**5))
    for name, kind in (("cycle", "<i8"), ("time", "<f8"), ("value", "<f8")):
        del file[f"recorded/1/{name}"]
        file[f"recorded/1/{name}"] = np.arange(many).astype(kind)
    for number in range(2, 6):
        file.pop(f"recorded/{number}", None)
        file[f"recorded/{number}"] = file["recorded/1"]
    return False


def attribute(rng: Rng, file: File, secret: Path) -> bool:
    """Attributes that are too large, of other types, or not there."""
    place, name = one(rng, TEXTS + NUMBERS)
    attrs = file[place or "/"].attrs
    many = int(2.0 ** rng.uniform(0, 24))
    del attrs[name]
    value = one(
        rng,
        [np.zeros(many), text(b"x" * min(many, 60000)), np.int64(3), "any length", h5py.Empty("f8"), None],
    )
    if value is not None:
        attrs[name] = value
    return not place.startswith(("laws", "provenance", "recorded")) and place != ""


def packed_names(rng: Rng, file: File, secret: Path) -> bool:
    """A group whose names are packed."""
    place = one(rng, ["common", "laws", "layout", "recorded"])
    plist = h5p.create(h5p.GROUP_CREATE)
    view = h5p.PropDCID(plist.id)
    view.locked = True
    view.set_deflate(9)
    file.move(place, "before")
    group = h5py.Group(h5py.h5g.create(file.id, place.encode(), None, plist))
    for name in file["before"]:
        group[name] = file["before"][name]
    group.attrs.update(dict(file["before"].attrs))
    return True


def chunks(rng: Rng, file: File, secret: Path) -> bool:
    """Pieces of the heap that are too short or too long, or of another size than ours."""
    kept, held = take(file, "heap/IA")
    length = len(held) if rng.random() < 0.5 else int(rng.integers(1, len(held) + 1))
    node = file.create_dataset("heap/IA", held.shape, held.dtype, chunks=(length,), fletcher32=True)
    raw = rng.bytes(int(rng.integers(1, 2 * held.nbytes)))
    node.id.write_direct_chunk((0,), raw, int(rng.integers(2)))
    node.attrs.update(kept)
    return True


def strings(rng: Rng, file: File, secret: Path) -> bool:
    """Words that a terminal obeys, in all that is text."""
    raw = str(one(rng, WORDS)).encode("latin-1" if rng.random() < 0.3 else "utf-8", "replace")
    where = int(rng.integers(4))
    if where == 0:
        place, name = one(rng, TEXTS)
        file[place or "/"].attrs[name] = np.array(raw, f"S{max(len(raw), 1)}")
    elif where == 1:
        place = one(rng, ["deck", "volatile/date", "volatile/host"])
        del file[place]
        file[place] = np.array(raw, f"S{max(len(raw), 1)}")
    elif where == 2:
        group = file["laws"].create_group(str(one(rng, ["\x1b[2J", "cl3", "..\u202e"])))
        group.attrs["file"], group.attrs["sha256"] = text(raw), text(raw)
    else:
        new_table(
            file,
            TABLE.read_bytes().replace(one(rng, [b"KBRO", b"NBLK", b"NVBL"]), raw[:60].replace(b"\n", b"")),
        )
    return False


def new_table(file: File, table: bytes) -> None:
    """Give the file another field table, with its checksum."""
    del file["layout/table"]
    file["layout/table"] = text(table)
    file["layout"].attrs["sha256"] = text(sha256(table).hexdigest())


def tables(rng: Rng, file: File, secret: Path) -> bool:
    """Field tables with very many fields, or very large ones."""
    line = "KZ{} {} - data - ours | x\n"
    kind = one(
        rng, ["int", "real", "real*999999999", "int*" + "9" * 4000, "int*-5", "real*0", "int*" + "9" * 5000]
    )
    many = int(2.0 ** rng.uniform(0, 15)) if len(kind) < 20 else 3
    before = TABLE.read_text()
    more = "".join(line.format(i, kind) for i in range(many))
    new_table(
        file, (before + more if rng.random() < 0.5 else before.replace("COMMON", more + "COMMON", 1)).encode()
    )
    return False


def mutated(rng: Rng, lines: list[str]) -> None:
    """Change one line of a field table: take it out, write it twice, move it, or put another word into it."""
    k, other = (int(rng.integers(len(lines))) for _ in range(2))
    what = int(rng.integers(5))
    if what == 0:
        del lines[k]
    elif what == 1:
        lines.insert(other, lines[k])
    elif what == 2:
        lines[k], lines[other] = lines[other], lines[k]
    elif words := lines[k].split(" "):
        places = [i for i, word in enumerate(words) if word and word != "|"]
        if places:
            words[one(rng, places[:6])] = one(rng, ODD)
        lines[k] = " ".join(words)


def odd_tables(rng: Rng, file: File, secret: Path) -> bool:
    """Field tables that mean something else, or nothing: the words of the file stay."""
    lines = [line for line in TABLE.read_text().splitlines() if line and not line.startswith("#")]
    for _ in range(int(rng.integers(1, 4))):
        mutated(rng, lines)
    fit(file, "\n".join(lines) + "\n")
    return False


def chain(rng: Rng, file: File, secret: Path) -> bool:
    """A heap of groups of one word, each of which leads to the next, or to any other."""
    many = int(2.0 ** rng.uniform(4, 16))
    words = np.arange(3, 2 * many + 3).astype("<i4")
    words[1::2] = rng.integers(-5, 2 * many + 5, many)
    words[-2:] = one(rng, [0, 1, -1, 2 * many])
    kept, _ = take(file, "heap/IA")
    kept["sha256"] = text(sha256(words).hexdigest())
    pieces = (min(len(words), 65536),)
    file.create_dataset("heap/IA", data=words, chunks=pieces, fletcher32=True).attrs.update(kept)
    for name, value in {"MFREE": len(words) + 1, "MTOP": len(words), "ISGPNT": 1, "IHPNT": 0}.items():
        file[f"common/{name}"][()] = value
    front, _, rest = TABLE.read_text().partition("GROUP  signal")
    kind = one(rng, ["int signal next", "int*2 signal data", "int any next", "int! signal next"])
    group = f"GROUP  signal  NVSG  ISGPNT  ours | one word\nKT {kind} - ours | next\nGROUP  tabpoint"
    table = front + group + rest.partition("GROUP  tabpoint")[2]
    fit(file, table.replace("HEAD  MSIG   9  signal   | signal\n", ""))
    return False


def fit(file: File, table: str) -> None:
    """Give the file another field table, and the variables that it has."""
    new_table(file, table.encode())
    with suppress(TableError, OverflowError, MemoryError):
        for field in parse(table).common:
            if f"common/{field.name}" not in file and field.count < 10**5:
                kind = {"int": "<i8", "real": "<f8", "double": "<f8"}[field.type]
                file[f"common/{field.name}"] = (
                    np.zeros(field.count, kind) if field.count > 1 else np.zeros((), kind)
                )
        seal_commons(file, parse(table))


def commons(rng: Rng, file: File, secret: Path) -> bool:
    """Sizes and heads of lists that are mad, with the right checksum."""
    name = one(rng, ["MFREE", "MTOP", "JUNK", "IBPNT", "IHPNT", "NBLK", "NWANT", "NSPARE", "MCTOT", "LENER"])
    file[f"common/{name}"][()] = one(rng, [-1, 0, 2**31 - 1, 2**62, -(2**63), int(rng.integers(2**31))])
    seal_commons(file)
    return False


def seal_commons(file: File, table: Table | None = None) -> None:
    """Give the common block its checksum."""
    fields = [field for field in (table or read_table()).common if f"common/{field.name}" in file]
    held = [(field.type, file[f"common/{field.name}"][()].tobytes()) for field in fields]
    content = b"".join(part for kind in COMMON_TYPES for its, part in held if its == kind)
    file["common"].attrs["sha256"] = text(sha256(content).hexdigest())


def nothing(rng: Rng, file: File, secret: Path) -> bool:
    """A good file, which must be read."""
    return False


EDITS: list[Callable[[Rng, File, Path], bool]] = [link, loop, external, virtual, bomb, paper, other_type]
EDITS += [other_shape, same_numbers, attribute, packed_names, chunks, strings, tables, commons, nothing]
EDITS += [odd_tables, odd_tables, odd_tables, chain]


# ---- what is done to the bytes


def tree(rng: Rng, body: bytearray) -> None:
    """The tree that finds the pieces of the heap: it leads to itself."""
    at = body.find(b"TREE\x01")
    body[at + 5] = int(rng.integers(1, 256))
    if rng.random() < 0.7:
        child = at + 24 + 8 + 16  # behind signature, type, level, number, two neighbours, and the first key
        body[child : child + 8] = struct.pack("<Q", at)
        body[at + 6 : at + 8] = struct.pack("<H", int(rng.integers(1, 65)))


def superblock(rng: Rng, body: bytearray) -> None:
    """The first bytes of the HDF5 part."""
    for _ in range(int(rng.integers(1, 4))):
        body[int(rng.integers(48))] = int(rng.integers(256))


def anything(rng: Rng, body: bytearray) -> None:
    """Any bytes, moved or changed."""
    for _ in range(int(rng.integers(1, 6))):
        at, length = int(rng.integers(len(body))), int(rng.integers(1, 16))
        if rng.random() < 0.5:
            body[at : at + length] = rng.bytes(len(body[at : at + length]))
        else:
            body[at] ^= 1 << int(rng.integers(8))


def headers(rng: Rng, body: bytearray) -> None:
    """Bytes of what describes an object: behind the signature of a header, a heap of names or a tree."""
    marks = [b"OHDR", b"OCHK", b"FRHP", b"FHDB", b"BTHD", b"BTLF", b"TREE"]
    places = [at for mark in marks for at in _all(body, mark)]
    for _ in range(int(rng.integers(1, 4))):
        at = one(rng, places) + int(rng.integers(4, 200))
        if at < len(body):
            body[at] = int(rng.integers(256))


def _all(body: bytearray, mark: bytes) -> list[int]:
    found, at = [], body.find(mark)
    while at >= 0:
        found.append(at)
        at = body.find(mark, at + 1)
    return found


BYTES: list[Callable[[Rng, bytearray], None]] = [tree, superblock, anything, headers]


# ---- reading them


def base(folder: Path) -> bytes:
    """A good restart file that has all that a restart file can have."""
    model = Model(out=folder)
    model.run(
        "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5\nBLOCK 0,0 0,2 2,2 2,0\nSPLIT -1 1 3 1\n"
        "FIX 0 2 0 1\nGRAVITY 0 -10\nHISTORY 1 KXD AT 1 1.5\n" + "HISTORY 1 TIME\n" * 4
    )
    model.cycle(3)
    laws = {"cl2": ("law.py", "0" * 64)}
    return save(model.array, folder / "base.h5", model.deck_log, laws, model.histories()).read_bytes()


def hostile(rng: Rng, image: bytes, secret: Path) -> tuple[str, bytes, bool]:
    """What was done, the file, and whether it must be refused."""
    what = int(rng.integers(len(EDITS) + len(BYTES)))
    if what < len(EDITS):
        buffer = io.BytesIO(image)
        with h5py.File(buffer, "r+") as file:
            refused = EDITS[what](rng, file, secret)
        body, name = bytearray(buffer.getvalue()[SIZE:]), EDITS[what].__name__
    else:
        body, refused, name = bytearray(image[SIZE:]), False, BYTES[what - len(EDITS)].__name__
        BYTES[what - len(EDITS)](rng, body)
    return name, seal(memoryview(body)) + bytes(body), refused


def read(path: Path) -> tuple[bool, list[str]]:
    """Was the file taken by RESTART, and all that was printed about it. Raises errors other than 29."""
    said: list[str] = []
    model = Model()
    model.tell = model.inform = said.append

    def histories(path: Path) -> str:
        model.restart(path)
        return model.print("histories")

    def forced(path: Path) -> str:
        model.restart(path, force=True)
        return model.print("histories") + "".join(f"{one.message[:LINE]}\n" for one in model.check())

    taken = True
    for look in (info, histories, forced):
        try:
            said.append(look(path))
        except UdecError as error:
            if error.number != 29:
                raise
            taken = taken and look is not histories
            said.append(str(error))
    return taken, said


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


def peak() -> int:
    """The most memory in use since the last call, in bytes."""
    (line,) = [
        line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM")
    ]
    Path("/proc/self/clear_refs").write_text("5")
    return int(line.split()[1]) * 1024


def faults(path: Path, watch: Watch, refused: bool) -> tuple[bool, list[str]]:
    """Read a file: was it taken, and what went wrong."""
    size, found = path.stat().st_size, []
    peak()
    before, clock = peak(), time.process_time()
    watch.seen()
    taken, said = read(path)
    took, used = time.process_time() - clock, peak() - before
    if watch.seen():
        found.append("another file was opened")
    if used > MEMORY[0] + MEMORY[1] * size:
        found.append(f"{used} bytes of memory for a file of {size}")
    if took > SECONDS:
        found.append(f"{took:.1f} s")
    lines = [line for one in said for line in one.splitlines()]
    if not all(line.isprintable() and len(line) < LONGEST for line in lines) or "another file" in str(said):
        found.append(f"said {said}")
    if taken and refused:
        found.append("it was taken")
    return taken, found


def cases(seed: int, first: int, last: int) -> Iterator[tuple[int, str, str, list[str]]]:
    """Run the cases from `first` to before `last`: case, what was done, how it ended, what went wrong."""
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
        size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (size + ROOM, size + ROOM))
        for case in range(first, last):
            rng = np.random.default_rng([seed, case])
            what, content, refused = hostile(rng, image, secret)
            path.write_bytes(content)
            yield case, what, "", []
            try:
                taken, wrong = faults(path, watch, refused)
            except Exception as error:
                taken, wrong = False, [f"{type(error).__name__}: {error}"]
            yield case, what, "taken" if taken else "refused", wrong


def batch(seed: int, first: int, last: int, ends: dict[str, Counter[str]], failed: list[str]) -> int:
    """Run a batch in a process of its own. Returns the case to go on with."""
    arguments = [sys.executable, __file__, "--work", str(first), str(last), "--seed", str(seed)]
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True, env=environment)
    assert process.stdout is not None
    case, what, end = first, "", "before the first file"
    for line in process.stdout:
        case, what, end, wrong = json.loads(line)
        if end:
            ends[what][end] += 1
        failed += [f"case {case} of seed {seed}, {what}: {fault}" for fault in wrong]
    if process.wait() == 0:
        return last
    failed.append(f"case {case} of seed {seed}, {what}: the process ended with status {process.returncode}")
    return case + 1


def main() -> int:
    """Read hostile files and say how each kind of them ended; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--files", type=int, default=1000, help="number of files")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", nargs=2, type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.work:
        resource.setrlimit(resource.RLIMIT_CPU, (600, 600))
        for line in cases(options.seed, *options.work):
            print(json.dumps(line), flush=True)
        return 0
    ends: dict[str, Counter[str]] = defaultdict(Counter)
    failed: list[str] = []
    case = 0
    while case < options.files:
        case = batch(options.seed, case, min(case + BATCH, options.files), ends, failed)
    for what, counts in sorted(ends.items()):
        print(f"{what:14}{counts['refused']:5} refused{counts['taken']:5} taken")
    for failure in failed:
        print(f"FAILED {failure}")
    print(f"{case} files, {len(failed)} failures")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
