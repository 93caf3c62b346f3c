"""The points inside a meshed outline, and the triangulation of all points into zones.

Lengths are in units of the given edge of zones. An outline is an array of points, clockwise. The points of a
mesh are those of the outline, in this order, then those inside. Side k of a zone runs from vertex k to the
next.

The constrained Delaunay triangulation of the package pythoncdt is exact and keeps every edge of the outline.
Its zones have the greatest least angle that the points allow. So good zones need good points: a lattice of
equilateral triangles at some distance from the outline, more points in the middle of sides that are too long,
and a shift of all points.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from udec_ia.errors import UdecError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ROW = 3**0.5 / 2  # distance of the rows of the lattice
SHORTEST = 0.75  # least spacing of a lattice that follows a fine outline
CLEAR = 0.6  # distance of the lattice from the outline, in its spacing
LONGEST = 1.5  # a longer side gets a point in its middle,
ROOM = 0.45  # if this is its least distance from the other sides of the two zones
EXPONENTS = range(0, 24, 2)  # of the weights in `relax`, one for each step
THIN = 100.0  # greatest weight of a zone to the power 1
NEXT, LAST = [1, 2, 0], [2, 0, 1]  # for each vertex of a zone the next one, and the one before


def triangulate(points: Floats, b: int) -> Ints:
    """The zones, clockwise, of points of which the first `b` are the outline; none if it crosses itself."""
    try:
        import pythoncdt as cdt
    except ImportError:
        missing = "the package pythoncdt, which automatic zones need, is not installed"
        raise UdecError(23, missing, parameter="mode") from None
    corner = np.arange(b, dtype=np.uint32)
    vertices: Any = np.ascontiguousarray(points)  # mypy knows Buffer in Python 3.12 only
    edges: Any = np.stack([corner, following(corner)], axis=1)
    order, crossing = cdt.VertexInsertionOrder.AUTO, cdt.IntersectingConstraintEdges.NOT_ALLOWED
    t = cdt.Triangulation(order, crossing, 0.0)
    try:
        t.insert_vertices(vertices)
        t.insert_edges(edges)
    except RuntimeError:  # crossing edges, or the same point twice
        return np.empty((0, 3), np.int64)
    t.erase_outer_triangles()
    return t.triangles_array()["vertices"][:, ::-1].astype(np.int64)


def following(ring: Any) -> Any:
    """For each row the next one, the first row for the last."""
    return np.roll(ring, -1, axis=0)


def sides(points: Floats, zones: Ints) -> Floats:
    """The lengths of the three sides of each zone."""
    at = points[zones]
    return np.asarray(np.linalg.norm(at[:, NEXT] - at, axis=2))


def areas(points: Floats, zones: Ints) -> Floats:
    """The area of each zone, positive if it runs clockwise."""
    at = points[zones]
    u, v = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    return np.asarray(0.5 * (u[:, 1] * v[:, 0] - u[:, 0] * v[:, 1]))


def common_sides(zones: Ints) -> tuple[Ints, Ints]:
    """The sides that two zones have in common, 3 * zone + side for the one zone and for the other."""
    ends = np.sort(np.stack([zones, zones[:, NEXT]], axis=-1).reshape(-1, 2), axis=1)
    order = np.lexsort(ends.T)
    twice = np.flatnonzero((ends[order[1:]] == ends[order[:-1]]).all(axis=1))
    return order[twice], order[twice + 1]


def lattice(outline: Floats, parts: Ints) -> Floats:
    """Points of a lattice of equilateral triangles inside the outline, at a distance from it.

    Its rows are at right angles to the longest edge of the block: only zones of different orientation can be
    paired, and along the edge all zones would have the same. parts: number of parts of each edge of the
    block.
    """
    start = np.cumsum(parts) - parts
    first = outline[start]
    along = following(first) - first
    lengths = np.linalg.norm(along, axis=1)
    k = int(np.argmax(lengths))
    spacing = lengths[k] / parts[k] if lengths[k] / parts[k] >= SHORTEST else 1.0
    u = along[k] / lengths[k]
    frame = np.stack([[u[1], -u[0]], u])
    ring = (outline - first[k]) @ frame.T / spacing
    row, column = _inside(ring)
    keep = ~np.isin(_key(row, column), _near(ring))
    return np.asarray(first[k] + spacing * (_place(row, column)[keep] @ frame))


def _place(row: Ints, column: Ints) -> Floats:
    """Coordinates in the frame of the lattice: each row is shifted by half a place."""
    return np.stack([column + row / 2, row * ROW], axis=-1)


def _key(row: Ints, column: Ints) -> Ints:
    return row * (1 << 32) + column


def _ranges(start: Ints, count: Ints) -> Ints:
    """start[0], start[0] + 1, ... (count[0] numbers), start[1], ..."""
    return np.repeat(start - np.cumsum(count) + count, count) + np.arange(count.sum())


def _inside(ring: Floats) -> tuple[Ints, Ints]:
    """Rows and columns of the lattice points inside: from a row's 1st crossing to its 2nd, 3rd to 4th ..."""
    end = following(ring)
    low, high = np.minimum(ring[:, 1], end[:, 1]), np.maximum(ring[:, 1], end[:, 1])
    before = np.floor(low / ROW).astype(np.int64)
    count = np.floor(high / ROW).astype(np.int64) - before
    k, row = np.repeat(np.arange(len(ring)), count), _ranges(before + 1, count)
    part = (row * ROW - ring[k, 1]) / (end[k, 1] - ring[k, 1])
    x = ring[k, 0] + part * (end[k, 0] - ring[k, 0]) - row / 2
    order = np.lexsort((x, row))
    row, enter, leave = row[order][::2], x[order][::2], x[order][1::2]
    column = np.ceil(enter).astype(np.int64)
    count = np.maximum(np.floor(leave).astype(np.int64) - column + 1, 0)
    return np.repeat(row, count), _ranges(column, count)


def _near(ring: Floats) -> Ints:
    """Keys of the lattice points nearer than CLEAR to the outline, whose edges are 2 long at most."""
    a, along = ring[:, None], (following(ring) - ring)[:, None]
    middle = ring + along[:, 0] / 2
    rows, columns = np.mgrid[-3:4, -4:5].reshape(2, -1)
    row = np.rint(middle[:, 1] / ROW).astype(np.int64)[:, None] + rows
    column = np.rint(middle[:, 0] - row[:, 0] / 2).astype(np.int64)[:, None] + columns
    away = _place(row, column) - a
    part = np.clip((away * along).sum(-1) / (along * along).sum(-1), 0, 1)
    distance = np.linalg.norm(away - part[..., None] * along, axis=-1)
    return np.asarray(_key(row, column)[distance < CLEAR])


def fill(points: Floats, b: int) -> Floats:
    """The points, and one in the middle of each side that is too long and has ROOM around it."""
    while True:
        zones = triangulate(points, b)
        one, other = common_sides(zones)
        lengths, area = sides(points, zones), areas(points, zones)
        long = lengths.ravel()[one] > LONGEST
        long &= _roomy(lengths, area, one) & _roomy(lengths, area, other)
        one, other = one[long], other[long]
        if not len(one):
            return points
        rank = np.empty(len(one), np.int64)
        rank[np.argsort(-lengths.ravel()[one], kind="stable")] = np.arange(len(one))
        first = np.full(len(zones), len(one))  # of the sides of each zone the longest
        np.minimum.at(first, np.concatenate([one, other]) // 3, np.tile(rank, 2))
        side = one[(first[one // 3] == rank) & (first[other // 3] == rank)]
        ends = zones.ravel()[side], zones[:, NEXT].ravel()[side]
        points = np.vstack([points, (points[ends[0]] + points[ends[1]]) / 2])


def _roomy(lengths: Floats, area: Floats, side: Ints) -> NDArray[np.bool_]:
    """True where the middle of the side is ROOM from the zone's other sides."""
    zone, k = np.divmod(side, 3)
    others = lengths[zone]
    others[np.arange(len(zone)), k] = 0
    return np.asarray(area[zone] >= ROOM * others.max(axis=1))


def relax(points: Floats, ring: Ints, zones: Ints | None = None) -> tuple[Floats, Ints]:
    """The best points and zones of several steps that move all points but those of the ring.

    Given zones stay as they are; without them the ring must be the first points.
    """
    new = triangulate(points, len(ring)) if zones is None else zones
    if len(ring) == len(points):
        return points, new
    best, found = _poorest(points, new, ring), (points, new)
    for exponent in EXPONENTS:
        points = _moved(points, new, ring, exponent)
        new = triangulate(points, len(ring)) if zones is None else zones
        poorest = _poorest(points, new, ring)
        if poorest >= best:
            best, found = poorest, (points, new)
    return found


def shapes(points: Floats, zones: Ints) -> Floats:
    """1 for an equilateral zone, towards 0 for a thin one: area over sum of the sides squared."""
    return np.asarray(4 * 3**0.5 * areas(points, zones) / (sides(points, zones) ** 2).sum(axis=1))


def _poorest(points: Floats, zones: Ints, ring: Ints) -> tuple[float, float]:
    """The worst shape of all zones, and of the zones with a point inside."""
    each = shapes(points, zones)
    inside = each[~np.isin(zones, ring).all(axis=1)]
    return float(each.min()), float(inside.min(initial=1))


def _moved(points: Floats, zones: Ints, ring: Ints, exponent: int) -> Floats:
    """The points, except those of the ring, moved half the way to the mean of the targets of their zones.

    The target of a zone for a vertex makes the zone equilateral. Its weight is 1 over its shape to the power
    `exponent`: with 0 all zones count alike, with a high power only the worst. No zone turns over.
    """
    at = points[zones]
    weight = np.minimum(1 / shapes(points, zones), THIN) ** exponent
    start, end = at[:, NEXT], at[:, LAST]
    along = end - start
    wanted = (start + end) / 2 + ROW * np.stack([along[..., 1], -along[..., 0]], axis=-1)
    names = zones.ravel()
    total = np.bincount(names, np.repeat(weight, 3), len(points))
    target = [
        np.bincount(names, (weight[:, None] * wanted[..., c]).ravel(), len(points)) / total for c in (0, 1)
    ]
    moved = (points + np.stack(target, axis=1)) / 2
    moved[ring] = points[ring]
    while True:
        spoilt = areas(moved, zones) <= areas(points, zones) / 10
        back = np.unique(zones[spoilt])
        if (moved[back] == points[back]).all():
            return moved
        moved[back] = points[back]
