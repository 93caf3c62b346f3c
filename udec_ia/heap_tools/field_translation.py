"""The words of a state, field by field, by another table and in words of other widths.

Groups, fields and codes are found by their names, and pointers follow their groups. A field that only the new
table has is 0; one that only the old table has can be left out where it is 0. All else that has no place is a
fault, reported with the first group that has it. Nothing is trusted: pointers must lead to groups of their
kind, and no group may lie in another.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from udec_ia.heap.junk_list import JNEXT, JSIZE, JSIZES
from udec_ia.heap.word_scheme import Scheme
from udec_ia.heap_tools.table_translation import (
    FOLLOWED,
    FOLLOWER,
    HISTORY,
    KIND,
    NUMBER,
    Meaning,
    UnknownError,
    head_codes,
    in_words,
    is_alike,
    may_be_0,
    same_words,
)
from udec_ia.heap_tools.written_state import (
    AT_FAULT,
    COMMON,
    FREE,
    JUNK,
    TOP,
    Faults,
    Places,
    Rows,
    TranslationError,
    Words,
)
from udec_ia.layout.field_table import Field, Group, Table, lay_out


class Fit:
    """What has become of all numbers so far.

    misfits: how many do not fit; first: name and value of the first of them, None if all do. reals: how many
    were written that are as wide as the scheme says. rounded: how many of them are not what they were,
    vanished: how many of these are 0 now. change: the largest relative change of the others; where: the field
    that has it, "" if there is none.
    """

    def __init__(self) -> None:
        self.misfits = 0
        self.first: tuple[str, int | float] | None = None
        self.reals = self.rounded = self.vanished = 0
        self.change, self.where = 0.0, ""

    def take(self, rows: Rows, field: Field, former: Any, to: Any) -> Any:
        """The numbers `former` of a field of `rows`, as the type `to` can hold them."""
        if field.type == "real":
            self.reals += former.size
        if np.dtype(to).itemsize >= former.dtype.itemsize:
            return former
        if not field.real:
            limits = np.iinfo(to)
            self._count_misfits((former < limits.min) | (former > limits.max), rows, field, former)
            return former.astype(to)
        with np.errstate(over="ignore", under="ignore"):
            narrow = former.astype(to)
        back = narrow.astype(former.dtype)
        lost = (back != former) & ~np.isnan(former)
        if not lost.any():
            return narrow
        self._count_misfits(lost & np.isinf(back), rows, field, former)
        was, now = former[lost], back[lost]
        self.rounded += len(was)
        self.vanished += int(np.count_nonzero(now == 0))
        change = np.where((now != 0) & np.isfinite(now), np.abs((now - was) / was), 0.0)
        if change.max(initial=0.0) > self.change:
            place = np.flatnonzero(lost)[np.argmax(change)]
            self.change, self.where = float(change.max()), _name(rows, field, int(place))
        return narrow

    def _count_misfits(self, bad: Any, rows: Rows, field: Field, former: Any) -> None:
        """Numbers that do not fit."""
        if bad.any() and not self.misfits:
            place = int(np.argmax(bad))
            self.first = _name(rows, field, place), former.flat[place].item()
        self.misfits += int(np.count_nonzero(bad))


def _name(rows: Rows, field: Field, place: int) -> str:
    """PAR1(3), or KXD of block@88: an element of a field, by its place among those of all rows."""
    row, element = divmod(place, field.count)
    return rows.called(field.name + (f"({element + 1})" if field.count > 1 else ""), row)


PIECE = 8192  # groups that are written together: they fit in the machine's caches


def translate(state: Words, table: Table, scheme: Scheme) -> Words:
    """The same state by `table` in words of `scheme`; reals may be rounded. Raises TranslationError."""
    work = Translation(state, table, scheme)
    numbered = any(state.integer(name) for name in ("IHPNT", "IFWPNT"))
    stays = scheme == state.scheme and same_words(state.table, table, numbered)
    if not stays:
        work.move()
    ia, common = state.ia, dict[str, Any]()
    if not work.faults:
        if not stays:
            ia = np.zeros(work.used, scheme.int_type)
            work.write(ia)
        common = work.variables()
    if work.fit.first:
        name, value = work.fit.first
        work.faults.add(f"{name} is {value}, too large for {scheme.name}", work.fit.misfits)
    if work.faults:
        raise TranslationError(work.faults.phrases())
    return Words(table, scheme, ia, common)


class Translation:
    """One state on its way into other words.

    faults: what has found no place so far, but for numbers that do not fit, which `fit` counts. places: where
    groups go; None while every word stays as it is.
    """

    def __init__(
        self, state: Words, table: Table, scheme: Scheme, found: dict[str, Any] | None = None
    ) -> None:
        """found: as Places takes it."""
        self.state, self.table, self.scheme = state, table, scheme
        self.meaning = Meaning(state.table, table)
        self.faults, self.fit, self.found = Faults(), Fit(), found
        self.places: Places | None = None

    def move(self) -> None:
        """Give the groups their places. If there are faults now, nothing else can be done."""
        self.places = Places(self.state, self.found)
        sizes = {group.name: lay_out(group, self.scheme.ratio).size for group in self.table.groups}
        self.places.move(sizes, self.faults)
        if self.used > self.scheme.top_address:
            self.faults.add(
                f"{self.used} words are needed, and {self.scheme.name} has no addresses for so many"
            )

    @property
    def used(self) -> int:
        """The words that the groups and the junk list take."""
        return self.places.used if self.places else len(self.state.ia)

    @property
    def room(self) -> int:
        """Those of IA(): as many as before, unless the groups need more or the addresses end before."""
        ratio = self.scheme.ratio
        return min(max(self.state.integer(TOP), self.used, ratio), self.scheme.top_address) // ratio * ratio

    def write(self, ia: Any) -> None:
        """Write the words into `ia` (used,), which is 0."""
        assert self.places is not None
        places, groups = self.places, {group.name: group for group in self.table.groups}
        for kind, at in places.at.items():
            if not len(at):  # of a kind that may not be known here
                continue
            rows: Any = sliding_window_view(ia, lay_out(groups[kind], self.scheme.ratio).size, writeable=True)
            for first in range(0, len(at), PIECE):
                piece = slice(first, first + PIECE)
                words = self._groups(groups[kind], Rows(kind, at[piece]))
                rows[places.start[kind][piece] - 1] = words
        for link in (JNEXT, JSIZE, JSIZES) if places.stays else ():
            first = places.junk[places.junk[:, 1] > link[0], 0] - 1 + link[0]
            ia[first] = self.state.ia[first]

    def _groups(self, group: Group, rows: Rows) -> Any:
        """The words of groups by the new table, a row each."""
        before = {field.name: field for field in self.state.table.group(group.name).fields}
        old = lay_out(self.state.table.group(group.name), self.state.scheme.ratio)
        words = sliding_window_view(self.state.ia, old.size)[rows.at - 1]
        reals = words.view(self.state.scheme.real_type)
        former = {}
        for name, field in before.items():
            first = old.offset[name] - field.real
            former[name] = (reals if field.real else words)[:, first : first + field.count]
        if group.name == HISTORY and {KIND, NUMBER} <= {*before} and self.table is not self.state.table:
            self._renumber(former, rows)
        if group.name == FOLLOWER and FOLLOWED in before and self.table is not self.state.table:
            self._renumber_followed(former, rows)
        new = lay_out(group, self.scheme.ratio)
        words = np.zeros((len(rows), new.size), self.scheme.int_type)
        reals = words.view(self.scheme.real_type)
        for field, values in self._translated(rows, before, group.fields, former):
            first = new.offset[field.name] - field.real
            (reals if field.real else words)[:, first : first + field.count] = values
        return words

    def variables(self) -> dict[str, Any]:
        """The common block."""
        before = {field.name: field for field in self.state.table.common}
        former = {name: np.reshape(self.state.common[name], (1, -1)) for name in before}
        translated = self._translated(Rows(COMMON, ()), before, self.table.common, former)
        found = {field.name: row[0] for field, row in translated}
        if self.places is not None:
            found |= {FREE: np.array([self.used + 1]), TOP: np.array([self.room])}
            if not self.places.stays:
                found |= {JUNK: np.zeros(1, np.int64), AT_FAULT: np.zeros(1, np.int64)}
        return found

    def _translated(
        self, rows: Rows, before: dict[str, Field], fields: tuple[Field, ...], former: dict[str, Any]
    ) -> list[tuple[Field, Any]]:
        """The values of `fields`, from the `former` values of the fields `before`, by name."""
        names = {field.name for field in fields}
        for name, old in before.items():
            only_head = old.role == "head" and len(head_codes(self.state.table, rows.kind)) == 1
            if name not in names and not (rows.kind and only_head):  # else the kind of the group says as much
                gone = next((one for one in self.table.retired if one.name == name), None)
                why = f"retired since layout {gone.until} ({gone.text})" if gone else "not known"
                self._refuse(former[name] != 0, rows, name, former[name], f"and that field is {why} here")
        found = []
        for field in fields:
            values = np.zeros((len(rows), field.count), self._type(rows.kind, field))
            if field.name in before:
                self._put(values, rows, before[field.name], field, former[field.name])
            else:
                self._begin(values, rows, field)
            found.append((field, values))
        return found

    def _type(self, kind: str, field: Field) -> Any:
        """Type of the numbers of a field by the new table."""
        if field.type == "double":
            return np.float64
        return self.scheme.real_type if field.real else self.scheme.int_type if kind else np.int64

    def _put(self, values: Any, rows: Rows, old: Field, new: Field, former: Any) -> None:
        """Let `values` of the field `new` be what the field `old` of the name was before (`former`)."""
        many = min(old.count, new.count) if is_alike(old, new) else 0
        self._refuse(
            former[:, many:] != 0, rows, old.name, former[:, many:], f"but it is {in_words(new)} here"
        )
        former = former[:, :many]
        if new.target is not None and self.places is not None:
            moved, astray = self.places.followed(former, new.target)
            self._refuse(astray, rows, old.name, former, f"but there is no {new.target} at that address")
            former = moved
        elif new.target is None and not new.real and old.name not in (KIND, NUMBER):
            former = self._recoded(rows, old, new, former)
        values[:, :many] = self.fit.take(rows, new, former, values.dtype)

    def _begin(self, values: Any, rows: Rows, field: Field) -> None:
        """A field that is new is 0, or the head code of a kind that has one."""
        kind = rows.kind
        codes = head_codes(self.table, kind) if field.role == "head" and kind else []
        if len(codes) == 1:
            values[:] = codes[0].value
        elif codes or not may_be_0(field):
            self._refuse(values == 0, rows, field.name, values, "as it is new, but must not be 0")

    def _recoded(self, rows: Rows, old: Field, new: Field, former: Any) -> Any:
        """Codes by their new numbers."""
        if self.table is self.state.table:
            return former
        different = np.unique(former)
        try:
            codes = self.meaning.codes(old, new, rows.kind, different.tolist())
        except UnknownError as error:
            self.faults.add(f"{old.name} of {rows.kind or 'the common block'} {error}")
            return former
        if not codes:
            return former
        return np.array([codes[value] for value in different.tolist()])[np.searchsorted(different, former)]

    def _renumber(self, former: dict[str, Any], rows: Rows) -> None:
        """What histories record, which they know by numbers of kinds and fields."""
        for row, (kind, number) in enumerate(zip(former[KIND][:, 0], former[NUMBER][:, 0], strict=True)):
            try:
                former[KIND][row, 0], former[NUMBER][row, 0] = self.meaning.recorded(int(kind), int(number))
            except UnknownError as error:
                self.faults.add(f"history@{rows.at[row]} {error}")
                return

    def _renumber_followed(self, former: dict[str, Any], rows: Rows) -> None:
        """What followers set, which they know by its index."""
        for row, number in enumerate(former[FOLLOWED][:, 0]):
            try:
                former[FOLLOWED][row, 0] = self.meaning.followed(int(number))
            except UnknownError as error:
                self.faults.add(f"follower@{rows.at[row]} {error}")
                return

    def _refuse(self, wrong: Any, rows: Rows, name: str, former: Any, what: str) -> None:
        """A fault for the groups that `wrong` is true of."""
        bad = np.flatnonzero(wrong.any(axis=1))
        if len(bad):
            (value,) = former[bad[0]][wrong[bad[0]]][:1]
            phrase = f"{rows.called(name, bad[0])} is {value}, {what}"
            self.faults.add(phrase, len(bad), rows.kind, name, what)
