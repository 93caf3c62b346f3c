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

from udec_ia.errors import DISORDERED
from udec_ia.inspect.check.groups import State
from udec_ia.inspect.check.map import SIDES
from udec_ia.inspect.reading import INDEX
from udec_ia.layout import offsets as g


def check_outer(state: State) -> None:
    """Invariant 4, if every list is closed and all places are numbers."""
    rings, domains = state.rings, state.address["domain"]
    if state.common("NSPOIL") in DISORDERED:
        return
    if len(rings.block) < len(state.address["block"]) or len(domains) < 2:
        return
    if not len(rings.item) or (rings.row < 0).any():
        return
    x, y = (_along(state, *names) for names in (("KXP", "KXC"), ("KYP", "KYC")))
    x -= x.mean()
    y -= y.mean()
    twice = x * y[rings.after] - y * x[rings.after]
    del x, y
    domain = _exposed_to(state)
    if (domain < 0).any() or not np.isfinite(twice).all():
        return
    area = np.bincount(domain, twice, minlength=len(domains)) / 2
    outer, lowest = state.common("IODPNT"), int(area.argmin())
    if outer != domains[lowest]:
        state.report(
            4, f"IODPNT, the outer domain, is {outer}, but domain@{domains[lowest]} lies around all blocks"
        )


def _along(state: State, corner: str, contact: str) -> np.ndarray:
    """A coordinate of each item of the lists; of a virtual contact that of the item before it."""
    rings = state.rings
    place = np.empty(len(rings.item))
    place[~rings.contact] = state.read(rings.item[~rings.contact], corner)
    place[rings.contact] = state.read(rings.item[rings.contact], contact)
    real = np.arange(len(rings.item), dtype=INDEX)
    row = rings.row[rings.contact]
    real[np.flatnonzero(rings.contact)[state.column("contact", "KCCOD")[row] == g.VIRTUAL]] = 0
    return place[np.maximum.accumulate(real)]  # a list begins with a corner


def _exposed_to(state: State) -> np.ndarray:
    """Row of the domain on the piece of the outline after each item: that before the next contact."""
    rings = state.rings
    index = np.flatnonzero(rings.contact).astype(INDEX)
    named = [state.rows("domain", state.column("contact", side)) for side in SIDES]
    domain = np.full(len(rings.item), -1, INDEX)
    if not len(index):
        return domain
    number = np.cumsum(rings.contact, dtype=INDEX)
    following = index[np.minimum(number, len(index) - 1)]
    before = number[rings.first] - rings.contact[rings.first]
    first = index[np.minimum(before, len(index) - 1)][rings.owner]
    inside = (number < len(index)) & (rings.owner[following] == rings.owner)
    following = np.where(inside, following, first)
    known = rings.owner[following] == rings.owner
    row, side = rings.row[following], rings.side[following]
    domain[known] = np.where(side == 0, named[0][row], named[1][row])[known]
    return domain
