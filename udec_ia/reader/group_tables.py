"""Groups of one kind as a table: a structured NumPy array with the field table's own names."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.reader.group_lists import Lists
from udec_ia.reader.word_map import KINDS, TABLE, kind_named


def table(array: MainArray, kind: str) -> Any:
    """All groups of `kind` that the lists reach, one row each, as a copy.

    Rows stand in list order; corners block by block, clockwise from KP; extensions in the order of their
    blocks or domains, zones and grid-points block by block. Fields: `address`, then those of the field table
    by name and in its units, integers as int64, reals in the type of the word scheme; a triple is a field of
    three. kind: in singular or plural. Raises ValueError for an unknown kind, and Unsound if the lists are
    broken or have lost groups that pointers lead to.
    """
    kind = _known(kind)
    lists, fields = Lists(array), TABLE.group(kind).fields
    at = lists.addresses(kind)
    lists.report_lost(kind)
    types: list[Any] = [("address", np.int64)]
    for field in fields:
        base = array.scheme.real_type if field.real else np.dtype(np.int64)
        types.append((field.name, base, field.count) if field.count > 1 else (field.name, base))
    rows = np.empty(len(at), types)
    rows["address"] = at
    for field in fields:
        columns = rows[field.name].reshape(len(at), field.count)
        for i in range(field.count):
            columns[:, i] = lists.read(at, field.name, i)
    return rows


def addresses(array: MainArray, kind: str) -> Any:
    """Addresses of all groups of `kind` in the order of the rows of their table. Raises as `table` does."""
    return Lists(array).addresses(_known(kind))


def _known(text: str) -> str:
    """The kind of group that `text` names. ValueError if there is no such kind."""
    kind = kind_named(text)
    if kind is None:
        raise ValueError(f"unknown kind of group {text!r}: choose one of {', '.join(KINDS)}")
    return kind
