"""Which groups a heap holds, one pointer after the other, with nothing but the field table."""

from __future__ import annotations

from typing import Any

from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets
from udec_ia.layout.field_table import lay_out, read_table

TABLE = read_table()
CODES = {head.value: head.group for head in TABLE.heads}
WITH_CODE = {*CODES.values()}
EXTENDED = {offsets.MSDEF: "sdef", offsets.MFDEF: "fdef"}


def census(array: MainArray) -> dict[str, list[int]]:
    """Addresses by kind, rising."""
    words = array.h.ia.tolist()
    layouts = {group.name: lay_out(group, array.scheme.ratio) for group in TABLE.groups}
    last = int(array.h.ci[offsets.MFREE]) - 1
    found: dict[int, str] = {}
    waiting: list[Any] = [
        (int(array.h.ci[getattr(offsets, field.name)]), field.target)
        for field in TABLE.common
        if field.role == "head" and field.target
    ]
    while waiting:
        iad, kind = waiting.pop()
        if not 0 < iad <= last or (iad - 1) % array.scheme.ratio or iad in found:
            continue
        code = CODES.get(words[iad - 1])
        if kind == "item" and code in ("corner", "contact"):
            kind = code
        if kind == "item" or (kind in WITH_CODE and code != kind) or iad + layouts[kind].size - 1 > last:
            continue
        found[iad] = kind
        for field in TABLE.group(kind).fields:
            for i in range(field.count if field.target and field.target != "any" else 0):
                to = words[iad + layouts[kind].offset[field.name] + i - 1]
                if field.target != "soft":
                    waiting.append((to, field.target))
                elif words[iad - 1] in EXTENDED:
                    waiting.append((to, EXTENDED[words[iad - 1]]))
    for group in TABLE.groups:
        if group.behind and array.h.ci[getattr(offsets, group.flag)]:
            hosts = [iad for iad, kind in found.items() if kind == group.behind]
            found |= {iad + layouts[group.behind].size: group.name for iad in hosts}
    return {
        group.name: sorted(iad for iad, kind in found.items() if kind == group.name) for group in TABLE.groups
    }
