"""Intersections of two outlines: an arc and an edge, two arcs, two edges that cross.

Brute force: every arc of one block against every edge and arc of the other. A point of an arc is at most D
away from its corner, another D deep under the edge or beside its end, and farther along the edge if the arc
does not face it. So boxes rule out most pairs.
"""

from __future__ import annotations

import math
from typing import Any

from udec_ia.compiling.kernel_decorators import over_arrays
from udec_ia.kernels.audit.outline_arrays import (
    Outlines,
    arc_at,
    end_of,
    fineness,
    in_polygon,
    in_rounded,
    start_of,
)
from udec_ia.kernels.geometry.contact_geometry import BLUNT

AWRY = 0.5  # sine of the angle up to which the end of an arc that does not face an edge is tested against it
AWRY_POINT = 0.2  # the same for a point of an edge: a contact is formed up to an angle of 0.25
FAR = 3.0  # greatest distance, in rounding lengths, of a corner from an edge that its arc meets
EDGE, ARC = 0, 1  # kinds of segments that an arc meets


@over_arrays
def intersections_without_contact(
    o: Outlines, pairs: Any, contacts: Any, points: Any, near: float, late: float, rows: Any
) -> int:
    """Number of intersections of two blocks without a contact near them.

    pairs: two columns of blocks. contacts: index of their first contact in `points`, and number of their
    contacts. A contact is near if its distance is at most `near` plus the overlap, and D more for an
    intersection of, or beside, a blunt arc, if the overlap or the distance to the arc is at most `late`.
    rows: corner of the arc, the other corner, EDGE or ARC, point and overlap, as far as there are rows.
    """
    found = 0
    for k in range(len(pairs)):
        for turn in range(2):
            one, two = pairs[k, turn], pairs[k, 1 - turn]
            around = o.d + o.slack[one]
            for i in range(o.first[one], o.first[one] + o.count[one]):
                if not is_arc(o, i) or not _near_block(o, i, two, around):
                    continue
                far = FAR * o.d + o.slack[one] + AWRY * abs(o.r[i])
                for j in range(o.first[two], o.first[two] + o.count[two]):
                    if not _near_edge(o, i, j, far):
                        continue
                    for what in range(2 if one < two else 1):  # two arcs once
                        if what == EDGE:
                            meets, x, y, depth = arc_in_edge(o, i, j)
                        else:
                            meets, x, y, depth = arc_in_arc(o, i, j)
                        if not meets:
                            continue
                        first, many = contacts[k, 0], contacts[k, 1]
                        if _has_near(points, first, many, x, y, near + depth):
                            continue
                        if _is_late(o, i, j, x, y, depth, late) and _has_near(
                            points, first, many, x, y, near + depth + o.d
                        ):
                            continue
                        if found < len(rows):
                            rows[found, 0], rows[found, 1], rows[found, 2] = i, j, what
                            rows[found, 3], rows[found, 4], rows[found, 5] = x, y, depth
                        found += 1
    return found


@over_arrays
def is_arc(o: Outlines, i: int) -> bool:
    """True for a corner that may touch edges and arcs of others."""
    return o.r[i] > 0 or o.pointed[i]


@over_arrays
def _near_block(o: Outlines, i: int, block: int, beyond: float) -> bool:
    """True if corner i is in the box of the block, or not more than that beyond its sides."""
    x, y = o.p[i, 0], o.p[i, 1]
    along = x >= o.low[block, 0] - beyond and x <= o.high[block, 0] + beyond
    return along and y >= o.low[block, 1] - beyond and y <= o.high[block, 1] + beyond


@over_arrays
def _near_edge(o: Outlines, i: int, j: int, far: float) -> bool:
    """True if corner i is in the box around the edge of corner j, or not more than that beyond its sides."""
    k = o.before[j]
    for axis in range(2):
        x, one, two = o.p[i, axis], o.p[j, axis], o.p[k, axis]
        if x + far < min(one, two) or x - far > max(one, two):
            return False
    return True


@over_arrays
def _has_near(points: Any, first: int, many: int, x: float, y: float, reach: float) -> bool:
    """True if one of the points is within `reach` of a place."""
    for m in range(first, first + many):
        u, v = x - points[m, 0], y - points[m, 1]
        if math.sqrt(u * u + v * v) <= reach:
            return True
    return False


@over_arrays
def _is_late(o: Outlines, i: int, j: int, x: float, y: float, depth: float, late: float) -> bool:
    """True for a meeting of a blunt arc, or beside one along the edge of corner j: see `late` above."""
    blunt = BLUNT * o.d
    if o.r[i] > blunt and depth <= late:
        return True
    for turn in range(2):
        corner, end = (o.before[j], o.d) if turn else (j, -o.d)
        if o.r[corner] > blunt:
            away = (o.p[corner, 0] + end * o.t[j, 0] - x) * o.t[j, 0]
            away += (o.p[corner, 1] + end * o.t[j, 1] - y) * o.t[j, 1]
            if abs(away) <= late:
                return True
    return False


@over_arrays
def arc_in_edge(o: Outlines, i: int, j: int) -> tuple[bool, float, float, float]:
    """True if the deepest place of arc i under the edge of corner j is on the edge or in the block.

    Returns the place and its depth as well. The deepest place of an arc that does not face the edge is one of
    its ends. The centre of a blunt arc may then be far away along the edge. A place of an edge that does not
    face it has deeper places beside it, where its own edge continues.
    """
    k, after, blunt = o.before[j], o.after[i], o.r[i] > BLUNT * o.d
    tx, ty, start, end = o.t[j, 0], o.t[j, 1], start_of(o, j), end_of(o, j)
    along = (o.c[i, 0] - o.p[k, 0]) * tx + (o.c[i, 1] - o.p[k, 1]) * ty
    if not blunt and not (along >= start and along <= end):
        return False, 0.0, 0.0, 0.0
    if not ty * (o.t[i, 1] + o.t[after, 1]) + tx * (o.t[i, 0] + o.t[after, 0]) < 0:  # normals
        return False, 0.0, 0.0, 0.0
    early, late = ty * o.t[i, 0] - tx * o.t[i, 1], ty * o.t[after, 0] - tx * o.t[after, 1]
    reach = 0.0 if o.pointed[i] else o.d
    if early < 0:
        x, y = o.p[i, 0] - reach * o.t[i, 0], o.p[i, 1] - reach * o.t[i, 1]
    elif late > 0:
        x, y = o.p[i, 0] + reach * o.t[after, 0], o.p[i, 1] + reach * o.t[after, 1]
    else:
        x, y = o.c[i, 0] + o.r[i] * ty, o.c[i, 1] - o.r[i] * tx
    along = (x - o.p[k, 0]) * tx + (y - o.p[k, 1]) * ty
    if blunt and not (along >= start and along <= end):
        return False, 0.0, 0.0, 0.0
    depth = (x - o.p[j, 0]) * ty - (y - o.p[j, 1]) * tx
    slack = fineness(o, i, j)
    awry = AWRY_POINT if o.pointed[i] else AWRY
    if not (depth >= -min(slack, o.g) and depth <= o.d and -early <= awry and late <= awry):
        return False, 0.0, 0.0, 0.0
    return depth <= slack or in_polygon(o, o.owner[j], x, y), x, y, depth


@over_arrays
def arc_in_arc(o: Outlines, i: int, j: int) -> tuple[bool, float, float, float]:
    """True if arcs i and j face each other and overlap along their line of centres; place and overlap."""
    x, y = o.c[j, 0] - o.c[i, 0], o.c[j, 1] - o.c[i, 1]
    distance = math.sqrt(x * x + y * y)
    depth = o.r[i] + o.r[j] - distance
    if not (is_arc(o, j) and depth >= -min(fineness(o, i, j), o.g) and distance > 0):
        return False, 0.0, 0.0, 0.0
    if not (_faces(o, i, x, y) and _faces(o, j, -x, -y)):
        return False, 0.0, 0.0, 0.0
    middle = o.r[i] - depth / 2
    return True, o.c[i, 0] + middle * (x / distance), o.c[i, 1] + middle * (y / distance), depth


@over_arrays
def _faces(o: Outlines, k: int, x: float, y: float) -> bool:
    """True if the direction (x, y) leads from the centre of corner k through its arc."""
    after = o.after[k]
    if not (x * o.t[k, 0] + y * o.t[k, 1] >= 0 and x * o.t[after, 0] + y * o.t[after, 1] <= 0):
        return False
    return y * (o.t[k, 0] + o.t[after, 0]) - x * (o.t[k, 1] + o.t[after, 1]) > 0


@over_arrays
def mark_crossing(o: Outlines, pairs: Any, cross: Any) -> None:
    """Set `cross` for pairs of blocks with crossing straight edges, or with an arc's end of one in the other.

    Only parts in the boxes of both blocks are tested.
    """
    for k in range(len(pairs)):
        a, b = pairs[k, 0], pairs[k, 1]
        cross[k] = _reaches_into(o, a, b) or _reaches_into(o, b, a) or _edges_cross(o, a, b)


@over_arrays
def _reaches_into(o: Outlines, inner: int, outer: int) -> bool:
    """True if an end or the middle of an arc of block `inner` lies in block `outer`."""
    for k in range(o.first[inner], o.first[inner] + o.count[inner]):
        if _near_block(o, k, outer, o.d):
            arc = arc_at(o, k)
            for x, y in ((arc[0], arc[1]), (arc[2], arc[3]), (arc[4], arc[5])):
                if _in_box(o, inner, x, y) and _in_box(o, outer, x, y) and in_rounded(o, outer, x, y):
                    return True
    return False


@over_arrays
def _in_box(o: Outlines, block: int, x: float, y: float) -> bool:
    """True for a place in the box around the corners of a block."""
    along = x >= o.low[block, 0] and x <= o.high[block, 0]
    return along and y >= o.low[block, 1] and y <= o.high[block, 1]


@over_arrays
def _edges_cross(o: Outlines, a: int, b: int) -> bool:
    """True if the straight parts of two edges cross, one of each block."""
    for i in range(o.first[a], o.first[a] + o.count[a]):
        if _in_both_boxes(o, i, b):
            for j in range(o.first[b], o.first[b] + o.count[b]):
                if _in_both_boxes(o, j, a) and _cuts(o, i, j) and _cuts(o, j, i):
                    return True
    return False


@over_arrays
def _in_both_boxes(o: Outlines, i: int, block: int) -> bool:
    """True if the edge of corner i has a part in the box of another block."""
    k = o.before[i]
    for axis in range(2):
        one, two = o.p[i, axis], o.p[k, axis]
        if min(one, two) > o.high[block, axis] or max(one, two) < o.low[block, axis]:
            return False
    return True


@over_arrays
def _cuts(o: Outlines, i: int, j: int) -> bool:
    """True if the ends of the straight part of edge i lie on the two sides of edge j."""
    k, slack = o.before[i], fineness(o, i, j)
    x, y, start, end = o.p[k, 0] - o.p[j, 0], o.p[k, 1] - o.p[j, 1], start_of(o, i), end_of(o, i)
    u = o.t[j, 0] * (y + start * o.t[i, 1]) - o.t[j, 1] * (x + start * o.t[i, 0])
    v = o.t[j, 0] * (y + end * o.t[i, 1]) - o.t[j, 1] * (x + end * o.t[i, 0])
    return min(u, v) < -slack and max(u, v) > slack
