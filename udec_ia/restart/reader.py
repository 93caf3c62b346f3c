"""RESTART: the state of a run out of a restart file, or a refusal that says why not.

Nothing in the file is believed before it is tested: seal, format, completeness, field table, word
widths, types and shapes, checksums, bounds, and at last the lists and pointers of the heap itself.
"""

from __future__ import annotations

import hashlib
import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np

from offsets.generated import DTOL, JPHASE, MFREE, MTOP
from offsets.table import Table, TableError, read_table
from udec_ia.heap.array import MainArray
from udec_ia.heap.words import ALL_SCHEMES, Scheme
from udec_ia.inspect.check import check_links
from udec_ia.kernels.cycle import BLOCKS, BROKEN
from udec_ia.kernels.tolerances import tolset
from udec_ia.restart.layout import common_places, differences
from udec_ia.restart.refusal import OTHER_FILE, RefusedError, refusing
from udec_ia.restart.seal import read_sealed

SHOWN = 3  # differences or violations that a refusal lists


class Restored(NamedTuple):
    """What a restart file holds.

    deck: the command lines that led to the state. laws: file and SHA-256 of each constitutive law of the
    user's that it was calculated with.
    """

    array: MainArray
    deck: list[str]
    laws: dict[str, tuple[str, str]]


def load(path: str | Path) -> Restored:
    """The state in the restart file `path`, in the file's own word scheme.

    Raises UdecError 29, and nothing else, if the file is not exactly what `save` wrote or its heap is
    unsound.
    """
    path = Path(path)
    with refusing(path), opened(path) as file:
        check_layout(file)
        array = _read_state(file)
        restored = Restored(array, read_deck(file), read_laws(file))
        _check_heap(array)
    return restored


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """The HDF5 part of a sealed, complete restart file of a format that this program reads."""
    if not path.exists():
        raise RefusedError("does not exist", OTHER_FILE)
    if not path.is_file():
        raise RefusedError("is not a file", OTHER_FILE)
    with path.open("rb") as stream:
        data, version = read_sealed(stream, path.stat().st_size)
    with h5py.File(io.BytesIO(data), "r") as file:
        if attribute(file, "/", "format") != "udec_ia restart":
            raise RefusedError("is an HDF5 file, but not a restart file of udec_ia", OTHER_FILE)
        if tuple(file.attrs["format_version"]) != version:
            raise RefusedError("is damaged: its first lines name another format version than the rest")
        if file.attrs.get("complete") != 1:
            raise RefusedError("is not complete: the program that wrote it did not come to the end")
        yield file


def attribute(file: h5py.File, place: str, name: str) -> str:
    """A text attribute."""
    return bytes(file[place].attrs[name]).decode()


def string(file: h5py.File, name: str) -> bytes:
    """A text dataset, as bytes."""
    node = file[name]
    return bytes(_values(file, name, np.dtype(f"S{node.dtype.itemsize}"), ()))


def read_deck(file: h5py.File) -> list[str]:
    """The executed command lines."""
    return string(file, "deck").decode("utf-8", "surrogatepass").split("\n")[:-1]


def read_laws(file: h5py.File) -> dict[str, tuple[str, str]]:
    """The constitutive laws of the user's: name, and name of its file and SHA-256 of that file's text."""
    if "laws" not in file:  # format 1.0
        return {}
    return {
        name: (bytes(law.attrs["file"]).decode("utf-8", "surrogatepass"), bytes(law.attrs["sha256"]).decode())
        for name, law in file["laws"].items()
    }


def layout_faults(file: h5py.File) -> list[str]:
    """How the file's field table differs from this program's; empty if it is the same."""
    ours = read_table()
    written = string(file, "layout/table")
    digest = hashlib.sha256(written).hexdigest()
    if digest != attribute(file, "layout", "sha256"):
        raise RefusedError("is damaged: the checksum of its field table is wrong")
    if digest == ours.digest:
        return []
    try:
        return differences(ours, read_table(written.decode())) or ["only the wording differs"]
    except (TableError, UnicodeDecodeError) as error:
        return [f"it cannot be read here: {error}"]


def check_layout(file: h5py.File) -> None:
    """Refuse a file whose words stand in other places than this program's, or mean something else."""
    faults = layout_faults(file)
    if faults:
        raise RefusedError(
            f"was written with another field table: {shorten(faults)}",
            f"read it with the version that wrote it, udec_ia {attribute(file, 'provenance', 'udec_ia')}",
        )


def shorten(faults: list[str]) -> str:
    """The first few of `faults`, and how many there are."""
    more = [f"and {len(faults) - SHOWN} more"] if len(faults) > SHOWN else []
    return "; ".join(faults[:SHOWN] + more)


def read_scheme(file: h5py.File) -> Scheme:
    """The word scheme of the heap."""
    attrs = file["heap/IA"].attrs
    widths = tuple(int(attrs[name]) for name in ("int_bits", "real_bits", "ratio"))
    for scheme in ALL_SCHEMES.values():
        if widths == (scheme.int_bits, scheme.real_bits, scheme.ratio):
            return scheme
    raise RefusedError("has words of {} and {} bits, {} to a real: there is no such scheme".format(*widths))


def _values(file: h5py.File, name: str, dtype: np.dtype[Any], shape: tuple[int, ...]) -> Any:
    """The dataset `name`, if it has this type and shape and the file is large enough to hold it."""
    node = file[name]
    if not isinstance(node, h5py.Dataset):
        raise RefusedError(f"is damaged: /{name} is no dataset")
    if node.dtype != dtype or node.shape != shape:
        raise RefusedError(f"is damaged: /{name} is {node.dtype}{node.shape} instead of {dtype}{shape}")
    if node.nbytes > file.id.get_filesize():
        raise RefusedError(f"is damaged: /{name} is said to be larger than the file")
    return node[()]


def read_common(file: h5py.File, scheme: Scheme, layout: Table) -> tuple[Any, Any]:
    """Integers and reals of the common block, in the order of the field table."""
    parts: dict[bool, list[Any]] = {False: [], True: []}
    types = {False: np.dtype("<i8"), True: scheme.real_type.newbyteorder("<")}
    for field, _ in common_places(layout):
        shape = (field.count,) if field.count > 1 else ()
        values = _values(file, f"common/{field.name}", types[field.real], shape)
        parts[field.real].append(np.atleast_1d(values))
    integers, reals = (np.concatenate(parts[real]) for real in (False, True))
    _check_sum(file, "common", integers.tobytes() + reals.tobytes())
    return integers, reals


def _check_sum(file: h5py.File, place: str, content: Any) -> None:
    if hashlib.sha256(content).hexdigest() != attribute(file, place, "sha256"):
        raise RefusedError(f"is damaged: the checksum of /{place} is wrong")


def _read_state(file: h5py.File) -> MainArray:
    scheme = read_scheme(file)
    integers, reals = read_common(file, scheme, read_table())
    mfree, mtop = int(integers[MFREE]), int(integers[MTOP])
    if not (1 <= mfree <= mtop + 1 and mtop <= scheme.top_address and mtop % scheme.ratio == 0):
        raise RefusedError(f"is damaged: MFREE {mfree} and MTOP {mtop} cannot be in {scheme.name}")
    words = _values(file, "heap/IA", scheme.int_type.newbyteorder("<"), (mfree - 1,))
    _check_sum(file, "heap/IA", words)
    try:
        array = MainArray(scheme, max(mtop, 1))
    except (MemoryError, ValueError) as error:  # NumPy raises the latter beyond 2**63 bytes
        raise RefusedError(f"asks for {mtop} words, more memory than there is") from error
    array.fixed = bool(file["heap/IA"].attrs["mtop_fixed"])
    array.h.ia[: mfree - 1] = words
    array.h.ci[:] = integers
    array.h.cr[:] = reals
    return array


def _check_heap(array: MainArray) -> None:
    """Refuse a heap whose links are broken, whose materials do not exist or that stopped in no known pass.

    Compiled routines follow these without a further test. Forces and overlaps that have run away are
    taken: such a state is there to be looked at.
    """
    faults = [violation.message for violation in check_links(array)]
    if faults:
        raise RefusedError(f"holds an unsound heap: {shorten(faults)}")
    phase = int(array.h.ci[JPHASE])
    if not BLOCKS <= phase <= BROKEN:
        raise RefusedError(f"is to be resumed in pass {phase} of the cycle, and there is none")
    _check_tolerances(array)


def _check_tolerances(array: MainArray) -> None:
    """Refuse tolerances that are not those of the rounding length: updates would not come to an end."""
    reals = array.h.cr
    written, d = reals.copy(), reals[DTOL]
    tolset(array.h, d)
    alike = np.allclose(written, reals, rtol=4 * np.finfo(reals.dtype).eps, atol=0, equal_nan=True)
    reals[:] = written
    if not (0 <= d < np.inf and alike):
        raise RefusedError(f"holds tolerances that are not those of its rounding length, {d:g}")
