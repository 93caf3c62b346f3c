"""Two heaps word by word, at equal addresses: what an address holds in the one and in the other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from udec_ia.counting import counted
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap_tools.comparison_report import CALLED, LIMIT
from udec_ia.reader.atlas import TABLE, Atlas
from udec_ia.reader.field_rows import COMMON
from udec_ia.reader.listing import Listing

COLUMNS = ("address", "what it is", "first", "second")


def raw(one: MainArray, two: MainArray, limit: int = LIMIT, called: Sequence[str] = CALLED) -> Listing:
    """The words of IA() in use that differ, and the variables of the common block; status 1 if any does.

    limit: rows. called: how the states are called. ValueError for states in words of two schemes.
    """
    if one.scheme is not two.scheme:
        text = f"{called[0]} has words of {one.scheme.name}, {called[1]} of {two.scheme.name}"
        raise ValueError(f"{text}: their words can be compared by meaning only, without --raw")
    atlases = Atlas(one.h), Atlas(two.h)
    used = min(atlas.free for atlas in atlases) - 1
    at = np.flatnonzero(one.h.ia[:used] != two.h.ia[:used]) + 1
    rows = list(_common(one, two))
    count = len(at) + len(rows)
    verb = "differs" if len(at) == 1 else "differ"
    said = [
        f"{called[0]} and {called[1]}: {len(at)} of {used} words {verb}, {counted(len(rows), 'variable')}"
    ]
    for atlas, name in zip(atlases, called, strict=True):
        if atlas.free - 1 > used:
            said.append(f"{name} has {counted(atlas.free - 1 - used, 'more word')} in use")
    if count > limit:
        said.append(f"the first {limit} of {count}:")
    for address in at[: max(limit - len(rows), 0)].tolist():
        what = [_what(atlas, address) for atlas in atlases]
        told = " / ".join(dict.fromkeys(what))
        rows.append((address, told, *(int(array.h.ia[address - 1]) for array in (one, two))))
    return Listing(said, COLUMNS, rows[:limit], int(count > 0 or atlases[0].free != atlases[1].free))


def _common(one: MainArray, two: MainArray) -> list[tuple[Any, ...]]:
    """Rows of the variables of which not every bit is the same."""
    rows: list[tuple[Any, ...]] = []
    for field in TABLE.common:
        values = [variable(array.h, field) for array in (one, two)]
        bits = [part.view(f"i{part.itemsize}") for part in values]
        for k in np.flatnonzero(bits[0] != bits[1]).tolist():
            name = field.name + (f"({k + 1})" if field.count > 1 else "")
            rows.append(("", f"{COMMON}: {name}", *(part[k].item() for part in values)))
    return rows


def _what(atlas: Atlas, address: int) -> str:
    """Group and field of a word."""
    span, word = atlas.word_at(address)
    return span.name + (f".{word.name}" if word else "")
