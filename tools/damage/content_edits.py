"""Edits of what a restart file contains: texts, field tables, chains of groups, common blocks, and bytes.

An edit of a file returns True if the file must be refused.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

import numpy as np
from damage.storage_edits import TEXTS, File, Rng, one, take

from udec_ia.layout.field_table import COMMON_TYPES, TABLE, Table, TableError, parse, read_table
from udec_ia.restart.file_tables import text

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


EDITS: list[Callable[[Rng, File, Path], bool]] = [strings, tables, commons, nothing]
EDITS += [odd_tables, odd_tables, odd_tables, chain]


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


BYTE_EDITS: list[Callable[[Rng, bytearray], None]] = [tree, superblock, anything, headers]
