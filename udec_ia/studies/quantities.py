"""Quantities: what a study asks of a state of a run, each of them one number; and rules to stop at.

    time, cycles, KINETIC, WFRIC              of the whole model: what HISTORY can record without a place
    block(5, 5).KY, contact(2, 1).KCFN        a field of the group at a place (quantities.py)
    block(5, 5).DISPLACEMENT                  since the first cycle; XDISPLACEMENT, YDISPLACEMENT
    max contact.KCFN where KCM == 2           or min, mean, sum, with a condition or without (condition.py)
    count block where KXD > 0.1
    last history 1                            or max, min, mean
    energy.friction                           a line of the account of the energy
    solve.reached, solve.ratio, solve.cycles, solve.motion, solve.fallen      of the last SOLVE

NAME = QUANTITY gives it a name of its own. A rule is a quantity, a comparison and a number.

A block, corner, grid-point or zone at a place is the one that is nearest to it when the first cycle begins
(before that, now). It is followed from there by its address as long as it exists. Contacts, domains and
other groups come and go in a run: for these it is the one that is nearest now.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.kernels.drive.history_recording import measured
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.energy_account import Balance, balance
from udec_ia.reader.group_conditions import Wrong, satisfying
from udec_ia.reader.group_positions import select_groups
from udec_ia.reader.group_tables import addresses
from udec_ia.reader.recordable_numbers import Recordable, recordable
from udec_ia.reader.word_map import KINDS, Atlas, Word
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
        self._first = {kind: (atlas.groups[kind], positions(atlas, kind)) for kind in PLACES}

    def look(self, array: MainArray) -> None:
        """A command was obeyed: drop deleted groups, before their addresses belong to others."""
        if self._array is None:
            return
        there = {kind: addresses(array, kind) for kind in FOLLOWED}
        for place, group in self._groups.items():
            if isinstance(group, int) and group not in there[place[0]]:
                self._groups[place] = f"the {place[0]} that was nearest has gone"
        for kind, (at, where) in self._first.items():
            stays = np.isin(at, there[kind])
            self._first[kind] = at[stays], where[stays]

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
        where = np.searchsorted(addresses, at)
        known = np.isin(at, addresses)
        moved = np.full((len(at), 2), np.nan)
        moved[known] = positions(atlas, kind)[np.searchsorted(atlas.groups[kind], at)][known]
        moved[known] -= first[where[known]]
        return moved


class State:
    """A state of a run, with what has been recorded until now."""

    def __init__(
        self, array: MainArray, start: InitialState, series: list[Series], solutions: list[Solution]
    ) -> None:
        self.array, self.start, self.series, self.solutions = array, start, series, solutions

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
        word: Word = next(one for one in self.atlas.shapes[kind] if one.name == name)
        return self.atlas.gather(word, at).astype(np.float64)


def positions(atlas: Atlas, kind: str) -> Any:
    """Where the groups of a kind are, in the order of the atlas, (n, 2)."""
    words = {word.name: word for word in atlas.shapes[kind]}
    columns = [atlas.gather(words[name], atlas.groups[kind]) for name in PLACES[kind]]
    return np.column_stack(columns).astype(np.float64)


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
    """One number of a state. value: gives it, or raises NoValue with the reason why there is none.

    place: of the group that has to be found when the first cycle begins, if there is one.
    """

    value: Callable[[State], float]
    place: Place | None = None


def of_model(what: Recordable) -> Quantity:
    """A variable of the common block, or a quantity of the whole model."""

    def value(state: State) -> float:
        h = state.array.h
        if what.kind == g.WHOLE_MODEL:
            return measured(h, what.number)
        part = {"double": h.cd, "real": h.cr, "int": h.ci}[what.field.type]
        return float(part[getattr(g, what.field.name)])

    return Quantity(value)


def at_place(kind: str, x: float, y: float, field: str) -> Quantity:
    """A field, or a displacement, of the group at a place."""
    place = kind, x, y

    def value(state: State) -> float:
        at = np.array([state.start.group(state.array, place)])
        return float(state.column(kind, field, at)[0])

    return Quantity(value, place)


def over_groups(how: str, kind: str, field: str, where: str) -> Quantity:
    """The maximum, minimum, mean or sum of a field over groups of a kind. where: condition, "" for all."""

    def value(state: State) -> float:
        found = state.column(kind, field, state.groups(kind, where))
        found = found[~np.isnan(found)] if field in DISPLACEMENTS else found
        if not len(found) and how != "sum":
            raise NoValue(f"there is no such {kind}")
        return float(OVER[how](found))

    return Quantity(value)


def count(kind: str, where: str) -> Quantity:
    """The number of groups of a kind. where: condition, "" for all."""
    return Quantity(lambda state: float(len(state.groups(kind, where))))


def of_history(how: str, number: int) -> Quantity:
    """The last, greatest, least or mean number that a history has recorded. number: of it, from 1."""

    def value(state: State) -> float:
        if number > len(state.series):
            raise NoValue(f"there is no history {number}")
        numbers = state.series[number - 1].numbers[:, 2]
        if not len(numbers):
            raise NoValue(f"history {number} has recorded nothing")
        return float(OF_SERIES[how](numbers))

    return Quantity(value)


def of_energy(name: str) -> Quantity:
    """A line of the energy account."""

    def value(state: State) -> float:
        try:
            return float(getattr(balance(state.array.h), name))
        except UdecError as error:
            raise NoValue(f"{error.detail}: {error.advice}") from error

    return Quantity(value)


def of_solve(name: str) -> Quantity:
    """How the last SOLVE has ended."""

    def value(state: State) -> float:
        if not state.solutions:
            raise NoValue("there was no SOLVE")
        found = getattr(state.solutions[-1], name)
        return float(len(found) if name == "fallen" else found)

    return Quantity(value)


# ---- how they are written

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
FIELD = r"([A-Za-z]\w*(?:\(\d+\))?)"
NAMED = re.compile(r"\s*([A-Za-z][\w ./-]*?)\s*=(?!=)\s*(?=\S)")
AT_PLACE = re.compile(rf"(\w+)\s*\(\s*({NUMBER})\s*,\s*({NUMBER})\s*\)\s*\.\s*{FIELD}\s*")
OVER_ALL = re.compile(rf"(\w+)\s+(\w+)\s*\.\s*{FIELD}\s*(?:(\w+)(\s.*)?)?", re.DOTALL)
COUNT = re.compile(r"count\s+(\w+)\s*(?:(\w+)(\s.*)?)?", re.DOTALL)
HISTORY = re.compile(r"(\w+)\s+history\s+(\d+)\s*")
OF = re.compile(r"(energy|solve)\s*\.\s*(\w+)\s*")
RULE = re.compile(rf"(.*\S)\s*(<=|>=|==|!=|<|>)\s*({NUMBER})\s*", re.DOTALL)
COMPARISONS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
OTHER_NAMES = {"time": "TIME", "cycles": "MCTOT"}
SOLUTION = ("reached", "ratio", "cycles", "motion", "fallen")
ENERGIES = (*Balance._fields, "strain", "residual", "throughput")
FORMS = (
    "write time, block(5, 5).KY, max contact.KCFN where ..., count block where ..., last history 1, "
    "energy.friction or solve.ratio"
)
DEFAULTS = (
    "time",
    "displacement = max block.DISPLACEMENT",
    "force = max contact.KCFN",
    "ratio = RATIO",
)


class Named(NamedTuple):
    """A quantity and the name of its column."""

    name: str
    quantity: Quantity


class Rule(NamedTuple):
    """A rule to stop at. text: as it was written."""

    text: str
    quantity: Quantity
    comparison: str
    number: float

    def holds(self, state: State) -> bool:
        """True if a run is to stop in this state. Raises NoValue."""
        return COMPARISONS[self.comparison](self.quantity.value(state), self.number)


def read_quantities(texts: Iterable[str]) -> list[Named]:
    """The quantities in `texts`, with their names. ValueError, with a caret, for a wrong one."""
    found: list[Named] = []
    for text in texts:
        given = NAMED.match(text)
        one = Named(given[1] if given else text.strip(), _quantity(text, given.end() if given else 0))
        if one.name in (other.name for other in found):
            raise ValueError(
                f"two quantities are called {one.name}: give one of them a name, as in NAME = time"
            )
        found.append(one)
    return found


def read_rule(text: str) -> Rule:
    """The rule in `text`. ValueError, with a caret, for a wrong one."""
    found = RULE.fullmatch(text)
    if found is None:
        raise Wrong(text, len(text), "a rule ends with a comparison and a number, as in max block.KXD > 1")
    return Rule(text.strip(), _quantity(found[1], 0), found[2], _number(text, found, 3))


def _quantity(text: str, start: int) -> Quantity:
    """The quantity that `text` is from the column `start` on."""
    start += len(text[start:]) - len(text[start:].lstrip())
    if found := AT_PLACE.fullmatch(text, start):
        kind = _kind(text, found, 1)
        x, y = (_number(text, found, part) for part in (2, 3))
        return at_place(kind, x, y, _field(text, found, 4, kind))
    if found := HISTORY.fullmatch(text, start):
        number = int(_number(text, found, 2))
        if number < 1:
            raise Wrong(text, found.start(2), "histories count from 1")
        return of_history(_one_of(text, found, 1, OF_SERIES), number)
    if found := COUNT.fullmatch(text, start):
        kind = _kind(text, found, 1)
        return count(kind, _where(text, found, 2, kind))
    if found := OVER_ALL.fullmatch(text, start):
        how, kind = _one_of(text, found, 1, OVER), _kind(text, found, 2)
        return over_groups(how, kind, _field(text, found, 3, kind), _where(text, found, 4, kind))
    if found := OF.fullmatch(text, start):
        if found[1] == "energy":
            return of_energy(_one_of(text, found, 2, ENERGIES))
        return of_solve(_one_of(text, found, 2, SOLUTION))
    return _of_model(text, start)


def _number(text: str, found: re.Match[str], part: int) -> float:
    value = float(found[part])
    if not math.isfinite(value):
        raise Wrong(text, found.start(part), "this is too large a number")
    return value


def _of_model(text: str, start: int) -> Quantity:
    """The variable or quantity of the whole model that `text` names."""
    typed = text[start:].strip()
    what = recordable().get(OTHER_NAMES.get(typed.lower(), typed.upper()))
    if what is None:
        known = [*OTHER_NAMES, *(name for name, one in recordable().items() if not one.group)]
        raise Wrong(text, start, f"this is not a quantity: {_suggestion(typed, known) or FORMS}")
    if what.group:
        name = what.field.name
        advice = f"write {what.group}(x, y).{name}, or max {what.group}.{name}"
        raise Wrong(text, start, f"{name} of which {what.group}? {advice}")
    return of_model(what)


def _kind(text: str, found: re.Match[str], part: int) -> str:
    return _one_of(text, found, part, KINDS, "no kind of group is called so")


def _field(text: str, found: re.Match[str], part: int, kind: str) -> str:
    known = [word.name for word in _empty().shapes[kind]] + [*(DISPLACEMENTS if kind in PLACES else ())]
    return _one_of(text, found, part, known, f"a {kind} has no field {found[part]}")


def _one_of(
    text: str, found: re.Match[str], part: int, known: Iterable[str], what: str = "this is not known here"
) -> str:
    """The one of `known` that is written there, in upper or lower case."""
    names = {name.upper(): name for name in known}
    typed = found[part].upper()
    if typed not in names:
        advice = _suggestion(typed, names.values()) or f"there are {', '.join(names.values())}"
        raise Wrong(text, found.start(part), f"{what}: {advice}")
    return names[typed]


def _where(text: str, found: re.Match[str], part: int, kind: str) -> str:
    """The condition behind `where`, tried on a model without groups; "" if there is none."""
    if found[part] is None:
        return ""
    if found[part] != "where":
        raise Wrong(text, found.start(part), "the text after it must begin with: where")
    condition, begin = found[part + 1] or "", f"{kind} where"
    try:
        satisfying(_empty(), begin + condition)
    except Wrong as wrong:
        raise Wrong(
            text, wrong.column - len(begin) + found.end(part), str(wrong).partition("\n")[0]
        ) from None
    return condition.strip()


def _empty() -> Atlas:
    """A model without groups, which knows all fields."""
    return Atlas(MainArray(scheme(DEFAULT_SCHEME)).h)


def _suggestion(typed: str, known: Iterable[str]) -> str:
    """`did you mean`, if one of `known` is nearly what was typed."""
    by_case = {name.upper(): name for name in known}
    near = get_close_matches(typed.upper(), by_case, 1)
    return f"did you mean {by_case[near[0]]}?" if near else ""
