"""A state in the words of another scheme: every number in its field, every pointer to the group it meant.

Sizes and offsets of groups differ with the number of integers in the space of a real, so each group is
written anew, field by field by the table, and all addresses follow. Groups keep their order in memory. The
junk list is empty afterwards: a junk group has a size and no kind, and two kinds that are of one size in a
scheme are not in another, so nobody could say how large it has to be. Where FIND takes its words from changes
no result.

IA() keeps its number of words, unless the groups need more or the addresses end before. The tolerances are
those that reals of the new width make of the rounding length, as RESTART asks for.

What does not fit is refused, and reals that lose digits are counted. Nothing else happens to a number: into
wider words and back again is the same state, word for word if there was no junk.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.array import MainArray, variable
from udec_ia.heap.words import Scheme
from udec_ia.inspect.change.movable import movable, name_at
from udec_ia.kernels.geometry.tolerances import tolset
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field, layouts, read_table

TABLE = read_table()

PIECE = 16384  # groups that are written together: they fit in the machine's caches


class Rewritten(NamedTuple):
    """A state in other words, and what that has cost.

    reals: how many there are in groups and the common block. rounded: how many of them are not what they
    were, vanished: how many of these are 0 now. change: the largest relative change of the others; where: the
    field that has it, "" if there is none.
    """

    array: MainArray
    reals: int
    rounded: int
    vanished: int
    change: float
    where: str


def rewrite(array: MainArray, to: Scheme) -> Rewritten:
    """The state of `array`, which stays as it is, in the words of the scheme `to`.

    Raises Unsound if there are groups that cannot be told apart (movable.py), UdecError 1 if the addresses
    of `to` end before the groups do, and 28 if its integers or reals cannot hold all numbers.
    """
    found = movable(array)
    start, used = _places(found, to)
    fresh = _empty(array, to, used)
    wide = np.int32 if used < 2**31 else np.int64
    moved = _Moved(np.zeros(int(array.h.ci[g.MFREE]) // array.scheme.ratio + 2, wide), array.scheme.ratio)
    for kind, at in found.items():
        moved.to[moved.places(at)] = start[kind]
    fit = _Fit(array, to)
    for kind, at in found.items():
        for first in range(0, len(at), PIECE):
            piece = slice(first, first + PIECE)
            _write(array, fresh, kind, at[piece], start[kind][piece], moved, fit)
    _write_common(array, fresh, moved, used, fit)
    fit.require()
    if to.real_bits != array.scheme.real_bits:
        tolset(fresh.h, fresh.h.cr[g.DTOL])
    return Rewritten(fresh, fit.reals, fit.rounded, fit.vanished, fit.change, fit.where)


class _Moved(NamedTuple):
    """Where groups have moved. to: the new address of each, by its place; groups begin on reals."""

    to: Any
    ratio: int

    def places(self, addresses: Any) -> Any:
        """Where the addresses of groups stand in `to`; 0 of 0."""
        return (addresses.astype(np.int64) + (self.ratio - 1)) // self.ratio

    def of(self, addresses: Any) -> Any:
        """The new addresses of groups at `addresses`; 0 of 0."""
        return self.to[self.places(addresses)]


def _places(found: dict[str, Any], to: Scheme) -> tuple[dict[str, Any], int]:
    """New addresses of the groups at the addresses `found`, in the same order, and the words they take."""
    layout = layouts(to.ratio)
    at = np.concatenate([*found.values()])
    size = np.repeat([layout[kind].size for kind in found], [len(one) for one in found.values()])
    order = np.argsort(at)
    ends = np.cumsum(size[order])
    start = np.empty_like(at)
    start[order] = 1 + ends - size[order]
    bounds = np.cumsum([len(one) for one in found.values()])[:-1]
    return dict(zip(found, np.split(start, bounds), strict=True)), int(size.sum())


def _empty(array: MainArray, to: Scheme, used: int) -> MainArray:
    """An array of the scheme `to` with room for `used` words. Error 1 if its addresses end before."""
    top = to.top_address // to.ratio * to.ratio
    if used > top:
        detail = f"the groups take {used} words of {to.name}, whose last address is {to.top_address}"
        raise UdecError(1, detail, "take wider integers")
    size = min(max(int(array.h.ci[g.MTOP]), used, to.ratio), top)
    fresh = MainArray(to, -(-size // to.ratio) * to.ratio)
    fresh.fixed = array.fixed
    return fresh


def _write(
    array: MainArray, fresh: MainArray, kind: str, at: Any, start: Any, moved: _Moved, fit: _Fit
) -> None:
    """The groups of a kind, from the addresses `at` of `array` to the addresses `start` of `fresh`."""
    old, new = (layouts(one.scheme.ratio)[kind] for one in (array, fresh))
    rows = array.h.ia[(at - 1)[:, np.newaxis] + np.arange(old.size)]  # a row each
    fresh_rows = np.zeros((len(at), new.size), fresh.scheme.int_type)
    reals, fresh_reals = rows.view(array.scheme.real_type), fresh_rows.view(fresh.scheme.real_type)
    for field in TABLE.group(kind).fields:
        here, there = old.offset[field.name] - field.real, new.offset[field.name] - field.real
        values = (reals if field.real else rows)[:, here : here + field.count]
        if field.target is not None:
            values = moved.of(values)
        target = fresh_reals if field.real else fresh_rows
        target[:, there : there + field.count] = fit.take(kind, at, field, values)
    fresh.h.ia[(start - 1)[:, np.newaxis] + np.arange(new.size)] = fresh_rows


def _write_common(array: MainArray, fresh: MainArray, moved: _Moved, used: int, fit: _Fit) -> None:
    """The common block, with the addresses in it, and the memory as it is now."""
    size = int(fresh.h.ci[g.MTOP])
    for field in TABLE.common:
        values = variable(array.h, field)
        if field.target is not None:
            values = moved.of(values)
        variable(fresh.h, field)[:] = fit.take("", None, field, values) if field.type == "real" else values
    fresh.h.ci[g.JUNK], fresh.h.ci[g.MTOP], fresh.h.ci[g.MFREE] = 0, size, used + 1


class _Fit:
    """Whether numbers fit in words of the scheme `to`, and what becomes of reals that it rounds.

    misfits: how many do not; first: kind and address of the group of the first of them, field, value.
    """

    def __init__(self, array: MainArray, to: Scheme) -> None:
        self.array, self.to = array, to
        self.shortens = to.int_bits < array.scheme.int_bits
        self.narrows = to.real_bits < array.scheme.real_bits
        self.misfits, self.first = 0, ("", 0, "", 0.0)
        self.reals = self.rounded = self.vanished = 0
        self.change, self.where = 0.0, ""

    def take(self, kind: str, at: Any, field: Field, values: Any) -> Any:
        """`values` of a field of the groups at `at`, a row each, as the scheme can hold them.

        kind: "" for a variable of the common block, whose elements stand in one row.
        """
        if not field.real:
            if self.shortens:
                limits = np.iinfo(self.to.int_type)
                self._note((values < limits.min) | (values > limits.max), kind, at, field, values)
            return values
        self.reals += values.size
        if not self.narrows:
            return values
        with np.errstate(over="ignore", under="ignore"):
            narrow = values.astype(self.to.real_type)
        back = narrow.astype(values.dtype)
        lost = (back != values) & ~np.isnan(values)
        self._note(lost & np.isinf(back), kind, at, field, values)
        self.rounded += int(np.count_nonzero(lost))
        self.vanished += int(np.count_nonzero(lost & (back == 0)))
        kept = lost & (back != 0) & np.isfinite(back)
        change = np.zeros_like(values)
        change[kept] = np.abs((back[kept] - values[kept]) / values[kept])
        if change.max(initial=0.0) > self.change:
            self.change, self.where = float(change.max()), _name(kind, at, field, int(np.argmax(change)))
        return narrow

    def _note(self, bad: Any, kind: str, at: Any, field: Field, values: Any) -> None:
        """Values that do not fit."""
        if bad.any():
            place = int(np.argmax(bad))
            if not self.misfits:
                address = int(at[place // field.count]) if kind else 0
                self.first = kind, address, _name("", at, field, place), values.flat[place].item()
            self.misfits += int(np.count_nonzero(bad))

    def require(self) -> None:
        """Error 28 if there are numbers that do not fit."""
        if not self.misfits:
            return
        kind, address, name, value = self.first
        what = f"{name} of {name_at(self.array, address)}" if kind else name
        if isinstance(value, int):
            limits = np.iinfo(self.to.int_type)
            holds = f"{self.to.int_bits}-bit integers hold {limits.min} to {limits.max}"
        else:
            largest = np.finfo(self.to.real_type).max
            holds = f"{self.to.real_bits}-bit reals hold numbers up to {largest:.2g}"
        more = f", the first of {self.misfits} numbers beyond these words" if self.misfits > 1 else ""
        raise UdecError(28, f"{what} is {value}{more}", f"{holds}: take wider words")


def _name(kind: str, at: Any, field: Field, place: int) -> str:
    """An element of a field, by its place among those of all groups of a kind, as the table calls it."""
    row, element = divmod(place, field.count)
    name = field.name + (f"({element + 1})" if field.count > 1 else "")
    return f"{name} of {kind}@{at[row]}" if kind else name
