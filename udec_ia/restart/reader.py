"""RESTART: the state of a run out of a restart file, or a refusal that says why not.

Nothing in the file is believed before it is tested: seal, format, completeness, field table, word
widths, types and shapes, checksums, bounds, and at last the lists and pointers of the heap itself.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from udec_ia.heap.array import MainArray, variable
from udec_ia.heap.words import ALL_SCHEMES, Scheme
from udec_ia.inspect.check import check_links
from udec_ia.inspect.check.common import check_common
from udec_ia.layout.table import Table, TableError, parse, read_table
from udec_ia.ops.laws.law_file import RESULTS
from udec_ia.ops.run.watch import Series
from udec_ia.printable import printable
from udec_ia.restart.contents import Contents, contents
from udec_ia.restart.layout import differences, losses
from udec_ia.restart.recorded import recall
from udec_ia.restart.refusal import OTHER_FILE, RefusedError, refusing
from udec_ia.restart.seal import read_sealed

SHOWN = 3  # differences or violations that a refusal lists
MAX_FAULT = 200  # characters of one of them
MAX_TABLE = 2**20  # bytes of another field table, which is read like a program


class Restored(NamedTuple):
    """What a restart file holds.

    deck: the command lines that led to the state. laws: file and SHA-256 of each constitutive law of the
    user's that it was calculated with.
    """

    array: MainArray
    deck: list[str]
    laws: dict[str, tuple[str, str]]
    series: list[Series]


def load(path: str | Path) -> Restored:
    """The state in the restart file `path`, in the file's own word scheme.

    Raises UdecError 29, and nothing else, if the file is not exactly what `save` wrote or its heap is
    unsound.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        array = _read_state(file)
        _check_heap(array)
        return Restored(array, read_deck(file), read_laws(file), recall(file, array))


def look_into(path: str | Path) -> MainArray:
    """The array in the restart file `path`, in whatever state its heap is: to look at, not to go on with.

    Raises UdecError 29 if the file is not what `save` wrote.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        return _read_state(file)


def deck_in(path: str | Path) -> list[str]:
    """The command lines that led to the state in the restart file `path`. Raises as `look_into` does."""
    path = Path(path)
    with refusing(path), opened(path) as file:
        return read_deck(file)


@contextmanager
def opened(path: Path) -> Iterator[Contents]:
    """The contents of a sealed, complete restart file of a format that this program reads."""
    if not path.exists():
        raise RefusedError("does not exist", OTHER_FILE)
    if not path.is_file():
        raise RefusedError("is not a file", OTHER_FILE)
    with path.open("rb") as stream:
        data, version = read_sealed(stream, path.stat().st_size)
    with contents(data) as file:
        if file.attribute("", "format") != b"udec_ia restart":
            raise RefusedError("is an HDF5 file, but not a restart file of udec_ia", OTHER_FILE)
        if tuple(file.attribute_numbers("", "format_version", "<i4", (2,))) != version:
            raise RefusedError("is damaged: its first lines name another format version than the rest")
        if not file.has_attribute("", "complete") or file.attribute_numbers("", "complete", "i1") != 1:
            raise RefusedError("is not complete: the program that wrote it did not come to the end")
        yield file


def read_deck(file: Contents) -> list[str]:
    """The executed command lines."""
    return file.string("deck").decode("utf-8", "surrogatepass").split("\n")[:-1]


def read_laws(file: Contents) -> dict[str, tuple[str, str]]:
    """The constitutive laws of the user's: name, and name of its file and SHA-256 of that file's text."""
    if not file.has("laws"):  # format 1.0
        return {}
    found = {}
    for name in RESULTS:
        if file.has(place := f"laws/{name}"):
            origin = file.attribute(place, "file").decode("utf-8", "surrogatepass")
            found[name] = origin, file.attribute(place, "sha256").decode()
    return found


def read_their_table(file: Contents) -> Table:
    """The field table that the file was written with."""
    written = file.string("layout/table")
    digest = hashlib.sha256(written).hexdigest()
    if digest.encode() != file.attribute("layout", "sha256"):
        raise RefusedError("is damaged: the checksum of its field table is wrong")
    if digest == read_table().digest:
        return read_table()
    if len(written) > MAX_TABLE:
        raise RefusedError(f"has a field table of {len(written)} bytes")
    try:
        return parse(written.decode())
    except (TableError, UnicodeDecodeError) as error:
        raise _other_table(file, [f"it cannot be read here: {error}"]) from error


def _other_table(file: Contents, faults: list[str]) -> RefusedError:
    version = file.attribute("provenance", "udec_ia").decode("utf-8", "backslashreplace")
    return RefusedError(
        f"was written with another field table: {shorten(faults)}",
        f"read it with the version that wrote it, udec_ia {printable(version)}",
    )


def shorten(faults: list[str]) -> str:
    """The first few of `faults`, and how many there are."""
    more = [f"and {len(faults) - SHOWN} more"] if len(faults) > SHOWN else []
    return "; ".join([printable(fault, MAX_FAULT) for fault in faults[:SHOWN]] + more)


def read_scheme(file: Contents) -> Scheme:
    """The word scheme of the heap."""
    names = ("int_bits", "real_bits", "ratio")
    widths = tuple(int(file.attribute_numbers("heap/IA", name, "<i4")) for name in names)
    for scheme in ALL_SCHEMES.values():
        if widths == (scheme.int_bits, scheme.real_bits, scheme.ratio):
            return scheme
    raise RefusedError("has words of {} and {} bits, {} to a real: there is no such scheme".format(*widths))


def read_common(file: Contents, scheme: Scheme, table: Table) -> dict[str, Any]:
    """The variables of the common block by name, as the field table `table` of the file has them."""
    types = {"int": "<i8", "real": scheme.real_type.newbyteorder("<"), "double": "<f8"}
    shapes = {field.name: (field.count,) if field.count > 1 else () for field in table.common}
    values = {
        field.name: file.numbers(f"common/{field.name}", types[field.type], shapes[field.name])
        for field in table.common
    }
    parts = [values[field.name] for kind in types for field in table.common if field.type == kind]
    _check_sum(file, "common", b"".join(part.tobytes() for part in parts))
    return values


def _check_sum(file: Contents, place: str, content: Any) -> None:
    if hashlib.sha256(content).hexdigest().encode() != file.attribute(place, "sha256"):
        raise RefusedError(f"is damaged: the checksum of /{place} is wrong")


def _read_state(file: Contents) -> MainArray:
    scheme, ours, theirs = read_scheme(file), read_table(), read_their_table(file)
    values = read_common(file, scheme, theirs)
    faults = differences(ours, theirs) + losses(ours, theirs, values)
    if faults:
        raise _other_table(file, faults)
    mfree, mtop = (int(values.get(name, 0)) for name in ("MFREE", "MTOP"))
    if not (1 <= mfree <= mtop + 1 and mtop <= scheme.top_address and mtop % scheme.ratio == 0):
        raise RefusedError(f"is damaged: MFREE {mfree} and MTOP {mtop} cannot be in {scheme.name}")
    words = file.words("heap/IA", scheme.int_type.newbyteorder("<"), mfree - 1)
    _check_sum(file, "heap/IA", words)
    try:
        array = MainArray(scheme, max(mtop, 1))
    except (MemoryError, ValueError) as error:  # NumPy raises the latter beyond 2**63 bytes
        raise RefusedError(f"asks for {mtop} words, more memory than there is") from error
    array.fixed = bool(file.attribute_numbers("heap/IA", "mtop_fixed", "i1"))
    array.h.ia[: mfree - 1] = words
    for field in ours.common:
        variable(array.h, field)[:] = values.get(field.name, 0)
    return array


def _check_heap(array: MainArray) -> None:
    """Refuse a heap whose links are broken or whose codes, such as materials or the pass, do not exist.

    Compiled routines follow these without a further test. Forces and overlaps that have run away are
    taken: such a state is there to be looked at.
    """
    faults = [violation.message for violation in check_links(array) or check_common(array)]
    if faults:
        raise RefusedError(f"holds an unsound heap: {shorten(faults)}")
