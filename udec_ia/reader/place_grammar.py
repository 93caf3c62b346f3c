"""Places in the heap by name: one grammar for the command line, PATCH, the debugger and Python.

412              an address: the word there, or the group that it is part of
block@88         a group, as every answer prints it
block@88.KXD     a field of a group
zone@9.KZG(2)    an element of a field
FRAC, AMU(1)     a variable of the common block, and an element of one
"""

from __future__ import annotations

import re
from typing import NamedTuple

from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field
from udec_ia.printable_text import counted
from udec_ia.reader.word_map import JUNK, KINDS, TABLE, Atlas, Span, Word, called

GROUP = re.compile(r"(?:([A-Za-z]+)@)?(\d{1,40})")
FIELD = re.compile(r"([A-Za-z]\w*)(?:\((\d{1,9})\))?")
STRETCH = re.compile(r"([^-/]+)(?:-([^-/]+)|/(\d{1,18}))?")
FORMS = "give block@88.KXD, zone@9.KZG(2), block@88, FRAC, AMU(1) or an address"
PARTS = {"int": "ci", "real": "cr", "double": "cd"}  # of a Memory, by the type of a variable


class PlaceError(ValueError):
    """A place that cannot be read, or is not in the heap. detail: what is wrong; advice: what to do."""

    def __init__(self, detail: str, advice: str) -> None:
        self.detail, self.advice = detail, advice
        super().__init__(f"{detail}: {advice}")


class PlaceName(NamedTuple):
    """A place as it is written.

    kind: of the group, "" for an address alone and for a variable. address: 0 for a variable. field: "" for a
    whole group. element: from 1 on, None if it is not given.
    """

    kind: str
    address: int
    field: str
    element: int | None


class Place(NamedTuple):
    """One number of a memory.

    name: as the grammar writes it. part: ia, ra, ci, cr or cd of the memory; at: index into it. kind: of the
    group that it is part of, "" for none. field: None for a word that no field has.
    """

    name: str
    part: str
    at: int
    kind: str = ""
    field: Field | None = None

    @property
    def unit(self) -> str:
        """The unit of the number, "" for none."""
        return self.field.unit.strip("-") if self.field else ""

    def value(self, h: Memory) -> int | float | None:
        """The number in `h`; None where IA() is not in use."""
        words = getattr(h, self.part)
        wide = int(words.itemsize // h.ia.itemsize)
        if self.part in ("ia", "ra") and (self.at + 1) * wide >= h.ci[g.MFREE]:
            return None
        value: int | float = words[self.at].item()
        return value


def read_place(text: str) -> PlaceName:
    """The place that `text` names. Raises PlaceError for what is not in the grammar."""
    left, dot, right = text.strip().partition(".")
    group, field = GROUP.fullmatch(left), FIELD.fullmatch(right if dot else left)
    if group and not dot:
        return PlaceName((group[1] or "").lower(), int(group[2]), "", None)
    if field and (not dot or (group and group[1])):
        kind, address = (group[1].lower(), int(group[2])) if group else ("", 0)
        return PlaceName(kind, address, field[1].upper(), int(field[2]) if field[2] else None)
    raise PlaceError(f"{text.strip()!r} names no place", FORMS)


# ---- addresses


def address_of(atlas: Atlas, place: int | str) -> int:
    """The first word of a place: an address, which may be any integer, or text.

    Raises PlaceError for a variable of the common block and for a group that is not there.
    """
    return place if isinstance(place, int) else _words(atlas, read_place(place))[0]


def stretch(atlas: Atlas, text: str) -> tuple[int, int]:
    """First and last address of 412, 412-500, 412/20, block@88 or block@88.KXD. Raises PlaceError."""
    given = STRETCH.fullmatch(text)
    if given is None:
        raise PlaceError(f"{text!r} names no words", "give 412, 412-500 (to address 500), 412/20 or block@88")
    first, end = _words(atlas, read_place(given[1]))
    if given[2]:
        return first, _words(atlas, read_place(given[2]))[1]
    return first, first + int(given[3]) - 1 if given[3] else end


def _words(atlas: Atlas, name: PlaceName) -> tuple[int, int]:
    """First and last address of a place in IA()."""
    if not name.address and name.field:
        raise PlaceError(f"{name.field} names no words of IA()", "give 412, block@88 or block@88.KXD")
    if not name.kind:
        return name.address, name.address
    span = _span(atlas, name)
    if not name.field:
        return span.first, span.last
    word = _word(atlas, span, name)
    return word.first, word.last


def _span(atlas: Atlas, name: PlaceName) -> Span:
    """The words of a group, of which the kind is given."""
    kind, address = name.kind, name.address
    if kind not in (*KINDS, JUNK):
        raise PlaceError(f"{kind} is not a kind of group", f"there are {', '.join(KINDS)}")
    if not 1 <= address <= len(atlas.h.ia):
        raise PlaceError(f"there is no {kind} at {address}", f"IA() has the addresses 1 to {len(atlas.h.ia)}")
    span = atlas.span(address)
    if (span.kind, span.first) != (kind, address):
        there = called(atlas, span)
        raise PlaceError(f"there is no {kind} at {address}", f"that word is in {there}")
    return span


def _word(atlas: Atlas, span: Span, name: PlaceName) -> Word:
    """The element of a field of a group."""
    fields = {} if span.kind == JUNK else {one.name: one for one in TABLE.group(span.kind).fields}
    if name.field not in fields:
        has = f"there are {', '.join(fields)}" if fields else "it has none"
        raise PlaceError(f"{name.field} is not a field of a {span.kind}", has)
    field = fields[name.field]
    return atlas.word(span, field, _element(field, name.element))


def _element(field: Field, given: int | None) -> int:
    """The element of a field, counted from 0. given: as it is written, from 1 on."""
    if given is None and field.count > 1:
        raise PlaceError(f"{field.name} has {field.count} elements", f"give one of them, as {field.name}(1)")
    if given is not None and not 1 <= given <= field.count:
        raise PlaceError(f"{field.name} has no element {given}", f"it has {counted(field.count, 'element')}")
    return (given or 1) - 1


# ---- numbers


def find_number(atlas: Atlas, text: str) -> Place:
    """The number that `text` names. Raises PlaceError, and IndexError for an address outside IA()."""
    name = read_place(text)
    if not name.kind and name.field:
        fields = {one.name: one for one in TABLE.common}
        if name.field not in fields:
            detail = f"{name.field} is not a variable of the common block"
            raise PlaceError(detail, "a field needs its group, as in block@88.KXD")
        return _variable(fields[name.field], _element(fields[name.field], name.element))
    if not name.kind:
        return number_at(atlas, name.address)
    span = _span(atlas, name)
    if not name.field:
        raise PlaceError(f"{span.name} is a whole group", f"give a field of it, as in {span.name}.FIELD")
    return _of_word(atlas, span, _word(atlas, span, name))


def number_at(atlas: Atlas, address: int) -> Place:
    """The number that the word at `address` is a part of; the word itself where no field is."""
    span, word = atlas.word_at(address)
    return _of_word(atlas, span, word) if word else Place(str(address), "ia", address - 1, span.kind)


def number_of(atlas: Atlas, part: str, index: int) -> Place:
    """The number `index` of a part of the memory."""
    if part == "ia":
        return number_at(atlas, index + 1)
    if part == "ra":
        return number_at(atlas, index * atlas.ratio + 1)
    for field in TABLE.common:
        first = getattr(g, field.name)
        if PARTS[field.type] == part and first <= index < first + field.count:
            return _variable(field, index - first)
    return Place(f"{part}[{index}]", part, index)


def _of_word(atlas: Atlas, span: Span, word: Word) -> Place:
    """A field of a group as a number of the memory."""
    part, index = ("ra", (word.first - 1) // atlas.ratio) if word.field.real else ("ia", word.first - 1)
    return Place(f"{span.name}.{word.name}", part, index, span.kind, word.field)


def _variable(field: Field, element: int) -> Place:
    """An element of a variable of the common block."""
    name = f"{field.name}({element + 1})" if field.count > 1 else field.name
    return Place(name, PARTS[field.type], getattr(g, field.name) + element, "", field)
