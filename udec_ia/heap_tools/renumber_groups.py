"""Groups at new addresses: in the order of their lists (`udec renumber`), or in that of the map.

A run gives groups the addresses that FIND has left, so in time neighbours of a list lie far apart, and each
step along it waits for the memory of the machine. `renumber` gives each kind a stretch of IA() of its own, in
the order of its list: blocks, contacts and the other main lists as they run, corners block by block
clockwise, extensions, grid-points and zones in the order of their blocks. The lists themselves stay as they
are. Their order is that of the sums of forces, so no bit of any result changes.

`arrange` puts the lists in a new order too, before the first cycle of a large model. SPLIT makes blocks,
corners, contacts and domains by turns, wherever the lines run. Every pass of the cycle goes through one kind
of group and looks at its neighbours in the map: so each kind is laid in strips across the model, and all
passes read memory in nearly straight runs. Small models stay as they are: they fit the machine's caches, and
their addresses are what a deck has seen.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, iget, integers, size_of
from udec_ia.heap.main_array import MainArray, relocate
from udec_ia.heap_tools.rewrite_heap import junk_words, movable
from udec_ia.kernels.links.linked_lists import map_order
from udec_ia.kernels.split.split import enter_boxes
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table
from udec_ia.ops.common.block_ranges import chain
from udec_ia.reader.group_tables import addresses
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


LARGE = 500  # blocks from which on it pays


def arrange(array: MainArray) -> Any:
    """Put the groups of a large model that has not been cycled yet in the order of the map.

    Returns the new address of the group at each old one, 0 where there was none; None if nothing moved.
    """
    h = array.h
    if h.ci[g.NBLK] < LARGE or h.ci[g.MCTOT] > 0:
        return None
    blocks = in_strips(h)
    order = of_the_map(h, blocks) | of_deformable_blocks(h, blocks)
    others = (group.name for group in read_table().groups if group.name not in order)
    order |= {kind: addresses(array, kind) for kind in others}
    return relocate(array, {kind: np.array(groups) for kind, groups in order.items() if len(groups)})


def in_strips(h: Memory) -> Any:
    """Blocks strip after strip across the model, as wide as a block."""
    n = int(h.ci[g.NBLK])
    boxes, blocks = np.empty((n, 4), h.cr.dtype), np.empty(n, np.int64)
    enter_boxes(h, boxes, blocks)
    across, along = sorted((boxes[:, :2] + boxes[:, 2:]).T / 2, key=np.ptp)
    strip = math.sqrt(np.ptp(across) * np.ptp(along) / n)
    return blocks[np.lexsort((across, np.floor((along - along.min()) / strip)))]


def of_the_map(h: Memory, blocks: Any) -> dict[str, Any]:
    """Blocks, corners, contacts and domains, as a walk round block after block needs them."""
    top = int(h.ci[g.MFREE])
    corners = np.empty(top // size_of(h, g.NVCR), np.int64)
    contacts, domains = np.empty(int(h.ci[g.NCON]), np.int64), np.empty(int(h.ci[g.NDOM]), np.int64)
    count, _, _ = map_order(h, blocks, corners, contacts, domains, np.zeros(top + 1, np.bool_))
    return {"block": blocks, "contact": contacts, "corner": corners[:count], "domain": domains}


def of_deformable_blocks(h: Memory, blocks: Any) -> dict[str, Any]:
    """Extensions, grid-points and zones, block after block."""
    soft = blocks if h.ci[g.NSOFT] else ()
    sdef = [iget(h, ib, g.KBEX) for ib in soft if iget(h, ib, HEAD) == g.MSDEF]
    fdef = [iget(h, ib, g.KBEX) for ib in soft if iget(h, ib, HEAD) == g.MFDEF]
    points = [ig for ie in fdef for ig in chain(h, iget(h, ie, g.KFG), g.KG)]
    zones = [iz for ie in fdef for iz in chain(h, iget(h, ie, g.KFZ), g.KZ)]
    return {"sdef": sdef, "fdef": fdef, "gridpoint": points, "zone": zones}
