"""The meaning of the words, in a restart file.

The file has the text of the field table, and for each kind of group a table with one row per field: the facts
of `offsets/`, for the word scheme of the file.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import h5py
import numpy as np

from udec_ia.heap.group_census import CHOICES
from udec_ia.heap_tools.table_translation import in_words
from udec_ia.layout.field_table import COMMON_TYPES, RATIOS, Field, Group, HeadCode, Table, lay_out
from udec_ia.printable_text import printable

TEXT_COLUMNS = ("name", "type", "refers_to", "role", "unit", "page", "text")
NUMBER_COLUMNS = ("count", "offset", "word")
SHOWN, MAX_FAULT = 3, 200  # faults that a sentence lists, and characters of each
MARK, MARKED = "unsound", 10  # attribute of a file that was saved by force, and violations that it lists
MAX_KINDS, MAX_WORDS, MAX_HEAD = 1000, 4096, 2**15  # of groups, in one, and of head codes, by another's table
SEVERAL = (*CHOICES, "any")  # what a pointer may point to beside one kind of group


def text(value: str | bytes) -> Any:
    """A string as HDF5 keeps it in place: UTF-8 of fixed length."""
    raw = value if isinstance(value, bytes) else value.encode()
    return np.array(raw, h5py.string_dtype("utf-8", max(len(raw), 1)))


def shorten(faults: Sequence[str], shown: int = SHOWN, between: str = "; ") -> str:
    """The first few of `faults`, safe to print, and how many more there are."""
    more = [f"and {len(faults) - shown} more"] if len(faults) > shown else []
    return between.join([printable(fault, MAX_FAULT) for fault in faults[:shown]] + more)


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
    """Each variable of the common block, and its place among those of its type."""
    end = dict.fromkeys(COMMON_TYPES, 0)
    for field in table.common:
        start = end[field.type]
        end[field.type] = start + field.count
        yield field, slice(start, end[field.type])


def table_faults(table: Table) -> list[str]:
    """Why a table that came with a file cannot be used: names with two meanings, impossible sizes."""
    names, fields = [group.name for group in table.groups], list(table.common)
    found = [f"two kinds of group are called {name}" for name in _repeated(names)]
    for heads in ([one.name for one in table.heads], [one.value for one in table.heads]):
        found += [f"two head codes are {one}" for one in _repeated(heads)]
    found += [f"{one.name} is no head code of a group" for one in table.heads if not _is_head(one, names)]
    if len(names) > MAX_KINDS:
        found.append("it has too many kinds of group")
    for group in table.groups:
        fields += group.fields
        found += [f"group {group.name} has two {name}" for name in _repeated([f.name for f in group.fields])]
        if lay_out(group, max(RATIOS)).size > MAX_WORDS:
            found.append(f"group {group.name} is too large")
        first = (group.fields[0].role, in_words(group.fields[0])) if group.fields else ()
        if any(one.group == group.name for one in table.heads) and first != ("head", "int"):
            found.append(f"group {group.name} does not begin with its head code")
    for field in fields:
        if field.count > MAX_WORDS:
            found.append(f"there are too many of {field.name}")
        if field.target is not None and (field.real or field.target not in (*names, *SEVERAL)):
            found.append(f"{field.name} points to {field.target}, which is not a kind of group")
    return found


def _is_head(head: HeadCode, kinds: list[str]) -> bool:
    return head.group in kinds and head.value < MAX_HEAD


def _repeated(names: list[Any]) -> list[Any]:
    """Names that occur more than once."""
    return [name for name, times in Counter(names).items() if times > 1]
