"""How numbers and texts are stored: as links, elsewhere, packed, huge, of other types and shapes.

Each edit returns True if the file must be refused. secret: a file outside, which may not be opened.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from h5py import h5d, h5p, h5s, h5t

from udec_ia.restart.file_tables import text

DATA = ["heap/IA", "deck", "layout/table", "common/AKN", "common/MFREE", "volatile/date", "volatile/host"]
DATA += ["recorded/1/cycle", "recorded/1/time", "recorded/1/value"]
GROUPS = ["heap", "common", "layout", "recorded", "recorded/1", "laws", "laws/cl2", "provenance", "volatile"]
TEXTS = [("layout", "sha256"), ("heap/IA", "sha256"), ("common", "sha256"), ("laws/cl2", "file")]
TEXTS += [("laws/cl2", "sha256"), ("provenance", "udec_ia"), ("provenance", "numpy"), ("", "format")]
TEXTS += [("recorded/1", "group"), ("recorded/1", "place")]
NUMBERS = [("", "format_version"), ("", "complete"), ("heap/IA", "int_bits"), ("heap/IA", "mtop_fixed")]
NUMBERS += [("recorded/1", "lost")]
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
    """Datasets in one piece that were never written, that claim to be huge."""
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


EDITS: list[Callable[[Rng, File, Path], bool]] = [link, loop, external, virtual, bomb, paper, other_type]
EDITS += [other_shape, same_numbers, attribute, packed_names, chunks]
