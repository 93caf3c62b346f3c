"""RESTART: the state of a run is read from a restart file, or the file is refused with the reason.

Everything in the file is tested before it is used: seal, format, completeness, field table, word widths,
types and shapes, checksums, limits, and at last the lists and pointers of the heap itself. A file that was
written with another field table is read by the names of that table (field_translation.py).
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from udec_ia.checker import check, check_links
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import ALL_SCHEMES, Scheme
from udec_ia.heap_tools.field_translation import translate
from udec_ia.heap_tools.table_translation import news
from udec_ia.heap_tools.written_state import TranslationError, Words
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Table, TableError, parse, read_table
from udec_ia.ops.laws.law_file import RESULTS
from udec_ia.printable_text import printable
from udec_ia.restart.file_seal import OTHER_FILE, OTHER_TABLE, RefusedError, read_sealed, refusing
from udec_ia.restart.file_tables import MARK, MAX_FAULT, shorten, table_faults
from udec_ia.restart.hdf5_contents import Contents, contents
from udec_ia.restart.stage_file import is_stage, read_stage
from udec_ia.restart.stored_histories import has_readable_histories, read_histories
from udec_ia.running.history_series import Series

FORCE = "udec check FILE lists all faults; RESTART FILE FORCE reads it for inspection and repair"
MAX_TABLE = 2**18  # bytes of another field table, which is read like a program


class StoredState(NamedTuple):
    """The array in a restart file, and notes on it.

    news: in phrases, what its field table says in another way than that of this program; [] if nothing.
    mark: what SAVE ... FORCE has found wrong with the state; [] if nothing.
    """

    array: MainArray
    news: list[str]
    mark: list[str]

    @property
    def notes(self) -> list[str]:
        """The same in sentences, safe to print."""
        news = [printable(one, MAX_FAULT) for one in self.news]
        return [
            *(["read with another field table: " + ", ".join(news)] if news else []),
            *([f"saved by force, being unsound: {shorten(self.mark)}"] if self.mark else []),
        ]


class Restored(NamedTuple):
    """What a restart file holds.

    deck: the command lines that led to the state. laws: file and SHA-256 of each of the user's constitutive
    laws that it was calculated with. notes: sentences on how it was read. unsound: what is wrong with its
    links and codes, which must not be followed then.
    """

    array: MainArray
    deck: list[str]
    laws: dict[str, tuple[str, str]]
    series: list[Series]
    notes: list[str]
    unsound: list[str]


def load(path: str | Path, force: bool = False, unchecked: bool = False) -> Restored:
    """The state in the restart file `path`, in the file's own word scheme.

    Raises UdecError 29, and nothing else, if the file is not exactly what `save` wrote or, unless taken by
    `force`, its state is unsound or it is marked as that. unchecked: only the links and codes are proved.
    """
    path = Path(path)
    with refusing(path):
        with opened(path) as file:
            seen = read_state(file, read_header(file))
            known = has_readable_histories(seen.array)
            series = read_histories(file, seen.array, bool(seen.mark)) if known else []
            deck, laws = read_deck(file), read_laws(file)
        faults = _faults(seen.array, unchecked)  # takes memory, when that of the file is free again
        if seen.mark and not force:
            raise RefusedError(f"was saved by force, being unsound: {shorten(seen.mark)}", FORCE)
        if faults and not force:
            raise RefusedError(f"holds an unsound heap: {shorten(faults)}", FORCE)
        return Restored(seen.array, deck, laws, series, seen.notes, faults)


def read_stored_state(path: str | Path) -> StoredState:
    """The array in the restart file `path`, sound or not, for inspection only.

    Raises UdecError 29 if the file is not what `save` wrote.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        return read_state(file, read_header(file))


def look_into(path: str | Path) -> MainArray:
    """The array in the restart file `path` alone, as `read_stored_state` returns it."""
    return read_stored_state(path).array


def deck_in(path: str | Path) -> list[str]:
    """The command lines that led to the state in the restart file `path`. Raises as `look_into` does."""
    path = Path(path)
    with refusing(path), opened(path) as file:
        return read_deck(file)


@contextmanager
def opened(path: Path) -> Iterator[Contents]:
    """The contents of a sealed, complete restart file of a format that this program reads."""
    if is_stage(path):
        image = read_stage(path)
        data, version = read_sealed(io.BytesIO(image), len(image))
    elif not path.exists():
        raise RefusedError("does not exist", OTHER_FILE)
    elif not path.is_file():
        raise RefusedError("is not a file", OTHER_FILE)
    else:
        with path.open("rb") as stream:
            data, version = read_sealed(stream, os.fstat(stream.fileno()).st_size)
    with contents(data) as file:
        if file.attribute("", "format") != b"udec_ia restart":
            raise RefusedError("is an HDF5 file, but not a restart file of udec_ia", OTHER_FILE)
        if tuple(file.attribute_numbers("", "format_version", "<i4", (2,))) != version:
            raise RefusedError("is damaged: its first lines and the rest name different format versions")
        if not file.has_attribute("", "complete") or file.attribute_numbers("", "complete", "i1") != 1:
            raise RefusedError("is not complete: the program that wrote it did not finish")
        yield file


def read_deck(file: Contents) -> list[str]:
    """The executed command lines."""
    return file.string("deck").decode("utf-8", "surrogatepass").split("\n")[:-1]


def read_laws(file: Contents) -> dict[str, tuple[str, str]]:
    """The user's constitutive laws: name, and name of its file and SHA-256 of that file's text."""
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
        table = parse(written.decode())
    except (TableError, UnicodeDecodeError) as error:
        raise _other_table(file, [f"it cannot be read here: {error}"]) from error
    if faults := table_faults(table):
        raise _other_table(file, faults)
    return table


def _other_table(file: Contents, faults: list[str]) -> RefusedError:
    version = file.attribute("provenance", "udec_ia").decode("utf-8", "backslashreplace")
    return RefusedError(
        OTHER_TABLE + shorten(faults),
        f"read it with the version that wrote it, udec_ia {printable(version)}",
    )


def read_scheme(file: Contents) -> Scheme:
    """The word scheme of the heap."""
    names = ("int_bits", "real_bits", "ratio")
    widths = tuple(int(file.attribute_numbers("heap/IA", name, "<i4")) for name in names)
    for scheme in ALL_SCHEMES.values():
        if widths == (scheme.int_bits, scheme.real_bits, scheme.ratio):
            return scheme
    raise RefusedError(
        "has words of {} and {} bits, {} to a real: there is no such word scheme".format(*widths)
    )


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


def read_header(file: Contents) -> Words:
    """The state in the file but for the words of IA(), in the words and by the table of the file."""
    scheme, table = read_scheme(file), read_their_table(file)
    return Words(table, scheme, (), read_common(file, scheme, table))


def read_state(file: Contents, front: Words) -> StoredState:
    """The array of the file, whose `front` was read before."""
    scheme, ours, theirs = front.scheme, read_table(), front.table
    mfree, mtop = front.integer("MFREE"), front.integer("MTOP")
    if not (1 <= mfree <= mtop + 1 and mtop <= scheme.top_address and mtop % scheme.ratio == 0):
        raise RefusedError(f"is damaged: MFREE {mfree} and MTOP {mtop} are impossible in {scheme.name}")
    file.has_words("heap/IA", mfree - 1, scheme.int_type.itemsize)
    if theirs is ours:
        array = _array(front)
        _read_words(file, scheme, array.h.ia[: mfree - 1])
    else:
        words = np.empty(mfree - 1, scheme.int_type)
        _read_words(file, scheme, words)
        try:
            state = translate(front._replace(ia=words), ours, scheme)
        except TranslationError as error:
            raise _other_table(file, error.faults) from error
        array = _array(state)
        array.h.ia[: len(state.ia)] = state.ia
    array.fixed = bool(file.attribute_numbers("heap/IA", "mtop_fixed", "i1"))
    return StoredState(array, [] if theirs is ours else news(theirs, ours), read_mark(file))


def _read_words(file: Contents, scheme: Scheme, into: Any) -> None:
    """Fill `into` with the words of IA()."""
    kind = scheme.int_type.newbyteorder("<")
    file.words("heap/IA", kind, into)
    _check_sum(file, "heap/IA", into.astype(kind, copy=False))


def _array(state: Words) -> MainArray:
    """An array of the size of `state` with its common block; IA() is yet to be filled."""
    mtop = state.integer("MTOP")
    try:
        array = MainArray(state.scheme, max(mtop, 1))
    except (MemoryError, ValueError) as error:  # NumPy raises the latter beyond 2**63 bytes
        raise RefusedError(f"needs {mtop} words, more than the memory available") from error
    for field in state.table.common:
        variable(array.h, field)[:] = state.common[field.name]
    return array


def _faults(array: MainArray, unchecked: bool) -> list[str]:
    """What is wrong with a state.

    Compiled routines follow links and codes, such as materials or the pass, without a further test: these are
    always proved. The rest is not with `unchecked`, or if an error has ended a run of the state: its forces
    and overlaps may have any value, and it is there to be inspected.
    """
    proof = check_links if unchecked or array.h.ci[g.NSPOIL] else check
    return [violation.message for violation in proof(array)]


def read_mark(file: Contents) -> list[str]:
    """What SAVE ... FORCE has found wrong with the state that it wrote; [] for a sound one."""
    if not file.has_attribute("", MARK):
        return []
    return file.attribute("", MARK).decode("utf-8", "backslashreplace").splitlines()
