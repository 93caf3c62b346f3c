"""The outlines of blocks as arrays, and the arcs that follow from their edges.

Clockwise corners p; the edge that ends at a corner, with its length z, its unit vector t and its outward
normal (-ty, tx); the arc of a corner, of the circle with centre c and radius r. On an edge the roundings at
its two ends take a rounding length D each; a corner without a radius takes none.

A point that GENERATE has put on an edge has an arc too: a circle of radius zero, however the edge is bent.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from udec_ia.compiling.kernel_decorators import over_arrays
from udec_ia.kernels.geometry.block_shape import BULGE, FLAT, KEPT
from udec_ia.kernels.geometry.contact_geometry import BLUNT


class Outlines(NamedTuple):
    """The corners of all sound blocks, block by block, clockwise.

    With one element for each block: block: address; first, count: position of its corners; low, high: the box
    around them (n x 2); fine: rounding error of a length that is calculated from the present coordinates;
    slack: accumulated error of a coordinate of a corner or circle relative to the others.

    With one for each corner: corner: address; owner: index into `block`; before, after: index of the
    neighbours; p, c, t: corner, circle centre and edge (n x 2); z: length of the edge; r: radius; pointed:
    True for a point of an edge, by its grid-point.

    d: the rounding length; g: the slack between two contact codes.
    """

    block: Any
    first: Any
    count: Any
    low: Any
    high: Any
    fine: Any
    slack: Any
    corner: Any
    owner: Any
    before: Any
    after: Any
    p: Any
    c: Any
    t: Any
    z: Any
    r: Any
    pointed: Any
    d: float
    g: float


@over_arrays
def measure(o: Outlines, rounding: float, growth: float) -> None:
    """Fill in t, z, low, high, fine, slack. rounding: relative error of a real; growth: slack over fine."""
    for b in range(len(o.block)):
        greatest = 0.0
        for k in range(o.first[b], o.first[b] + o.count[b]):
            for axis in range(2):
                x = o.p[k, axis]
                o.t[k, axis] = x - o.p[o.before[k], axis]
                greatest = max(greatest, abs(x), abs(o.c[k, axis]))
                if k == o.first[b] or x < o.low[b, axis]:
                    o.low[b, axis] = x
                if k == o.first[b] or x > o.high[b, axis]:
                    o.high[b, axis] = x
            greatest = max(greatest, abs(o.r[k]))
            o.z[k] = math.sqrt(o.t[k, 0] * o.t[k, 0] + o.t[k, 1] * o.t[k, 1])
            o.t[k, 0], o.t[k, 1] = o.t[k, 0] / o.z[k], o.t[k, 1] / o.z[k]
        o.fine[b] = greatest * rounding
        o.slack[b] = o.fine[b] * growth


@over_arrays
def start_of(o: Outlines, j: int) -> float:
    """Distance from the start of the edge that ends at corner j to the end of the rounding there."""
    return o.d if o.r[o.before[j]] > 0 else 0.0


@over_arrays
def end_of(o: Outlines, j: int) -> float:
    """Distance along the edge that ends at corner j to the start of its rounding."""
    return o.z[j] - (o.d if o.r[j] > 0 else 0.0)


@over_arrays
def fineness(o: Outlines, i: int, j: int) -> float:
    """Rounding error of a length between corners i and j."""
    return 2 * max(o.fine[o.owner[i]], o.fine[o.owner[j]])


@over_arrays
def turn_at(o: Outlines, k: int) -> float:
    """Angle by which the outline turns clockwise at corner k; negative at a concave corner."""
    after = o.after[k]
    cross = o.t[k, 0] * o.t[after, 1] - o.t[k, 1] * o.t[after, 0]
    return math.atan2(-cross, o.t[k, 0] * o.t[after, 0] + o.t[k, 1] * o.t[after, 1])


@over_arrays
def fill_blocks(o: Outlines, centroid: Any, area: Any, far: Any) -> None:
    """Area within the corners of each block, and greatest distance of a corner from its centroid (n x 2)."""
    for b in range(len(o.block)):
        first, twice, square = o.first[b], 0.0, 0.0
        for k in range(first, first + o.count[b]):
            j = o.before[k]
            x, y = o.p[k, 0] - o.p[first, 0], o.p[k, 1] - o.p[first, 1]
            twice += x * (o.p[j, 1] - o.p[first, 1]) - y * (o.p[j, 0] - o.p[first, 0])
            x, y = o.p[k, 0] - centroid[b, 0], o.p[k, 1] - centroid[b, 1]
            square = max(square, x * x + y * y)
        area[b], far[b] = twice / 2, math.sqrt(square)


@over_arrays
def short_edges(o: Outlines, spare: float, found: Any) -> int:
    """Number of edges too short for the roundings at their ends, which may overlap by `spare`.

    found: corner at the end, length, and length of both roundings, as far as there are rows.
    """
    n = 0
    for k in range(len(o.corner)):
        ends = (0 if o.pointed[k] else 1) + (0 if o.pointed[o.before[k]] else 1)
        if not o.z[k] >= ends * (o.d - spare / 2) - 2 * o.slack[o.owner[k]]:
            if n < len(found):
                found[n, 0], found[n, 1], found[n, 2] = k, o.z[k], ends * o.d
            n += 1
    return n


@over_arrays
def circle_at(o: Outlines, k: int) -> tuple[float, float, float]:
    """Centre and radius of the circle that follows from the edges of corner k: D tan(theta/2).

    For a flat corner and a point of an edge: the corner itself, and radius 0.
    """
    angle = turn_at(o, k)
    if o.pointed[k] or not abs(math.sin(angle)) >= _flat_at(o, k):
        return o.p[k, 0], o.p[k, 1], 0.0
    radius = o.d / math.tan(angle / 2)
    x, y = o.p[k, 0] - o.d * o.t[k, 0], o.p[k, 1] - o.d * o.t[k, 1]
    return x + radius * o.t[k, 1], y - radius * o.t[k, 0], radius


@over_arrays
def _flat_at(o: Outlines, k: int) -> float:
    """Sine of the turn below which corner k is a point of a straight edge."""
    flat = min(BULGE * o.d * (1 / o.z[k] + 1 / o.z[o.after[k]]), FLAT)
    return flat * KEPT if o.r[k] != 0 else flat


@over_arrays
def fill_circles(o: Outlines, centre: Any, radius: Any) -> None:
    """Centre and radius of all corners, as circle_at has them."""
    for k in range(len(o.corner)):
        centre[k, 0], centre[k, 1], radius[k] = circle_at(o, k)


@over_arrays
def wrong_circles(o: Outlines, found: Any) -> int:
    """Number of corners whose circle does not follow from their edges.

    An edge is at least 2 D long, so an error s in its ends turns it by s/D and changes the radius by (1 +
    (R/D)^2)/2 times as much. If rounding decides whether a corner is flat, both circles are accepted. found:
    corner, centre and radius, as far as there are rows.
    """
    n = 0
    for k in range(len(o.corner)):
        x, y, radius = circle_at(o, k)
        rounding = o.slack[o.owner[k]]
        slack = rounding * (1 + (radius / o.d) * (radius / o.d))
        if abs(o.r[k] - radius) > slack or abs(o.c[k, 0] - x) > slack or abs(o.c[k, 1] - y) > slack:
            bend = abs(math.sin(turn_at(o, k)))
            if o.pointed[k] or not abs(bend - _flat_at(o, k)) < rounding / o.d:
                if n < len(found):
                    found[n, 0], found[n, 1], found[n, 2], found[n, 3] = k, x, y, radius
                n += 1
    return n


@over_arrays
def deepest(o: Outlines, i: int, x: float, y: float, on_edge: bool) -> tuple[float, float]:
    """The deepest place of arc i in the direction (x, y); for a blunt arc on an edge, one of its ends."""
    after = o.after[i]
    if on_edge and o.r[i] > BLUNT * o.d:
        if x * o.t[after, 0] + y * o.t[after, 1] > 0:
            return o.p[i, 0] + o.d * o.t[after, 0], o.p[i, 1] + o.d * o.t[after, 1]
        if x * o.t[i, 0] + y * o.t[i, 1] < 0:
            return o.p[i, 0] - o.d * o.t[i, 0], o.p[i, 1] - o.d * o.t[i, 1]
    return o.c[i, 0] + o.r[i] * x, o.c[i, 1] + o.r[i] * y


@over_arrays
def arc_at(o: Outlines, k: int) -> tuple[float, float, float, float, float, float]:
    """Start, middle and end of the arc of corner k.

    A corner without contacts, such as a concave one, is sharp: others meet its two edges.
    """
    px, py = o.p[k, 0], o.p[k, 1]
    if not o.r[k] > 0:
        return px, py, px, py, px, py
    after, x, y = o.after[k], px - o.c[k, 0], py - o.c[k, 1]
    part = o.r[k] / max(math.sqrt(x * x + y * y), o.fine[o.owner[k]])
    return (
        px - o.d * o.t[k, 0],
        py - o.d * o.t[k, 1],
        o.c[k, 0] + part * x,
        o.c[k, 1] + part * y,
        px + o.d * o.t[after, 0],
        py + o.d * o.t[after, 1],
    )


@over_arrays
def rounded(o: Outlines, corners: Any, points: Any) -> None:
    """Start, middle and end of the arcs of `corners`, in `points` (n x 3 x 2); nothing where it is -1."""
    for row in range(len(corners)):
        if corners[row] >= 0:
            arc = arc_at(o, corners[row])
            points[row, 0, 0], points[row, 0, 1] = arc[0], arc[1]
            points[row, 1, 0], points[row, 1, 1] = arc[2], arc[3]
            points[row, 2, 0], points[row, 2, 1] = arc[4], arc[5]


@over_arrays
def in_polygon(o: Outlines, block: int, x: float, y: float) -> bool:
    """True for a place in the polygon of a block (by the crossings of a ray)."""
    inside = False
    for j in range(o.first[block], o.first[block] + o.count[block]):
        i = o.before[j]
        if (o.p[i, 1] > y) != (o.p[j, 1] > y):
            along, up = o.p[j, 0] - o.p[i, 0], o.p[j, 1] - o.p[i, 1]
            left = along * (y - o.p[i, 1]) - up * (x - o.p[i, 0]) > 0
            if left == (o.p[j, 1] > o.p[i, 1]):
                inside = not inside
    return inside


@over_arrays
def in_rounded(o: Outlines, block: int, x: float, y: float) -> bool:
    """True for a place in the rounded outline of a block: the polygon without its tips."""
    for j in range(o.first[block], o.first[block] + o.count[block]):
        after, u, v = o.after[j], x - o.c[j, 0], y - o.c[j, 1]
        if o.r[j] > 0 and u * o.t[j, 0] + v * o.t[j, 1] >= 0 and u * o.t[after, 0] + v * o.t[after, 1] <= 0:
            from_tip = math.sqrt((x - o.p[j, 0]) * (x - o.p[j, 0]) + (y - o.p[j, 1]) * (y - o.p[j, 1]))
            if math.sqrt(u * u + v * v) > o.r[j] and from_tip <= o.d:
                return False
    return in_polygon(o, block, x, y)
