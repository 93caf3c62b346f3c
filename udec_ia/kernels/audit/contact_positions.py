"""Positions at which the outlines of two blocks touch, and positions of contacts along each outline."""

from __future__ import annotations

import math
from typing import Any

from udec_ia.compiling.kernel_decorators import over_arrays
from udec_ia.kernels.audit.outline_arrays import Outlines, deepest, end_of, start_of, turn_at
from udec_ia.kernels.geometry.contact_geometry import BLUNT
from udec_ia.layout import offsets as g

PASSED_OVER = -2  # a contact that does not restrict the order of others
OVERLAP, PLACE, LIMIT = 0, 1, 2  # kinds of faults of a contact


@over_arrays
def touching(o: Outlines, code: Any, i: Any, j: Any, overlap: Any, point: Any) -> None:
    """Overlap, and point in its middle, of contacts of these codes at corners i (KCP1) and j (KCP2)."""
    for k in range(len(code)):
        one, two = i[k], j[k]
        if code[k] == g.CORNER_CORNER:
            x, y = o.c[two, 0] - o.c[one, 0], o.c[two, 1] - o.c[one, 1]
            distance = math.sqrt(x * x + y * y)
            x, y = x / distance, y / distance
            u, v = o.c[one, 0] + o.r[one] * x, o.c[one, 1] + o.r[one] * y
            overlap[k] = o.r[one] + o.r[two] - distance
        else:
            arc, edge = (two, one) if code[k] == g.EDGE_CORNER else (one, two)
            x, y = o.t[edge, 1], -o.t[edge, 0]  # away from the arc's block
            u, v = deepest(o, arc, x, y, True)
            overlap[k] = (u - o.p[edge, 0]) * x + (v - o.p[edge, 1]) * y
        point[k, 0], point[k, 1] = u - overlap[k] / 2 * x, v - overlap[k] / 2 * y


@over_arrays
def wrong_contacts(
    noted: Any, x: Any, y: Any, overlap: Any, point: Any, slack: Any, limit: float, found: Any
) -> int:
    """Number of contacts whose overlap or place differs from the outlines, and of overlaps beyond the limit.

    noted, x, y: overlap and place stored in the contacts. found: contact, and OVERLAP, PLACE or LIMIT, as far
    as there are rows.
    """
    n = 0
    for k in range(len(noted)):
        away = max(abs(x[k] - point[k, 0]), abs(y[k] - point[k, 1]))
        for what in (OVERLAP, PLACE, LIMIT):
            if what == OVERLAP:
                is_wrong = abs(noted[k] - overlap[k]) > slack[k]
            elif what == PLACE:
                is_wrong = away > slack[k]
            else:
                is_wrong = max(noted[k], overlap[k]) > limit + slack[k]
            if is_wrong:
                if n < len(found):
                    found[n, 0], found[n, 1] = k, what
                n += 1
    return n


@over_arrays
def locate_on_outlines(o: Outlines, code: Any, corner: Any, others: Any, edge: int, places: Any) -> None:
    """The places of contacts of these codes on one of their blocks (see checker/contact_places.py).

    corner, others: the corner on that block, and on the other; edge: code of contacts on an edge. places (n x
    4): distance of a contact before the start of its segment, and beyond its end; the lever; and the position
    along the outline.
    """
    for row in range(len(code)):
        k, other = corner[row], others[row]
        if code[row] == g.CORNER_CORNER:
            _on_arc_of_two(o, k, other, places[row])
        elif code[row] == edge:
            _on_edge(o, k, other, places[row])
        else:
            along = _along_arc(o, k, o.t[other, 1], -o.t[other, 0])
            places[row, 0], places[row, 1], places[row, 2], places[row, 3] = -math.inf, -math.inf, 1.0, along


@over_arrays
def _on_arc_of_two(o: Outlines, k: int, other: int, place: Any) -> None:
    """On the arc of corner k, which must face the centre of the other arc."""
    after, x, y = o.after[k], o.c[other, 0] - o.c[k, 0], o.c[other, 1] - o.c[k, 1]
    place[0], place[1] = -(x * o.t[k, 0] + y * o.t[k, 1]), x * o.t[after, 0] + y * o.t[after, 1]
    distance = math.sqrt(x * x + y * y)
    far = o.r[other] > BLUNT * o.d and distance > 0
    place[2] = max(o.r[k], o.d) / distance if far else 1.0
    place[3] = _along_arc(o, k, x, y)


@over_arrays
def _on_edge(o: Outlines, k: int, other: int, place: Any) -> None:
    """On the edge that ends at corner k: a contact must lie between its roundings."""
    before, start, end = o.before[k], start_of(o, k), end_of(o, k)
    u, v = deepest(o, other, o.t[k, 1], -o.t[k, 0], True)
    along = (u - o.p[before, 0]) * o.t[k, 0] + (v - o.p[before, 1]) * o.t[k, 1]
    place[0] = -_past(o, before, other) if o.r[before] == 0 else start - along
    place[1] = _past(o, k, other) if o.r[k] == 0 else along - end
    place[2] = 1.0
    place[3] = min(max(along, start), max(end, start))


@over_arrays
def _past(o: Outlines, k: int, other: int) -> float:
    """Distance by which the touching part of corner `other` is past the bisector at corner k, clockwise."""
    after = o.after[k]
    x, y = (o.t[k, 0] + o.t[after, 0]) / 2, (o.t[k, 1] + o.t[after, 1]) / 2
    u, v = deepest(o, other, y, -x, True)
    return (u - o.p[k, 0]) * x + (v - o.p[k, 1]) * y


@over_arrays
def _along_arc(o: Outlines, k: int, x: float, y: float) -> float:
    """Length along the arc of corner k to where it faces the direction (x, y), and length of the edge."""
    turn = max(turn_at(o, k), 0.0)
    tx, ty = o.t[k, 0], o.t[k, 1]
    angle = math.atan2(ty * y + tx * x, tx * y - ty * x)  # clockwise from the edge's normal
    if angle < turn / 2 - math.pi:  # facing away, nearer to the end
        angle += 2 * math.pi
    return end_of(o, k) + o.r[k] * min(max(angle, 0.0), turn)


@over_arrays
def contacts_out_of_order(
    lists: Any, contact: Any, row: Any, side: Any, index: Any, along: Any, slack: Any, found: Any
) -> int:
    """Number of contacts that lie behind the next one in a list, with no corner between them.

    lists, contact, row, side: as in audit/domain_faces.py. index: by row, number of a contact among those
    that have a place; -1 for one without a place, PASSED_OVER for one that does not restrict the order of
    others. along: the places on each side; slack: tolerance of each. found: list, index of both and distance
    of the first behind the second, as far as there are rows.
    """
    n = 0
    for r in range(len(lists)):
        last = -1
        for k in range(lists[r, 0], lists[r, 0] + lists[r, 1]):
            if not contact[k]:
                last = -1
            elif row[k] >= 0 and index[row[k]] != PASSED_OVER:
                if last >= 0 and index[row[last]] >= 0 and index[row[k]] >= 0:
                    one, two = index[row[last]], index[row[k]]
                    behind = along[side[last], one] - along[side[k], two]
                    if behind > slack[one] + slack[two]:
                        if n < len(found):
                            found[n, 0], found[n, 1], found[n, 2], found[n, 3] = r, one, two, behind
                        n += 1
                last = k
    return n
