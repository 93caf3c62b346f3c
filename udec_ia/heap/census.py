"""Which groups a heap holds, found by following every pointer of the table from the list heads.

A word of IA() has no type of its own, and only some kinds of group carry a head code. But the table says what
each pointer leads to: so the kind of a group is known by the way that leads there. The pointers of what was
found are followed until they lead to nothing new (reach.py). Nothing is trusted: a pointer that leads out of
the heap, to an address where no group can stand or to another head code is not followed. So this tells what
is there in a damaged heap, too; whether it is sound is for the checker to say.

The table may be that of another program, whose restart file is being read.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any

import numpy as np

from udec_ia.heap.interpreting import LOOKS, Sparing
from udec_ia.heap.reach import Shapes, reach, room_for
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Table, lay_out, read_table

TABLE = read_table()
SOFT = {  # kind of the extension of a group with this head code
    head.value: head.extension for head in TABLE.heads if head.extension
}
SOFT_NAMES = {head.name: head.extension for head in TABLE.heads if head.extension}
CHOICES = {  # kinds that such a pointer can lead to
    "item": ("corner", "contact"),
    "soft": tuple(SOFT.values()),
}
REACH = Sparing(reach, 9e5, LOOKS)  # places where a group can begin


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
    shapes, number = _our_shapes(ratio) if table is TABLE else _shapes(table, ratio)
    known = [(number[kind], iad) for kind, iad in heads if kind in number]
    ways = np.array(known, np.int64).reshape(-1, 2)
    places = (len(words) - 1) // ratio + 1  # groups begin on reals
    found = room_for(places)
    REACH(places, words, ratio, shapes, ways, strict, found)
    place = np.flatnonzero(found.kind_at)
    kinds = found.kind_at[place]
    return {kind: place[kinds == k] * ratio + 1 for kind, k in number.items()}


def one_of(values: Any, few: Sequence[int]) -> Any:
    """True for each of `values` that is one of a `few` numbers."""
    good = np.asarray(values == few[0])
    for other in few[1:]:
        good |= values == other
    return good


@cache
def _our_shapes(ratio: int) -> tuple[Shapes, dict[str, int]]:
    """Those of the table that the program has."""
    return _shapes(TABLE, ratio)


def _shapes(table: Table, ratio: int) -> tuple[Shapes, dict[str, int]]:
    """What groups look like, and the numbers of the kinds.

    What may be of any kind is reached by its own lists. Of what extends a block the head code of the block
    says what it is.
    """
    number = {group.name: k for k, group in enumerate(table.groups, 1)}
    soft = [(number[SOFT_NAMES[head.name]], head.value) for head in table.heads if head.name in SOFT_NAMES]
    sizes, pointers, first = [0], list[tuple[int, int, int]](), [0]
    for group in table.groups:
        layout = lay_out(group, ratio)
        sizes.append(layout.size)
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
