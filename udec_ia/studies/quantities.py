"""Quantities: what a study asks of a state of a run, each of them one number; and rules to stop at.

docs/sweep.md lists all forms, as in: time, block(5, 5).KY, max contact.KCFN where KCM == 2, solve.ratio.
NAME = QUANTITY gives it a name of its own. A rule is a quantity, a comparison and a number.

A block, corner, grid-point or zone at a place is the one that is nearest when the first cycle begins, and is
followed by its address. Contacts and other groups come and go: for these it is the one that is nearest now.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from operator import eq, ge, gt, le, lt, ne
from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.kernels.drive.history_recording import measured
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.energy_account import Balance, balance
from udec_ia.reader.group_conditions import Wrong, satisfying
from udec_ia.reader.group_positions import select_groups
from udec_ia.reader.group_tables import addresses
from udec_ia.reader.joint_rows import joint_rows
from udec_ia.reader.recordable_numbers import recordable
from udec_ia.reader.word_map import KINDS, Atlas, kind_named
from udec_ia.running.history_series import Series
from udec_ia.running.solve_result import Solution

FOLLOWED = ("block", "corner", "gridpoint", "zone")
PLACES = {"block": ("KX", "KY"), "gridpoint": ("KXG", "KYG")}  # of what has a displacement
Place = tuple[str, float, float]  # kind of group, x, y


class NoValue(ValueError):
    """A quantity has no value in a state, and why."""


class InitialState:
    """Where groups were when the first cycle began. places: those that quantities name."""

    def __init__(self, places: frozenset[Place]) -> None:
        self._places = places
        self._array: MainArray | None = None
        self._groups: dict[Place, int | str] = {}  # address, or why there is none
        self._first: dict[str, tuple[Any, Any]] = {}  # kind: addresses (n,), places (n, 2)

    def begin(self, array: MainArray) -> None:
        """A run of cycles begins: record where groups are, unless there have been cycles before."""
        if self._array is not None and array.h.ci[g.MCTOT] > 0:
            return
        self._array = array
        self._groups = {place: _nearest(array, place) for place in self._places if place[0] in FOLLOWED}
        atlas = Atlas(array.h)
        self._first = {kind: (atlas.groups[kind], _positions(atlas, kind)) for kind in PLACES}

    def look(self, array: MainArray) -> None:
        """After a command: drop deleted groups, before their addresses belong to others."""
        if self._array is None:
            return
        there = {kind: addresses(array, kind) for kind in FOLLOWED}
        for place, group in self._groups.items():
            if isinstance(group, int) and group not in there[place[0]]:
                self._groups[place] = f"the {place[0]} that was nearest was deleted"
        for kind, (at, where) in self._first.items():
            stays = np.isin(at, there[kind])
            self._first[kind] = at[stays], where[stays]

    def renumber(self, moved: Any) -> None:
        """Follow groups to their new addresses. moved: the new address of the group at each old one."""
        for place, group in self._groups.items():
            if isinstance(group, int):
                self._groups[place] = int(moved[group])
        for kind, (at, where) in self._first.items():
            order = np.argsort(moved[at])
            self._first[kind] = moved[at][order], where[order]

    def group(self, array: MainArray, place: Place) -> int:
        """Address of the group at a place. Raises NoValue."""
        found = self._groups.get(place) or _nearest(array, place)
        if isinstance(found, str):
            raise NoValue(found)
        return found

    def displacements(self, atlas: Atlas, kind: str, at: Any) -> Any:
        """How far groups have moved since, (n, 2): NaN for those that were not there yet."""
        if self._array is None:
            return np.zeros((len(at), 2))
        addresses, first = self._first[kind]
        known = np.isin(at, addresses)
        moved = np.full((len(at), 2), np.nan)
        now = _positions(atlas, kind)[np.searchsorted(atlas.groups[kind], at[known])]
        moved[known] = now - first[np.searchsorted(addresses, at[known])]
        return moved


@dataclass
class State:
    """A state of a run, with what has been recorded until now."""

    array: MainArray
    start: InitialState
    series: list[Series]
    solutions: list[Solution]
    safety: list[tuple[float, float, float]]

    @cached_property
    def atlas(self) -> Atlas:
        """Groups and fields of the state."""
        return Atlas(self.array.h)

    def groups(self, kind: str, where: str) -> Any:
        """Addresses of the groups of a kind for which a condition is true, ascending; "" is true for all."""
        return satisfying(self.atlas, f"{kind} where {where}").at if where else self.atlas.groups[kind]

    def column(self, kind: str, name: str, at: Any) -> Any:
        """The field or displacement `name` of the groups at `at`, as 64-bit reals (n,)."""
        if name in DISPLACEMENTS:
            return DISPLACEMENTS[name](self.start.displacements(self.atlas, kind, at))
        return _gather(self.atlas, kind, name, at)


def _gather(atlas: Atlas, kind: str, name: str, at: Any) -> Any:
    """A field of groups, as 64-bit reals (n,)."""
    word = next(one for one in atlas.shapes[kind] if one.name == name)
    return atlas.gather(word, at).astype(np.float64)


def _positions(atlas: Atlas, kind: str) -> Any:
    """Where the groups of a kind are, in the order of the atlas, (n, 2)."""
    return np.column_stack([_gather(atlas, kind, name, atlas.groups[kind]) for name in PLACES[kind]])


def _nearest(array: MainArray, place: Place) -> int | str:
    kind, x, y = place
    try:
        return select_groups(array, kind, "", None, [(x, y)])[0].address
    except UdecError as error:
        return error.detail


DISPLACEMENTS: dict[str, Callable[[Any], Any]] = {  # since the first cycle, of (n, 2) in x and y
    "DISPLACEMENT": lambda moved: np.hypot(moved[:, 0], moved[:, 1]),
    "XDISPLACEMENT": lambda moved: moved[:, 0],
    "YDISPLACEMENT": lambda moved: moved[:, 1],
}
OVER: dict[str, Callable[[Any], Any]] = {"max": np.max, "min": np.min, "mean": np.mean, "sum": np.sum}
OF_SERIES: dict[str, Callable[[Any], Any]] = {**OVER, "last": lambda numbers: numbers[-1]}


@dataclass(frozen=True)
class Quantity:
    """value: gives a number of a state, or raises NoValue. place: of the group to find at the first cycle."""

    value: Callable[[State], float]
    place: Place | None = None


class Rule(NamedTuple):
    """A rule to stop at. text: as it was written."""

    text: str
    quantity: Quantity
    comparison: str
    number: float

    def holds(self, state: State) -> bool:
        """True if a run is to stop in this state. Raises NoValue."""
        return COMPARISONS[self.comparison](self.quantity.value(state), self.number)


# ---- how they are written

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
FIELD = r"([A-Za-z]\w*(?:\(\d+\))?)"
NAMED = re.compile(r"\s*([A-Za-z][\w ./-]*?)\s*=(?!=)\s*(?=\S)")
RULE = re.compile(rf"(.*\S)\s*(<=|>=|==|!=|<|>)\s*({NUMBER})\s*", re.DOTALL)
COMPARISONS: dict[str, Callable[[float, float], bool]]
COMPARISONS = {"<": lt, "<=": le, ">": gt, ">=": ge, "==": eq, "!=": ne}
OTHER_NAMES = {"CYCLES": "MCTOT"}
SAFETY = ("factor", "stable", "failing")
SOLUTION = ("reached", "ratio", "cycles", "motion", "fallen")
ENERGIES = (*Balance._fields, "strain", "residual", "throughput")
OF_JOINTS: dict[str, Callable[[Any], Any]] = {  # of the rows of all joints
    "slip": lambda rows: np.abs(rows["slip"]).max(initial=0.0),
    "opening": lambda rows: rows["opening"].max(initial=0.0),
    "broken": lambda rows: rows["broken"].sum(),
}
EXAMPLES = (
    "write time, block(5, 5).KY, max contact.KCFN where ..., count block where ..., last history 1, "
    "energy.friction, joints.slip, solve.ratio or fos.factor"
)
DEFAULTS = ("time", "displacement = max block.DISPLACEMENT", "force = max contact.KCFN", "ratio = RATIO")
OF_SAFETY = "factor of safety = fos.factor"  # of a deck with FOS, after the DEFAULTS


def read_quantities(texts: Iterable[str]) -> dict[str, Quantity]:
    """The quantities in `texts`, by their names. ValueError, with a caret, for a wrong one."""
    found: dict[str, Quantity] = {}
    for text in texts:
        given = NAMED.match(text)
        name = given[1] if given else text.strip()
        if name in found:
            raise ValueError(f"two quantities are called {name}: name one of them, as in NAME = time")
        found[name] = _quantity(text, given.end() if given else 0)
    return found


def read_rule(text: str) -> Rule:
    """The rule in `text`. ValueError, with a caret, for a wrong one."""
    found = RULE.fullmatch(text)
    if found is None:
        raise Wrong(text, len(text), "a rule ends with a comparison and a number, as in max block.KXD > 1")
    return Rule(text.strip(), _quantity(found[1], 0), found[2], _number(found, 3))


def _quantity(text: str, start: int) -> Quantity:
    """The quantity that `text` is from the column `start` on."""
    start += len(text[start:]) - len(text[start:].lstrip())
    for form, read in FORMS.items():
        if found := form.fullmatch(text, start):
            return read(found)
    return _of_model(text, start)


def _at_place(found: re.Match[str]) -> Quantity:
    """A field, or a displacement, of the group at a place."""
    kind = _kind(found, 1)
    place = kind, _number(found, 2), _number(found, 3)
    field = _field(found, 4, kind)

    def value(state: State) -> float:
        at = np.array([state.start.group(state.array, place)])
        return float(state.column(kind, field, at)[0])

    return Quantity(value, place)


def _over_groups(found: re.Match[str]) -> Quantity:
    """The maximum, minimum, mean or sum of a field over groups of a kind."""
    how, kind = _one_of(found, 1, OVER), _kind(found, 2)
    field, where = _field(found, 3, kind), _where(found, 4, kind)

    def value(state: State) -> float:
        numbers = state.column(kind, field, state.groups(kind, where))
        numbers = numbers[~np.isnan(numbers)] if field in DISPLACEMENTS else numbers
        if not len(numbers) and how != "sum":
            raise NoValue(f"there is no such {kind}")
        return float(OVER[how](numbers))

    return Quantity(value)


def _count(found: re.Match[str]) -> Quantity:
    """The number of groups of a kind."""
    kind = _kind(found, 1)
    where = _where(found, 2, kind)
    return Quantity(lambda state: float(len(state.groups(kind, where))))


def _of_history(found: re.Match[str]) -> Quantity:
    """The last, greatest, least or mean number that a history has recorded; histories count from 1."""
    number = int(_number(found, 2))
    if number < 1:
        raise _wrong(found, 2, "histories count from 1")
    how = _one_of(found, 1, OF_SERIES)

    def value(state: State) -> float:
        if number > len(state.series):
            raise NoValue(f"there is no history {number}")
        numbers = state.series[number - 1].numbers[:, 2]
        if not len(numbers):
            raise NoValue(f"history {number} has recorded nothing")
        return float(OF_SERIES[how](numbers))

    return Quantity(value)


def _of_energy(found: re.Match[str]) -> Quantity:
    """A line of the energy account. Its value raises UdecError if there is no account."""
    name = _one_of(found, 1, ENERGIES)
    return Quantity(lambda state: float(getattr(balance(state.array.h), name)))


def _of_joints(found: re.Match[str]) -> Quantity:
    """The greatest slip or opening of a joint, or the number of contacts with a broken one."""
    name = _one_of(found, 1, OF_JOINTS)
    return Quantity(lambda state: float(OF_JOINTS[name](joint_rows(state.array.h))))


def _of_safety(found: re.Match[str]) -> Quantity:
    """The result of the last FOS: its factor, and the greatest stable and the least failing one."""
    name = _one_of(found, 1, SAFETY)

    def value(state: State) -> float:
        if not state.safety:
            raise NoValue("there was no FOS")
        return state.safety[-1][SAFETY.index(name)]

    return Quantity(value)


def _of_solve(found: re.Match[str]) -> Quantity:
    """How the last SOLVE has ended."""
    name = _one_of(found, 1, SOLUTION)

    def value(state: State) -> float:
        if not state.solutions:
            raise NoValue("there was no SOLVE")
        result = getattr(state.solutions[-1], name)
        return float(len(result) if name == "fallen" else result)

    return Quantity(value)


FORMS: dict[re.Pattern[str], Callable[[re.Match[str]], Quantity]] = {
    re.compile(rf"(\w+)\s*\(\s*({NUMBER})\s*,\s*({NUMBER})\s*\)\s*\.\s*{FIELD}\s*"): _at_place,
    re.compile(r"(\w+)\s+history\s+(\d+)\s*"): _of_history,
    re.compile(r"count\s+(\w+)\s*(?:(\w+)(\s.*)?)?", re.DOTALL): _count,
    re.compile(rf"(\w+)\s+(\w+)\s*\.\s*{FIELD}\s*(?:(\w+)(\s.*)?)?", re.DOTALL): _over_groups,
    re.compile(r"energy\s*\.\s*(\w+)\s*"): _of_energy,
    re.compile(r"joints\s*\.\s*(\w+)\s*"): _of_joints,
    re.compile(r"solve\s*\.\s*(\w+)\s*"): _of_solve,
    re.compile(r"fos\s*\.\s*(\w+)\s*"): _of_safety,
}


def _of_model(text: str, start: int) -> Quantity:
    """The variable of the common block, or quantity of the whole model, that `text` names."""
    typed = text[start:].strip().upper()
    what = recordable().get(OTHER_NAMES.get(typed, typed))
    if what is None:
        raise Wrong(text, start, f"this is not a quantity: {_suggestion(typed, recordable()) or EXAMPLES}")
    if what.group:
        advice = f"write {what.group}(x, y).{typed}, or max {what.group}.{typed}"
        raise Wrong(text, start, f"{typed} of which {what.group}? {advice}")

    def value(state: State) -> float:
        h = state.array.h
        if what.kind == g.WHOLE_MODEL:
            return measured(h, what.number)
        return float(variable(h, what.field)[0])

    return Quantity(value)


# ---- the parts of a text


def _wrong(found: re.Match[str], part: int, reason: str) -> Wrong:
    return Wrong(found.string, found.start(part), reason)


def _number(found: re.Match[str], part: int) -> float:
    value = float(found[part])
    if not math.isfinite(value):
        raise _wrong(found, part, "this is too large a number")
    return value


def _kind(found: re.Match[str], part: int) -> str:
    """The kind of group that is written there, in singular or plural."""
    return kind_named(found[part]) or _one_of(found, part, KINDS)


def _field(found: re.Match[str], part: int, kind: str) -> str:
    known = [word.name for word in _empty().shapes[kind]] + [*(DISPLACEMENTS if kind in PLACES else ())]
    return _one_of(found, part, known, f"a {kind} has no field {found[part]}")


def _one_of(found: re.Match[str], part: int, known: Iterable[str], what: str = "this is unknown") -> str:
    """The one of `known` that is written there, in upper or lower case."""
    names = {name.upper(): name for name in known}
    typed = found[part].upper()
    if typed not in names:
        advice = _suggestion(typed, names) or f"there are {', '.join(names.values())}"
        raise _wrong(found, part, f"{what}: {advice}")
    return names[typed]


def _where(found: re.Match[str], part: int, kind: str) -> str:
    """The condition behind `where`, tried on a model without groups; "" if there is none."""
    if found[part] is None:
        return ""
    if found[part] != "where":
        raise _wrong(found, part, "the text after it must begin with: where")
    condition, begin = found[part + 1] or "", f"{kind} where"
    try:
        satisfying(_empty(), begin + condition)
    except Wrong as wrong:
        column = wrong.column - len(begin) + found.end(part)
        raise Wrong(found.string, column, str(wrong).partition("\n")[0]) from None
    return condition.strip()


def _empty() -> Atlas:
    """A model without groups, which knows all fields."""
    return Atlas(MainArray(scheme(DEFAULT_SCHEME)).h)


def _suggestion(typed: str, known: Iterable[str]) -> str:
    """`did you mean`, if one of `known`, in upper case, is nearly what was typed."""
    near = get_close_matches(typed, known, 1)
    return f"did you mean {near[0]}?" if near else ""
