"""Quantities: what somebody wants to know of a state of a run, each of them one number.

Each class is one form; reading.py tells how it is written.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.kernels.drive.history_recording import measured
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.energy_account import balance
from udec_ia.reader.conditions import satisfying
from udec_ia.reader.recordable_numbers import Recordable
from udec_ia.study.observed import NoValue, Place, State

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
