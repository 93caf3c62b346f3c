"""What a restart file says about itself (`udec info FILE`), without making an array of it."""

from __future__ import annotations

from pathlib import Path

import h5py

from offsets import generated as g
from offsets.table import read_table
from udec_ia.heap.words import Scheme
from udec_ia.restart.reader import (
    attribute,
    layout_faults,
    opened,
    read_common,
    read_deck,
    read_laws,
    read_scheme,
    shorten,
    string,
)
from udec_ia.restart.refusal import refusing


def info(path: str | Path) -> str:
    """The header of the restart file `path`, in lines of `name  value`.

    A file with another field table is described too, as far as its common block has the variables.
    Raises UdecError 29 if the file is foreign, damaged or of another format.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        scheme = read_scheme(file)
        lines = [("file", str(path)), ("format", _format(file)), ("written", _written(file))]
        lines += [("words", f"{scheme.name}: {scheme.int_bits}-bit integers, {scheme.real_bits}-bit reals")]
        faults = layout_faults(file)
        lines += [
            ("layout", f"not that of this program: {shorten(faults)}" if faults else "that of this program")
        ]
        lines += [] if faults else _state(file, scheme)
        lines += [("deck", f"{len(read_deck(file))} command lines")]
        lines += [("law", f"{name} of {origin}, sha256 {d}") for name, (origin, d) in read_laws(file).items()]
        lines += [("heap", f"sha256 {attribute(file, 'heap/IA', 'sha256')}")]
    return "\n".join(f"{name:10}{value}" for name, value in lines)


def _format(file: h5py.File) -> str:
    major, minor = file.attrs["format_version"]
    return f"udec_ia restart {major}.{minor}, complete, checksum right"


def _written(file: h5py.File) -> str:
    versions = ", ".join(
        f"{name} {bytes(value).decode()}" for name, value in file["provenance"].attrs.items()
    )
    return (
        f"{string(file, 'volatile/date').decode()} on {string(file, 'volatile/host').decode()} by {versions}"
    )


def _state(file: h5py.File, scheme: Scheme) -> list[tuple[str, str]]:
    ci, cr = read_common(file, scheme, read_table())
    top = f"fixed at {ci[g.MTOP]}" if file["heap/IA"].attrs["mtop_fixed"] else "grows as needed"
    return [
        ("IA()", f"{ci[g.MFREE] - 1} words in use; its size {top}"),
        (
            "model",
            f"{ci[g.NBLK]} blocks, {ci[g.NCON]} contacts ({ci[g.NVIRT]} virtual), {ci[g.NDOM]} domains",
        ),
        ("run", f"{ci[g.MCTOT]} cycles, time {cr[g.TIME]:.6g} s, time-step {cr[g.TDEL]:.6g} s"),
    ]
