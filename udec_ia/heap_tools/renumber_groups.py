"""Groups in the order in which the passes come to them, and the junk list empty.

A run gives groups the addresses that FIND has left, so in time neighbours of a list lie far apart, and each
step along it waits for the memory of the machine. Here each kind gets a stretch of IA() of its own, in the
order of its list: blocks, contacts and the other main lists as they run, corners block by block clockwise,
extensions, grid-points and zones in the order of their blocks.

The lists themselves stay as they are. Their order is that of the sums of forces, so no bit of any result
changes; `arrange` (memory_order.py), which puts the lists in a new order too, is for the time before
the first cycle.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import integers
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.relocation import relocate
from udec_ia.heap_tools.movable_groups import junk_words, movable
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table
from udec_ia.reader.listing import Listing

TABLE = read_table()
COLUMNS = ("along", "field", "jumps", "before", "after", "meaning")
LINKS = ("next", "clockwise", "anticlockwise")  # roles of what leads from a group of a list to the next
LOOKED_UP = ("host", "associate", "triple")  # of what passes look up for each group of a list


def renumber(array: MainArray) -> Listing:
    """Lay out the groups of `array` in the order of their lists, from address 1, without junk.

    Says how far, in words, a step along each list went and goes now: from a group to the next, and from what
    passes look up for the one to what they look up for the next. Raises Unsound, and nothing is changed, if
    there are groups that cannot be told apart (movable.py).
    """
    order = movable(array)
    junk, before = junk_words(array), _jumps(array, order)
    moved = relocate(array, {kind: at for kind, at in order.items() if len(at)})
    after = _jumps(array, {kind: moved[at] for kind, at in order.items()})
    changed = sum(int(np.count_nonzero(moved[at] != at)) for at in order.values())
    said = [
        f"{changed} of {sum(map(len, order.values()))} groups have another address; {junk} words were junk",
        "mean jump in words along each list, between its groups or between what is looked up for them:",
    ]
    rows = [
        (*place, jumps, round(jump, 1), round(after[place][1], 1), text)
        for place, (jumps, jump, text) in before.items()
    ]
    return Listing(said, COLUMNS, rows)


def _jumps(array: MainArray, order: dict[str, Any]) -> dict[tuple[str, str], tuple[int, float, str]]:
    """By kind and field: how many jumps there are, how long they are in the mean, and what the field is."""
    found = {}
    for kind, at in order.items():
        for field in TABLE.group(kind).fields:
            if field.role in LINKS + LOOKED_UP:
                to = integers(array.h, at, getattr(g, field.name))
                jumps = (to - at)[to != 0] if field.role in LINKS else np.diff(to[to != 0])
                if len(jumps):
                    found[kind, field.name] = (
                        len(jumps),
                        float(np.abs(jumps).mean()),
                        field.text.partition(";")[0],
                    )
    return found
