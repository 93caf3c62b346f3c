"""What a restart file says about itself (`udec info FILE`), without making an array of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from udec_ia.errors import MESSAGES, spoilt
from udec_ia.layout.table import read_table
from udec_ia.printable import printable
from udec_ia.restart.contents import Contents
from udec_ia.restart.layout import differences, losses
from udec_ia.restart.reader import (
    opened,
    read_common,
    read_deck,
    read_laws,
    read_scheme,
    read_their_table,
    shorten,
)
from udec_ia.restart.refusal import refusing

PROGRAMS = ("udec_ia", "python", "numpy", "numba", "h5py", "hdf5")
LINE = 1000  # characters


def info(path: str | Path) -> str:
    """The header of the restart file `path`, in lines of `name  value`, which are safe to print.

    A file with another field table is described too, as far as it can be read here. Raises UdecError 29 if
    the file is foreign, damaged or of another format.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        scheme, ours, theirs = read_scheme(file), read_table(), read_their_table(file)
        values = read_common(file, scheme, theirs)
        faults = differences(ours, theirs) + losses(ours, theirs, values)
        lines = [("file", str(path)), ("format", _format(file)), ("written", _written(file))]
        lines += [("words", f"{scheme.name}: {scheme.int_bits}-bit integers, {scheme.real_bits}-bit reals")]
        lines += [
            ("layout", f"not that of this program: {shorten(faults)}" if faults else "that of this program")
        ]
        lines += [] if faults else _state(file, values)
        lines += [("deck", f"{len(read_deck(file))} command lines")]
        lines += [("law", f"{name} of {origin}, sha256 {d}") for name, (origin, d) in read_laws(file).items()]
        lines += [("heap", f"sha256 {_shown(file.attribute('heap/IA', 'sha256'))}")]
    return "\n".join(f"{name:10}{printable(value, LINE)}" for name, value in lines)


def _shown(text: bytes) -> str:
    return printable(text.decode("utf-8", "backslashreplace"))


def _format(file: Contents) -> str:
    major, minor = file.attribute_numbers("", "format_version", "<i4", (2,))
    return f"udec_ia restart {major}.{minor}, complete, checksum right"


def _written(file: Contents) -> str:
    versions = ", ".join(f"{name} {_shown(file.attribute('provenance', name))}" for name in PROGRAMS)
    return f"{_shown(file.string('volatile/date'))} on {_shown(file.string('volatile/host'))} by {versions}"


def _state(file: Contents, values: dict[str, Any]) -> list[tuple[str, str]]:
    fixed = file.attribute_numbers("heap/IA", "mtop_fixed", "i1")
    top = f"fixed at {values['MTOP']}" if fixed else "grows as needed"
    error = int(values.get("NSPOIL", 0))
    blocks = "{NBLK} blocks, {NCON} contacts ({NVIRT} virtual), {NDOM} domains"
    return [
        ("IA()", f"{values['MFREE'] - 1} words in use; its size {top}"),
        ("model", blocks.format(**values)),
        ("run", "{MCTOT} cycles, time {TIME:.6g} s, time-step {TDEL:.6g} s".format(**values)),
        *([("ended", spoilt(error, int(values["MCSPOI"])))] if error in MESSAGES else []),
    ]
