"""Walks along the lists of a heap that is not proved sound: every address is tested, every walk ends.

The words of IA() come as a bare array; a `step` is the place of a field in it, from the address of the group.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import over_arrays
from udec_ia.layout import offsets as g

TURNS = 4  # walks around blocks take as many steps together, for each place where a group could begin


@over_arrays
def chains(words: Any, firsts: Any, step: int, last: int, ratio: int, found: Any, many: Any) -> int:
    """The number of addresses along the lists that begin at `firsts`, all together.

    found: the addresses; a 0 where a list breaks, as it leads to where no group of the kind can be: beyond
    `last`, or between reals. many: how many of them each list has. What has no room in `found` any more goes
    in a circle, and ends it all.
    """
    n = 0
    for k in range(len(firsts)):
        start, iad = n, firsts[k]
        while iad != 0 and n < len(found):
            there = iad >= 1 and iad <= last and (iad - 1) % ratio == 0
            found[n] = iad if there else 0
            n += 1
            iad = words[iad + step] if there else 0
        many[k] = n - start
    return n


@over_arrays
def groups_along(
    words: Any, starts: Any, kind: int, heads: Any, step: int, seen: Any, found: Any, many: Any
) -> int:
    """The number of groups of a kind along the lists that begin at `heads`, all together.

    starts: by address, number of the kind that begins there. A list ends where it leads to none of the kind,
    or to one that was `seen` before. found: the addresses; many: how many of them each list has.
    """
    n = 0
    for k in range(len(heads)):
        before, iad = n, heads[k]
        while iad > 0 and iad < len(starts) and starts[iad] == kind and not seen[iad]:
            seen[iad] = True
            found[n] = iad
            n += 1
            iad = words[iad + step]
        many[k] = n - before
    return n


@over_arrays
def closed_lists(words: Any, blocks: Any, limits: Any, steps: Any, rows: Any, items: Any, closed: Any) -> int:
    """The number of items in the clockwise lists of `blocks` that close.

    limits: the last address of a corner, that of a contact, and integers to a real; steps: to KP of a block,
    KL of a corner, KB1, KB2, KL1 and KL2 of a contact. rows: of the block of each item; items: its address;
    closed: True for a block whose list does.
    """
    last_corner, last_contact, ratio = limits
    kp, along, one, two, over_one, over_two = steps
    n, left = 0, TURNS * len(items)
    for k in range(len(blocks)):
        block, start = blocks[k], n
        first = iad = words[block + kp]
        while left > 0 and n < len(items) and iad >= 1 and iad <= last_corner and (iad - 1) % ratio == 0:
            left -= 1
            if words[iad - 1] == g.MCOR:
                step = along
            elif words[iad - 1] != g.MCON or iad > last_contact or n == start:
                break
            elif words[iad + one] == block:
                step = over_one
            elif words[iad + two] == block:
                step = over_two
            else:
                break
            rows[n], items[n] = k, iad
            n += 1
            iad = words[iad + step]
            closed[k] = iad == first
            if closed[k]:
                break
        if not closed[k]:
            n = start
    return n
