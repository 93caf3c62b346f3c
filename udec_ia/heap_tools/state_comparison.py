"""What differs between two heaps: group by group and field by field, and the variables of the common block.

A pointer differs if it leads to another group. The variables that say how memory is used (MEMORY) are left
out. Reals are compared in the words of the narrower scheme: absolute, relative, and in last digits (ulp).
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import variable
from udec_ia.heap_tools.group_matching import Matching
from udec_ia.layout.field_table import Field
from udec_ia.reader.word_map import KINDS, TABLE, kind_named

RELATIVE, ULPS = "relative", "ulp"
UNITS = sorted({f.unit for part in (*(one.fields for one in TABLE.groups), TABLE.common) for f in part})


class Differences(NamedTuple):
    """Numbers that differ: which rows (n,), and how far; of numbers that are no reals, 0. ulps as reals."""

    rows: Any
    absolute: Any
    relative: Any
    ulps: Any


Tolerance = dict[str, float]  # greatest distance that does not count, by unit, RELATIVE or ULPS


def tolerance(texts: Iterable[str]) -> Tolerance:
    """Of texts such as m=1e-6, N/m=10, relative=1e-9, ulp=4. ValueError for anything else."""
    found: Tolerance = {}
    for text in texts:
        name, sign, number = text.partition("=")
        try:
            limit = float(number)
        except ValueError:
            limit = -inf
        if name not in (*UNITS, RELATIVE, ULPS) or not sign or not (isfinite(limit) and limit >= 0):
            known = ", ".join((RELATIVE, ULPS, *UNITS))
            raise ValueError(f"tolerance {text}: give NAME=NUMBER, such as m=1e-6, of {known}")
        found[name] = limit
    return found


def _counts(tolerance: Tolerance, unit: str, distances: Differences) -> Any:
    """True for each difference of reals that counts."""
    found = np.ones(len(distances.rows), bool)
    of_names = (unit, distances.absolute), (RELATIVE, distances.relative), (ULPS, distances.ulps)
    for name, distance in of_names:
        if limit := tolerance.get(name):
            found &= ~(distance <= limit)
    return found


def whole_differences(differ: Any) -> Differences:
    """Whole numbers or groups (n,), which differ or not."""
    rows = np.flatnonzero(differ)
    return Differences(rows, *(np.zeros(len(rows)),) * 3)


def real_differences(one: Any, two: Any) -> Differences:
    """Reals (n,) and (n,) of one width or two. NaN is NaN, and -0 is 0."""
    narrow = min(one.dtype, two.dtype, key=lambda kind: kind.itemsize)
    with np.errstate(all="ignore"):
        a, b = one.astype(narrow, copy=False), two.astype(narrow, copy=False)
        rows = np.flatnonzero((a != b) & ~((a != a) & (b != b)))
        x, y = one[rows].astype(np.float64), two[rows].astype(np.float64)
        absolute = np.abs(x - y)
        relative = absolute / np.maximum(np.abs(x), np.abs(y))
    return Differences(rows, absolute, relative, _ulps(a[rows], b[rows]))


def _ulps(one: Any, two: Any) -> Any:
    """How many reals of their width lie between two, as reals of 64 bits."""
    a, b = _order(one), _order(two)
    return (np.maximum(a, b) - np.minimum(a, b)).astype(np.float64)


def _order(values: Any) -> Any:
    """Whole numbers in the order of the reals, one for each; -0 and 0 are the same."""
    bits = values.view(f"u{values.itemsize}").astype(np.uint64)
    sign = np.uint64(1) << np.uint64(8 * values.itemsize - 1)
    return np.where(bits >= sign, sign - (bits - sign), sign + bits)


COMMON = "common"  # what the variables of the common block stand under
MEMORY = ("JUNK", "MFREE", "MTOP", "NWANT", "NSPARE")
PIECE = 16384  # pairs that are compared together: they fit in the machine's caches
ADDRESSES = ("IERAD",)  # variables that are pointers to any group


class Differing(NamedTuple):
    """A field of a kind of groups, or a variable of the common block, whose values differ.

    kind: COMMON for a variable. one, two: addresses (n,) of the groups, or numbers of the elements, from 0.
    values: in the one (n,) and in the other (n,). greatest: of all values, 0.0 of what are no reals.
    """

    kind: str
    field: Field
    element: int
    one: Any
    two: Any
    values: tuple[Any, Any]
    distances: Differences
    greatest: float
    many: int

    @property
    def name(self) -> str:
        """KXD, or KZG(2)."""
        several = self.field.count > 1 and self.kind != COMMON
        return self.field.name + (f"({self.element + 1})" if several else "")

    @property
    def share(self) -> Any:
        """Differences as shares of the greatest value (n,)."""
        with np.errstate(invalid="ignore"):
            return self.distances.absolute / self.greatest if self.greatest > 0 else self.distances.absolute


class Compared(NamedTuple):
    """matching: which group is which. fields: those that differ, in the order of the table.

    alone: by kind the addresses of the groups that only the one (n,) and only the other (m,) has.
    kinds: of groups that were compared, and COMMON if variables were.
    """

    matching: Matching
    fields: list[Differing]
    alone: dict[str, tuple[Any, Any]]
    kinds: set[str]

    @property
    def differ(self) -> bool:
        """True if anything does."""
        return bool(self.fields or any(len(one) + len(two) for one, two in self.alone.values()))


def compare(
    one: Memory, two: Memory, only: Iterable[str] = (), tolerance: Tolerance | None = None
) -> Compared:
    """Two heaps of any word schemes, sound or damaged.

    only: kinds of groups and fields, such as contact or contact.KCFN, or common.FRAC; all if there are none.
    ValueError for one that is not known.
    """
    wanted = selected_fields(only)
    matching = Matching(one, two)
    found = *_groups(matching, wanted, tolerance or {}), *_common(matching, wanted, tolerance or {})
    fields = [one for one in found if len(one.one)]
    alone = {kind: matching.left(kind) for kind in KINDS if not only or (kind, "") in wanted}
    return Compared(matching, fields, alone, {kind for kind, _ in wanted})


def selected_fields(only: Iterable[str]) -> set[tuple[str, str]]:
    """Kinds and fields of texts such as contact.KCFN; with all fields of a kind that is named alone."""
    fields = {kind: [one.name for one in TABLE.group(kind).fields] for kind in KINDS}
    fields[COMMON] = [one.name for one in TABLE.common]
    found: set[tuple[str, str]] = set()
    for text in only or fields:
        typed, dot, name = text.partition(".")
        kind = kind_named(typed) or typed
        if kind not in fields:
            raise ValueError(f"{text}: {kind} is not a kind of group: choose from {', '.join(fields)}")
        if dot and name.upper() not in fields[kind]:
            raise ValueError(f"{text}: {kind} has the fields {', '.join(fields[kind])}")
        found |= {(kind, name.upper())} if dot else {(kind, one) for one in ("", *fields[kind])}
    return found


def _groups(matching: Matching, wanted: set[tuple[str, str]], tolerance: Tolerance) -> Iterable[Differing]:
    one, two = matching.sides
    for kind, at in matching.pairs.items():
        if not len(at[0]):
            continue
        changed = _changed(matching, kind, at)
        for words in zip(one.atlas.shapes[kind], two.atlas.shapes[kind], strict=True):
            field = words[0].field
            alike = not changed[words[0].first : words[0].last + 1].any()
            if (kind, field.name) not in wanted or (alike and (matching.in_place or not field.target)):
                continue
            values = one.atlas.gather(words[0], at[0]), two.atlas.gather(words[1], at[1])
            yield _differing(matching, (kind, field, words[0].element), at, values, tolerance)


def _changed(matching: Matching, kind: str, at: Any) -> Any:
    """True for each word of a group that differs in any of the pairs at (n,) and (n,); all in two schemes."""
    one, two = matching.sides
    size = one.atlas.layout[kind].size
    if one.h.ia.dtype != two.h.ia.dtype or one.atlas.ratio != two.atlas.ratio:
        return np.ones(size, bool)
    found = np.zeros(size, bool)
    rows = [sliding_window_view(side.h.ia, size) for side in matching.sides]
    for first in range(0, len(at[0]), PIECE):
        a, b = (words[where[first : first + PIECE] - 1] for words, where in zip(rows, at, strict=True))
        found |= (a != b).any(axis=0)
    return found


def _common(matching: Matching, wanted: set[tuple[str, str]], tolerance: Tolerance) -> Iterable[Differing]:
    one, two = matching.sides
    for field in TABLE.common:
        if (COMMON, field.name) in wanted and field.name not in MEMORY:
            values = variable(one.h, field), variable(two.h, field)
            at = np.arange(field.count)
            yield _differing(matching, (COMMON, field, 0), (at, at), values, tolerance)


def _differing(
    matching: Matching, of: tuple[str, Field, int], at: Any, values: tuple[Any, Any], tolerance: Tolerance
) -> Differing:
    """What differs of one column of values."""
    field = of[1]
    greatest = 0.0
    if field.real:
        distances = real_differences(*values)
        counts = _counts(tolerance, field.unit, distances)
        distances = Differences(*(column[counts] for column in distances))
        with np.errstate(invalid="ignore"):
            greatest = float(max(np.max(np.abs(one), initial=0.0) for one in values)) if counts.any() else 0.0
    elif field.target or field.name in ADDRESSES:
        distances = whole_differences(_pointers_differ(matching, values))
    else:
        distances = whole_differences(values[0] != values[1])
    rows = distances.rows
    some = values[0][rows], values[1][rows]
    return Differing(*of, at[0][rows], at[1][rows], some, distances, greatest, len(values[0]))


def _pointers_differ(matching: Matching, values: tuple[Any, Any]) -> Any:
    """True for each pointer (n,) of both that does not lead to one group, or to the same nonsense."""
    one, two = (side.numbers(at) for side, at in zip(matching.sides, values, strict=True))
    astray = (~side.atlas.holding("any", at) for side, at in zip(matching.sides, values, strict=True))
    same_nonsense = (values[0] == values[1]) & np.logical_and(*astray)
    return ~(((one == two) & (one > 0)) | same_nonsense)
