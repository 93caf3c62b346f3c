"""The description of a restart file (`udec info FILE`), from its header."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from udec_ia.checker.invariants import unfinished
from udec_ia.errors import MESSAGES, spoilt
from udec_ia.heap.main_array import variable
from udec_ia.heap_tools.written_state import Words
from udec_ia.layout.field_table import read_table
from udec_ia.printable_text import counted, printable
from udec_ia.restart.file_seal import OTHER_TABLE, RefusedError, refusing
from udec_ia.restart.file_tables import shorten
from udec_ia.restart.hdf5_contents import Contents
from udec_ia.restart.restart_reader import (
    opened,
    read_deck,
    read_header,
    read_laws,
    read_mark,
    read_state,
)

PROGRAMS = ("udec_ia", "python", "numpy", "numba", "h5py", "hdf5")
GREATER = 1.05  # moment of inertia of zones over that of a body, from which on it is shown
TURNS_SLOWLY = "masses at grid-points make moments of inertia up to {:.2f} times those of the bodies"
LINE = 1000  # characters


def info(path: str | Path) -> str:
    """The header of the restart file `path`, in lines of `name  value`, which are safe to print.

    A file with another field table is described too, as far as it can be read here. Raises UdecError 29 if
    the file is foreign, damaged or of another format.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        front = read_header(file)
        scheme, (layout, values) = front.scheme, _read_values(file, front)
        lines = [("file", str(path)), ("format", _format(file)), ("written", _written(file))]
        lines += [("words", f"{scheme.name}: {scheme.int_bits}-bit integers, {scheme.real_bits}-bit reals")]
        lines += [("layout", layout), *(_state(file, values) if values else [])]
        lines += [("unsound", f"saved by force: {shorten(mark)}")] if (mark := read_mark(file)) else []
        lines += [("deck", counted(len(read_deck(file)), "command line"))]
        lines += [("law", f"{name} of {origin}, sha256 {d}") for name, (origin, d) in read_laws(file).items()]
        lines += [("heap", f"sha256 {_shown(file.attribute('heap/IA', 'sha256'))}")]
    return "\n".join(f"{name:10}{printable(value, LINE)}" for name, value in lines)


def _read_values(file: Contents, front: Words) -> tuple[str, Mapping[str, Any]]:
    """Which field table the file has, and its common block; {} if it cannot be read here."""
    if front.table is read_table():
        return "that of this program", front.common
    try:
        seen = read_state(file, front)
    except RefusedError as error:
        return f"not that of this program: {error.what.removeprefix(OTHER_TABLE)}", {}
    values = {one.name: variable(seen.array.h, one)[0] for one in read_table().common if one.count == 1}
    return f"another one: {', '.join(seen.news)}" if seen.news else "that of this program", values


def _shown(text: bytes) -> str:
    return printable(text.decode("utf-8", "backslashreplace"))


def _format(file: Contents) -> str:
    major, minor = file.attribute_numbers("", "format_version", "<i4", (2,))
    return f"udec_ia restart {major}.{minor}, complete, checksum right"


def _written(file: Contents) -> str:
    versions = ", ".join(f"{name} {_shown(file.attribute('provenance', name))}" for name in PROGRAMS)
    return f"{_shown(file.string('volatile/date'))} on {_shown(file.string('volatile/host'))} by {versions}"


def _state(file: Contents, values: Mapping[str, Any]) -> list[tuple[str, str]]:
    fixed = file.attribute_numbers("heap/IA", "mtop_fixed", "i1")
    top = f"fixed at {values['MTOP']}" if fixed else "grows as needed"
    error = int(values.get("NSPOIL", 0))
    blocks, contacts, domains = (
        counted(int(values[name]), what)
        for name, what in (("NBLK", "block"), ("NCON", "contact"), ("NDOM", "domain"))
    )
    cycles = counted(int(values["MCTOT"]), "cycle")
    return [
        ("IA()", f"{values['MFREE'] - 1} words in use; its size {top}"),
        ("model", f"{blocks}, {contacts} ({values['NVIRT']} virtual), {domains}"),
        *([("zones", TURNS_SLOWLY.format(values["ZINER"]))] if values["ZINER"] > GREATER else []),
        ("run", f"{cycles}, time {values['TIME']:.6g} s, time-step {values['TDEL']:.6g} s"),
        *([("ended", spoilt(error, int(values["MCSPOI"])))] if error in MESSAGES else []),
        *(("check", text) for text in unfinished(int(values["JPHASE"]), error, int(values["MCSPOI"]))),
    ]
