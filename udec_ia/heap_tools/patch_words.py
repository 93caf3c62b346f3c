"""Words of a state are given other values by name: block@88.KXD = 0.5, zone@9.KZG(2) = 412, FRAC = 0.1.

What can be given a value is a field of a group in use, a variable of the common block, or, by its address, an
integer word. All assignments are read and judged before the first is made: there must be such a field in such
a group, and the word must be able to hold the value. Then the whole state is proved, as `check` proves it. If
it is not sound, every word is put back.

Not to be given are the size of the array (MTOP, MFREE beyond it) and what a history records: the numbers
that it has recorded would not be its own.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from udec_ia.checker import Violation, check
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.fault_summary import in_short
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field
from udec_ia.reader.atlas import KINDS, TABLE, Atlas, Span, Word
from udec_ia.reader.group_names import called
from udec_ia.reader.recordable_numbers import HISTORY

ELEMENT = r"(?P<name>[A-Za-z]\w*)(\((?P<element>\d{1,9})\))?"
PLACE = re.compile(rf"(?P<address>\d{{1,18}})|((?P<kind>[A-Za-z]+)@(?P<group>\d{{1,18}})\.)?{ELEMENT}")
INTEGER = re.compile(r"[+-]?\d+")
REAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([EeDd][+-]?\d+)?")
DIGITS = 20  # and a sign: of an integer of 64 bits
FORM = "give block@88.KXD = 0.5, zone@9.KZG(2) = 412, FRAC = 0.1, or an integer word by address: 1234 = 7"


class Patch(NamedTuple):
    """One assignment, read and judged. what: the place by name; words, row: the array and where in it."""

    what: str
    words: Any
    row: int
    value: int | float

    @property
    def now(self) -> int | float:
        """What stands there."""
        number: int | float = self.words[self.row].item()
        return number

    @property
    def place(self) -> int:
        """Where the number stands in the memory of the machine."""
        return int(self.words.ctypes.data) + self.row * int(self.words.itemsize)


class Patched(NamedTuple):
    """former: the assignments that take all back, in the order given. broken: what is not sound now."""

    former: list[Patch]
    broken: list[Violation]


def patch(array: MainArray, *assignments: str, force: bool = False) -> Patched:
    """Make the assignments, each `PLACE = VALUE`, several with commas between them, and prove the state.

    As after RSET the next CYCLE finds the time-step anew, and before the first one the masses. Error 10 for
    what cannot be read or is not there, 30 for an address outside the words in use, and 28 for a value that
    the word cannot hold or, unless `force` is given, with which the state would not be sound. They leave it
    as it was.
    """
    patches = read_patches(array, assignments)
    ready, array.h.ci[g.LREADY] = int(array.h.ci[g.LREADY]), 0
    former = assign(patches)
    broken = check(array)
    if broken and not force:
        assign(former)
        array.h.ci[g.LREADY] = ready
        detail = f"the state would not be sound: {in_short(broken)}"
        raise UdecError(28, detail, "nothing is changed: change with it everything that depends on it")
    return Patched(former, broken)


def assign(patches: Sequence[Patch]) -> list[Patch]:
    """Make assignments. Returns those that take them back."""
    former = [one._replace(value=one.now) for one in patches]
    for one in patches:
        one.words[one.row] = one.value
    return former


def read_patches(array: MainArray, assignments: Sequence[str]) -> list[Patch]:
    """The assignments, judged against the state as it is. Errors 10, 28 and 30."""
    atlas = Atlas(array.h)
    patches = [_read(array, atlas, part.strip()) for line in assignments for part in line.split(",")]
    seen: set[int] = set()
    for one in patches:
        if one.place in seen:
            raise UdecError(10, f"{one.what} is given two values", "give each place one value")
        seen.add(one.place)
    return patches


def _read(array: MainArray, atlas: Atlas, text: str) -> Patch:
    """One assignment."""
    left, _, right = (part.strip() for part in text.partition("="))
    found = PLACE.fullmatch(left)
    if not (found and right):
        raise UdecError(10, f"{text!r} is not an assignment", FORM)
    if found["address"]:
        return _of_word(atlas, int(found["address"]), right)
    if found["kind"]:
        return _of_group(atlas, found["kind"].lower(), int(found["group"]), found, right)
    field = next((one for one in TABLE.common if one.name == found["name"].upper()), None)
    if field is None:
        raise UdecError(10, f"{found['name']} is not a variable of the common block", FORM)
    return _of_common(array, field, _element(field, found), right)


def _of_word(atlas: Atlas, address: int, text: str) -> Patch:
    """An integer word by its address."""
    if not 1 <= address < atlas.free:
        raise UdecError(30, f"{address}", f"the words in use are 1 to {atlas.free - 1}")
    span, word = atlas.word_at(address)
    if word is None:
        return _judged(f"word {address} of {called(atlas, span)}", atlas.h.ia, address - 1, text)
    if word.field.real:
        what = f"{address} is in the real {word.name} of {called(atlas, span)}"
        raise UdecError(10, what, f"give {span.name}.{word.name} = VALUE")
    return _of_field(atlas, span, word, text)


def _of_group(atlas: Atlas, kind: str, address: int, found: re.Match[str], text: str) -> Patch:
    """A field of a group."""
    if kind not in KINDS:
        raise UdecError(10, f"{kind} is not a kind of group", f"there are {', '.join(KINDS)}")
    if not atlas.holds(kind, address):
        there = called(atlas, atlas.span(address)) if 1 <= address <= len(atlas.h.ia) else "outside IA()"
        raise UdecError(10, f"there is no {kind} at {address}", f"what is there: {there}")
    field = next((one for one in TABLE.group(kind).fields if one.name == found["name"].upper()), None)
    if field is None:
        names = ", ".join(one.name for one in TABLE.group(kind).fields)
        raise UdecError(10, f"{found['name']} is not a field of a {kind}", f"there are {names}")
    span = atlas.span(address)
    return _of_field(atlas, span, atlas.word(span, field, _element(field, found)), text)


def _of_field(atlas: Atlas, span: Span, word: Word, text: str) -> Patch:
    """An element of a field of a group, but not of what a history records: that is kept beside the array."""
    what = f"{word.name} of {called(atlas, span)}"
    if span.kind == HISTORY and word.field.role == "data":
        raise UdecError(10, f"{what} says what was recorded", "HISTORY defines another history")
    if word.field.real:
        return _judged(what, atlas.h.ra, (word.first - 1) // atlas.ratio, text)
    return _judged(what, atlas.h.ia, word.first - 1, text)


def _of_common(array: MainArray, field: Field, element: int, text: str) -> Patch:
    """An element of a variable of the common block. No file could hold sizes that are not those of IA()."""
    h = array.h
    words = {"int": h.ci, "real": h.cr, "double": h.cd}[field.type]
    index = getattr(g, field.name) + element
    name = field.name + (f"({element + 1})" if field.count > 1 else "")
    made = _judged(name, words, index, text)
    limits = {g.MFREE: (1, len(h.ia) + 1), g.MTOP: (len(h.ia), len(h.ia))}
    low, high = limits.get(index, (made.value, made.value)) if words is h.ci else (made.value, made.value)
    if not low <= made.value <= high:
        raise UdecError(28, f"{name} is {text}", f"IA() has {len(h.ia)} words")
    return made


def _element(field: Field, found: re.Match[str]) -> int:
    """The element of a field that is meant, counted from 0."""
    if found["element"] is None and field.count > 1:
        raise UdecError(10, f"{field.name} has {field.count} elements", f"give {field.name}(1), ...")
    element = int(found["element"] or 1)
    if not 1 <= element <= field.count:
        raise UdecError(10, f"{field.name} has no element {element}", f"they are 1 to {field.count}")
    return element - 1


def _judged(what: str, words: Any, row: int, text: str) -> Patch:
    """A value for an element of `words`, if it can hold that."""
    if words.dtype.kind == "i":
        limits = np.iinfo(words.dtype)
        if not INTEGER.fullmatch(text):
            raise UdecError(10, f"{text!r} is not an integer, which {what} is")
        if len(text) > DIGITS or not limits.min <= int(text) <= limits.max:
            raise UdecError(28, f"{what} cannot be {text}", f"its word holds {limits.min} to {limits.max}")
        return Patch(what, words, row, int(text))
    if not REAL.fullmatch(text):
        raise UdecError(10, f"{text!r} is not a number, which {what} is")
    value, largest = float(text.upper().replace("D", "E")), float(np.finfo(words.dtype).max)
    if abs(value) > largest:
        raise UdecError(28, f"{what} cannot be {text}", f"its word holds numbers up to {largest:.2g}")
    return Patch(what, words, row, value)
