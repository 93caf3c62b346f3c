"""Groups of one kind as a table: a structured NumPy array with the field table's own names, or a data frame.

Columns of a data frame have the names that PRINT, HISTORY and the documents have. What they are in words, and
their units, are in `attrs`: `frame.rename(columns=frame.attrs["names"])` has the words as columns.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from udec_ia.heap.main_array import MainArray
from udec_ia.layout.field_table import Field
from udec_ia.reader.group_lists import Lists
from udec_ia.reader.word_map import KINDS, TABLE, kind_named

if TYPE_CHECKING:
    from pandas import DataFrame


def table(array: MainArray, kind: str) -> NDArray[np.void]:
    """All groups of `kind` that the lists reach, one row each, as a copy.

    Rows stand in list order; corners block by block, clockwise from KP; extensions in the order of their
    blocks or domains, zones and grid-points block by block. Fields: `address`, then those of the field table
    by name and in its units, integers as int64, reals in the type of the word scheme; a triple is a field of
    three. kind: in singular or plural. Raises ValueError for an unknown kind, and Unsound if the lists are
    broken or have lost groups that pointers lead to.
    """
    kind, lists = _known(kind), Lists(array)
    lists.report_lost(kind)
    return _rows(lists, kind)


def tables(array: MainArray) -> dict[str, NDArray[np.void]]:
    """The tables of all kinds of which there are groups, by kind. Raises Unsound as `table` does."""
    lists = Lists(array)
    lists.report_lost(*KINDS)
    return {kind: _rows(lists, kind) for kind in KINDS if len(lists.addresses(kind))}


def _rows(lists: Lists, kind: str) -> NDArray[np.void]:
    """The table of one kind."""
    at, fields = lists.addresses(kind), TABLE.group(kind).fields
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
    return Lists(array).addresses(_known(kind))


def all_addresses(array: MainArray) -> dict[str, Any]:
    """Addresses of all groups of every kind, as of `addresses`. Raises Unsound if the lists are broken."""
    lists = Lists(array)
    return {kind: lists.addresses(kind) for kind in KINDS}


def _known(text: str) -> str:
    """The kind of group that `text` names. ValueError if there is no such kind."""
    kind = kind_named(text)
    if kind is None:
        raise ValueError(f"unknown kind of group {text!r}: choose one of {', '.join(KINDS)}")
    return kind


def column_names(field: Field) -> list[str]:
    """Names of the columns with single numbers: KZG_1, KZG_2 and KZG_3 of KZG."""
    return [field.name] if field.count == 1 else [f"{field.name}_{k + 1}" for k in range(field.count)]


def frame(array: MainArray, kind: str) -> DataFrame:
    """The table of `kind` as a data frame of pandas, with a column for each number of a triple.

    Raises as `table` does, and ModuleNotFoundError without pandas.
    """
    pandas, rows = import_pandas(), table(array, kind)
    columns: dict[str, Any] = {}
    fields: dict[str, Field] = {}
    for field in TABLE.group(_known(kind)).fields:
        several = rows[field.name].reshape(len(rows), field.count).T
        names = column_names(field)
        columns |= {name: np.ascontiguousarray(one) for name, one in zip(names, several, strict=True)}
        fields |= dict.fromkeys(names, field)
    found = pandas.DataFrame(columns, index=pandas.Index(rows["address"].copy(), name="address"))
    texts = {name: field.text.partition(";")[0] for name, field in fields.items()}
    count = Counter(texts.values())
    found.attrs["names"] = {
        name: text if count[text] == 1 else f"{text} ({name})" for name, text in texts.items()
    }
    found.attrs["units"] = {name: field.unit.strip("-") for name, field in fields.items()}
    return found


def import_pandas() -> Any:
    """The module pandas."""
    try:
        import pandas
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError("a data frame needs pandas: pip install udec-ia[pandas]") from error
    return pandas
