"""Quantities: what a study asks of a state of a run, each of them one number.

A block, corner, grid-point or zone at a place is the one that is nearest to it when the first cycle begins
(before that, now). It is followed from there by its address as long as it exists. Contacts, domains and
other groups come and go in a run: for these it is the one that is nearest now. Each class is one form of
quantity; quantity_syntax.py describes how it is written.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.history_recording import measured
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.energy_account import balance
from udec_ia.reader.atlas import Atlas, Word
from udec_ia.reader.conditions import satisfying
from udec_ia.reader.group_positions import select_groups
from udec_ia.reader.group_tables import addresses
from udec_ia.reader.recordable_numbers import Recordable
from udec_ia.running.history_series import Series
from udec_ia.running.solve_result import Solution

FOLLOWED = ("block", "corner", "gridpoint", "zone")
PLACES = {"block": ("KX", "KY"), "gridpoint": ("KXG", "KYG")}  # of what has a displacement
Place = tuple[str, float, float]  # kind of group, x, y


class NoValue(ValueError):
    """A quantity has no value in a state, and why."""


class InitialState:
    """What was where at first. places: what will be asked for."""

    def __init__(self, places: frozenset[Place]) -> None:
        self._places = places
        self._array: MainArray | None = None
        self._groups: dict[Place, int | str] = {}  # address, or why there is none
        self._first: dict[str, tuple[Any, Any]] = {}  # kind: addresses (n,), places (n, 2)

    def begin(self, array: MainArray) -> None:
        """A run of cycles begins: note what is where, unless there have been cycles before."""
        if self._array is not None and array.h.ci[g.MCTOT] > 0:
            return
        self._array = array
        self._groups = {place: _nearest(array, place) for place in self._places if place[0] in FOLLOWED}
        atlas = Atlas(array.h)
        self._first = {kind: (atlas.groups[kind], positions(atlas, kind)) for kind in PLACES}

    def look(self, array: MainArray) -> None:
        """A command was obeyed: forget what is not there any more, before its address has a new owner."""
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
        """What the words are."""
        return Atlas(self.array.h)

    def column(self, kind: str, name: str, at: Any) -> Any:
        """The field `name` of the groups at `at`, as 64-bit reals (n,)."""
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


class Quantity:
    """One number of a state."""

    @property
    def place(self) -> Place | None:
        """Of the group that it has to find when the first cycle begins, if there is one."""
        return None

    def value(self, state: State) -> float:
        """The number. Raises NoValue with the reason if there is none."""
        raise NotImplementedError


@dataclass(frozen=True)
class OfModel(Quantity):
    """A variable of the common block, or a quantity of the whole model."""

    what: Recordable

    def value(self, state: State) -> float:
        """See Quantity."""
        h, what = state.array.h, self.what
        if what.kind == g.WHOLE_MODEL:
            return measured(h, what.number)
        index = getattr(g, what.field.name)
        part = {"double": h.cd, "real": h.cr, "int": h.ci}[what.field.type]
        return float(part[index])


@dataclass(frozen=True)
class AtPlace(Quantity):
    """A field, or a displacement, of the group at a place."""

    kind: str
    x: float
    y: float
    field: str

    @property
    def place(self) -> Place:
        """See Quantity."""
        return self.kind, self.x, self.y

    def value(self, state: State) -> float:
        """See Quantity."""
        at = np.array([state.start.group(state.array, self.place)])
        return float(_column(state, self.kind, self.field, at)[0])


@dataclass(frozen=True)
class Over(Quantity):
    """The maximum, minimum, mean or sum of a field over the groups of a kind, or of those `where` says."""

    how: str
    kind: str
    field: str
    where: str

    def value(self, state: State) -> float:
        """See Quantity."""
        found = _column(state, self.kind, self.field, _groups(state, self.kind, self.where))
        found = found[~np.isnan(found)] if self.field in DISPLACEMENTS else found
        if not len(found) and self.how != "sum":
            raise NoValue(f"there is no such {self.kind}")
        return float(OVER[self.how](found))


@dataclass(frozen=True)
class Count(Quantity):
    """How many groups of a kind there are, or that `where` says."""

    kind: str
    where: str

    def value(self, state: State) -> float:
        """See Quantity."""
        return float(len(_groups(state, self.kind, self.where)))


@dataclass(frozen=True)
class OfHistory(Quantity):
    """The last, greatest, least or mean number that a history has recorded. number: of it, from 1."""

    how: str
    number: int

    def value(self, state: State) -> float:
        """See Quantity."""
        if self.number > len(state.series):
            raise NoValue(f"there is no history {self.number}")
        numbers = state.series[self.number - 1].numbers[:, 2]
        if not len(numbers):
            raise NoValue(f"history {self.number} has recorded nothing")
        return float(OF_SERIES[self.how](numbers))


@dataclass(frozen=True)
class OfEnergy(Quantity):
    """A line of the account of the energy."""

    name: str

    def value(self, state: State) -> float:
        """See Quantity."""
        try:
            return float(getattr(balance(state.array.h), self.name))
        except UdecError as error:
            raise NoValue(f"{error.detail}: {error.advice}") from error


@dataclass(frozen=True)
class OfSolve(Quantity):
    """How the last SOLVE has ended."""

    name: str

    def value(self, state: State) -> float:
        """See Quantity."""
        if not state.solutions:
            raise NoValue("there was no SOLVE")
        found = getattr(state.solutions[-1], self.name)
        return float(len(found) if self.name == "fallen" else found)


def _groups(state: State, kind: str, where: str) -> Any:
    """Addresses of the groups of a kind, ascending."""
    return satisfying(state.atlas, f"{kind} where {where}").at if where else state.atlas.groups[kind]


def _column(state: State, kind: str, field: str, at: Any) -> Any:
    """A field or displacement of groups (n,)."""
    if field in DISPLACEMENTS:
        return DISPLACEMENTS[field](state.start.displacements(state.atlas, kind, at))
    return state.column(kind, field, at)
