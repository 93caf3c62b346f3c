"""Which groups a heap holds, found by following every pointer of the table from the list heads, in waves.

A word of IA() has no type of its own, and only some kinds of group carry a head code. But the table says what
each pointer leads to: so the kind of a group is known by the way that leads there. All pointers of all groups
that were found last are followed at once, until they lead to nothing new; blocks lead to their neighbours, so
there are about as many waves as blocks across the model. Nothing is trusted: a pointer that leads out of the
heap, to an address where no group can stand or to another head code is not followed. So this tells what is
there in a damaged heap, too; whether it is sound is for the checker to say.

The table may be that of another program, whose restart file is being read.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from udec_ia.layout import offsets as g
from udec_ia.layout.table import Group, Table, lay_out, read_table

TABLE = read_table()
SOFT = {  # kind of the extension of a group with this head code
    head.value: head.extension for head in TABLE.heads if head.extension
}
SOFT_NAMES = {head.name: head.extension for head in TABLE.heads if head.extension}
CHOICES = {  # kinds that such a pointer can lead to
    "item": ("corner", "contact"),
    "soft": tuple(SOFT.values()),
}


class Shape(NamedTuple):
    """What groups of one kind look like in a word scheme: words, head codes, pointers with their targets."""

    size: int
    heads: tuple[int, ...]
    pointers: list[tuple[int, str]]


def census(h: Any) -> dict[str, Any]:
    """Addresses of the groups of every kind, each an ascending array.

    An address to which two kinds of pointer lead is counted once: as a kind with a head code, if it has that.
    """
    words, ratio = getattr(h.ia, "array", h.ia), int(h.ra.itemsize // h.ia.itemsize)
    top = max(min(int(h.ci[g.MFREE]), len(words) + 1), 1)
    heads = ((str(field.target), int(h.ci[getattr(g, field.name)])) for field in list_heads(TABLE))
    return reached(TABLE, ratio, words[: top - 1], heads)


def list_heads(table: Table) -> list[Any]:
    """The fields of the common block that point to groups."""
    return [field for field in table.common if field.target]


def reached(
    table: Table, ratio: int, words: Any, heads: Iterable[tuple[str, int]], strict: bool = False
) -> dict[str, Any]:
    """The same of any `table` and the words in use, where `heads`, pointers with their targets, lead.

    strict: it is over as soon as groups have more words together than there are, as they lie in each other.
    """
    top = left = len(words) + 1
    shapes = {group.name: _shape(table, group, ratio) for group in table.groups}
    soft = {head.value: SOFT_NAMES[head.name] for head in table.heads if head.name in SOFT_NAMES}
    places = (top - 2) // ratio + 1  # groups begin on reals: at these places, counted from 0
    kind_at = np.zeros(places, np.int16)  # number of the kind of the group that begins there; 0 for none
    last_at = np.empty(places, np.int32)
    wave: dict[str, list[Any]] = {}
    for kind, address in heads:
        wave.setdefault(kind, []).append(np.array([address], np.int64))
    while wave and not (strict and left < 0):
        sure = [kind for kind in wave if shapes[kind].heads]  # first: a wrong pointer makes no other of them
        turn = {kind: wave.pop(kind) for kind in sure or [*wave]}
        for number, (kind, shape) in enumerate(shapes.items(), 1):
            if kind not in turn or shape.size >= top:
                continue
            at = np.concatenate(turn[kind])
            at = at[(at >= 1) & (at <= top - shape.size) & ((at - 1) % ratio == 0)]
            at = at[kind_at[(at - 1) // ratio] == 0]
            at = at[_once((at - 1) // ratio, last_at)]
            if shape.heads:
                at = at[one_of(words[at - 1], shape.heads)]
            kind_at[(at - 1) // ratio] = number
            left -= len(at) * shape.size
            if not len(at) or (strict and left < 0):
                continue
            for offset, target in shape.pointers:
                to = words[at + offset - 1].astype(np.int64)
                for other, chosen in _by_kind(soft, words[at - 1], target, to):
                    wave.setdefault(other, []).append(chosen)
    return {kind: np.flatnonzero(kind_at == number) * ratio + 1 for number, kind in enumerate(shapes, 1)}


def one_of(values: Any, few: Sequence[int]) -> Any:
    """True for each of `values` that is one of a `few` numbers."""
    good = np.asarray(values == few[0])
    for other in few[1:]:
        good |= values == other
    return good


def _once(places: Any, last_at: Any) -> Any:
    """True for each of `places` that stands for its equals. last_at: room for a number at every place."""
    rows = np.arange(len(places), dtype=last_at.dtype)
    last_at[places] = rows
    return last_at[places] == rows


def _by_kind(soft: dict[int, str], codes: Any, target: str, to: Any) -> list[tuple[str, Any]]:
    """What pointers lead `to`, by kind: of what extends a block, its own head code says which."""
    if target == "soft":
        return [(kind, to[(codes == code) & (to != 0)]) for code, kind in soft.items()]
    to = to[to != 0]
    return [(kind, to) for kind in CHOICES.get(target, (target,))]


def _shape(table: Table, group: Group, ratio: int) -> Shape:
    """What groups of a kind look like. What may be of any kind is reached by its own lists, not from here."""
    layout = lay_out(group, ratio)
    pointers = [
        (layout.offset[field.name] + i, str(field.target))
        for field in group.fields
        if field.target and field.target != "any"
        for i in range(field.count)
    ]
    return Shape(layout.size, tuple(one.value for one in table.heads if one.group == group.name), pointers)
