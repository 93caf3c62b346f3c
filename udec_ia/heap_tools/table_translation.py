"""What the words of one field table mean by another one: fields, codes and recorded numbers go by names.

`theirs` is the table that a state was written by, `ours` the one that it is to be read by.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from udec_ia.layout import offsets as g
from udec_ia.layout.code_names import spelled
from udec_ia.layout.field_table import Code, Field, Table, lay_out

HISTORY, KIND, NUMBER = "history", "KHK", "KHF"  # what a history records: kind of group, and field in it
FOLLOWER, FOLLOWED = "follower", "KWN"  # a number of the common block that follows a FUNCTION, by its index
SHOWN = 4  # names that a sentence lists


class UnknownError(ValueError):
    """A word means nothing by the other table; the message is a phrase that follows what it is."""


def same_words(theirs: Table, ours: Table, numbered: bool) -> bool:
    """True if every word means the same by both tables. numbered: some know a variable by its number."""
    known = {code.name: code.value for code in ours.codes}
    shapes = [
        (
            [(group.name, [_word(field) for field in group.fields]) for group in table.groups],
            {(head.name, head.value, head.group) for head in table.heads},
            numbered and [(one.name, one.type, one.count) for one in table.common],
        )
        for table in (theirs, ours)
    ]
    same_codes = not known or all(known.get(one.name) == one.value for one in theirs.codes)
    return same_codes and shapes[0] == shapes[1]


def _word(field: Field) -> tuple[Any, ...]:
    return field.name, field.type, field.count, field.target is None


def in_words(field: Field) -> str:
    """What a field holds: a pointer, an int*3, a real."""
    kind = "pointer" if field.target else field.type
    return kind + (f"*{field.count}" if field.count > 1 else "")


def is_alike(old: Field, new: Field) -> bool:
    """True if what stands in `old` may stand in `new`, being of the same kind. A real may be a double."""
    if old.type == "real" and new.type == "double":
        return True
    return old.type == new.type and (old.target is None) == (new.target is None)


def may_be_0(field: Field) -> bool:
    """True if the field may hold 0."""
    return not field.allowed or any(low <= 0 <= (0 if high is None else high) for low, high in field.allowed)


def news(theirs: Table, ours: Table) -> list[str]:
    """What another table has changed for a state, in phrases with the names of fields, kinds and codes."""
    mine, other = _all_fields(ours), _all_fields(theirs)
    kinds, known_kinds = ([group.name for group in table.groups] for table in (theirs, ours))
    codes, named = _all_codes(ours), _all_codes(theirs)
    changes = {
        "fields that are new and 0": [
            n for n, at in mine.items() if n not in other and at[0] in ("", *kinds)
        ],
        "fields not known here, and 0": [
            n for n, at in other.items() if n not in mine and at[0] in ("", *known_kinds)
        ],
        "fields elsewhere in the group": [n for n, at in mine.items() if other.get(n, at) != at],
        "kinds of group that are new": [kind for kind in known_kinds if kind not in kinds],
        "kinds of group not known here, and empty": [kind for kind in kinds if kind not in known_kinds],
        "codes under another number": [n for n, value in named.items() if codes.get(n, value) != value],
    }
    return [
        f"{what}: {len(names)} ({', '.join(names[:SHOWN])}{', ...' if len(names) > SHOWN else ''})"
        for what, names in changes.items()
        if names
    ]


def _all_codes(table: Table) -> dict[str, int]:
    """Head codes and codes of fields by their names."""
    return {one.name: one.value for one in table.heads} | {one.name: one.value for one in table.codes}


def _all_fields(table: Table) -> dict[str, tuple[Any, ...]]:
    """Each field by its name, with its kind of group, and where it stands for the ratios 1 and 2."""
    found: dict[str, tuple[Any, ...]] = {field.name: ("", ()) for field in table.common}
    for group in table.groups:
        layouts = [lay_out(group, ratio).offset for ratio in (1, 2)]
        for field in group.fields:
            found[f"{field.name} of {group.name}"] = group.name, [layout[field.name] for layout in layouts]
    return found


class Meaning:
    """Translates codes, head codes and what histories record."""

    def __init__(self, theirs: Table, ours: Table) -> None:
        self.theirs, self.ours = theirs, ours
        self._recorded = _recordable(theirs)
        self._numbers = {field: numbers for numbers, field in _recordable(ours).items()}

    def codes(self, old: Field, new: Field, kind: str, values: list[int]) -> dict[int, int]:
        """New numbers of `values` of a field, {} if all are the old ones. UnknownError if one has none."""
        if new.role == "head" and new.target is None:
            there, ours = head_codes(self.theirs, kind), head_codes(self.ours, kind)
        else:
            ours = list(self.ours.codes_of(new.name))
            there = self._there(old, {code.name: code.flag for code in ours})
        here = {code.name: code.value for code in ours}
        if not here or not there or all(here.get(code.name) == code.value for code in there):
            return {}
        return {value: _renumbered(value, there, here) for value in values}

    def _there(self, field: Field, flags: dict[str, bool]) -> list[Code]:
        """The codes of a field by the old table. flags: codes of the new one by name, True for a flag.

        A table of before the word FLAG knew each code of one field only, and not which of them add up.
        """
        return [
            replace(code, flag=code.flag or flags.get(code.name, False))
            for code in self.theirs.codes
            if field.name in code.fields or code.name in flags
        ]

    def recorded(self, kind: int, number: int) -> tuple[int, int]:
        """KHK and KHF of a history by the new table. UnknownError if it has no such field or variable."""
        if kind < g.COMMON_BLOCK:
            return kind, number
        group, name = self._recorded.get((kind, number), ("", "a number without a name"))
        if (group, name) not in self._numbers:
            raise UnknownError(f"records {name} of {group or 'the common block'}, which is not known here")
        return self._numbers[group, name]

    def followed(self, number: int) -> int:
        """KWN of a follower by the new table. UnknownError if it has no such number."""
        reals = self.theirs.common_reals
        if not 0 <= number < len(reals):
            raise UnknownError("follows a number without a name")
        field, element = reals[number]
        for k, (one, i) in enumerate(self.ours.common_reals):
            if (one.name, i) == (field.name, element):
                return k
        raise UnknownError(f"follows {field.name}, which is not known here")


def _recordable(table: Table) -> dict[tuple[int, int], tuple[str, str]]:
    """Kind of group, "" for none, and name of the field for each (KHK, KHF)."""
    found = {(g.COMMON_BLOCK, number): ("", one.name) for number, one in enumerate(table.common)}
    for kind, group in enumerate(table.groups, 1):
        found |= {(kind, number): (group.name, one.name) for number, one in enumerate(group.fields)}
    return found


def head_codes(table: Table, kind: str) -> list[Code]:
    """The head codes that groups of `kind` can have; none if they have no head code."""
    return [Code(one.name, one.value, ("HEAD",), one.text) for one in table.heads if one.group == kind]


def _renumbered(value: int, there: Iterable[Code], here: dict[str, int]) -> int:
    """The new number of one code, of the sum of several flags, or of 0, which needs no name."""
    names = [code.name for code in spelled(there, value)]
    if lost := [name for name in names if name not in here]:
        raise UnknownError(f"is {value}, {'+'.join(lost)} in the file, which is not known here")
    if value and not names:
        raise UnknownError(f"is {value}, which is no code in the file")
    return sum(here[name] for name in names)
