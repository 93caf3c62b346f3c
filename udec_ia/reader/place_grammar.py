"""Places in the heap by name: one grammar for the command line, PATCH, the debugger and Python.

412                an address: the word there, or the group that it is part of
block@88           a group, as every answer prints it; blocks@88 is the same
block@88.KXD       a field of a group
zone@9.KZG(2)      an element of a field
FRAC, AMU(1)       a variable of the common block, and an element of one
block@88.KP.KXP    a path: the pointer KP of the block leads to a corner, which has the field KXP
IBPNT.KB.KX        a path from a pointer of the common block
"""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field
from udec_ia.printable_text import counted
from udec_ia.reader.word_map import JUNK, KINDS, TABLE, Atlas, Span, Word, called, kind_named, leads_to

GROUP = re.compile(r"(?:([A-Za-z-]+)@)?(\d{1,40})")
FIELD = re.compile(r"([A-Za-z]\w*)(?:\((\d{1,9})\))?")
STRETCH = re.compile(r"((?:[A-Za-z-]+@)?[^-/]+)(?:-((?:[A-Za-z-]+@)?[^-/]+)|/(\d{1,18}))?")
FORMS = "give block@88.KXD, zone@9.KZG(2), block@88, block@88.KP.KXP, FRAC, AMU(1) or an address"
PARTS = {"int": "ci", "real": "cr", "double": "cd"}  # of a Memory, by the type of a variable
LONGEST = 40  # pointers of a path


class PlaceError(ValueError):
    """A place that cannot be read, or is not in the heap. detail: what is wrong; advice: what to do.

    text, column: of a path, and where in it the step begins that fails.
    """

    def __init__(self, detail: str, advice: str, text: str = "", column: int = 0) -> None:
        self.detail, self.advice, self.text, self.column = detail, advice, text, column
        caret = f"\n    {text}\n    {' ' * column}^" if text else ""
        super().__init__(f"{detail}: {advice}{caret}")


class Step(NamedTuple):
    """A field of a path. element: from 1 on, None if it is not given. column: where it stands in the text."""

    field: str
    element: int | None
    column: int


class PlaceName(NamedTuple):
    """A place as it is written.

    kind: of the group, "" for an address alone and for a variable. address: 0 for a variable. field: "" for a
    whole group. element: from 1 on, None if it is not given. path: the fields after that, each of the group
    that the one before leads to. text: of a path, else "".
    """

    kind: str
    address: int
    field: str
    element: int | None
    path: tuple[Step, ...] = ()
    text: str = ""


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
    text = text.strip()
    left, *rest = text.split(".")
    group, variable = GROUP.fullmatch(left), FIELD.fullmatch(left)
    steps, column = list[Step](), len(left) + 1
    for part in rest[: LONGEST + 1]:
        found = FIELD.fullmatch(part)
        if found is None:
            break
        steps.append(Step(found[1].upper(), int(found[2]) if found[2] else None, column))
        column += len(part) + 1
    kindless = rest and (kind_named(left) is not None if variable else group and not group[1])
    if len(steps) < len(rest) or not (group or variable) or kindless:
        raise PlaceError(f"{text!r} names no place", FORMS)
    if group:
        kind, address = (kind_named(group[1]) or group[1].lower()) if group[1] else "", int(group[2])
        first = steps.pop(0) if steps else Step("", None, 0)
    else:
        assert variable is not None
        kind, address = "", 0
        first = Step(variable[1].upper(), int(variable[2]) if variable[2] else None, 0)
    return PlaceName(kind, address, first.field, first.element, tuple(steps), text if steps else "")


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
    if name.path:
        word = _end_of_path(atlas, name)[1]
        return word.first, word.last
    if not name.address and name.field:
        raise PlaceError(f"{name.field} names no words of IA()", "give 412, block@88 or block@88.KXD")
    if not name.kind:
        return name.address, name.address
    span = _span(atlas, name)
    if not name.field:
        return span.first, span.last
    word = _word(atlas, span, name.field, name.element)
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


def _word(atlas: Atlas, span: Span, name: str, element: int | None) -> Word:
    """The element of a field of a group."""
    fields = {} if span.kind == JUNK else {one.name: one for one in TABLE.group(span.kind).fields}
    if name not in fields:
        has = f"there are {', '.join(fields)}" if fields else "it has none"
        raise PlaceError(f"{name} is not a field of a {span.kind}", has)
    field = fields[name]
    return atlas.word(span, field, _element(field, element))


def _element(field: Field, given: int | None) -> int:
    """The element of a field, counted from 0. given: as it is written, from 1 on."""
    if given is None and field.count > 1:
        raise PlaceError(f"{field.name} has {field.count} elements", f"give one of them, as {field.name}(1)")
    if given is not None and not 1 <= given <= field.count:
        raise PlaceError(f"{field.name} has no element {given}", f"it has {counted(field.count, 'element')}")
    return (given or 1) - 1


# ---- paths


def _end_of_path(atlas: Atlas, name: PlaceName) -> tuple[Span, Word]:
    """The group at the end of a path, and the word in it. PlaceError has a caret at the step that fails."""
    column = 0
    try:
        if name.kind:
            span = _span(atlas, name)
            column = name.text.find(".") + 1
            word = _word(atlas, span, name.field, name.element)
            field, of, value = word.field, f"{word.name} of {span.name}", atlas.value(word)
        else:
            place = _variable_named(name)
            assert place.field is not None
            field, of, value = place.field, place.name, place.value(atlas.h) or 0
        for step in name.path:
            span = _group_behind(atlas, field, of, value)
            column = step.column
            word = _word(atlas, span, step.field, step.element)
            field, of, value = word.field, f"{word.name} of {span.name}", atlas.value(word)
    except PlaceError as error:
        raise PlaceError(error.detail, error.advice, name.text, column) from None
    return span, word


def _group_behind(atlas: Atlas, field: Field, of: str, number: int | float) -> Span:
    """The group that a pointer with a value leads to. of: what the pointer is called."""
    if not field.target:
        raise PlaceError(f"{of} is not a pointer", field.text)
    value = int(number)
    if value == 0:
        raise PlaceError(f"{of} is 0 and leads to no group", field.text)
    if not atlas.holds(field.target, value):
        (there,) = leads_to(atlas, field.target, np.array([value]))
        raise PlaceError(f"{of} leads to {value}", f"that is {there}")
    return atlas.span(value)


# ---- numbers


def find_number(atlas: Atlas, text: str) -> Place:
    """The number that `text` names. Raises PlaceError, and IndexError for an address outside IA()."""
    name = read_place(text)
    if name.path:
        return _of_word(atlas, *_end_of_path(atlas, name))
    if not name.kind and name.field:
        return _variable_named(name)
    if not name.kind:
        return number_at(atlas, name.address)
    span = _span(atlas, name)
    if not name.field:
        raise PlaceError(f"{span.name} is a whole group", f"give a field of it, as in {span.name}.FIELD")
    return _of_word(atlas, span, _word(atlas, span, name.field, name.element))


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


def _variable_named(name: PlaceName) -> Place:
    """The variable of the common block of a name."""
    fields = {one.name: one for one in TABLE.common}
    if name.field not in fields:
        detail = f"{name.field} is not a variable of the common block"
        raise PlaceError(detail, "a field needs its group, as in block@88.KXD")
    return _variable(fields[name.field], _element(fields[name.field], name.element))


def _variable(field: Field, element: int) -> Place:
    """An element of a variable of the common block."""
    name = f"{field.name}({element + 1})" if field.count > 1 else field.name
    return Place(name, PARTS[field.type], getattr(g, field.name) + element, "", field)
