"""What each group is called, from tables alone: corner@412 of block@88."""

from __future__ import annotations

from typing import Any

from naive.layout import count_words
from udec_ia import Model
from udec_ia.layout.field_table import read_table


def names(m: Model) -> dict[int, str]:
    """Names by address. Every list is followed by hand."""
    tables = {kind: {int(row["address"]): row for row in m.table(kind)} for kind in KINDS}
    found = {iad: f"{kind}@{iad}" for kind, rows in tables.items() for iad in rows}

    def of(iad: int, *blocks: Any) -> None:
        found[iad] += " of " + " and ".join(f"block@{int(block)}" for block in blocks)

    for iad, row in tables["corner"].items():
        of(iad, row["KNB"])
    for iad, row in tables["contact"].items():
        of(iad, row["KB1"], row["KB2"])
    for kind, host in BEHIND.items():
        for iad in tables[kind]:
            found[iad] += f" of {host}@{iad - words(host, m.array.scheme.ratio)}"
    for iad, row in tables["bound"].items():
        of(iad, row["KUB"])
    for iad, row in tables["summand"].items():
        of(iad, row["KQB"])
    for iad, row in tables["member"].items():
        of(iad, row["KIB"])
    for iad, row in tables["breakable"].items():
        of(iad, row["KBKB"])
    for block, row in tables["block"].items():
        extension = int(row["KBEX"])
        if extension:
            of(extension, block)
        for kind, head, link in (("gridpoint", "KFG", "KG"), ("zone", "KFZ", "KZ")):
            iad = int(tables["fdef"][extension][head]) if extension in tables["fdef"] else 0
            while iad:
                of(iad, block)
                iad = int(tables[kind][iad][link])
    return found


def words(kind: str, ratio: int) -> int:
    """Words of a group, counted."""
    fields = read_table().group(kind).fields
    return count_words([(field.name, field.real, field.count) for field in fields], ratio)[1]


BEHIND = {
    "joint": "contact",
    "edge": "corner",
    "water": "domain",
    "pipe": "joint",
    "displacement": "block",
    "pointdisplacement": "gridpoint",
}
KINDS = (
    "block",
    "corner",
    "contact",
    "joint",
    "edge",
    "pipe",
    "domain",
    "water",
    "sdef",
    "fdef",
    "zone",
    "gridpoint",
    "bound",
    "signal",
    "tabpoint",
    "follower",
    "history",
    "summand",
    "outside",
    "crack",
    "member",
    "breakable",
    "fracture",
    "bolt",
    "node",
    "element",
    "displacement",
    "pointdisplacement",
)
