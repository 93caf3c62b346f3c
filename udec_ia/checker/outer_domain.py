"""Invariant 4: the outer domain is the one around all blocks.

A domain is on the left of its loop. So the polygon of its loop, through contacts and corners, runs around an
area that is positive, but for the overlaps; that of the outer domain runs around all blocks with the
ground on its outside, and has minus the area of all that it encloses. No other is as low.

The loop passes a virtual contact on both of the ways between its two blocks, so that the two jumps cancel:
each block's part of the loop counts as if it closed at the item before the contact.

Where blocks lie deeper in each other than contacts allow, areas tell nothing: that is so in a state that such
an error has ended a run of.
"""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_map import SIDES
from udec_ia.compiling.interpreting import InterpretWhenSmall
from udec_ia.errors import DISORDERED
from udec_ia.heap.untrusted_lists import place_items
from udec_ia.kernels.audit.domain_faces import areas
from udec_ia.layout import offsets as g

AREAS, PLACE_ITEMS = InterpretWhenSmall(areas, 9e5), InterpretWhenSmall(place_items, 1e6)  # items


def check_outer(state: State) -> None:
    """Invariant 4, if every list is closed and all places are numbers."""
    rings, domains = state.rings, state.address["domain"]
    if state.common("NSPOIL") in DISORDERED:
        return
    if len(rings.block) < len(state.address["block"]) or len(domains) < 2:
        return
    if not len(rings.item) or (rings.row < 0).any() or (rings.at < 0).any():  # a block's part is missing
        return
    places, fields = np.empty((len(rings.item), 2)), ("KXP", "KYP", "KXC", "KYC")
    reals = tuple(state.offset[name] for name in fields)
    PLACE_ITEMS(len(places), state.h.ra, rings.item, rings.contact, state.ratio, reals, places)
    virtual = state.column("contact", "KCCOD") == g.VIRTUAL
    named = np.array([state.rows("domain", state.column("contact", side)) for side in SIDES])
    twice = np.zeros(len(domains))
    of_lists = rings.lists, rings.contact, rings.row, rings.side
    if not AREAS(len(rings.item), *of_lists, virtual, named, places, twice):
        return
    outer, lowest = state.common("IODPNT"), int(twice.argmin())
    if outer != domains[lowest]:
        state.report(
            4, f"IODPNT, the outer domain, is {outer}, but domain@{domains[lowest]} lies around all blocks"
        )
