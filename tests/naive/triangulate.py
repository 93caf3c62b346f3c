"""Random triangulations of polygons: ears cut off one by one, inner points put into random triangles."""

from __future__ import annotations

from typing import Any

from naive.geometry import Outline, Point

Triangle = tuple[int, int, int]


def cross(o: Point, a: Point, b: Point) -> float:
    """Twice the area of the triangle o, a, b; positive if it runs anticlockwise."""
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def ears(points: Outline, rng: Any) -> list[Triangle]:
    """Triangles of a clockwise polygon, each an ear chosen at random among the fatter half of all ears.

    Points of straight edges are corners like any other. If no ear is left, fewer triangles come back.
    """
    ring, found = list(range(len(points))), []
    while len(ring) > 3:
        candidates = []
        for k in range(len(ring)):
            i, j, m = ring[k - 1], ring[k], ring[(k + 1) % len(ring)]
            a, b, c = points[i], points[j], points[m]
            size = -cross(a, b, c)
            longest = max((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 for p, q in ((a, b), (b, c), (c, a)))
            if size <= 1e-3 * longest:
                continue
            others = [points[n] for n in ring if n not in (i, j, m)]
            inside = (all(cross(u, v, p) <= 0 for u, v in ((a, b), (b, c), (c, a))) for p in others)
            if not any(inside):
                candidates.append((size / longest, k))
        if not candidates:
            return found
        candidates.sort(reverse=True)
        _, k = candidates[int(rng.integers((len(candidates) + 1) // 2))]
        found.append((ring[k - 1], ring[k], ring[(k + 1) % len(ring)]))
        del ring[k]
    return [*found, (ring[0], ring[1], ring[2])]


def triangulate(outline: Outline, rng: Any, on_edges: float, inside: int) -> tuple[Outline, list[Triangle]]:
    """Points and triangles of a clockwise outline.

    on_edges: how likely an edge is to have a point near its middle. inside: how many points are put into
    the largest triangles.
    """
    points: Outline = []
    for a, b in zip(outline, [*outline[1:], outline[0]], strict=True):
        points.append(a)
        if rng.random() < on_edges:
            s = float(rng.uniform(0.4, 0.6))
            points.append(((1 - s) * a[0] + s * b[0], (1 - s) * a[1] + s * b[1]))
    triangles = ears(points, rng)
    for _ in range(inside if triangles else 0):
        triangles.sort(key=lambda t: cross(points[t[0]], points[t[1]], points[t[2]]))
        i, j, m = triangles.pop(0)
        shares = rng.dirichlet((8, 8, 8))
        x, y = (
            float(sum(s * points[n][axis] for s, n in zip(shares, (i, j, m), strict=True))) for axis in (0, 1)
        )
        points.append((x, y))
        n = len(points) - 1
        triangles += [(i, j, n), (j, m, n), (m, i, n)]
    return points, triangles
