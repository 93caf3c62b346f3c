"""Looking for groups by a condition, for numbers by their value, and for pointers by where they lead."""

from __future__ import annotations

from itertools import repeat
from math import inf, isfinite, isnan
from typing import Any

import numpy as np

from udec_ia.heap.main_array import variable
from udec_ia.heap_tools.heap_lookup import pointer_rows, pointing
from udec_ia.printable_text import counted
from udec_ia.reader.field_rows import COMMON
from udec_ia.reader.group_conditions import ADDRESS, satisfying
from udec_ia.reader.place_grammar import address_of
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import TABLE, Atlas, Word, leads_to, names

LIMIT = 1000  # rows, if no number is given
TOLERANCE = 1e-6  # as a share of the value that is looked for


def find(atlas: Atlas, condition: str, limit: int = LIMIT) -> Listing:
    """The groups of a kind that a condition is true for, with the fields that it names.

    condition: "block where KXD > 0.1 and KMAT == 2", or a kind alone; see group_conditions.py. limit: rows.
    Raises ValueError for an invalid condition, with a caret below the place.
    """
    kind, at, columns = satisfying(atlas, condition)
    head = f"{len(at)} of {len(atlas.groups[kind])} groups of the kind {kind}{_first(len(at), limit)}"
    shown = [at, names(atlas, at[:limit]), *columns.values()]
    rows = list(zip(*(np.asarray(one)[:limit].tolist() for one in shown), strict=True))
    return Listing([head], (ADDRESS, "group", *columns), rows)


def find_value(atlas: Atlas, value: float, tolerance: float = TOLERANCE, limit: int = LIMIT) -> Listing:
    """Numbers that differ from `value` by no more than `tolerance` times its size; NaN is found, too.

    They are looked for in the common block and in every group. limit: rows. ValueError for a tolerance below
    0.
    """
    if not 0 <= tolerance < inf:
        raise ValueError(f"tolerance {tolerance:g}: give a share of the value, 0 or more")
    rows: list[tuple[Any, ...]] = []
    for field in TABLE.common:
        values = variable(atlas.h, field)
        for k in np.flatnonzero(_near(values, value, tolerance)).tolist():
            name = f"{field.name}({k + 1})" if field.count > 1 else field.name
            rows.append(("", COMMON, name, values[k].item(), field.unit.strip("-")))
    many, found = len(rows), list[tuple[int, Word, float]]()
    for kind, at in atlas.groups.items():
        for word in atlas.shapes[kind]:
            values = atlas.gather(word, at)
            near = np.flatnonzero(_near(values, value, tolerance))
            many += len(near)
            found += zip(at[near[:limit]].tolist(), repeat(word), values[near[:limit]].tolist(), strict=False)
    found.sort(key=lambda one: one[0] + one[1].first)
    found = found[: max(limit - len(rows), 0)]
    groups = names(atlas, np.array([at for at, _, _ in found], np.int64))
    for (at, word, number), group in zip(found, groups, strict=True):
        rows.append((at + word.first, group, word.name, number, word.field.unit.strip("-")))
    head = f"{counted(many, 'number')} with the value {value:.15g} (tolerance {tolerance:g} of it)"
    return Listing([head + _first(many, limit)], (ADDRESS, "group", "field", "value", "unit"), rows[:limit])


def find_pointers(atlas: Atlas, place: int | str, limit: int = LIMIT) -> Listing:
    """The first `limit` pointers to the address of a place. ValueError if there is no such place."""
    address = address_of(atlas, place)
    if abs(address) >= 2**63:
        raise ValueError(f"{address} is more than an integer of 64 bits holds")
    found = list(pointing(atlas, address))
    many = sum(len(one.at) for one in found)
    (there,) = leads_to(atlas, "any", np.array([address], np.int64))
    head = f"{counted(many, 'pointer')} to {address}, {there}{_first(many, limit)}"
    return Listing([head], (ADDRESS, "group", "field"), pointer_rows(atlas, found, limit))


def _first(many: int, limit: int) -> str:
    """What to add where not all is shown. ValueError unless something is."""
    if limit < 1:
        raise ValueError(f"limit {limit}: give the number of rows to show, 1 or more")
    return f"; the first {limit}:" if many > limit else ""


def _near(found: Any, value: float, tolerance: float) -> Any:
    """True for each of `found`, integers or reals, that is as near to `value`."""
    if not isfinite(value):
        return np.isnan(found) if isnan(value) else found == value
    if found.dtype.kind == "f":
        with np.errstate(all="ignore"):  # a value may be beyond the reals of 32 bits
            near = np.abs(found - np.float64(value)) <= abs(value) * tolerance
            return near | (found == found.dtype.type(value))
    if abs(round(value) - value) > abs(value) * tolerance or abs(value) >= 2**63:
        return np.zeros(len(found), bool)
    return found == round(value)
