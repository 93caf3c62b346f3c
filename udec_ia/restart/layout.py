"""What the words mean, as a restart file tells it.

The text of the field table goes into the file as it is, and for each kind of group a table with one row
per field: the same facts as `offsets/` holds, laid out for the word scheme of the file.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import h5py
import numpy as np

from udec_ia.layout.table import COMMON_TYPES, Field, Group, Table, lay_out

TEXT_COLUMNS = ("name", "type", "refers_to", "role", "unit", "page", "text")
NUMBER_COLUMNS = ("count", "offset", "word")


def text(value: str | bytes) -> Any:
    """A string as HDF5 keeps it in place: UTF-8 of fixed length."""
    raw = value if isinstance(value, bytes) else value.encode()
    return np.array(raw, h5py.string_dtype("utf-8", max(len(raw), 1)))


def field_rows(group: Group, ratio: int) -> Any:
    """One row per field of `group`; `word` counts from 0 from the group's address."""
    layout = lay_out(group, ratio)
    texts, numbers = [], []
    for field in group.fields:
        offset = layout.offset[field.name]
        words = (field.name, field.type, field.target or "-", field.role, field.unit, field.page, field.text)
        texts.append([part.encode() for part in words])
        numbers.append((field.count, offset, (offset - 1) * ratio if field.real else offset))
    widths = [max(map(len, column)) for column in zip(*texts, strict=True)]
    columns: list[Any] = [
        (name, h5py.string_dtype("utf-8", width)) for name, width in zip(TEXT_COLUMNS, widths, strict=True)
    ]
    columns += [(name, "<i4") for name in NUMBER_COLUMNS]
    return np.array([(*row, *more) for row, more in zip(texts, numbers, strict=True)], np.dtype(columns))


def common_places(table: Table) -> Iterator[tuple[Field, slice]]:
    """Each variable of the common block, and where it stands among those of its type."""
    end = dict.fromkeys(COMMON_TYPES, 0)
    for field in table.common:
        start = end[field.type]
        end[field.type] = start + field.count
        yield field, slice(start, end[field.type])


def differences(ours: Table, theirs: Table) -> list[str]:
    """In words, where two tables give words of IA() another place or meaning; wording does not count.

    A history knows a field by its place in the table, so the order counts.
    """
    mine, other = _places(ours), _places(theirs)
    found = [f"{what} has {name} in this version only" for what, name in mine if (what, name) not in other]
    found += [f"{what} has {name} in the file only" for what, name in other if (what, name) not in mine]
    found += [
        f"{what} has {name} as {other[what, name]} in the file, as {place} here"
        for (what, name), place in mine.items()
        if other.get((what, name), place) != place
    ]
    codes = {code.name: code.value for code in ours.codes}
    found += [
        f"the code {code.name} of {code.field} is {code.value} in the file, {codes[code.name]} here"
        for code in theirs.codes
        if codes.get(code.name, code.value) != code.value
    ]
    return found or ([] if list(mine) == list(other) else ["its groups or fields come in another order"])


def losses(ours: Table, theirs: Table, values: dict[str, Any]) -> list[str]:
    """In words, what of the common block `values`, written by `theirs`, cannot be told by `ours`.

    Variables are taken by their names: what the file does not have is 0, as after START, and what has gone
    since is no loss if it is 0; nor is a real that is a double now.
    """
    mine = {field.name: (_kind(field), place) for place, field in enumerate(ours.common)}
    found = []
    for place, field in enumerate(theirs.common):
        kind, here = mine.get(field.name, ("", place))
        if not kind and np.any(values[field.name]):
            found.append(f"the common block has {field.name}, which is not 0, in the file only")
        elif kind and kind != _kind(field) and (_kind(field), kind) != ("real", "double"):
            found.append(f"the common block has {field.name} as {_kind(field)} in the file, as {kind} here")
        elif kind and here != place and values.get("IHPNT"):
            found.append(f"histories know {field.name} of the common block by another number")
    return found


def _places(table: Table) -> dict[tuple[str, str], str]:
    """(group, field) to its place, in words, by the two layouts that tell all of them apart."""
    found = {("the list of head codes", head.name): f"{head.value} of {head.group}" for head in table.heads}
    for group in table.groups:
        places = [lay_out(group, ratio).offset for ratio in (1, 2)]
        for field in group.fields:
            where = ", ".join(str(place[field.name]) for place in places)
            found[f"group {group.name}", field.name] = f"{_kind(field)} {where}"
    return found


def _kind(field: Field) -> str:
    return field.type + (f"*{field.count}" if field.count > 1 else "")
