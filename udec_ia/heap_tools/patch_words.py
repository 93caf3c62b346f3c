"""Assignments to words by name: block@88.KXD = 0.5, zone@9.KZG(2) = 412, FRAC = 0.1.

All assignments are read and checked before the first is made. Then the state is proved as `check` does; if it
is not sound, every word is put back. The size of the array (MTOP, MFREE beyond it) and what a history records
cannot be changed.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from udec_ia.checker import Violation, check, in_short
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.place_grammar import Place, PlaceError, find_number
from udec_ia.reader.recordable_numbers import HISTORY
from udec_ia.reader.word_map import Atlas

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
    what cannot be read or is not there, 30 outside the words in use, and 28 for a value that the word cannot
    hold or, without `force`, with which the state would not be sound. They leave it as it was.
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
    if not (left and right):
        raise UdecError(10, f"{text!r} is not an assignment", FORM)
    if left.isdecimal() and not 1 <= int(left) < atlas.free:
        raise UdecError(30, left, f"the words in use are 1 to {atlas.free - 1}")
    try:
        place = find_number(atlas, left)
    except PlaceError as error:
        wrong = UdecError(10, error.detail, error.advice)
        if error.text:  # of a path; a deck names its own line and column
            wrong.source, wrong.column = error.text, error.column + 1
        raise wrong from None
    if left.isdecimal() and place.field and place.field.real:
        raise UdecError(10, f"{left} is in the real {place.name}", f"give {place.name} = VALUE")
    if place.kind == HISTORY and place.field and place.field.role == "data":
        raise UdecError(10, f"{place.name} states what was recorded", "HISTORY defines another history")
    made = _judged(place, array.h, right)
    _check_size(array, made)
    return made


def _check_size(array: MainArray, made: Patch) -> None:
    """Error 28 for sizes that are not those of IA(): no file could hold them."""
    words = len(array.h.ia)
    allowed = {g.MFREE: (1, words + 1), g.MTOP: (words, words)}
    if made.words is array.h.ci and made.row in allowed:
        low, high = allowed[made.row]
        if not low <= made.value <= high:
            raise UdecError(28, f"{made.what} is {made.value}", f"IA() has {words} words")


def _judged(place: Place, h: Memory, text: str) -> Patch:
    """A value for the number at `place`, if its word can hold it."""
    what, words = place.name, getattr(h, place.part)
    if words.dtype.kind == "i":
        limits = np.iinfo(words.dtype)
        if not INTEGER.fullmatch(text):
            raise UdecError(10, f"{text!r} is not an integer, which {what} is")
        if len(text) > DIGITS or not limits.min <= int(text) <= limits.max:
            raise UdecError(28, f"{what} cannot be {text}", f"its word holds {limits.min} to {limits.max}")
        return Patch(what, words, place.at, int(text))
    if not REAL.fullmatch(text):
        raise UdecError(10, f"{text!r} is not a number, which {what} is")
    value, largest = float(text.upper().replace("D", "E")), float(np.finfo(words.dtype).max)
    if abs(value) > largest:
        raise UdecError(28, f"{what} cannot be {text}", f"its word stores numbers up to {largest:.2g}")
    return Patch(what, words, place.at, value)
