"""A state told by another field table, or in words of other widths: all that it says goes by names.

A group goes by the name of its kind, a field by its own, a code by what it is called; a group of another size
gets another address, and every pointer that the table knows follows it. What the new table has and the old
one has not is 0. What it has not can be left out only where it is 0; all else that finds no place is a fault,
told with the first group that has it, and nothing is translated then.

The words that are translated may be anybody's: a group is believed to be one when pointers lead there, none
lies in another, and each pointer leads to a group of its kind. Whether the state makes sense is for the
checker to say.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.array import MainArray, variable
from udec_ia.heap.memory import JNEXT, JSIZE, JSIZES
from udec_ia.heap.words import Scheme
from udec_ia.inspect.census import CHOICES, junk_chains, list_heads, reached
from udec_ia.inspect.meaning import (
    HISTORY,
    KIND,
    NUMBER,
    Meaning,
    UnknownError,
    in_words,
    is_alike,
    may_be_0,
    same_words,
)
from udec_ia.layout.table import Field, Group, Layout, Table, lay_out, read_table

JUNK, FREE, TOP, AT_FAULT = (
    "JUNK",
    "MFREE",
    "MTOP",
    "IERAD",
)  # of the memory; the last is a note of an address
COMMON = ""  # kind of what is in no group


class Words(NamedTuple):
    """A state as words. ia: those of IA() in use, from address 1 on; common: the common block by names."""

    table: Table
    scheme: Scheme
    ia: Any
    common: Mapping[str, Any]

    def integer(self, name: str) -> int:
        """A variable of the common block; 0 if there is none of the name."""
        return int(np.ravel(self.common.get(name, 0))[0])


class TranslationError(ValueError):
    """What of a state cannot be told by another table: `faults`, each a phrase."""

    def __init__(self, faults: list[str]) -> None:
        self.faults = faults
        super().__init__("; ".join(faults))


def words_of(array: MainArray) -> Words:
    """The state of `array`; its words are not copied."""
    table, h = read_table(), array.h
    common = {field.name: variable(h, field) for field in table.common}
    return Words(table, array.scheme, h.ia[: int(common[FREE][0]) - 1], common)


def translate(state: Words, table: Table, scheme: Scheme) -> Words:
    """The same state by `table` in words of `scheme`. Raises TranslationError.

    If no kind of group in use gets another size, every group keeps its address and the junk list stays; else
    they are laid side by side in the order that they have, and there is no junk. Reals of fewer bits are
    rounded.
    """
    counted = state.integer("IHPNT") != 0  # a history knows a variable by its number
    same = scheme == state.scheme and same_words(state.table, table, counted)
    work = _Translation(state, table, scheme)
    ia = state.ia if same else work.words()
    common = {} if work.faults else work.variables(len(ia))
    if work.faults:
        raise TranslationError(work.faults)
    return Words(table, scheme, ia, common)


class _Translation:
    """One state on its way into other words.

    faults: what has found no place so far. moved: new address of the group at each old one, and kind_at: the
    number of its kind; None while every word stays as it is. stays: no group has a new address.
    """

    moved: Any = None
    kind_at: Any = None
    stays = True

    def __init__(self, state: Words, table: Table, scheme: Scheme) -> None:
        self.state, self.table, self.scheme = state, table, scheme
        self.meaning = Meaning(state.table, table)
        self.faults: list[str] = []

    # ---- where groups are, and where they go

    def words(self) -> Any:
        """The words of IA(); what is returned has no meaning if there are faults."""
        groups = {group.name: group for group in self.table.groups}
        new = {name: lay_out(group, self.scheme.ratio) for name, group in groups.items()}
        self.faults += [
            f"{kind}@{at[0]} is of a kind that is not known here" + _and_more(len(at) - 1)
            for kind, at in self.at.items()
            if len(at) and kind not in new
        ]
        sizes = {kind: new[kind].size for kind, at in self.at.items() if len(at) and kind in new}
        known = {layout.size for layout in new.values()}  # of which junk groups may be found again
        self.stays = all(size == self.old[kind].size for kind, size in sizes.items()) and all(
            size in known for size in set(self.junk[:, 1].tolist())
        )
        self._check_spans()
        if self.faults:
            return ()
        last = self._move(sizes)
        if last > self.scheme.top_address:
            self.faults.append(
                f"{last} words are needed, and {self.scheme.name} has no addresses for so many"
            )
            return ()
        ia = np.zeros(last, self.scheme.int_type)
        for kind in sizes:
            at = self.moved[self.at[kind]]
            for field, values in self._fields(kind, groups[kind]):
                view, first = _words(ia, self.scheme, field, at, new[kind])
                view[first[:, None] + np.arange(field.count)] = values
        for link in (JNEXT, JSIZE, JSIZES) if self.stays else ():
            first = self.junk[self.junk[:, 1] > link[0], 0] - 1 + link[0]
            ia[first] = self.state.ia[first]
        return ia

    @cached_property
    def old(self) -> dict[str, Layout]:
        """Layouts of the kinds of groups as they were."""
        return {group.name: lay_out(group, self.state.scheme.ratio) for group in self.state.table.groups}

    @cached_property
    def at(self) -> dict[str, Any]:
        """Addresses of the groups of every kind as they were, ascending."""
        heads = ((str(one.target), self.state.integer(one.name)) for one in list_heads(self.state.table))
        return reached(self.state.table, self.state.scheme.ratio, self.state.ia, heads, strict=True)

    @cached_property
    def junk(self) -> Any:
        """Address and size of the junk groups."""
        chains = junk_chains(self.state.ia, self.state.integer(JUNK))
        return np.array([one for chain in chains for one in chain], np.int64).reshape(-1, 2)

    def _check_spans(self) -> None:
        """Groups must not lie in each other; where they move, every word must be in one."""
        sizes = [np.full(len(at), self.old[kind].size) for kind, at in self.at.items()]
        first = np.concatenate([*self.at.values(), self.junk[:, 0]])
        after = first + np.concatenate([*sizes, self.junk[:, 1]])
        order = np.argsort(first, kind="stable")
        after, first = np.append(1, after[order]), np.append(first[order], len(self.state.ia) + 1)
        for k in np.flatnonzero(after > first)[:1]:
            self.faults.append(f"word {first[k]} is in two groups")
        for k in np.flatnonzero(after < first)[: 0 if self.stays else 1]:
            self.faults.append(f"words {after[k]} to {first[k] - 1} are in no group")

    def _move(self, sizes: dict[str, int]) -> int:
        """Give every group its new address, the old one or the next that is free; the last word in use."""
        top = len(self.state.ia)
        self.moved, self.kind_at = np.zeros(top + 1, np.int64), np.zeros(top + 1, np.int16)
        for number, kind in enumerate(self.at, 1):
            self.moved[self.at[kind]], self.kind_at[self.at[kind]] = sizes.get(kind, 0), number
        here = np.flatnonzero(self.moved)
        after = np.cumsum(self.moved[here]) + 1
        self.moved[here] = here if self.stays else after - self.moved[here]
        return top if self.stays else int(after[-1]) - 1 if len(after) else 0

    # ---- fields

    def _fields(self, kind: str, group: Group) -> list[tuple[Field, Any]]:
        """The fields of a kind of group by the new table, and what they hold: a row for each group."""
        at, held = self.at[kind], {}
        before = {field.name: field for field in self.state.table.group(kind).fields}
        for name, field in before.items():
            view, first = _words(self.state.ia, self.state.scheme, field, at, self.old[kind])
            held[name] = view[first[:, None] + np.arange(field.count)]
        if kind == HISTORY and {KIND, NUMBER} <= {*before}:
            self._renumber(held, at)
        return self._translated(kind, before, group.fields, held)

    def variables(self, words: int) -> dict[str, Any]:
        """The common block, of a state that has so many words now."""
        before = {field.name: field for field in self.state.table.common}
        held = {name: np.reshape(self.state.common[name], (1, -1)) for name in before}
        found = {f.name: row[0] for f, row in self._translated(COMMON, before, self.table.common, held)}
        if self.moved is not None:
            room = min(max(self.state.integer(TOP), words), self.scheme.top_address)
            found |= {
                FREE: np.array([words + 1]),
                TOP: np.array([room // self.scheme.ratio * self.scheme.ratio]),
            }
        if not self.stays:
            found |= {JUNK: np.zeros(1, np.int64), AT_FAULT: np.zeros(1, np.int64)}
        return found

    def _translated(
        self, kind: str, before: dict[str, Field], fields: tuple[Field, ...], held: dict[str, Any]
    ) -> list[tuple[Field, Any]]:
        """The values of `fields`, from what the fields `before` held, by name: one row each."""
        names = {field.name for field in fields}
        for name, old in before.items():
            if name not in names and not (kind and self._is_head_of_one(kind, old)):
                self._refuse(
                    held[name] != 0, kind, name, held[name], f"and that field is {self._gone(name)} here"
                )
        rows = len(self.at[kind]) if kind else 1
        found = []
        for field in fields:
            values = np.zeros((rows, field.count), self._type(kind, field))
            if field.name in before:
                self._put(values, kind, before[field.name], field, held[field.name])
            else:
                self._begin(values, kind, field)
            found.append((field, values))
        return found

    def _is_head_of_one(self, kind: str, field: Field) -> bool:
        """True for a head code that says no more than the kind of the group does."""
        return field.role == "head" and len(self.meaning.names(field, kind, old=True)) == 1

    def _gone(self, name: str) -> str:
        """What is known of a field that the new table has not."""
        old = next((one for one in self.table.retired if one.name == name), None)
        return f"retired since layout {old.until} ({old.text})" if old else "not known"

    def _type(self, kind: str, field: Field) -> Any:
        """Type of the numbers of a field by the new table."""
        if field.type == "double":
            return np.float64
        return self.scheme.real_type if field.real else self.scheme.int_type if kind else np.int64

    def _put(self, values: Any, kind: str, old: Field, new: Field, held: Any) -> None:
        """Let `values` of the field `new` be what the field `old` of the name has `held`."""
        many = min(old.count, new.count) if is_alike(old, new) else 0
        self._refuse(held[:, many:] != 0, kind, old.name, held[:, many:], f"and is {in_words(new)} here")
        held = held[:, :many]
        if new.target is not None:
            held = self._renewed(kind, old, new, held)
        elif not new.real and old.name not in (KIND, NUMBER):
            held = self._recoded(kind, old, new, held)
        with np.errstate(over="ignore"):
            values[:, :many] = held.astype(values.dtype)
        if values.dtype.itemsize < held.dtype.itemsize:
            taken = values[:, :many]
            lost = np.isfinite(held) & ~np.isfinite(taken) if new.real else taken != held
            self._refuse(lost, kind, old.name, held, f"too large for {self.scheme.name}")

    def _begin(self, values: Any, kind: str, field: Field) -> None:
        """A field that is new is 0, or the head code of a kind that has one."""
        codes = self.meaning.names(field, kind, old=False) if field.role == "head" and kind else {}
        if len(codes) == 1:
            values[:] = min(codes)
        elif codes or not may_be_0(field):
            self._refuse(values == 0, kind, field.name, values, "being new, but must not be 0")

    def _renewed(self, kind: str, old: Field, new: Field, held: Any) -> Any:
        """Pointers to where the groups are now."""
        if self.moved is None:
            return held
        kinds = list(self.at) if new.target == "any" else CHOICES.get(str(new.target), (str(new.target),))
        numbers = [number for number, one in enumerate(self.at, 1) if one in kinds]
        inside = (held >= 0) & (held < len(self.moved))
        at = np.where(inside, held, 0)
        good = inside & ((at == 0) | np.isin(self.kind_at[at], numbers))
        self._refuse(~good, kind, old.name, held, f"and there is no {new.target}")
        return self.moved[np.where(good, at, 0)]

    def _recoded(self, kind: str, old: Field, new: Field, held: Any) -> Any:
        """Codes by their new numbers."""
        different = np.unique(held)
        try:
            codes = self.meaning.codes(old, new, kind, different.tolist())
        except UnknownError as error:
            self.faults.append(f"{old.name} of {kind or 'the common block'} {error}")
            return held
        if not codes:
            return held
        return np.array([codes[value] for value in different.tolist()])[np.searchsorted(different, held)]

    def _renumber(self, held: dict[str, Any], at: Any) -> None:
        """What histories record, which they know by numbers of kinds and fields."""
        for row, (kind, number) in enumerate(zip(held[KIND][:, 0], held[NUMBER][:, 0], strict=True)):
            try:
                held[KIND][row, 0], held[NUMBER][row, 0] = self.meaning.recorded(int(kind), int(number))
            except UnknownError as error:
                self.faults.append(f"history@{at[row]} {error}")
                return

    def _refuse(self, wrong: Any, kind: str, name: str, held: Any, what: str) -> None:
        """A fault for the first group that `wrong` is true of."""
        for row in np.flatnonzero(wrong.any(axis=1))[:1]:
            (value,) = held[row][wrong[row]][:1]
            where = f"{name} of {kind}@{self.at[kind][row]}" if kind else name
            more = _and_more(int(wrong.any(axis=1).sum()) - 1)
            self.faults.append(f"{where} is {value}, {what}{more}")


def _and_more(many: int) -> str:
    return f", and {many} more" if many else ""


def _words(ia: Any, scheme: Scheme, field: Field, at: Any, layout: Layout) -> tuple[Any, Any]:
    """The view of `ia` in which a field of the groups at `at` stands, and the index of its first number."""
    offset = layout.offset[field.name] - 1
    return (ia.view(scheme.real_type), (at - 1) // scheme.ratio + offset) if field.real else (ia, at + offset)
