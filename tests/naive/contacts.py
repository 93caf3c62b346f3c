"""Contacts between rounded polygons by their definitions, every arc against every edge and every arc.

An outline is a list of (x, y), clockwise; every corner is rounded by the arc that touches its two edges at
the distance d. A convex corner has a radius d tan(theta/2), theta the interior angle; a concave or flat one
carries no contact and leaves its edges their full length.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import acos, cos, hypot, pi, sin, sqrt, tan

from shapely.geometry import Polygon

Point = tuple[float, float]
Outline = list[Point]
FLAT = 1e-3  # sine of the turn below which a corner is a point of a straight edge,
BULGE = 0.02  # of d: if it is not farther than that from the line through its neighbours


@dataclass(frozen=True)
class Corner:
    """A corner, the unit vectors of the edge that arrives and of the edge that leaves, and its circle."""

    point: Point
    arrives: Point
    leaves: Point
    length: float  # of the edge that arrives
    centre: Point
    radius: float  # 0 for a flat corner, negative for a concave one


@dataclass(frozen=True)
class Contact:
    """One numerical contact. part: index of the corner whose arc it is on, or where the edge ends."""

    blocks: tuple[int, int]
    on_edge: tuple[bool, bool]
    part: tuple[int, int]
    overlap: float
    point: Point


def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1]


def _minus(a: Point, b: Point) -> Point:
    return a[0] - b[0], a[1] - b[1]


def _unit(a: Point) -> Point:
    size = hypot(*a)
    return a[0] / size, a[1] / size


def round_corners(outline: Outline, d: float) -> list[Corner]:
    """The corners of `outline` with their circles."""
    corners = []
    for i, point in enumerate(outline):
        before, after = outline[i - 1], outline[(i + 1) % len(outline)]
        arrives, leaves = _unit(_minus(point, before)), _unit(_minus(after, point))
        turn = arrives[1] * leaves[0] - arrives[0] * leaves[1]  # sine, positive at a convex corner
        centre, radius = point, 0.0
        base = _minus(after, before)
        stands_out = abs(base[0] * (point[1] - before[1]) - base[1] * (point[0] - before[0])) / hypot(*base)
        if abs(turn) >= FLAT or stands_out >= BULGE * d:
            theta = pi - acos(max(-1.0, min(1.0, _dot(arrives, leaves))))
            radius = d * tan(theta / 2)
            bisector = _unit(_minus(leaves, arrives))  # from the corner to the centre, either way it turns
            reach = sqrt(d * d + radius * radius)
            centre = point[0] + reach * bisector[0], point[1] + reach * bisector[1]
            radius = radius if turn > 0 else -radius
        corners.append(Corner(point, arrives, leaves, hypot(*_minus(point, before)), centre, radius))
    return corners


def _arc_edge(arc: Corner, start: Corner, end: Corner, d: float) -> tuple[float, Point] | None:
    """Overlap and contact point of an arc with the edge from `start` to `end`; None off the straight part."""
    along = _dot(_minus(arc.centre, start.point), end.arrives)
    low = d if start.radius > 0 else 0.0
    high = end.length - (d if end.radius > 0 else 0.0)
    if arc.radius <= 0 or not low <= along <= high:
        return None
    normal = -end.arrives[1], end.arrives[0]
    overlap = arc.radius - _dot(_minus(arc.centre, start.point), normal)
    reach = arc.radius - overlap / 2
    return overlap, (arc.centre[0] - reach * normal[0], arc.centre[1] - reach * normal[1])


def _arc_arc(a: Corner, b: Corner) -> tuple[float, Point] | None:
    """Overlap and contact point of two arcs; None if one does not face the other's centre."""
    line = _minus(b.centre, a.centre)
    back = -line[0], -line[1]
    if a.radius <= 0 or b.radius <= 0 or line == (0.0, 0.0):
        return None
    for corner, way in ((a, line), (b, back)):
        if _dot(way, corner.arrives) < 0 or _dot(way, corner.leaves) > 0:
            return None
    overlap = a.radius + b.radius - hypot(*line)
    reach, unit = a.radius - overlap / 2, _unit(line)
    return overlap, (a.centre[0] + reach * unit[0], a.centre[1] + reach * unit[1])


def _faces(arc: Corner, edge: Corner) -> bool:
    """True if the arc's corner points towards the edge, so that it meets it from outside."""
    return _dot(_minus(arc.point, arc.centre), (-edge.arrives[1], edge.arrives[0])) < 0


def contacts(
    blocks: dict[int, Outline], d: float, gap: float = 0.0, deepest: float | None = None
) -> list[Contact]:
    """All contacts between the blocks whose overlap is at least -gap and at most `deepest` (default d/2)."""
    deepest = d / 2 if deepest is None else deepest
    rounded = {name: round_corners(outline, d) for name, outline in blocks.items()}
    found = []
    for one, two in combinations(rounded, 2):
        for i, a in enumerate(rounded[one]):
            for j, b in enumerate(rounded[two]):
                before_a, before_b = rounded[one][i - 1], rounded[two][j - 1]
                tries = (
                    ((False, False), _arc_arc(a, b)),
                    ((False, True), _arc_edge(a, before_b, b, d) if _faces(a, b) else None),
                    ((True, False), _arc_edge(b, before_a, a, d) if _faces(b, a) else None),
                )
                for on_edge, result in tries:
                    if result is not None and -gap <= result[0] <= deepest:
                        found.append(Contact((one, two), on_edge, (i, j), *result))
    return found


def rounded_polygon(outline: Outline, d: float, pieces: int = 64) -> Polygon:
    """The block as shapely sees it: convex corners replaced by arcs of `pieces` chords."""
    points: list[Point] = []
    for corner in round_corners(outline, d):
        if corner.radius <= 0:
            points.append(corner.point)
            continue
        turn = acos(max(-1.0, min(1.0, _dot(corner.arrives, corner.leaves))))
        normal = -corner.arrives[1], corner.arrives[0]
        for k in range(pieces + 1):
            c, s = cos(turn * k / pieces), -sin(turn * k / pieces)
            x, y = c * normal[0] - s * normal[1], s * normal[0] + c * normal[1]
            points.append((corner.centre[0] + corner.radius * x, corner.centre[1] + corner.radius * y))
    return Polygon(points)


def distance(one: Outline, two: Outline, d: float) -> float:
    """Distance of two rounded blocks; 0 if they touch or overlap."""
    return float(rounded_polygon(one, d).distance(rounded_polygon(two, d)))


def common_area(one: Outline, two: Outline, d: float) -> float:
    """Area that two rounded blocks share."""
    return float(rounded_polygon(one, d).intersection(rounded_polygon(two, d)).area)
