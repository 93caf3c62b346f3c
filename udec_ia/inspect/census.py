"""Which groups a heap holds, found by following every pointer of the table from the list heads, in waves.

A word of IA() has no type of its own, and only some kinds of group carry a head code. But the table says what
each pointer leads to: so the kind of a group is known by the way that leads there. All pointers of all groups
that were found last are followed at once, until they lead to nothing new; blocks lead to their neighbours, so
there are about as many waves as blocks across the model. Nothing is trusted: a pointer that leads out of the
heap, to an address where no group can stand or to another head code is not followed. So this tells what is
there in a damaged heap, too; whether it is sound is for the checker to say.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.inspect.walk import HEADS, SOFT, one_of
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Group, layouts, read_table

TABLE = read_table()
CHOICES = {
    "item": ("corner", "contact"),
    "soft": tuple(SOFT.values()),
}  # kinds that such a pointer can lead to


class Shape(NamedTuple):
    """What groups of one kind look like in a word scheme: words, head codes, pointers with their targets."""

    size: int
    heads: tuple[int, ...]
    pointers: list[tuple[int, str]]


def census(h: Memory) -> dict[str, Any]:
    """Addresses of the groups of every kind, each an ascending array.

    An address to which two kinds of pointer lead is counted once, as the kind that comes first.
    """
    ratio, top = int(h.ra.itemsize // h.ia.itemsize), max(min(int(h.ci[g.MFREE]), len(h.ia) + 1), 1)
    shapes = {group.name: _shape(group, ratio) for group in TABLE.groups}
    kind_at = np.zeros(top, np.int8)  # number of the kind of the group that begins there; 0 for none
    place = np.empty(top, np.int64)
    wave = _heads(h)
    while wave:
        ahead: dict[str, list[Any]] = {}
        for number, (kind, shape) in enumerate(shapes.items(), 1):
            at = np.concatenate([np.empty(0, np.int64), *wave.get(kind, ())])
            at = at[(at >= 1) & (at <= top - shape.size) & ((at - 1) % ratio == 0)]
            at = _once(at[kind_at[at] == 0], place)
            if shape.heads:
                at = at[one_of(h.ia[at - 1], shape.heads)]
            kind_at[at] = number
            for offset, target in shape.pointers if len(at) else ():
                to = h.ia[at + offset - 1].astype(np.int64)
                for other, chosen in _by_kind(h, target, at, to):
                    ahead.setdefault(other, []).append(chosen)
        wave = ahead
    return {kind: np.flatnonzero(kind_at == number) for number, kind in enumerate(shapes, 1)}


def _once(at: Any, place: Any) -> Any:
    """Each of the addresses `at` once. place: room for a number at every address."""
    rows = np.arange(len(at))
    place[at] = rows
    return at[place[at] == rows]


def _heads(h: Memory) -> dict[str, list[Any]]:
    """Where the pointers of the common block lead."""
    wave: dict[str, list[Any]] = {}
    for field in TABLE.common:
        if field.role == "head" and field.target:
            wave.setdefault(field.target, []).append(np.array([h.ci[getattr(g, field.name)]], np.int64))
    return wave


def _by_kind(h: Memory, target: str, owners: Any, to: Any) -> list[tuple[str, Any]]:
    """What pointers of `owners` lead `to`, by kind: of what extends a block, its own head code says which."""
    if target == "soft":
        return [(kind, to[(h.ia[owners - 1] == code) & (to != 0)]) for code, kind in SOFT.items()]
    to = to[to != 0]
    return [(kind, to) for kind in CHOICES.get(target, (target,))]


def _shape(group: Group, ratio: int) -> Shape:
    """What groups of a kind look like. What may be of any kind is reached by its own lists, not from here."""
    layout = layouts(ratio)[group.name]
    pointers = [
        (layout.offset[field.name] + i, str(field.target))
        for field in group.fields
        if field.target and field.target != "any"
        for i in range(field.count)
    ]
    return Shape(layout.size, HEADS.get(group.name, ()), pointers)
