"""The contents of a restart file: the header of each object is checked before a byte of it is read.

A checksum detects accidents, not intent: anybody who makes a file can seal it. An HDF5 file can point to
other files and to itself, and can declare numbers that take no room until they are read. A restart file needs
none of that. So only objects that a restart file has are opened, by name. They must be in the file itself,
not links, have the expected type and shape, be stored unpacked, and together be no larger than the file.
Reading takes memory and time in proportion to the size of the file, whatever it contains, and opens no other
file.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from math import prod
from typing import Any

import h5py
import numpy as np
from h5py import h5a, h5d, h5g, h5l, h5o, h5p, h5s, h5t, h5z

from udec_ia.restart.file_seal import HDF5_SIGNATURE, SIZE, RefusedError

CHUNK = 65536  # words of the heap in one piece
CHECKSUM = 4  # bytes of Fletcher-32 behind each piece; a SHA-256 covers all of them
MAX_TEXT = 4096  # bytes of an attribute
# How the HDF5 part begins: version 2, addresses and lengths of 8 bytes, written to its end, byte SIZE is its
# first, and no extension, which could describe other forms of storage.
SUPERBLOCK = HDF5_SIGNATURE + bytes((2, 8, 8, 0)) + SIZE.to_bytes(8, "little") + b"\xff" * 8


@contextmanager
def contents(image: bytes) -> Iterator[Contents]:
    """The contents of a whole restart file, seal included."""
    if image[SIZE : SIZE + len(SUPERBLOCK)] != SUPERBLOCK:
        raise RefusedError("is damaged: its HDF5 part does not begin as SAVE has it begin")
    with h5py.File(io.BytesIO(image), "r") as file:
        yield Contents(file, len(image))


class Contents:
    """The objects of a restart file.

    A place is the path of an object from the root, "" for the root itself. What is not there, or is not as it
    should be, is a RefusedError.
    """

    def __init__(self, file: h5py.File, size: int) -> None:
        self._root = h5g.open(file.id, b"/")
        self._groups: dict[str, Any] = {}  # by place, those that were found sound
        self._left = size  # bytes that may yet be read

    def has(self, place: str) -> bool:
        """True if there is an object at `place`."""
        above, _, name = place.rpartition("/")
        group = self._group(above)
        return bool(group.links.exists(name.encode()))

    def has_attribute(self, place: str, name: str) -> bool:
        """True if the object at `place` has this attribute."""
        return bool(h5a.exists(self._open(place), name.encode()))

    def string(self, place: str) -> bytes:
        """A text."""
        node = self._dataset(place, ())
        size = _size_of_text(node.get_type(), place)
        return bytes(self._read(place, node, np.dtype(f"S{size}"), ()))

    def numbers(self, place: str, kind: Any, shape: tuple[int, ...] | None) -> Any:
        """Numbers of the type `kind`; a row of any length if `shape` is None."""
        node = self._dataset(place, shape)
        _check_type(node.get_type(), kind, place)
        return self._read(place, node, np.dtype(kind), node.shape)

    def words(self, place: str, kind: Any, into: Any) -> None:
        """Fill the row `into` with words of the type `kind`, from pieces that have a checksum each."""
        many, size = len(into), np.dtype(kind).itemsize
        node = self._dataset(place, (many,))
        _check_type(node.get_type(), kind, place)
        plist = node.get_create_plist()
        piece = min(max(many, 1), CHUNK)
        filters = [plist.get_filter(i)[0] for i in range(plist.get_nfilters())]
        pieces = plist.get_chunk() if plist.get_layout() == h5d.CHUNKED else None
        if pieces != (piece,) or filters != [h5z.FILTER_FLETCHER32]:
            raise _damaged(place, "is not stored as SAVE stores it")
        raw = np.empty(piece * size + CHECKSUM, np.uint8)
        for first in range(0, many, piece):
            _, found = node.read_direct_chunk((first,), out=raw)
            if len(found) != len(raw):
                raise _damaged(place, f"has {len(found)} bytes in a piece of {len(raw)}")
            part = into[first : first + piece]
            part[:] = raw[:-CHECKSUM].view(kind)[: len(part)]

    def has_words(self, place: str, many: int, size: int) -> None:
        """Check in the header that there are `many` words of `size` bytes, and count them as read."""
        self._dataset(place, (many,))
        self._spend(place, many * size)

    def attribute(self, place: str, name: str) -> bytes:
        """The attribute of an object, a text."""
        found = self._attribute(place, name, ())
        kind = found.get_type()
        where = f"{place}, {name}"
        text = np.empty((), f"S{_size_of_text(kind, where, MAX_TEXT)}")
        found.read(text, kind)
        return bytes(text[()])

    def attribute_numbers(self, place: str, name: str, kind: str, shape: tuple[int, ...] = ()) -> Any:
        """The attribute of an object, numbers."""
        found = self._attribute(place, name, shape)
        _check_type(found.get_type(), kind, f"{place}, {name}")
        values = np.empty(shape, kind)
        found.read(values)
        return values

    def _open(self, place: str) -> Any:
        """The object at `place`, not through links."""
        if not place:
            return self._root
        above, _, last = place.rpartition("/")
        group, name = self._group(above), last.encode()
        if not group.links.exists(name):
            raise _damaged(place, "is not there")
        if group.links.get_info(name).type != h5l.TYPE_HARD:
            raise _damaged(place, "is a link that leads elsewhere")
        return h5o.open(group, name)

    def _group(self, place: str) -> Any:
        """The group at `place`, checked at the first call."""
        if place not in self._groups:
            node = self._open(place)
            if not isinstance(node, h5g.GroupID) or _filters(node):
                raise _damaged(place, "is no group")
            self._groups[place] = node
        return self._groups[place]

    def _dataset(self, place: str, shape: tuple[int, ...] | None) -> Any:
        """The dataset at `place`, if it has the shape, or one dimension if that is None."""
        node = self._open(place)
        if not isinstance(node, h5d.DatasetID):
            raise _damaged(place, "is no dataset")
        found = _shape(node)
        if found is None or (len(found) != 1 if shape is None else found != shape):
            wanted = "one row" if shape is None else shape
            raise _damaged(place, f"has the shape {found} instead of {wanted}")
        return node

    def _attribute(self, place: str, name: str, shape: tuple[int, ...]) -> Any:
        node = self._open(place)
        if not h5a.exists(node, name.encode()):
            raise _damaged(place, f"has no {name}")
        found = h5a.open(node, name.encode())
        if _shape(found) != shape:
            raise _damaged(place, f"has a {name} of the shape {_shape(found)} instead of {shape}")
        return found

    def _read(self, place: str, node: Any, kind: Any, shape: tuple[int, ...]) -> Any:
        """Numbers or text stored in one piece."""
        plist, size = node.get_create_plist(), prod(shape) * kind.itemsize
        inside = plist.get_layout() in (h5d.COMPACT, h5d.CONTIGUOUS) and plist.get_external_count() == 0
        if not inside or node.get_storage_size() != size:
            raise _damaged(place, "is not stored as SAVE stores it")
        self._spend(place, size)
        values = np.empty(shape, kind)
        if size:
            node.read(h5s.ALL, h5s.ALL, values, node.get_type())
        return values[()]

    def _spend(self, place: str, size: int) -> None:
        self._left -= size
        if self._left < 0:
            raise _damaged(place, "is declared larger than the file")


def _damaged(place: str, what: str) -> RefusedError:
    return RefusedError(f"is damaged: /{place} {what}")


def _shape(node: Any) -> tuple[int, ...] | None:
    """Lengths of a dataset or an attribute in all directions; None if it is empty by declaration."""
    space = node.get_space()
    if space.get_simple_extent_type() not in (h5s.SCALAR, h5s.SIMPLE):
        return None
    return tuple(space.get_simple_extent_dims())


def _filters(group: Any) -> int:
    """The number of filters that the names in `group` went through: by HDF5 they may be packed too."""
    plist = group.get_create_plist()
    view = h5p.PropDCID(plist.id)  # h5py counts the filters of datasets only
    view.locked = True  # the other one closes it
    return int(view.get_nfilters())


def _check_type(found: Any, kind: Any, place: str) -> None:
    if not found.equal(h5t.py_create(np.dtype(kind))):
        names = {h5t.INTEGER: "integers", h5t.FLOAT: "reals", h5t.STRING: "text"}
        what = f"{names.get(found.get_class(), 'something else')} of {found.get_size()} bytes"
        raise _damaged(place, f"holds {what}, not little-endian {np.dtype(kind).name}")


def _size_of_text(found: Any, place: str, limit: int | None = None) -> int:
    """Bytes of a text of fixed length."""
    if found.get_class() != h5t.STRING or found.is_variable_str():
        raise _damaged(place, "is not a text of fixed length")
    size = int(found.get_size())
    if limit is not None and size > limit:
        raise _damaged(place, f"is a text of {size} bytes")
    return size
