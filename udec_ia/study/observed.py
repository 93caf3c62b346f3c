"""What a study knows of a run: its state now, and where things were when the first cycle began.

A block, a corner, a grid-point or a zone that is meant by a place is the one that is nearest to it when the
first cycle begins (before it, now). It is followed from there, by its address, as long as it is there. What
comes and goes in a run, as contacts and domains do, is the one that is nearest now.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.atlas import Atlas, Word
from udec_ia.reader.group_positions import choose
from udec_ia.reader.group_tables import addresses
from udec_ia.running.history_series import Series
from udec_ia.running.solve_result import Solution

FOLLOWED = ("block", "corner", "gridpoint", "zone")
PLACES = {"block": ("KX", "KY"), "gridpoint": ("KXG", "KYG")}  # of what has a displacement
Place = tuple[str, float, float]  # kind of group, x, y


class NoValue(ValueError):
    """A quantity has no value in a state, and why."""


class Start:
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
        self, array: MainArray, start: Start, series: list[Series], solutions: list[Solution]
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
        return choose(array, kind, "", None, [(x, y)])[0].address
    except UdecError as error:
        return error.detail
