"""Words by name: `block@88.KXD`, `zone@9.KZG(2)`, `FRAC`, or an address, and where they are."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from udec_ia.counting import counted
from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.reader.atlas import KINDS, TABLE, Atlas, Word

FORM = re.compile(r"(?:(\w+)@(\d+)\.)?(\w+)(?:\((\d+)\))?")
PARTS = {"int": "ci", "real": "cr", "double": "cd"}


class Place(NamedTuple):
    """One number of a memory. part: ia, ra, ci, cr or cd; at: index into it.

    target: kind of group that a pointer leads to, None for other numbers.
    """

    name: str
    part: str
    at: int
    unit: str
    target: str | None

    def value(self, h: Memory) -> int | float | None:
        """What is there; None where IA() is not in use."""
        words = getattr(h, self.part)
        wide = int(words.itemsize // h.ia.itemsize)
        if self.part in ("ia", "ra") and (self.at + 1) * wide >= h.ci[g.MFREE]:
            return None
        value: int | float = words[self.at].item()
        return value


def place(atlas: Atlas, name: str) -> Place:
    """The number called `name`. Raises ValueError if there is none of that name."""
    if name.isdecimal():
        return at_address(atlas, int(name))
    found = FORM.fullmatch(name)
    if found is None:
        raise ValueError(
            f"{name}: give KIND@ADDRESS.FIELD, as block@88.KXD, a name of the common block, or an address"
        )
    kind, address, field, element = found.groups()
    k = int(element or 1) - 1
    if kind is None:
        return _common(field.upper(), k)
    if kind not in KINDS:
        raise ValueError(f"{kind} is not a kind of group: choose one of {', '.join(KINDS)}")
    if not atlas.holds(kind, int(address)):
        raise ValueError(f"there is no {kind} at {address}")
    known = {one.name: one for one in TABLE.group(kind).fields}
    if field.upper() not in known:
        raise ValueError(f"{field} is not a field of a {kind}: there are {', '.join(known)}")
    if not 0 <= k < known[field.upper()].count:
        raise ValueError(f"{field.upper()} has {counted(known[field.upper()].count, 'element')}")
    return of_word(atlas, f"{kind}@{address}", atlas.word(atlas.span(int(address)), known[field.upper()], k))


def of_word(atlas: Atlas, group: str, word: Word) -> Place:
    """Where a field of a group is."""
    if word.field.real:
        part, index = "ra", (word.first - 1) // atlas.ratio
    else:
        part, index = "ia", word.first - 1
    return Place(f"{group}.{word.name}", part, index, word.field.unit.strip("-"), word.field.target)


def at_address(atlas: Atlas, address: int) -> Place:
    """The number that the word at `address` is a part of; an integer where no field is."""
    span, word = atlas.word_at(address)
    if word is None:
        return Place(f"word {address}", "ia", address - 1, "", None)
    return of_word(atlas, span.name, word)


def named(atlas: Atlas, part: str, index: int) -> Place:
    """The number `index` of a part of the memory."""
    if part == "ia":
        return at_address(atlas, index + 1)
    if part == "ra":
        return at_address(atlas, index * atlas.ratio + 1)
    for field in TABLE.common:
        first = getattr(g, field.name)
        if PARTS[field.type] == part and first <= index < first + field.count:
            return _common(field.name, index - first)
    return Place(f"{part}[{index}]", part, index, "", None)


def _common(name: str, k: int) -> Place:
    field: Any = next((one for one in TABLE.common if one.name == name), None)
    if field is None:
        raise ValueError(
            f"{name} is not a variable of the common block; a field needs its group, as in block@88.KXD"
        )
    if not 0 <= k < field.count:
        raise ValueError(f"{name} has {counted(field.count, 'element')}")
    text = f"{name}({k + 1})" if field.count > 1 else name
    return Place(text, PARTS[field.type], getattr(g, name) + k, field.unit.strip("-"), field.target)
