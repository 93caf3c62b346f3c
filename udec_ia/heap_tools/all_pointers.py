"""All pointers of a heap: those of the common block, and every pointer field of every group that there is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import repeat
from typing import Any, NamedTuple

import numpy as np

from udec_ia.counting import counted
from udec_ia.heap.array import variable
from udec_ia.reader.atlas import KINDS, TABLE, Atlas, Word
from udec_ia.reader.field_rows import COMMON
from udec_ia.reader.group_names import called, names
from udec_ia.reader.listing import Listing
from udec_ia.reader.places import address_of


class Pointers(NamedTuple):
    """One pointer field of groups of a kind: their addresses (n,), and where it leads (n,).

    target: kind of group it should lead to. word: None for a pointer of the common block, called `name`.
    """

    name: str
    target: str
    word: Word | None
    at: Any
    to: Any


def pointers(atlas: Atlas) -> Iterator[Pointers]:
    """Every pointer of the common block, and every pointer field of every kind of group."""
    for field in TABLE.common:
        if field.target:
            yield Pointers(field.name, field.target, None, np.zeros(1, np.int64), variable(atlas.h, field))
    for kind in KINDS:
        at = atlas.groups[kind]
        for word in atlas.shapes[kind]:
            if word.field.target:
                yield Pointers(word.name, word.field.target, word, at, atlas.gather(word, at))


def pointing(atlas: Atlas, address: int) -> Iterator[Pointers]:
    """Those whose value is `address`."""
    for one in pointers(atlas):
        found = one.to == address
        yield one._replace(at=one.at[found], to=one.to[found])


def pointer_rows(atlas: Atlas, found: Iterable[Pointers], limit: int | None = None) -> list[tuple[Any, ...]]:
    """Address, group and field of some pointers; those of the common block have no address."""
    rows: list[tuple[Any, ...]] = []
    for name, _, word, at, _ in found:
        at = at if limit is None else at[: limit - len(rows)]
        if word is None:
            rows += [("", COMMON, name)] * len(at)
        else:
            rows += zip((at + word.first).tolist(), names(atlas, at), repeat(name), strict=False)
    return rows


def who(atlas: Atlas, place: int | str) -> Listing:
    """All words that point to the group at, or around, a place, by field.

    place: an address, or text such as block@88. IndexError outside IA(), ValueError for no such place.
    """
    span = atlas.span(address_of(atlas, place))
    rows = pointer_rows(atlas, pointing(atlas, span.first))
    said = f"{called(atlas, span)} is pointed to by {counted(len(rows), 'word')}"
    return Listing([said], ("address", "group", "field"), rows)
