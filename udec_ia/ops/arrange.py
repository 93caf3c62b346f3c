"""Before the first cycle of a large model: groups that are used together are put together.

SPLIT makes blocks, corners, contacts and domains by turns, wherever the lines run. Every pass of the cycle
goes through one kind of group and looks at its neighbours in the map: so each kind gets a stretch of IA() of
its own, in the order of strips across the model, and all passes read memory in nearly straight runs.
Small models stay as they are: they fit the machine's caches, and their addresses are what a deck has seen.
"""

from __future__ import annotations

import math

import numpy as np

from offsets.generated import MCTOT, MFREE, NBLK, NCON, NDOM, NVCR
from udec_ia.heap.accessors import size_of
from udec_ia.heap.array import MainArray
from udec_ia.heap.relocate import relocate
from udec_ia.kernels.cut import enter_boxes
from udec_ia.kernels.order import map_order

LARGE = 500  # blocks from which on it pays


def arrange(array: MainArray) -> None:
    """Put the groups of a large model that has not been cycled yet in the order of the map."""
    h = array.h
    n = int(h.ci[NBLK])
    if n < LARGE or h.ci[MCTOT] > 0:
        return
    boxes, blocks = np.empty((n, 4), h.cr.dtype), np.empty(n, np.int64)
    enter_boxes(h, boxes, blocks)
    across, along = sorted((boxes[:, :2] + boxes[:, 2:]).T / 2, key=np.ptp)
    strip = math.sqrt(np.ptp(across) * np.ptp(along) / n)
    blocks = blocks[np.lexsort((across, np.floor((along - along.min()) / strip)))]
    top = int(h.ci[MFREE])
    corners = np.empty(top // size_of(h, NVCR), np.int64)
    contacts, domains = np.empty(int(h.ci[NCON]), np.int64), np.empty(int(h.ci[NDOM]), np.int64)
    count, _, _ = map_order(h, blocks, corners, contacts, domains, np.zeros(top + 1, np.bool_))
    relocate(array, {"block": blocks, "corner": corners[:count], "contact": contacts, "domain": domains})
