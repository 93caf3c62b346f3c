"""SAVE: the state of a run into a restart file, all of it or nothing.

The HDF5 part is made in memory and sealed there, so that neither a full disk nor a kill can leave HDF5
with half a file. It then goes to a temporary file in the same folder, is forced to the disk and renamed:
whatever happens, the file is the old one or the new one, never a part of either.
"""

from __future__ import annotations

import hashlib
import io
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from udec_ia.file_replacement import put_in_place
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import Scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import COMMON_TYPES, TABLE, Table, lay_out, read_table
from udec_ia.ops.commands.history_definitions import definitions
from udec_ia.reader.group_tables import column_names, tables
from udec_ia.reader.list_walks import Unsound
from udec_ia.restart.file_seal import SIZE, VERSION, RefusedError, read_front, refusing, seal
from udec_ia.restart.file_tables import MARK, MARKED, common_places, field_rows, shorten, text
from udec_ia.restart.hdf5_contents import CHUNK
from udec_ia.restart.restart_reader import Restored, opened, read_deck, read_header, read_laws, read_state
from udec_ia.restart.stored_histories import (
    RECORDED,
    complete_series,
    has_readable_histories,
    read_histories,
    write_histories,
)
from udec_ia.running.history_series import Series
from udec_ia.version import __version__

COMMON = "common"
LIBRARY = "v108", "v108"  # the oldest and the newest format of HDF5 that a file may have
HOST_LENGTH = 64


NO_LAWS: Mapping[str, tuple[str, str]] = {}


def save(
    array: MainArray,
    path: str | Path,
    deck: Sequence[str] = (),
    laws: Mapping[str, tuple[str, str]] = NO_LAWS,
    series: Sequence[Series] = (),
    unsound: Sequence[str] = (),
) -> Path:
    """Write `array`, the command lines that led to it and what was recorded to the restart file `path`.

    laws: file and SHA-256 of each law of the user that the state was calculated with.
    unsound: what is wrong with the state, if anything is known to be: the file is marked with that.
    The folder is made if it is not there. Two files of one state differ in /volatile only, and in the
    checksum of the seal. Raises UdecError 31 if the file cannot be written, or would replace
    another kind of file.
    """
    path = Path(path)
    put_in_place(path, restart_image(array, deck, laws, series, unsound), _judge)
    return path


def _judge(front: bytes, size: int) -> str:
    """Why a file that begins with `front` is no restart file; "" if it is one."""
    try:
        read_front(front, size)
    except RefusedError as error:
        return error.what
    return ""


def restart_image(
    array: MainArray,
    deck: Sequence[str] = (),
    laws: Mapping[str, tuple[str, str]] = NO_LAWS,
    series: Sequence[Series] = (),
    unsound: Sequence[str] = (),
) -> bytes:
    """The bytes of the whole file: no view of the buffer, which could not be closed before the view is."""
    frame = _frame(array.scheme, read_table())
    buffer = io.BytesIO(frame.image)
    with h5py.File(buffer, "r+", libver=LIBRARY) as file:
        if unsound:
            file.attrs[MARK] = text(shorten(unsound, MARKED, "\n"))
        _write_heap(file, array)
        common = _common(array)
        file[COMMON].attrs.modify("sha256", text(hashlib.sha256(b"".join(common.values())).hexdigest()))
        file["deck"] = text("".join(line + "\n" for line in deck).encode("utf-8", "surrogatepass"))
        _write_laws(file, laws)
        _write_tables(file, array)
        if series := complete_series(array, series):
            write_histories(file.create_group(RECORDED), series)
        _write_volatile(file)
        file.attrs["complete"] = np.int8(1)
    with buffer.getbuffer() as image, image[SIZE:] as body:
        for kind, start, end, at in frame.places:
            image[at : at + end - start] = common[kind][start:end]
        image[:SIZE] = seal(body)
    return buffer.getvalue()


class _Frame(NamedTuple):
    """A file but for what differs from state to state: the numbers of /common are all 0.

    places: for each variable of the common block, its type, where its bytes begin and end among those of its
    type, and where they stand in the file.
    """

    image: bytes
    places: list[tuple[str, int, int, int]]


@cache
def _frame(scheme: Scheme, table: Table) -> _Frame:
    """The frame of all files with words of `scheme`. HDF5 takes its time for a hundred small things."""
    buffer = io.BytesIO()
    with h5py.File(buffer, "w", userblock_size=SIZE, libver=LIBRARY) as file:
        file.attrs["format"] = text("udec_ia restart")
        file.attrs["format_version"] = np.array(VERSION, "<i4")
        file.attrs["byte_order"] = text("little-endian")
        places = _write_common(file, scheme, table)
        _write_layout(file, table, scheme.ratio)
        _write_provenance(file)
    return _Frame(buffer.getvalue(), places)


def _write_heap(file: h5py.File, array: MainArray) -> None:
    """/heap/IA: the words below MFREE; above it there is nothing that counts."""
    scheme = array.scheme
    words = array.h.ia[: int(array.h.ci[g.MFREE]) - 1].astype(scheme.int_type.newbyteorder("<"), copy=False)
    chunk = min(max(len(words), 1), CHUNK)
    heap = file.create_dataset("heap/IA", data=words, chunks=(chunk,), maxshape=(None,), fletcher32=True)
    heap.attrs["int_bits"] = np.int32(scheme.int_bits)
    heap.attrs["real_bits"] = np.int32(scheme.real_bits)
    heap.attrs["ratio"] = np.int32(scheme.ratio)
    heap.attrs["first_address"] = np.int32(1)
    heap.attrs["mtop_fixed"] = np.int8(array.fixed)
    heap.attrs["sha256"] = text(hashlib.sha256(words).hexdigest())


def _common(array: MainArray) -> dict[str, bytes]:
    """The common block, by type."""
    parts = zip(COMMON_TYPES, (array.h.ci, array.h.cr, array.h.cd), strict=True)
    return {kind: part.astype(part.dtype.newbyteorder("<"), copy=False).tobytes() for kind, part in parts}


def _write_common(file: h5py.File, scheme: Scheme, table: Table) -> list[tuple[str, int, int, int]]:
    """/common: a dataset of zeros for each variable of the common block. Returns the places of a _Frame."""
    group = file.create_group(COMMON)
    types = dict(zip(COMMON_TYPES, (np.dtype(np.int64), scheme.real_type, np.dtype(float)), strict=True))
    places = []
    for field, place in common_places(table):
        kind = types[field.type].newbyteorder("<")
        shape = (field.count,) if field.count > 1 else ()
        dataset = group.create_dataset(field.name, data=np.zeros(shape, kind))
        dataset.attrs["unit"] = text(field.unit)
        dataset.attrs["text"] = text(field.text)
        start, end = place.start * kind.itemsize, place.stop * kind.itemsize
        places.append((field.type, start, end, dataset.id.get_offset()))
    group.attrs["sha256"] = text(hashlib.sha256().hexdigest())
    return places


def _write_layout(file: h5py.File, table: Table, ratio: int) -> None:
    """/layout: the field table as it is, and one table for each kind of group."""
    layout = file.create_group("layout")
    layout.attrs["sha256"] = text(table.digest)
    layout["table"] = text(TABLE.read_text())
    for group in table.groups:
        layout[group.name] = field_rows(group, ratio)
        attrs = layout[group.name].attrs
        attrs["text"] = text(group.text)
        attrs["size_name"] = text(group.size_name)
        attrs["size"] = np.int32(lay_out(group, ratio).size)
        attrs["list_head"] = text(group.list_head or "-")
        for head in table.heads:
            if head.group == group.name:
                attrs[head.name] = np.int32(head.value)


def _write_tables(file: h5py.File, array: MainArray) -> None:
    """/tables: the groups of each kind, to be read without this program; none of a broken heap."""
    try:
        found = tables(array)
    except (Unsound, IndexError):
        return
    for kind, rows in found.items():
        fields = [(name, field) for field in read_table().group(kind).fields for name in column_names(field)]
        kinds = [("address", np.int64), *((name, rows.dtype[field.name].base) for name, field in fields)]
        rows = rows.view(kinds).astype(np.dtype(kinds).newbyteorder("<"), copy=False)
        dataset = file.create_dataset(
            f"tables/{kind}", data=rows, compression="gzip", compression_opts=1, shuffle=True
        )
        dataset.attrs["units"] = text("\n".join(["-", *(field.unit for _, field in fields)]))
        dataset.attrs["texts"] = text("\n".join(["address in IA()", *(field.text for _, field in fields)]))


def _write_laws(file: h5py.File, laws: Mapping[str, tuple[str, str]]) -> None:
    """/laws: one group for each of the user's constitutive laws."""
    group = file.create_group("laws")
    for name, (origin, digest) in laws.items():
        attrs = group.create_group(name).attrs
        attrs["file"] = text(origin.encode("utf-8", "surrogatepass"))
        attrs["sha256"] = text(digest)


def _write_provenance(file: h5py.File) -> None:
    """/provenance: the programs that made the state."""
    attrs = file.create_group("provenance").attrs
    attrs["udec_ia"] = text(__version__)
    attrs["python"] = text(platform.python_version())
    attrs["numpy"] = text(np.__version__)
    attrs["numba"] = text(metadata.version("numba"))
    attrs["h5py"] = text(h5py.__version__)
    attrs["hdf5"] = text(h5py.version.hdf5_version)


def _write_volatile(file: h5py.File) -> None:
    """/volatile: when and where; of fixed length, so that nothing else moves."""
    volatile = file.create_group("volatile")
    volatile["date"] = text(_now())
    volatile["host"] = text(platform.node().encode()[:HOST_LENGTH].ljust(HOST_LENGTH, b"\0"))


def _now() -> str:
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def load_to_change(path: str | Path) -> Restored:
    """All that the restart file `path` holds, its heap in whatever state it is.

    Raises UdecError 29 if the file is not what `save` wrote, or if its histories cannot be read.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        seen = read_state(file, read_header(file))
        if not has_readable_histories(seen.array):
            raise RefusedError("does not say what its histories have recorded: the list of them is broken")
        series = read_histories(file, seen.array, bool(seen.mark))
        return Restored(seen.array, read_deck(file), read_laws(file), series, seen.notes, seen.mark)


def save_changed(
    state: Restored, array: MainArray, path: str | Path, line: str, unsound: Sequence[str] = ()
) -> Path:
    """Write `array`, which was made of that of `state`, with all else of `state` to the file `path`.

    line: what the deck is to say of it, a command or a comment. unsound: what is wrong with it, with which
    the file is marked. Raises UdecError 31 as `save` does.
    """
    if has_readable_histories(array):
        for series, definition in zip(state.series, definitions(array), strict=False):
            series.set_address(definition)
    return save(array, path, [*state.deck, line], state.laws, state.series, unsound)
