"""Looking for groups by a condition, for numbers by their value, and for pointers by where they lead."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isfinite, isnan
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.main_array import variable
from udec_ia.heap_tools.heap_lookup import pointer_rows, pointing
from udec_ia.printable_text import counted
from udec_ia.reader.field_rows import COMMON
from udec_ia.reader.group_conditions import ADDRESS, satisfying
from udec_ia.reader.place_grammar import address_of
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import JUNK, KINDS, NAMES, NOTHING, TABLE, Atlas, leads_to, names

LIMIT = 1000  # rows, if it is not said how many
TOLERANCE = 1e-6  # as a share of the value that is looked for


class Hits(NamedTuple):
    """Places where a number was found: address of the word (n,) and value (n,), and the field that it is."""

    at: Any
    values: Any
    field: str
    unit: str = ""


def find(atlas: Atlas, condition: str, limit: int = LIMIT) -> Listing:
    """The groups of a kind that a condition is true for, with the fields that it names.

    condition: "block where KXD > 0.1 and KMAT == 2", or a kind alone; see condition.py. limit: rows. Raises
    ValueError for an invalid condition, with a caret below the place.
    """
    kind, at, columns = satisfying(atlas, condition)
    said = f"{len(at)} of {len(atlas.groups[kind])} groups of the kind {kind}{_first(len(at), limit)}"
    shown = [
        at[:limit].tolist(),
        names(atlas, at[:limit]),
        *(one[:limit].tolist() for one in columns.values()),
    ]
    return Listing([said], (ADDRESS, "group", *columns), list(zip(*shown, strict=True)))


def find_value(atlas: Atlas, value: float, tolerance: float = TOLERANCE, limit: int = LIMIT) -> Listing:
    """All numbers that differ from `value` by no more than `tolerance` times its size; NaN is found, too.

    They are looked for in the common block, in every field of every group, and in words of junk and of
    nothing as integers and as reals. limit: rows. ValueError for a tolerance below 0.
    """
    if not 0 <= tolerance < inf:
        raise ValueError(f"tolerance {tolerance:g}: give a share of the value, 0 or more")
    found = list(_in_common(atlas, value, tolerance))
    hits = [*_in_groups(atlas, value, tolerance), *_in_rest(atlas, value, tolerance)]
    ends = np.cumsum([0, *(len(hit.at) for hit in hits)])
    at = np.concatenate([np.zeros(0, np.int64), *(hit.at for hit in hits)])
    chosen = np.argsort(at, kind="stable")[: max(limit - len(found), 0)]
    source = np.searchsorted(ends, chosen, "right") - 1
    many = counted(len(found) + len(at), "number")
    said = f"{many} with the value {value:.15g} (tolerance {tolerance:g} of it)"
    rows = found[:limit]
    for k, s, group in zip(chosen.tolist(), source.tolist(), _containing(atlas, at[chosen]), strict=True):
        hit = hits[s]
        rows.append((int(at[k]), group, hit.field, hit.values[k - ends[s]].item(), hit.unit))
    said += _first(len(found) + len(at), limit)
    return Listing([said], (ADDRESS, "group", "field", "value", "unit"), rows)


def find_pointers(atlas: Atlas, place: int | str, limit: int = LIMIT) -> Listing:
    """All pointers whose value is the address of a place, or any integer. limit: rows.

    ValueError for what no word can hold, and for no such place.
    """
    address = address_of(atlas, place)
    if abs(address) >= 2**63:
        raise ValueError(f"{address} is more than an integer of 64 bits holds")
    found = list(pointing(atlas, address))
    many = sum(len(one.at) for one in found)
    (there,) = leads_to(atlas, "any", np.array([address], np.int64))
    said = f"{counted(many, 'pointer')} to {address}, {there}{_first(many, limit)}"
    return Listing([said], (ADDRESS, "group", "field"), pointer_rows(atlas, found, limit))


def _first(many: int, limit: int) -> str:
    """What to add where not all is shown. ValueError unless something is."""
    if limit < 1:
        raise ValueError(f"limit {limit}: give the number of rows to show, 1 or more")
    return f"; the first {limit}:" if many > limit else ""


def _containing(atlas: Atlas, addresses: Any) -> list[str]:
    """The groups that words are part of, by name."""
    first, _, _ = atlas.bounds
    return names(atlas, first[np.searchsorted(first, addresses, "right") - 1])


def _near(found: Any, value: float, tolerance: float) -> Any:
    """True for each of `found`, integers or reals, that is as near to `value`."""
    if found.dtype.kind == "f":
        if isnan(value):
            return np.isnan(found)
        with np.errstate(all="ignore"):  # a value may be beyond the reals of 32 bits
            same = found == found.dtype.type(value)
            return same | (
                np.abs(found - np.float64(value)) <= abs(value) * tolerance if isfinite(value) else False
            )
    whole = round(value) if isfinite(value) else 0
    limits = np.iinfo(found.dtype)
    near = (
        isfinite(value) and abs(whole - value) <= abs(value) * tolerance and limits.min <= whole <= limits.max
    )
    return found == whole if near else np.zeros(len(found), bool)


def _in_common(atlas: Atlas, value: float, tolerance: float) -> Iterator[tuple[Any, ...]]:
    """Rows for the variables of the common block."""
    for field in TABLE.common:
        values = variable(atlas.h, field)
        for k in np.flatnonzero(_near(values, value, tolerance)).tolist():
            name = field.name + (f"({k + 1})" if field.count > 1 else "")
            yield "", COMMON, name, values[k].item(), field.unit.strip("-")


def _in_groups(atlas: Atlas, value: float, tolerance: float) -> Iterator[Hits]:
    """Fields of groups."""
    for kind in KINDS:
        at = atlas.groups[kind]
        for word in atlas.shapes[kind]:
            values = atlas.gather(word, at)
            near = _near(values, value, tolerance)
            yield Hits(at[near] + word.first, values[near], word.name, word.field.unit.strip("-"))


def _in_rest(atlas: Atlas, value: float, tolerance: float) -> Iterator[Hits]:
    """Words of junk and of nothing, which may be integers or reals."""
    first, last, kind = atlas.bounds
    here = (kind == NAMES.index(JUNK)) | (kind == NAMES.index(NOTHING))
    many = (last - first + 1)[here]
    ahead = np.cumsum(many) - many  # words before those of each stretch
    words = np.arange(many.sum()) + np.repeat(first[here] - ahead, many)
    ends = np.repeat(last[here], many)
    reals = words[((words - 1) % atlas.ratio == 0) & (words + atlas.ratio - 1 <= ends)]
    for at, values, said in (
        (words, atlas.h.ia[words - 1], "as an integer"),
        (reals, atlas.h.ra[(reals - 1) // atlas.ratio], "as a real"),
    ):
        near = _near(values, value, tolerance)
        yield Hits(at[near], values[near], said)
