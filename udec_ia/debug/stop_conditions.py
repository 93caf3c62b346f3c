"""Stop conditions of the debugger: contacts made, broken or re-coded, changed words, unsound states.

A stop condition is shown the states one after the other, after every cycle and command. It reports what has
happened since the state before.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import eq, ge, gt, le, lt
from typing import Any, NamedTuple, Protocol

import numpy as np

from udec_ia.checker import check, in_short
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.group_conditions import evaluate, satisfying
from udec_ia.reader.group_tables import addresses, table
from udec_ia.reader.list_walks import Unsound
from udec_ia.reader.place_grammar import Place
from udec_ia.reader.word_map import Atlas, kind_named

GROUPS_MADE = [g.MFREE, g.JUNK, g.NBLK, g.NDOM, g.NMADE, g.NBROKE]  # one changes when a group comes or goes
COMPARED: dict[str, Callable[[Any, Any], Any]] = {">": gt, "<": lt, ">=": ge, "<=": le, "==": eq}


class StopCondition(Protocol):
    """text: the condition, as it was typed."""

    text: str

    def begin(self, array: MainArray) -> None:
        """Take this state as the first one."""

    def hit(self, array: MainArray) -> str:
        """What has happened since the last state, or "". The next call compares with this one."""


class WordChange:
    """A number that changes, or for which a comparison becomes true."""

    def __init__(self, place: Place, sign: str = "", limit: float = 0.0) -> None:
        self.place, self.sign, self.limit = place, sign, limit
        self.text = f"watch {place.name}" + (f" {sign} {limit:g}" if sign else "")
        self._seen: Any = None

    def begin(self, array: MainArray) -> None:
        """See StopCondition."""
        self._seen = self.place.value(array.h)

    def hit(self, array: MainArray) -> str:
        """See StopCondition."""
        before, now = self._seen, self.place.value(array.h)
        self._seen = now
        if before == now or (before != before and now != now):
            return ""
        if self.sign and (self._true(before) or not self._true(now)):
            return ""
        unit = f" {self.place.unit}" if self.place.unit else ""
        return f"{self.place.name}: {format_number(before)} -> {format_number(now)}{unit}"

    def _true(self, value: Any) -> bool:
        return value is not None and bool(COMPARED[self.sign](value, self.limit))


class ExpressionChange:
    """An expression of places whose value changes, such as `block@88.KP.KXP - 1`, or that becomes true.

    Its pointers are followed anew in every state. It has no value where that is not possible.
    """

    def __init__(self, expression: str) -> None:
        self.expression, self.text = expression, f"watch {expression}"
        self._seen: Any = None

    def begin(self, array: MainArray) -> None:
        """See StopCondition."""
        self._seen = self._value(array)

    def hit(self, array: MainArray) -> str:
        """See StopCondition."""
        before, now = self._seen, self._value(array)
        self._seen = now
        if before == now or (before != before and now != now) or (isinstance(now, bool) and not now):
            return ""
        return f"{self.expression}: {format_number(before)} -> {format_number(now)}"

    def _value(self, array: MainArray) -> float | bool | None:
        try:
            return evaluate(Atlas(array.h), self.expression)
        except (ValueError, IndexError):
            return None


class UnsoundState:
    """A state in which `check` finds something, after one in which it found nothing."""

    text = "break unsound"

    def __init__(self) -> None:
        self._sound = True

    def begin(self, array: MainArray) -> None:
        """See StopCondition."""
        self._sound = not check(array)

    def hit(self, array: MainArray) -> str:
        """See StopCondition."""
        broken, was_sound = check(array), self._sound
        self._sound = not broken
        return f"unsound: {in_short(broken)}" if broken and was_sound else ""


def format_number(value: Any) -> str:
    """A number as text; all digits of a real."""
    return "no word" if value is None else repr(value)


class ContactChange:
    """Contacts that are made, broken or re-coded. what: which of these.

    Those of blocks that come and go by commands count as well; a contact that becomes virtual is broken.
    """

    def __init__(self, what: str) -> None:
        self.what = what
        self.text = f"break {what}"
        self._codes: dict[Contact, int] = {}
        self._counts: list[int] = []
        self._cycle = 0

    def begin(self, array: MainArray) -> None:
        """See StopCondition."""
        self._codes, self._cycle = _codes(array), int(array.h.ci[g.MCTOT])
        self._counts = array.h.ci[GROUPS_MADE].tolist()

    def hit(self, array: MainArray) -> str:
        """See StopCondition."""
        counts = array.h.ci[GROUPS_MADE].tolist()
        if self.what != "recoded" and counts == self._counts:
            return ""
        before, now, cycle = self._codes, _codes(array), int(array.h.ci[g.MCTOT])
        self._codes, self._counts = now, counts
        if cycle == self._cycle:  # a command, which may hand a contact on to another block
            there = {one.address: one for one in now}
            before = {there.get(one.address, one): code for one, code in before.items()}
        self._cycle = cycle
        if self.what == "made":
            found = [f"contact@{one.address}" for one in now if one not in before]
        elif self.what == "broken":
            found = [f"contact@{one.address}" for one in before if one not in now]
        else:
            found = [
                f"contact@{one.address} from code {before[one]} to {code}"
                for one, code in now.items()
                if before.get(one, code) != code
            ]
        return f"{self.what}: {', '.join(found)}" if found else ""


class Contact(NamedTuple):
    """Identity of a contact. An address alone is not enough: it may be reused within a cycle."""

    address: int
    blocks: frozenset[int]


def _codes(array: MainArray) -> dict[Contact, int]:
    """Code of each contact that is not virtual."""
    try:
        rows = table(array, "contact")
        rows = rows[rows["KCCOD"] != g.VIRTUAL]
    except Unsound:
        return {}
    columns = (rows[name].tolist() for name in ("address", "KB1", "KB2", "KCCOD"))
    return {Contact(iad, frozenset((one, two))): code for iad, one, two, code in zip(*columns, strict=True)}


class GroupCondition:
    """A condition that becomes true for a group: `contact where KCN > 0.1`, as `udec find` takes it."""

    def __init__(self, text: str) -> None:
        self.text = f"break {text}"
        self.condition, self.kind = text, kind_named(text.split()[0])
        self._seen: set[int] = set()

    def _find(self, array: MainArray) -> list[int]:
        found: list[int] = satisfying(Atlas(array.h), self.condition).at.tolist()
        return found

    def begin(self, array: MainArray) -> None:
        """See StopCondition."""
        self._seen = {*self._find(array)}

    def hit(self, array: MainArray) -> str:
        """See StopCondition."""
        now = {*self._find(array)}
        new, self._seen = now - self._seen, now
        return f"{self.text}: {', '.join(f'{self.kind}@{iad}' for iad in sorted(new))}" if new else ""


class GroupBirth:
    """The group at an address is created or given back. Examined only when such counts have changed."""

    def __init__(self, kind: str, address: int) -> None:
        self.kind, self.address = kind, address
        self.text = f"born {kind}@{address}"
        self._counts: list[int] = []
        self._there: frozenset[int] | None = None
        self._cycle = 0

    def begin(self, array: MainArray) -> None:
        """See StopCondition."""
        self._counts, self._cycle = array.h.ci[GROUPS_MADE].tolist(), int(array.h.ci[g.MCTOT])
        self._there = self._found(array)

    def hit(self, array: MainArray) -> str:
        """See StopCondition."""
        counts = array.h.ci[GROUPS_MADE].tolist()
        ran, self._cycle = int(array.h.ci[g.MCTOT]) != self._cycle, int(array.h.ci[g.MCTOT])
        if counts == self._counts:
            return ""
        before, self._there, self._counts = self._there, self._found(array), counts
        if before == self._there:
            return ""
        if before is not None and self._there is not None:  # a command may hand a contact on
            return f"{self.kind}@{self.address} is given back, and another is made there" if ran else ""
        return f"{self.kind}@{self.address} {'is given back' if self._there is None else 'is made'}"

    def _found(self, array: MainArray) -> frozenset[int] | None:
        """The blocks of the contact that is there, no blocks for a group of another kind; None for none."""
        try:
            if not np.any(addresses(array, self.kind) == self.address):
                return None
            if self.kind != "contact":
                return frozenset()
            rows = table(array, self.kind)
            (row,) = rows[rows["address"] == self.address]
            return frozenset((int(row["KB1"]), int(row["KB2"])))
        except Unsound:
            return None
