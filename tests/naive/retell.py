"""The state of a model as a program with another field table would have written it, number by number.

Of the other table nothing is used but names: what it has more is 0 or given, and codes that it knows by other
numbers are given.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from naive.layout import count_words
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.layout.field_table import COMMON_TYPES, Group, Table, read_table
from udec_ia.reader.group_tables import table as rows_of
from udec_ia.restart.file_seal import SIZE, seal
from udec_ia.restart.file_tables import text

OURS = read_table()
KINDS = [group.name for group in OURS.groups]
Given = Mapping[str, float]
Codes = Mapping[str, Mapping[int, int]]
NONE: Mapping[str, Any] = {}


def retell(
    array: MainArray,
    theirs: Table,
    codes: Codes = NONE,
    given: Given = NONE,
    rng: np.random.Generator | None = None,
) -> tuple[Any, dict[str, Any]]:
    """Words of IA() and variables of the common block.

    codes: for fields, the numbers that `theirs` has for ours. given: values of fields that are new. rng: for
    the order of addresses; without it groups stand in the order that they have, without junk.
    """
    scheme = array.scheme
    rows = {kind: rows_of(array, kind) for kind in KINDS}
    groups = {group.name: group for group in theirs.groups}
    order = sorted((int(iad), kind, row) for kind in KINDS for row, iad in enumerate(rows[kind]["address"]))
    if rng is not None:  # what lies behind a group stays behind it
        runs: list[list[Any]] = []
        for one in order:
            runs += [] if OURS.group(one[1]).behind else [[]]
            runs[-1].append(one)
        order = [one for k in rng.permutation(len(runs)) for one in runs[int(k)]]
    new, free = {0: 0}, 1
    for iad, kind, _ in order:
        new[iad] = free
        free += count_words(_counted(groups[kind]), scheme.ratio)[1]
    words = np.zeros(free - 1, scheme.int_type)
    reals = words.view(scheme.real_type)
    for iad, kind, row in order:
        offset, _ = count_words(_counted(groups[kind]), scheme.ratio)
        for field in groups[kind].fields:
            held = [given.get(field.name, 0)]
            if field.name in (rows[kind].dtype.names or ()):
                held = np.ravel(rows[kind][row][field.name]).tolist()
            for i, value in enumerate(held):
                if field.real:
                    reals[(new[iad] - 1) // scheme.ratio + offset[field.name] + i - 1] = value
                else:
                    told = _integer(theirs, kind, rows[kind][row], field, value, codes, new)
                    words[new[iad] + offset[field.name] + i - 1] = told
    return words, _common(array, theirs, codes, given, new, free)


def _counted(group: Group) -> list[tuple[str, bool, int]]:
    return [(field.name, field.real, field.count) for field in group.fields]


def _integer(theirs: Table, kind: str, row: Any, field: Any, value: int, codes: Any, new: Any) -> int:
    if field.target is not None:
        return int(new[value])
    if field.name == "HEAD" and any(head.group == kind for head in OURS.heads):
        (name,) = (head.name for head in OURS.heads if head.group == kind and head.value == value)
        return next(head.value for head in theirs.heads if head.name == name)
    if field.name in ("KHK", "KHF") and row["KHK"] > 0:
        group = OURS.groups[row["KHK"] - 1]
        if field.name == "KHK":
            return [one.name for one in theirs.groups].index(group.name) + 1
        names = [one.name for one in theirs.group(group.name).fields]
        return names.index(group.fields[row["KHF"]].name)
    if field.name == "KWN":
        ours, others = ([one for one in table.common if one.type == "real"] for table in (OURS, theirs))
        places = [(one.name, i) for one in ours for i in range(one.count)]
        return [(one.name, i) for one in others for i in range(one.count)].index(places[value])
    if field.name == "KHF" and row["KHK"] == 0:
        return [one.name for one in theirs.common].index(OURS.common[row["KHF"]].name)
    return int(codes.get(field.name, {}).get(value, value))


def _common(array: MainArray, theirs: Table, codes: Any, given: Given, new: Any, free: int) -> dict[str, Any]:
    ours = {field.name: variable(array.h, field) for field in OURS.common}
    found = {}
    for field in theirs.common:
        kind = {"int": np.int64, "real": array.scheme.real_type, "double": np.float64}[field.type]
        values = np.zeros(field.count, kind)
        values[:] = ours.get(field.name, given.get(field.name, 0))
        if field.target is not None:
            values[:] = [new[value] for value in values.tolist()]
        elif field.name in codes:
            values[:] = [codes[field.name].get(value, value) for value in values.tolist()]
        found[field.name] = values
    found["JUNK"][:], found["MFREE"][:] = 0, free
    size = max(int(found["MTOP"][0]), free - 1)
    found["MTOP"][:] = size - size % array.scheme.ratio
    return found


def write(path: Path, table: str, words: Any, common: Mapping[str, Any], theirs: Table) -> Path:
    """Give the restart file `path` another field table, with its words and variables, and seal it."""
    with h5py.File(path, "r+") as file:
        _put(file, "layout/table", text(table))
        file["layout"].attrs["sha256"] = text(hashlib.sha256(table.encode()).hexdigest())
        kept = dict(file["heap/IA"].attrs) | {"sha256": text(hashlib.sha256(words).hexdigest())}
        del file["heap/IA"]
        chunk = (min(max(len(words), 1), 65536),)
        heap = file.create_dataset("heap/IA", data=words, chunks=chunk, maxshape=(None,), fletcher32=True)
        heap.attrs.update(kept)
        for name in list(file["common"]):
            del file[f"common/{name}"]
        for field in theirs.common:
            file[f"common/{field.name}"] = common[field.name] if field.count > 1 else common[field.name][0]
        parts = [
            common[one.name].tobytes() for kind in COMMON_TYPES for one in theirs.common if one.type == kind
        ]
        file["common"].attrs["sha256"] = text(hashlib.sha256(b"".join(parts)).hexdigest())
    image = path.read_bytes()[SIZE:]
    path.write_bytes(seal(memoryview(image)) + image)
    return path


def _put(file: h5py.File, name: str, value: Any) -> None:
    del file[name]
    file[name] = value
