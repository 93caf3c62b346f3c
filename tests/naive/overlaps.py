"""Bodies with rounded corners that lie in each other: outlines, overlaps and depths, by a geometry library.

A body is its corners, clockwise, as an array (n, 2). Every convex corner is rounded by the circle that
touches both its edges at the distance d from it, or at half an edge that is shorter than 2d; a concave corner
stays sharp, and so does one that turns by less than STRAIGHT or is printed to be plain (a point that was put
on an edge). Arcs are polygons of chords that lie within less than d/1000 of the circle.

A part is one connected piece of what two bodies have in common. Its depth is the greatest distance that a
point of one body's outline, lying in the other body, has from the other's outline.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import ceil
from typing import Any

import numpy as np
import shapely
from shapely.geometry import Polygon

CHORDS = 24  # of one arc: the chord of a right angle is then d/1800 from the circle
ALONG = np.linspace(-0.5, 0.5, CHORDS + 1)
STRAIGHT = 1e-3  # radians; who turns by less is no corner
FINE = (
    20  # depths are measured at points that lie d/FINE apart, or further in a part longer than FINE times d
)
RIGID = 1e-4  # a body whose edges keep their lengths to this fraction turns and shifts as a whole

Array = Any  # of float64, two columns


@dataclass(frozen=True)
class Body:
    """Corners, clockwise, and which of them are plain points of an edge."""

    corners: Array
    plain: Array

    @classmethod
    def of(cls, corners: Sequence[tuple[float, float]]) -> Body:
        """A body all of whose corners are rounded."""
        points = np.array(corners, dtype=float)
        return cls(points, np.zeros(len(points), dtype=bool))


@dataclass(frozen=True)
class Part:
    """A connected piece of the overlap of two bodies, its depth, and where it is deepest."""

    depth: float
    place: tuple[float, float]
    shape: Polygon


def outlines(bodies: Sequence[Body], d: float) -> list[Polygon]:
    """The rounded outlines of `bodies`."""
    if not bodies:
        return []
    p, plain = np.concatenate([b.corners for b in bodies]), np.concatenate([b.plain for b in bodies])
    ends = np.cumsum([len(b.corners) for b in bodies])
    firsts = np.concatenate([[0], ends[:-1]])
    earlier, later = np.arange(len(p)) - 1, np.arange(len(p)) + 1
    earlier[firsts], later[ends - 1] = ends - 1, firsts
    before, after = p[earlier] - p, p[later] - p
    lengths = np.hypot(after[:, 0], after[:, 1])
    u, v = before / lengths[earlier, None], after / lengths[:, None]
    cross, dot = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1)
    inner = np.arctan2(np.abs(cross), dot)  # angle between the two edges
    arc = (cross > 0) & (np.pi - inner > STRAIGHT) & ~plain
    inner = np.where(arc, inner, np.pi / 2)
    bisector = np.where(arc[:, None], u + v, 1.0)
    bisector /= np.hypot(bisector[:, 0], bisector[:, 1])[:, None]
    shorter = np.minimum(lengths, lengths[earlier])
    reach = np.minimum(d, shorter / 2) * (1 - 1e-9)  # two arcs on one edge do not cross by a rounding error
    radius = np.where(arc, reach * np.tan(inner / 2), 0.0)
    centre = np.where(arc[:, None], p + bisector * (reach / np.cos(inner / 2))[:, None], p)
    # from the middle of the arc, which looks away from the centre, half of it to either side
    middle = np.arctan2(-bisector[:, 1], -bisector[:, 0])
    angles = middle[:, None] - (np.pi - inner)[:, None] * ALONG
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points = (centre[:, None, :] + radius[:, None, None] * circle).reshape(-1, 2)
    owner = np.repeat(np.arange(len(bodies)), [len(b.corners) * len(ALONG) for b in bodies])
    return list(shapely.polygons(shapely.linearrings(points, indices=owner)))


def outline(body: Body, d: float) -> Polygon:
    """The rounded outline of `body`."""
    return outlines([body], d)[0]


def parts(one: Polygon, two: Polygon, d: float) -> list[Part]:
    """The connected parts of the overlap of two outlines, the deepest first."""
    found, rings = [], (one.exterior, two.exterior)
    shapely.prepare(rings)
    if not (one.is_valid and two.is_valid):  # between two steps, what is strained may cross itself
        one, two = shapely.make_valid(one), shapely.make_valid(two)
    for shape in shapely.get_parts(one.intersection(two)):
        if shape.area == 0.0:
            continue
        fine = max(d, shape.length / FINE) / FINE
        points = shapely.points(shapely.get_coordinates(shapely.segmentize(shape.exterior, fine)))
        depths = np.maximum(shapely.distance(points, rings[0]), shapely.distance(points, rings[1]))
        k = int(depths.argmax())
        found.append(Part(float(depths[k]), (float(points[k].x), float(points[k].y)), shape))
    return sorted(found, key=lambda part: -part.depth)


def depth(one: Polygon, two: Polygon, d: float) -> float:
    """The greatest depth to which two outlines lie in each other; 0 if they do not."""
    return max((part.depth for part in parts(one, two, d)), default=0.0)


def deeper(outlines: Sequence[Polygon], pairs: Sequence[tuple[int, int]], limit: float) -> Array:
    """Which pairs of outlines lie deeper than `limit` in each other, quickly: one reaches the other's core.

    The core of a body is what is further from its outline than `limit`. Shape (pairs,), of truth values.
    """
    whole = np.array(outlines)
    cores = shapely.buffer(whole, -limit, quad_segs=2)
    i, j = np.array(pairs, int).reshape(-1, 2).T
    reach = shapely.intersects(whole[j], cores[i]) | shapely.intersects(whole[i], cores[j])
    return shapely.intersects(whole[i], whole[j]) & reach


def polygons(bodies: Sequence[Body]) -> Array:
    """The outlines of `bodies` as if nothing was rounded, in which the rounded ones lie."""
    owner = np.repeat(np.arange(len(bodies)), [len(body.corners) for body in bodies])
    return shapely.polygons(
        shapely.linearrings(np.concatenate([body.corners for body in bodies]), indices=owner)
    )


def touching(bodies: Sequence[Body]) -> list[tuple[int, int]]:
    """Pairs of bodies whose polygons, not rounded, have points in common: no others can overlap."""
    whole = polygons(bodies)
    found = shapely.STRtree(whole).query(whole, predicate="intersects").T
    return [(int(i), int(j)) for i, j in found if i < j]


def bare(part: Part, contacts: Array, reach: float) -> bool:
    """Whether none of the `contacts`, points (n, 2), lies within `reach` of the part."""
    if len(contacts) == 0:
        return True
    return bool(shapely.distance(shapely.points(contacts), part.shape).min() > reach)


# ---- within a step


def between(before: Array, after: Array, t: float) -> Array:
    """Corners at the time `t` of a step, 0 before and 1 after it: of a rigid motion if it was one."""
    middle, end = before.mean(axis=0), after.mean(axis=0)
    a, b = before - middle, after - end
    cross, dot = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum()
    angle = np.arctan2(cross, dot)

    def turned(by: float) -> Array:
        c, s = np.cos(by), np.sin(by)
        return np.stack([c * a[:, 0] - s * a[:, 1], s * a[:, 0] + c * a[:, 1]], axis=1)

    if np.abs(turned(angle) - b).max() > RIGID * np.abs(a).max():
        return before + t * (after - before)
    return turned(t * angle) + middle + t * (end - middle)


def steps_of(before: Sequence[Array], after: Sequence[Array], d: float) -> int:
    """How many sub-steps bring two bodies no further than a tenth of `d` towards each other."""
    moves = [b - a for a, b in zip(before, after, strict=True)]
    low = np.array([move.min(axis=0) for move in moves])
    high = np.array([move.max(axis=0) for move in moves])
    relative = max(
        float(np.hypot(*np.maximum(high[i] - low[j], high[j] - low[i])))
        for i, j in combinations(range(len(moves)), 2)
    )
    return max(1, ceil(10 * relative / d))


def within(
    before: Sequence[Body], after: Sequence[Body], d: float, finer: int = 1
) -> Iterator[list[Polygon]]:
    """Outlines of the bodies in the course of a step, its beginning and its end left out.

    finer: sub-steps for one of `steps_of`.
    """
    n = finer * steps_of([body.corners for body in before], [body.corners for body in after], d)
    for k in range(1, n):
        moved = [
            Body(between(one.corners, two.corners, k / n), two.plain)
            for one, two in zip(before, after, strict=True)
        ]
        yield outlines(moved, d)


def deepest(before: Sequence[Body], after: Sequence[Body], d: float, finer: int = 1) -> float:
    """The greatest depth to which two bodies come into each other in a step, its ends included."""
    one, two = outlines(before, d)
    reached = depth(one, two, d)
    for one, two in within(before, after, d, finer):
        if one.intersects(two):
            reached = max(reached, depth(one, two, d))
    one, two = outlines(after, d)
    return max(reached, depth(one, two, d))
