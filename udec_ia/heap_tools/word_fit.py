"""Whether numbers fit in words of another width, and what becomes of reals that have fewer bits there."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap_tools.written_state import Rows
from udec_ia.layout.table import Field


class Misfit(NamedTuple):
    """A number that a scheme cannot hold: the kind and address of its group, its field, and what it is."""

    kind: str
    address: int
    field: str
    value: int | float

    def __str__(self) -> str:
        return f"{self.field} of {self.kind}@{self.address}" if self.kind else self.field


class Fit:
    """What has become of all numbers so far.

    misfits: how many do not fit; first: the first of them, None if all do. reals: how many were written that
    are as wide as the scheme says. rounded: how many of them are not what they were, vanished: how many of
    these are 0 now. change: the largest relative change of the others; where: the field that has it, "" if
    there is none.
    """

    def __init__(self) -> None:
        self.misfits = 0
        self.first: Misfit | None = None
        self.reals = self.rounded = self.vanished = 0
        self.change, self.where = 0.0, ""

    def take(self, rows: Rows, field: Field, held: Any, to: Any) -> Any:
        """The numbers `held` by a field of `rows`, as the type `to` can hold them."""
        if field.type == "real":
            self.reals += held.size
        if np.dtype(to).itemsize >= held.dtype.itemsize:
            return held
        if not field.real:
            limits = np.iinfo(to)
            self._note((held < limits.min) | (held > limits.max), rows, field, held)
            return held.astype(to)
        with np.errstate(over="ignore", under="ignore"):
            narrow = held.astype(to)
        back = narrow.astype(held.dtype)
        lost = back != held
        if not lost.any():
            return narrow
        lost &= ~np.isnan(held)
        self._note(lost & np.isinf(back), rows, field, held)
        was, now = held[lost], back[lost]
        self.rounded += len(was)
        self.vanished += int(np.count_nonzero(now == 0))
        change = np.where((now != 0) & np.isfinite(now), np.abs((now - was) / was), 0.0)
        if change.max(initial=0.0) > self.change:
            place = np.flatnonzero(lost)[np.argmax(change)]
            self.change, self.where = float(change.max()), _name(rows, field, int(place))
        return narrow

    def _note(self, bad: Any, rows: Rows, field: Field, held: Any) -> None:
        """Numbers that do not fit."""
        if bad.any() and not self.misfits:
            place = int(np.argmax(bad))
            row, element = divmod(place, field.count)
            address = int(rows.at[row]) if rows.kind else 0
            self.first = Misfit(rows.kind, address, _element(field, element), held.flat[place].item())
        self.misfits += int(np.count_nonzero(bad))


def _name(rows: Rows, field: Field, place: int) -> str:
    """An element of a field, by its place among those of all rows."""
    row, element = divmod(place, field.count)
    return rows.called(_element(field, element), row)


def _element(field: Field, element: int) -> str:
    """PAR1(3), or KXD of a field that is one number."""
    return field.name + (f"({element + 1})" if field.count > 1 else "")
