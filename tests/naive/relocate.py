"""The same map at other addresses, and what two maps have in common whatever their addresses are.

Both know of the groups nothing but the field table: which fields are pointers, and to what.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray, variable
from udec_ia.layout import offsets
from udec_ia.layout.field_table import lay_out, read_table
from udec_ia.reader.group_tables import table

TABLE = read_table()
KINDS = [group.name for group in TABLE.groups]
NO_STATE = {
    "JUNK",
    "MFREE",
    "MTOP",
    "NSPARE",
    "NWANT",
    "NCYC",
}  # of the memory, not the model


def relocate(array: MainArray, rng: np.random.Generator) -> MainArray:
    """A copy of `array` with its groups in random order of address, packed, and without junk.

    What lies behind a group stays behind it.
    """
    ratio = array.scheme.ratio
    sizes = {kind: lay_out(TABLE.group(kind), ratio).size for kind in KINDS}
    free_ones = [kind for kind in KINDS if not TABLE.group(kind).behind]
    alone = [(kind, int(iad)) for kind in free_ones for iad in table(array, kind)["address"]]
    rng.shuffle(alone)
    old = []
    behind = TABLE.behind(lambda flag: int(array.h.ci[getattr(offsets, flag)]))
    for kind, iad in alone:
        old.append((kind, iad))
        while kind in behind:
            iad, kind = iad + sizes[kind], behind[kind]
            old.append((kind, iad))
    moved = array.copy()
    moved.h.ia[:] = 0
    new = {0: 0}
    free = 1
    for kind, iad in old:
        new[iad] = free
        moved.h.ia[free - 1 : free - 1 + sizes[kind]] = array.h.ia[iad - 1 : iad - 1 + sizes[kind]]
        free += sizes[kind]
    for kind, iad in old:
        for field in TABLE.group(kind).fields:
            if field.target is not None:
                first = new[iad] + lay_out(TABLE.group(kind), ratio).offset[field.name] - 1
                for word in range(first, first + field.count):
                    moved.h.ia[word] = new[int(moved.h.ia[word])]
    for field in TABLE.common:
        if field.target is not None:
            at = getattr(offsets, field.name)
            moved.h.ci[at] = new[int(moved.h.ci[at])]
    moved.h.ci[offsets.JUNK] = 0
    moved.h.ci[offsets.MFREE] = free
    return moved


def essence(array: MainArray) -> dict[str, Any]:
    """Every field of every group in list order, and the common block: equal for equal maps.

    A pointer is told by the place of its group among all groups, counted from 1.
    """
    rows = {kind: table(array, kind) for kind in KINDS}
    addresses = [iad for kind in KINDS for iad in rows[kind]["address"].tolist()]
    number = {0: 0} | {iad: k for k, iad in enumerate(addresses, 1)}
    found: dict[str, Any] = {}
    for kind in KINDS:
        for field in TABLE.group(kind).fields:
            values = rows[kind][field.name]
            if field.target is not None:
                values = np.array([number[iad] for iad in values.ravel().tolist()], np.int64)
            found[f"{field.name} of {kind}"] = values
    for field in TABLE.common:
        values = variable(array.h, field)
        if field.real:
            found[field.name] = values.copy()
        elif field.target is not None:
            found[field.name] = number[int(values[0])]
        elif field.name not in NO_STATE:
            found[field.name] = int(values[0])
    return found


def differences(one: dict[str, Any], two: dict[str, Any], units: dict[str, float] | None = None) -> list[str]:
    """Names of the fields of which not every bit is the same; `two` is first multiplied by units[unit]."""
    unit = {f"{field.name} of {group.name}": field.unit for group in TABLE.groups for field in group.fields}
    names = []
    for name in one:
        factor = 1.0 if units is None else units.get(unit.get(name, "-"), 1.0)
        if units is not None and name not in unit:
            continue  # the common block holds numbers of many scales
        a, b = np.asarray(one[name]), np.asarray(two[name])
        if a.shape != b.shape or not np.array_equal(a, b * b.dtype.type(factor)):
            names.append(name)
    return names
