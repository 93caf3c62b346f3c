"""Polygons by a geometry library and by long arithmetic: slow, and of other formulas than the program's.

An outline is a list of (x, y), clockwise.
"""

from __future__ import annotations

import mpmath
import shapely
from shapely.geometry import LineString, Polygon
from shapely.ops import split as shapely_split

Point = tuple[float, float]
Outline = list[Point]


def area(outline: Outline) -> float:
    """Area by shapely; always positive."""
    return float(Polygon(outline).area)


def centroid(outline: Outline) -> Point:
    """Centroid by shapely."""
    point = Polygon(outline).centroid
    return float(point.x), float(point.y)


def moments(outline: Outline, digits: int = 40) -> tuple[float, float, float, float]:
    """Area, centroid x and y, and polar second moment of area about the centroid.

    The polygon is cut into triangles; one of area A and sides a, b, c contributes A (a^2 + b^2 + c^2)/36
    about its own centroid, and A times the square of its distance from the polygon's.
    """
    with mpmath.workdps(digits):
        pieces = []
        for triangle in shapely.constrained_delaunay_triangles(Polygon(outline)).geoms:
            p, q, s = [tuple(map(mpmath.mpf, xy)) for xy in triangle.exterior.coords[:3]]
            size = abs((q[0] - p[0]) * (s[1] - p[1]) - (s[0] - p[0]) * (q[1] - p[1])) / 2
            middle = ((p[0] + q[0] + s[0]) / 3, (p[1] + q[1] + s[1]) / 3)
            sides = sum((u[0] - v[0]) ** 2 + (u[1] - v[1]) ** 2 for u, v in ((p, q), (q, s), (s, p)))
            pieces.append((size, middle, size * sides / 36))
        whole = sum(size for size, _, _ in pieces)
        x = sum(size * middle[0] for size, middle, _ in pieces) / whole
        y = sum(size * middle[1] for size, middle, _ in pieces) / whole
        second = sum(
            own + size * ((middle[0] - x) ** 2 + (middle[1] - y) ** 2) for size, middle, own in pieces
        )
        return float(whole), float(x), float(y), float(second)


def clockwise(polygon: Polygon) -> Outline:
    """The corners of a shapely polygon, clockwise."""
    return [
        (float(x), float(y)) for x, y in shapely.geometry.polygon.orient(polygon, -1.0).exterior.coords[:-1]
    ]


def split(outline: Outline, start: Point, end: Point) -> list[Outline]:
    """The parts of a block cut by the segment from `start` to `end`.

    A segment that ends inside the block leaves it whole; one that enters and leaves a concave block more
    than once cuts it at every full passage.
    """
    block = Polygon(outline)
    ends_inside = [block.contains(shapely.Point(point)) for point in (start, end)]
    if any(ends_inside):
        return [outline]
    return [clockwise(part) for part in shapely_split(block, LineString([start, end])).geoms]
