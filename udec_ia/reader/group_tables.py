"""Groups of one kind as a table: a structured NumPy array with the field table's own names."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.layout.field_table import read_table
from udec_ia.reader.group_lists import Lists


def table(array: MainArray, kind: str) -> Any:
    """All groups of `kind` that the lists reach, one row each, as a copy.

    Rows stand in list order; corners block by block, clockwise from KP; extensions in the order of their
    blocks or domains, zones and grid-points block by block. Fields: `address`, then those of the field table
    by name and in its units, integers as int64, reals in the type of the word scheme; a triple is a field of
    three. Raises ValueError for an unknown kind and Unsound if the lists are broken, or have lost groups that
    pointers lead to.
    """
    kinds = [group.name for group in read_table().groups]
    if kind not in kinds:
        raise ValueError(f"unknown kind of group {kind!r}: choose one of {', '.join(kinds)}")
    lists = Lists(array)
    lists.report_lost(kind)
    return _rows(lists, kind)


def tables(array: MainArray) -> dict[str, Any]:
    """The tables of all kinds of which there are groups, by kind. Raises Unsound as `table` does."""
    lists, kinds = Lists(array), [group.name for group in read_table().groups]
    lists.report_lost(*kinds)
    return {kind: _rows(lists, kind) for kind in kinds if len(lists.addresses(kind))}


def _rows(lists: Lists, kind: str) -> Any:
    """The table of one kind."""
    at, fields = lists.addresses(kind), read_table().group(kind).fields
    types: list[Any] = [("address", np.int64)]
    for field in fields:
        base = lists.h.cr.dtype if field.real else np.dtype(np.int64)
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
    return Lists(array).addresses(kind)
