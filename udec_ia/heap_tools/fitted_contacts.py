"""What follows from the corners, found anew in the digits that the reals have now.

A state in wider reals still has the digits of the narrow ones. Corners, circles and contacts are all moved
and rounded by themselves, so they fit each other to a few last digits: those of before. The checker and SPLIT
take the difference for damage then, and the springs of the next cycle for a movement. So circles, the reach
of each block and the places and overlaps of contacts are calculated from the corners as they are. Corners,
velocities, forces and stresses stay, and so does the map.

Between two passes of a cycle (JPHASE) contacts are yet to follow their blocks: then they are left alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.checker.block_outlines import circles, extent, outlines
from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_overlaps import touches
from udec_ia.heap.accessors import Memory, getr, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g


def settle(array: MainArray) -> float:
    """Bring circles, reaches and contacts of `array` up to its corners. Returns the greatest change, in m."""
    with np.errstate(all="ignore"):
        state = State(array)
        o = outlines(state)
        if o is None or not o.d > 0:
            return 0.0
        h, rows = array.h, state.rows("block", o.block)
        centre, radius = circles(o)
        arc = (o.r != 0) & (radius != 0)  # a corner with a radius keeps one, and one without it none
        centre[~arc], radius[~arc] = np.where(o.r == 0, o.p.T, o.c.T).T[~arc], o.r[~arc]
        changes = [
            _put(h, o.corner, zip((g.KXCP, g.KYCP, g.KRAD), (*centre.T, radius), strict=True)),
            _put(h, o.block, [(g.KBRO, extent(state, o, rows)[1])]),
        ]
        if state.common("JPHASE") == g.AT_BLOCKS:
            touch = touches(state, o._replace(c=centre, r=radius))
            contacts = state.address["contact"][touch.row]
            new = (touch.overlap, *touch.point.T)
            changes.append(_put(h, contacts, zip((g.KCN, g.KXC, g.KYC), new, strict=True)))
    return max(changes)


def _put(h: Memory, at: Any, fields: Any) -> float:
    """Put reals of the groups at `at` where they are finite; returns the greatest change."""
    change = 0.0
    for offset, values in fields:
        old = getr(h, at, offset)
        new = np.where(np.isfinite(values), values, old)
        putr(h, at, offset, new)
        change = max(change, float(np.nanmax(np.abs(new - old), initial=0.0)))
    return change
