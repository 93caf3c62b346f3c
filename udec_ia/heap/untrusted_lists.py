"""Walks along the lists of a heap that is not proved sound: every address is tested, every walk ends.

The words of IA() come as a bare array; a `step` is the place of a field in it, from the address of the group.
Reals of many groups come as a bare array as well.
"""

from __future__ import annotations

import math
from typing import Any

from udec_ia.compiling.kernel_decorators import over_arrays
from udec_ia.layout import offsets as g

TURNS = 4  # walks around blocks take as many steps together, for each place where a group could begin
STRETCH = 256  # places in which groups are counted by a byte


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
        mark, turns, since = 0, 1, 0  # an item that was passed, as long ago as the list was long then
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
            if closed[k] or iad == mark:
                break
            since += 1
            if since == turns:
                mark, turns, since = iad, 2 * turns, 0
        if not closed[k]:
            n = start
    return n


@over_arrays
def lay_out_lists(
    words: Any,
    to_host: int,
    lists: Any,
    items: Any,
    row: Any,
    neighbours: Any,
    owner: Any,
    side: Any,
    at: Any,
) -> None:
    """What stands where in the clockwise lists that close, as checker/checked_state.py has it.

    to_host: to KB1 of a contact; lists: address of the block, first item and number of items, for each list;
    items: addresses; row: among the groups in use; neighbours: item before, item after, corner at or after.
    """
    for r in range(len(lists)):
        block, start, end = lists[r, 0], lists[r, 1], lists[r, 1] + lists[r, 2]
        corner = start  # a list begins with one
        for k in range(end - 1, start - 1, -1):
            owner[k], side[k] = r, 0
            if words[items[k] - 1] == g.MCON:
                side[k] = words[items[k] + to_host] != block
                if row[k] >= 0:
                    at[side[k], row[k]] = k
            else:
                corner = k
            neighbours[0, k] = k - 1 if k > start else end - 1
            neighbours[1, k] = k + 1 if k + 1 < end else start
            neighbours[2, k] = corner


@over_arrays
def ill_linked(
    words: Any, lists: Any, items: Any, side: Any, before: Any, corner: Any, steps: Any, found: Any
) -> int:
    """The number of links in the lists that are not what the lists say.

    lists, items, side: as above; before, corner: items by their places. steps: of a corner, to the block, the
    corner before and the item before; of a contact, to the corner ahead and the item before, both for each
    side. found: item, place in `steps`, what stands there and should, for as many as there is room for.
    """
    n = 0
    for r in range(len(lists)):
        start, end = lists[r, 1], lists[r, 1] + lists[r, 2]
        last = 0  # corner
        for k in range(start, end):
            last = items[k] if words[items[k] - 1] == g.MCOR else last
        for k in range(start, end):
            iad = items[k]
            if words[iad - 1] == g.MCOR:
                n = _compare(words, iad, steps, 0, lists[r, 0], k, found, n)
                n = _compare(words, iad, steps, 1, last, k, found, n)
                n = _compare(words, iad, steps, 2, items[before[k]], k, found, n)
                last = iad
            else:
                n = _compare(words, iad, steps, 3 + side[k], items[corner[k]], k, found, n)
                n = _compare(words, iad, steps, 5 + side[k], items[before[k]], k, found, n)
    return n


@over_arrays
def _compare(words: Any, iad: int, steps: Any, which: int, wanted: int, k: int, found: Any, n: int) -> int:
    """One more than n, and a row in `found`, if another word stands there than the one that is wanted."""
    there = words[iad + steps[which]]
    if there == wanted:
        return n
    if n < len(found):
        found[n, 0], found[n, 1], found[n, 2], found[n, 3] = k, which, there, wanted
    return n + 1


@over_arrays
def rows_of(
    addresses: Any, code: int, kind_at: Any, nth_at: Any, before: Any, row: Any, shift: int, found: Any
) -> None:
    """Row of each address among the groups of the kind `code`; -1 where there is none. See State.rows."""
    for k in range(len(addresses)):
        place = _place(addresses[k], len(kind_at), shift)
        found[k] = -1
        if place >= 0 and kind_at[place] == code:
            found[k] = row[before[place // STRETCH] + nth_at[place]]


@over_arrays
def astray(
    words: Any, groups: Any, step: int, codes: Any, optional: bool, kind_at: Any, shift: int, found: Any
) -> int:
    """The number of groups whose pointer `step` words after their address leads to none of the kinds `codes`.

    optional: it may be 0. found: rows among `groups` and what they hold, for as many as there is room for.
    """
    n = 0
    for k in range(len(groups)):
        iad = words[groups[k] + step]
        place = _place(iad, len(kind_at), shift)
        good = iad == 0 and optional
        for code in codes:
            good = good or (place >= 0 and kind_at[place] == code)
        if not good:
            if n < len(found):
                found[n, 0], found[n, 1] = k, iad
            n += 1
    return n


@over_arrays
def gaps(words: Any, kind_at: Any, sizes: Any, junk_size: int, ratio: int, free: int, found: Any) -> int:
    """The number of groups that do not begin at the word after the group before.

    kind_at: code of the kind of the group that begins at each real, 0 for none; sizes: of the kinds by code,
    in words, 0 for junk, whose size stands `junk_size` words after its address. found: address of the group
    before, 0 for none; the word after it; and where the next begins, or `free`: as many as there is room for.
    """
    n, before, end = 0, 0, 1
    for place in range(len(kind_at) + 1):
        last = place == len(kind_at)
        if not last and kind_at[place] == 0:
            continue
        iad = free if last else place * ratio + 1
        if iad != end:
            if n < len(found):
                found[n, 0], found[n, 1], found[n, 2] = before, end, iad
            n += 1
        if not last:
            size = sizes[kind_at[place]]
            before, end = iad, iad + (size if size else words[iad + junk_size])
    return n


@over_arrays
def _place(iad: int, places: int, shift: int) -> int:
    """The real that begins at an address, counted from 0; -1 where none does."""
    place = (iad - 1) >> shift
    return place if iad >= 1 and place < places and place << shift == iad - 1 else -1


@over_arrays
def all_finite(reals: Any, groups: Any, ratio: int, first: int, last: int) -> bool:
    """True if the reals `first` to `last` of the groups at these addresses, counted from 1, are numbers."""
    for k in range(len(groups)):
        base = (groups[k] - 1) // ratio
        for i in range(base + first - 1, base + last):
            if not math.isfinite(reals[i]):
                return False
    return True


@over_arrays
def place_items(reals: Any, items: Any, contact: Any, ratio: int, offsets: Any, places: Any) -> None:
    """The place of each item (n x 2), from that of the first, a corner.

    offsets: of x and y among the reals, counted from 1, of a corner and of a contact.
    """
    for k in range(len(items)):
        base, of_kind = (items[k] - 1) // ratio - 1, 2 if contact[k] else 0
        for axis in range(2):
            places[k, axis] = reals[base + offsets[of_kind + axis]]
    x, y = places[0, 0], places[0, 1]
    for k in range(len(items)):
        places[k, 0], places[k, 1] = places[k, 0] - x, places[k, 1] - y
