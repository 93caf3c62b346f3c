"""The groups that a heap holds, found by following every pointer of the field table from the list heads.

Nothing is trusted: a pointer that leads out of the heap, to an address where no group can begin or to another
head code is not followed. So the census works in a damaged heap, too, and with the table of another program.
A group whose kind has a head code counts as soon as a pointer of its kind leads to it, so that no wrong
pointer makes another kind of it. The others wait until no group with a code is left to follow. Where two
kinds of pointer lead to one address, it is of the kind that comes first in the table. Groups behind others
follow these.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.compiling.kernel_decorators import over_arrays
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Table, lay_out, read_table

TABLE = read_table()
SOFT = {head.value: head.extension for head in TABLE.heads if head.extension}  # extension by head code
SOFT_NAMES = {head.name: head.extension for head in TABLE.heads if head.extension}
CHOICES = {"item": ("corner", "contact"), "soft": tuple(SOFT.values())}  # kinds a pointer can lead to
SURE, WAITING = 0, 1  # what is counted: groups that are yet to be followed, and places that wait


class Shapes(NamedTuple):
    """Sizes, head codes and pointers of groups, by number of the kind, from 1 in the order of the table.

    size: in words. codes: two columns, head codes and the kinds that have them; coded: True for those kinds.
    pointers: three columns, word (1 for the first of the group), kind that it leads to, and head code that
    the group must have for that, 0 for any; those of kind k are the rows first[k] to before first[k + 1].
    """

    size: Any
    codes: Any
    coded: Any
    pointers: Any
    first: Any


class Found(NamedTuple):
    """The groups found so far; one element for each place at which a group can begin.

    kind_at: number of the kind that begins there; wanted: of the kind that waits there; 0 for none. sure:
    places of groups that are yet to be followed; waiting: places that wait. many: how many of both.
    """

    kind_at: Any
    wanted: Any
    sure: Any
    waiting: Any
    many: Any


def census(h: Any) -> dict[str, Any]:
    """Addresses of the groups of every kind, each an ascending array; each address counts once."""
    words, ratio = getattr(h.ia, "array", h.ia), int(h.ra.itemsize // h.ia.itemsize)
    top = max(min(int(h.ci[g.MFREE]), len(words) + 1), 1)
    heads = ((str(field.target), int(h.ci[getattr(g, field.name)])) for field in list_heads(TABLE))
    behind = TABLE.behind(lambda flag: int(h.ci[getattr(g, flag)]))
    return reached(TABLE, ratio, words[: top - 1], heads, behind)


def list_heads(table: Table) -> list[Any]:
    """The fields of the common block that point to groups."""
    return [field for field in table.common if field.target]


def reached(
    table: Table,
    ratio: int,
    words: Any,
    heads: Iterable[tuple[str, int]],
    behind: dict[str, str],
    strict: bool = False,
) -> dict[str, Any]:
    """Addresses of the groups of every kind of `table` to which `heads`, kinds with addresses, lead.

    words: in use. behind: as of Table.behind. strict: stop as soon as groups have more words together than
    there are, as they overlap.
    """
    shapes, number = (
        _our_shapes(ratio, tuple(behind.items())) if table is TABLE else _shapes(table, ratio, behind)
    )
    known = np.array([(number[kind], iad) for kind, iad in heads if kind in number], np.int64).reshape(-1, 2)
    places = (len(words) - 1) // ratio + 1  # groups begin on reals
    kind_at, wanted = (np.zeros(places, np.int8) for _ in range(2))
    sure, waiting = (np.empty(places, np.int32) for _ in range(2))
    found = Found(kind_at, wanted, sure, waiting, np.zeros(2, np.int64))
    REACH(places, words, ratio, shapes, known, strict, found)
    place = np.flatnonzero(kind_at)
    kinds = kind_at[place]
    at = {kind: place[kinds == k] * ratio + 1 for kind, k in number.items()}
    for host, kind in behind.items():
        at[kind] = at[host] + lay_out(table.group(host), ratio).size
    return at


def one_of(values: Any, few: Sequence[int]) -> Any:
    """True for each of `values` that is one of a `few` numbers."""
    good = np.asarray(values == few[0])
    for other in few[1:]:
        good |= values == other
    return good


@cache
def _our_shapes(ratio: int, behind: tuple[tuple[str, str], ...]) -> tuple[Shapes, dict[str, int]]:
    return _shapes(TABLE, ratio, dict(behind))


def _shapes(table: Table, ratio: int, behind: dict[str, str]) -> tuple[Shapes, dict[str, int]]:
    """The shapes of the groups of `table`, and the numbers of the kinds. behind: as of `reached`.

    Pointers to groups of any kind are left out, as those are in lists of their own. The kind of an extension
    follows from the head code of its block.
    """
    number = {group.name: k for k, group in enumerate(table.groups, 1)}
    soft = [(number[SOFT_NAMES[head.name]], head.value) for head in table.heads if head.name in SOFT_NAMES]
    sizes, pointers, first = [0], list[tuple[int, int, int]](), [0]
    for group in table.groups:
        layout, size, last = lay_out(group, ratio), 0, group.name
        while last:
            size += lay_out(table.group(last), ratio).size
            last = behind.get(last, "")
        sizes.append(size)
        first.append(len(pointers))
        for field in group.fields:
            if field.target is None or field.target == "any":
                continue
            kinds = [kind for kind in CHOICES.get(field.target, (field.target,)) if kind in number]
            leads = soft if field.target == "soft" else [(number[kind], 0) for kind in kinds]
            word = layout.offset[field.name] + 1
            pointers += [(k, *to) for k in range(word, word + field.count) for to in leads]
    first.append(len(pointers))
    codes = np.array([(head.value, number[head.group]) for head in table.heads], np.int64).reshape(-1, 2)
    coded = np.zeros(len(sizes), bool)
    coded[codes[:, 1]] = True
    rows = np.array(pointers, np.int64).reshape(-1, 3)
    return Shapes(np.array(sizes), codes, coded, rows, np.array(first)), number


@over_arrays
def reach(words: Any, ratio: int, shapes: Shapes, heads: Any, strict: bool, found: Found) -> None:
    """Find all groups that `heads`, kinds and addresses in two columns, lead to. strict: as for `reached`."""
    left = len(words)
    for k in range(len(heads)):
        _offer(words, ratio, shapes, heads[k, 0], heads[k, 1], found)
    while found.many[SURE] or found.many[WAITING]:
        if not found.many[SURE]:
            _take_in(found)
        if not found.many[SURE]:  # all that waited has been found as something else
            return
        found.many[SURE] -= 1
        place = found.sure[found.many[SURE]]
        iad, kind = place * ratio + 1, found.kind_at[place]
        left -= shapes.size[kind]
        if strict and left < 0:
            return
        for row in range(shapes.first[kind], shapes.first[kind + 1]):
            code = shapes.pointers[row, 2]
            if code == 0 or words[iad - 1] == code:
                to = words[iad + shapes.pointers[row, 0] - 2]
                _offer(words, ratio, shapes, shapes.pointers[row, 1], to, found)


@over_arrays
def _offer(words: Any, ratio: int, shapes: Shapes, kind: int, iad: int, found: Found) -> None:
    """A pointer leads to a group of the kind at an address."""
    if iad < 1 or iad - 1 > len(words) - shapes.size[kind] or (iad - 1) % ratio:
        return
    place = (iad - 1) // ratio
    if found.kind_at[place]:
        return
    if shapes.coded[kind]:
        for k in range(len(shapes.codes)):
            if shapes.codes[k, 1] == kind and shapes.codes[k, 0] == words[iad - 1]:
                found.kind_at[place] = kind
                found.sure[found.many[SURE]] = place
                found.many[SURE] += 1
    elif not found.wanted[place]:
        found.wanted[place] = kind
        found.waiting[found.many[WAITING]] = place
        found.many[WAITING] += 1
    else:
        found.wanted[place] = min(kind, found.wanted[place])


@over_arrays
def _take_in(found: Found) -> None:
    """The groups that wait are found, unless a group with a code is at their place."""
    for k in range(found.many[WAITING]):
        place = found.waiting[k]
        if not found.kind_at[place]:
            found.kind_at[place] = found.wanted[place]
            found.sure[found.many[SURE]] = place
            found.many[SURE] += 1
        found.wanted[place] = 0
    found.many[WAITING] = 0


REACH = InterpretWhenSmall(reach, 9e5)  # places where a group can begin
