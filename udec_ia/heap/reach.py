"""Following every pointer of the table from where the lists begin: the walk of a census, compiled.

Kinds are numbers, from 1 on in the order of the table. A group whose kind has a head code is known by that:
it counts as soon as a pointer of its kind leads to it, so that no wrong pointer makes another kind of it. The
others wait until no group with a code is left to follow; where two kinds of pointer lead to one address, it
is of the kind that comes first in the table.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.kernel import over_arrays

SURE, WAITING = 0, 1  # what is counted: groups that are yet to be followed, and places that wait


class Shapes(NamedTuple):
    """What groups look like, by number of the kind.

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
    """What has been found: each of as many elements as there are places, at which a group can begin.

    kind_at: number of the kind that begins there; wanted: of the kind that waits there; 0 for none. sure:
    places of groups that are yet to be followed; waiting: those that wait. many: how many of both.
    """

    kind_at: Any
    wanted: Any
    sure: Any
    waiting: Any
    many: Any


def room_for(places: int) -> Found:
    """Nothing found."""
    kind_at, wanted = (np.zeros(places, np.int8) for _ in range(2))
    sure, waiting = (np.empty(places, np.int32) for _ in range(2))
    return Found(kind_at, wanted, sure, waiting, np.zeros(2, np.int64))


@over_arrays
def reach(words: Any, ratio: int, shapes: Shapes, heads: Any, strict: bool, found: Found) -> None:
    """Find all that `heads`, kinds and addresses in two columns, lead to.

    strict: it is over as soon as groups have more words together than there are, as they lie in each other.
    """
    left = len(words)
    for k in range(len(heads)):
        _offer(words, ratio, shapes, heads[k, 0], heads[k, 1], found)
    while found.many[SURE] or found.many[WAITING]:
        if not found.many[SURE]:
            _take_in(ratio, found)
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
    """There may be a group of the kind at an address."""
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
def _take_in(ratio: int, found: Found) -> None:
    """What waits is there, unless a group with a code is."""
    for k in range(found.many[WAITING]):
        place = found.waiting[k]
        if not found.kind_at[place]:
            found.kind_at[place] = found.wanted[place]
            found.sure[found.many[SURE]] = place
            found.many[SURE] += 1
        found.wanted[place] = 0
    found.many[WAITING] = 0
