"""What differs between two states, as text: field by field, or word by word (`udec diff`)."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray, variable
from udec_ia.heap_tools.block_matching import Side
from udec_ia.heap_tools.memory_use import words_of_kind
from udec_ia.heap_tools.state_comparison import ADDRESSES, COMMON, Compared, Differing, compare
from udec_ia.heap_tools.state_comparison import tolerance as limits
from udec_ia.layout.code_names import spelled
from udec_ia.printable_text import counted
from udec_ia.reader.field_rows import COMMON as COMMON_BLOCK
from udec_ia.reader.printed_listing import Listing, Tables
from udec_ia.reader.word_map import KINDS, NOTHING, TABLE, Atlas, names

LIMIT = 20  # rows of a table, if no number is given
DISTANCES = ("difference", "relative", "ulp", "unit")
CALLED = ("the first", "the second")
FIRST = 3.0  # what counts as the share of a difference between numbers that are no reals: more than any other


def diff(
    one: MainArray,
    two: MainArray,
    only: Sequence[str] = (),
    tolerance: Sequence[str] = (),
    limit: int = LIMIT,
    called: Sequence[str] = CALLED,
) -> Tables:
    """What differs between two states by meaning; status 1 if anything does.

    only: contact, contact.KCFN, common.FRAC ...: what is compared (default: all). tolerance: m=1e-6,
    relative=1e-9, ulp=4 ...: what does not count. limit: rows of a table. called: how the states are called.
    ValueError for anything else.
    """
    if limit < 0:
        raise ValueError(f"{limit} rows: give 0 or more")
    found = compare(one.h, two.h, only, limits(tolerance))
    columns = ("kind", "field", "differ", "of", *DISTANCES)
    parts = {
        "summary": Listing(_summary(found, (one, two), called), columns, _by_field(found)),
        "alone": _alone(found, limit, called),
        "differences": _greatest(found, limit),
    }
    return Tables(parts, int(found.differ))


def _summary(found: Compared, arrays: Sequence[MainArray], called: Sequence[str]) -> list[str]:
    """How much differs, in sentences."""
    numbers = sum(len(one.one) for one in found.fields)
    differ = f"{numbers} numbers differ" if numbers > 1 else f"{numbers or 'no'} number differs"
    head = [f"{called[0]} and {called[1]}: {differ} in {_compared(found)}"]
    for k, what in enumerate(("deleted", "made")):
        counts = [counted(len(alone[k]), kind) for kind, alone in found.alone.items() if len(alone[k])]
        if counts:
            head.append(f"{what}: {', '.join(counts)}")
    coded = [one for one in found.fields if one.field.name == "KCCOD"]
    head += [f"re-coded: {counted(len(one.one), one.kind)}" for one in coded]
    bits = [array.scheme.real_bits for array in arrays]
    if bits[0] != bits[1]:
        head.append(f"reals of {bits[0]} and {bits[1]} bits are compared in {min(bits)}")
    for side, name in zip(found.matching.sides, called, strict=True):
        if lost := words_of_kind(side.atlas, NOTHING):
            head.append(f"left out: {counted(lost, 'word')} of {name} that nothing leads to")
    return head


def _compared(found: Compared) -> str:
    """What was looked at."""
    pairs = found.matching.pairs
    matched = sum(len(at) for kind, (at, _) in pairs.items() if kind in found.kinds)
    groups = [f"{counted(matched, 'group')} of both"] if found.kinds - {COMMON} else []
    return " and ".join([*groups, *(["the common block"] if COMMON in found.kinds else [])])


def _by_field(found: Compared) -> list[tuple[Any, ...]]:
    """For each field that differs how often, and the greatest difference."""
    rows: list[tuple[Any, ...]] = []
    for one in found.fields:
        greatest = int(np.argmax(np.nan_to_num(one.distances.absolute, nan=inf)))
        rows.append((one.kind, one.name, len(one.one), one.many, *_distances(one, greatest)))
    return rows


def _distances(one: Differing, row: int) -> tuple[Any, ...]:
    """The columns DISTANCES, of three digits each."""
    if not one.field.real:
        return "", "", "", ""
    columns = one.distances.absolute, one.distances.relative, one.distances.ulps
    absolute, relative, ulps = (float(f"{column[row]:.3g}") for column in columns)
    return absolute, relative, int(ulps) if ulps < 1e6 else ulps, one.field.unit.strip("-")


def _alone(found: Compared, limit: int, called: Sequence[str]) -> Listing:
    """Groups that only one state has."""
    rows: list[tuple[Any, ...]] = []
    for k, side in enumerate(found.matching.sides):
        for alone in found.alone.values():
            shown = alone[k][: max(limit - len(rows), 0)]
            rows += [(called[k], name) for name in names(side.atlas, shown)]
    count = sum(len(at) for both in found.alone.values() for at in both)
    head = [f"the first {limit} of {count} groups that only one has:"] if count > limit else []
    return Listing(head, ("only in", "group"), rows)


def _greatest(found: Compared, limit: int) -> Listing:
    """The differences one by one: of codes, counts and pointers first, then of reals by their shares."""
    best = [(share, one, row) for one in found.fields for share, row in _first(one, limit)]
    best.sort(key=lambda differing: -differing[0])
    rows = [_row(found, one, row) for _, one, row in best[:limit]]
    many = sum(len(one.one) for one in found.fields)
    head = [f"the greatest {limit} of {many}, by their share of the greatest value of the field:"]
    return Listing(head if many > limit else [], ("group", "field", "first", "second", *DISTANCES), rows)


def _first(one: Differing, limit: int) -> list[tuple[float, int]]:
    """The greatest differences of a field, and their rows; of equal ones the first."""
    shares = np.nan_to_num(one.share, nan=FIRST) if one.field.real else np.full(len(one.one), FIRST)
    order = np.argsort(-shares, kind="stable")[:limit]
    return list(zip(shares[order].tolist(), order.tolist(), strict=True))


def _row(found: Compared, one: Differing, row: int) -> tuple[Any, ...]:
    a, b = int(one.one[row]), int(one.two[row])
    name = COMMON_BLOCK if one.kind == COMMON else f"{one.kind}@{a}" + (f"/{b}" if a != b else "")
    field = f"{one.name}({a + 1})" if one.kind == COMMON and one.field.count > 1 else one.name
    first, second = (
        _shown(side, one, values[row].item())
        for side, values in zip(found.matching.sides, one.values, strict=True)
    )
    if first == second and isinstance(second, str):  # what has the name of a group there, and is not it
        second += ", another"
    return name, field, first, second, *_distances(one, row)


def _shown(side: Side, one: Differing, value: int | float) -> int | float | str:
    """A value; the group that a pointer leads to, or the name of a code."""
    if isinstance(value, int) and (one.field.target or one.field.name in ADDRESSES):
        kind = side.atlas.starts[value] if 0 < value < side.atlas.free else 0
        return f"{KINDS[kind - 1]}@{value}" if kind else value
    codes = spelled(TABLE.codes_of(one.field.name), value) if isinstance(value, int) else []
    return "+".join(code.name for code in codes) or value


def raw(one: MainArray, two: MainArray, limit: int = LIMIT, called: Sequence[str] = CALLED) -> Listing:
    """The words of IA() in use that differ, and the variables of the common block; status 1 if any does.

    limit: rows. called: how the states are called. ValueError for states in words of two schemes.
    """
    if one.scheme is not two.scheme:
        text = f"{called[0]} has words of {one.scheme.name}, {called[1]} of {two.scheme.name}"
        raise ValueError(f"{text}: their words can be compared by meaning only, without --raw")
    atlases = Atlas(one.h), Atlas(two.h)
    used = min(atlas.free for atlas in atlases) - 1
    at = np.flatnonzero(one.h.ia[:used] != two.h.ia[:used]) + 1
    rows = list(_common(one, two))
    count = len(at) + len(rows)
    words = f"{len(at)} of {used} words {'differs' if len(at) == 1 else 'differ'}"
    head = [f"{called[0]} and {called[1]}: {words}, {counted(len(rows), 'variable')}"]
    for atlas, name in zip(atlases, called, strict=True):
        if atlas.free - 1 > used:
            head.append(f"{name} has {counted(atlas.free - 1 - used, 'more word')} in use")
    if count > limit:
        head.append(f"the first {limit} of {count}:")
    for address in at[: max(limit - len(rows), 0)].tolist():
        places = dict.fromkeys(_place(atlas, address) for atlas in atlases)
        rows.append((address, " / ".join(places), *(int(array.h.ia[address - 1]) for array in (one, two))))
    differ = count > 0 or atlases[0].free != atlases[1].free
    return Listing(head, ("address", "what it is", "first", "second"), rows[:limit], int(differ))


def _common(one: MainArray, two: MainArray) -> list[tuple[Any, ...]]:
    """Rows of the variables of which not every bit is the same."""
    rows: list[tuple[Any, ...]] = []
    for field in TABLE.common:
        values = [variable(array.h, field) for array in (one, two)]
        bits = [part.view(f"i{part.itemsize}") for part in values]
        for k in np.flatnonzero(bits[0] != bits[1]).tolist():
            name = field.name + (f"({k + 1})" if field.count > 1 else "")
            rows.append(("", f"{COMMON_BLOCK}: {name}", *(part[k].item() for part in values)))
    return rows


def _place(atlas: Atlas, address: int) -> str:
    """Group and field of a word."""
    span, word = atlas.word_at(address)
    return span.name + (f".{word.name}" if word else "")
