"""Groups at new addresses: in the order of their lists (`udec renumber`), or in that of the map.

`renumber` leaves the lists, and with them the sums of forces, as they are, so no bit of any result changes.
`arrange` also puts the lists in a new order before the first cycle of a large model, in strips across the
model, so that all passes read memory in nearly straight runs. Small models fit the machine's caches.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, iget, size_of
from udec_ia.heap.main_array import MANY_BLOCKS, MainArray, relocate
from udec_ia.heap_tools.rewrite_heap import groups_in_list_order, junk_words
from udec_ia.kernels.links.linked_lists import map_order
from udec_ia.kernels.split.split import enter_boxes
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.group_tables import addresses
from udec_ia.reader.list_walks import chain
from udec_ia.reader.printed_listing import Listing


def renumber(array: MainArray) -> Listing:
    """Lay out the groups of `array` in the order of their lists, from address 1, without junk.

    Raises Unsound, and changes nothing, if a word is in no group or a pointer leads to no group of its kind.
    """
    order, junk = groups_in_list_order(array), junk_words(array)
    moved = relocate(array, order)
    changed = sum(int(np.count_nonzero(moved[at] != at)) for at in order.values())
    groups = sum(map(len, order.values()))
    return Listing([f"{changed} of {groups} groups have another address; {junk} words were junk"])


def arrange(array: MainArray) -> Any:
    """Put a large model, not cycled yet, in the order of the map. Returns new addresses by old, or None."""
    h = array.h
    if h.ci[g.NBLK] < MANY_BLOCKS or h.ci[g.MCTOT] > 0:
        return None
    blocks = in_strips(h)
    order = of_the_map(h, blocks) | of_deformable_blocks(h, blocks)
    others = (group.name for group in read_table().groups if group.name not in order)
    order |= {kind: addresses(array, kind) for kind in others}
    return relocate(array, {kind: np.array(groups, np.int64) for kind, groups in order.items()})


def in_strips(h: Memory) -> Any:
    """Blocks strip after strip across the model, as wide as a block."""
    n = int(h.ci[g.NBLK])
    boxes, blocks = np.empty((n, 4), h.cr.dtype), np.empty(n, np.int64)
    enter_boxes(h, boxes, blocks)
    across, along = sorted((boxes[:, :2] + boxes[:, 2:]).T / 2, key=np.ptp)
    strip = math.sqrt(np.ptp(across) * np.ptp(along) / n) or 1.0  # 0 if all blocks are in one line
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
