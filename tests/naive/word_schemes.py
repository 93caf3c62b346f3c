"""A heap in the words of another scheme, group by group and byte by byte: slow and plain.

The heap is taken apart into dicts, {address: (kind, {field: values})}, with nothing but the field table, the
counting of words on one's fingers, and `struct`; and put together again in the other words.
"""

from __future__ import annotations

import struct
from typing import Any

from naive.census import census
from naive.layout import count_words
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets
from udec_ia.layout.field_table import SCHEMES, read_table

TABLE = read_table()
LETTER = {("int", 16): "h", ("int", 32): "i", ("int", 64): "q", ("real", 32): "f", ("real", 64): "d"}
Groups = dict[int, tuple[str, dict[str, list[Any]]]]
Shape = tuple[list[tuple[str, str, int]], int]  # of each field: name, format and byte where it begins; words


def shape(kind: str, int_bits: int, real_bits: int) -> Shape:
    """Where the fields of a group of that kind stand, in bytes."""
    fields = TABLE.group(kind).fields
    offset, words = count_words([(f.name, f.real, f.count) for f in fields], real_bits // int_bits)
    places = []
    for f in fields:
        first = (offset[f.name] - 1) * real_bits // 8 if f.real else offset[f.name] * int_bits // 8
        places.append((f.name, f"<{f.count}{LETTER[f.type, real_bits if f.real else int_bits]}", first))
    return places, words


def take_apart(array: MainArray) -> Groups:
    """All groups in use by address, rising."""
    int_bits, real_bits = SCHEMES[array.scheme.name]
    raw, found = array.h.ia.tobytes(), {}
    for kind, at in census(array).items():
        places, _ = shape(kind, int_bits, real_bits)
        for iad in at:
            base = (iad - 1) * int_bits // 8
            found[iad] = kind, {n: [*struct.unpack_from(form, raw, base + k)] for n, form, k in places}
    return dict(sorted(found.items()))


def put_together(groups: Groups, name: str) -> tuple[bytes, dict[int, int]]:
    """The bytes of the heap in the words of the scheme `name`, and new addresses by old ones.

    struct.error or OverflowError if a number does not fit, KeyError if a pointer leads to no group.
    """
    int_bits, real_bits = SCHEMES[name]
    shapes = {group.name: shape(group.name, int_bits, real_bits) for group in TABLE.groups}
    new, free = {0: 0}, 1
    for iad, (kind, _) in groups.items():
        new[iad] = free
        free += shapes[kind][1]
    raw = bytearray((free - 1) * int_bits // 8)
    pointers = {f.name for group in TABLE.groups for f in group.fields if f.target is not None}
    for iad, (kind, fields) in groups.items():
        for field, form, k in shapes[kind][0]:
            values = [new[one] for one in fields[field]] if field in pointers else fields[field]
            struct.pack_into(form, raw, (new[iad] - 1) * int_bits // 8 + k, *values)
    return bytes(raw), new


def common(array: MainArray, new: dict[int, int], name: str, words: int) -> dict[str, list[Any]]:
    """The variables of the common block in the words of the scheme `name`, of a heap of so many words."""
    letter = LETTER["real", SCHEMES[name][1]]
    found: dict[str, list[Any]] = {}
    for field in TABLE.common:
        first = getattr(offsets, field.name)
        of = {"int": array.h.ci, "real": array.h.cr, "double": array.h.cd}[field.type]
        values = of[first : first + field.count].tolist()
        if field.target is not None:
            values = [new[one] for one in values]
        if field.type == "real":
            values = [struct.unpack(letter, struct.pack(letter, one))[0] for one in values]
        found[field.name] = values
    return found | {"JUNK": [0], "MFREE": [words + 1]}
