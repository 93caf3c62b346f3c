"""Points of structures belong to blocks and zones as they say, and lie in them: invariants 6 and 7.

A point names a zone if its block has zones, and one of that block. It lies in its block, to a rounding
length: points on joints may be a little outside, and move with rounding errors of their own.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from udec_ia.checker.block_members import zoned
from udec_ia.checker.checked_state import State
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.kernels.geometry.point_distance import distance_outside
from udec_ia.reader.field_reading import Numbers

POINTS = (
    ("bolt", "KAB1", "KAZ1", "KAX1", "KAY1"),
    ("bolt", "KAB2", "KAZ2", "KAX2", "KAY2"),
    ("node", "KNBL", "KNZN", "KNAX", "KNAY"),
)
DISTANCE = InterpretWhenSmall(distance_outside, 2e2)  # points


def _points(state: State) -> Iterator[tuple[str, Numbers, tuple[str, ...], Numbers, Numbers]]:
    """For each kind of points: kind, addresses, names of fields, blocks and zones of those with a block."""
    for kind, *names in POINTS:
        block, zone = (state.column(kind, name) for name in names[:2])
        has = block != 0
        yield kind, state.address[kind][has], tuple(names), block[has], zone[has]


def check_points(state: State) -> None:
    """Invariant 6: the zone of a point is one of its block, which has zones then, and only then."""
    with_zones = zoned(state)
    for kind, address, (_, to_zone, *_), block, zone in _points(state):
        owner = np.append(state.owner["zone"], 0)[state.rows("zone", zone)]
        due = np.where(np.isin(block, with_zones), block, 0)
        for k in np.flatnonzero(np.where(zone != 0, owner, 0) != due):
            what = "no zone of it" if due[k] else "a zone, but its block has none"
            state.report(6, f"{to_zone} of {kind}@{address[k]}, in block@{block[k]}, is {zone[k]}: {what}")


def check_places_of_points(state: State) -> None:
    """Invariant 7: points lie in their blocks; not looked at if links or outlines are broken."""
    if state.found:
        return
    for kind, address, (to_block, _, *place), block, _ in _points(state):
        x, y = (state.read(address, name).astype(np.float64) for name in place)
        for k in range(len(address)):
            at = float(x[k]), float(y[k])
            away = DISTANCE(1, state.h, int(block[k]), *at)
            if not away <= state.tolerance("DTOL"):
                text = f"{kind}@{address[k]} has a point at ({at[0]:g}, {at[1]:g}), {away:g} m outside"
                state.report(7, f"{text} of block@{block[k]}, its {to_block}")
