"""Where unrounded edges of two blocks face each other, and nodal forces of a traction along such a joint.

Blocks are lists of corners in one sense of rotation, clockwise or anticlockwise, the same for both. Edges
face each other if they run in opposite directions within 30 degrees and the gap between them is at most a
tolerance. Lengths are measured along the bisector of the two edges, so that neither block is preferred.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import cos, hypot, radians, sqrt
from typing import Any

import numpy as np
from shapely.geometry import LineString, Point, Polygon

Pair = tuple[float, float]
Outline = Sequence[Pair]
Edge = tuple[Pair, Pair]
Array = Any  # of float64

FACING = cos(radians(30))


@dataclass(frozen=True)
class Stretch:
    """A piece of a joint on one edge of each block: origin, unit vectors along and out of block 1, ends."""

    origin: Pair
    along: Pair
    outward: Pair
    start: float
    end: float

    def at(self, s: float) -> Pair:
        """The point at the distance s from the origin."""
        return self.origin[0] + s * self.along[0], self.origin[1] + s * self.along[1]


@dataclass
class Joint:
    """Stretches that follow one another. Positions along it are distances from its first end."""

    stretches: list[Stretch] = field(default_factory=list)
    nodes: list[float] = field(default_factory=list)  # ends, and corners of either block between them

    @property
    def length(self) -> float:
        """Length over which the two blocks face each other."""
        return sum(stretch.end - stretch.start for stretch in self.stretches)

    @property
    def ends(self) -> tuple[Pair, Pair]:
        """The two ends."""
        first, last = self.stretches[0], self.stretches[-1]
        return first.at(first.start), last.at(last.end)

    def at(self, s: float) -> tuple[Pair, Pair]:
        """The point at the distance s from the first end, and the unit normal out of block 1."""
        for stretch in self.stretches:
            if s <= stretch.end - stretch.start or stretch is self.stretches[-1]:
                return stretch.at(stretch.start + s), stretch.outward
            s -= stretch.end - stretch.start
        raise ValueError("a joint without stretches")


def edges(outline: Outline) -> list[Edge]:
    """Pairs of corners."""
    return [(outline[i - 1], outline[i]) for i in range(len(outline))]


def facing_stretch(one: Edge, two: Edge, clockwise: bool, gap: float) -> Stretch | None:
    """The stretch on which two edges face each other, from edge 1's start to its end, or None.

    The gap is the distance of the midpoint of the stretch from the further edge.
    """
    d1, d2 = direction(one), direction(two)
    if d1[0] * d2[0] + d1[1] * d2[1] > -FACING:
        return None
    size = hypot(d1[0] - d2[0], d1[1] - d2[1])
    along = (d1[0] - d2[0]) / size, (d1[1] - d2[1]) / size
    outward = (-along[1], along[0]) if clockwise else (along[1], -along[0])
    origin = one[0]

    def place(point: Pair) -> float:
        return (point[0] - origin[0]) * along[0] + (point[1] - origin[1]) * along[1]

    start, end = max(place(one[0]), place(two[1])), min(place(one[1]), place(two[0]))
    if end - start <= gap:
        return None
    found = Stretch(origin, along, outward, start, end)
    middle = Point(found.at((start + end) / 2))
    across = [LineString(edge).distance(middle) for edge in (one, two)]
    return found if max(across) <= gap else None


def direction(edge: Edge) -> Pair:
    """Unit vector along an edge."""
    (x1, y1), (x2, y2) = edge
    size = hypot(x2 - x1, y2 - y1)
    return (x2 - x1) / size, (y2 - y1) / size


def find_joints(one: Outline, two: Outline, gap: float) -> list[Joint]:
    """Joints between two blocks, each from its first to its last point in the sense of block 1.

    Stretches belong to one joint if one begins within `gap` of the end of another and turns by less than 30
    degrees against it. `gap` must be shorter than every edge.
    """
    clockwise = not Polygon(one).exterior.is_ccw
    pairs = [facing_stretch(a, b, clockwise, gap) for a in edges(one) for b in edges(two)]
    found = [stretch for stretch in pairs if stretch]
    joints: list[Joint] = []
    while found:
        chain = [found.pop(0)]
        grown = True
        while grown:
            grown = False
            for stretch in found:
                if follows(chain[-1], stretch, gap):
                    chain.append(stretch)
                elif follows(stretch, chain[0], gap):
                    chain.insert(0, stretch)
                else:
                    continue
                found.remove(stretch)
                grown = True
                break
        nodes = [0.0]
        for stretch in chain:
            nodes.append(nodes[-1] + stretch.end - stretch.start)
        joints.append(Joint(chain, nodes))
    return sorted(joints, key=lambda joint: joint.ends)


def follows(one: Stretch, two: Stretch, gap: float) -> bool:
    """Whether stretch 2 begins where stretch 1 ends, in nearly the same direction."""
    ends = Point(one.at(one.end)).distance(Point(two.at(two.start)))
    turn = one.along[0] * two.along[0] + one.along[1] * two.along[1]
    return bool(ends <= gap and turn >= FACING)


def nodal_forces(joint: Joint, positions: Sequence[float], traction: Callable[[float], Array]) -> Array:
    """Consistent forces, shape (n, ...), at n >= 2 sorted positions: integrals of traction times hat
    functions.

    Between positions, and beyond the outer ones up to the ends of the joint, the functions are linear, so
    that the forces have the resultant and the moment of the traction. Two Gauss points are exact for a
    linear traction.
    """
    places = [float(s) for s in positions]
    cuts = sorted({*joint.nodes, *(s for s in places if 0 < s < joint.length)})
    found: Array = 0.0
    for a, b in pairwise(cuts):
        for s in ((a + b) / 2 - (b - a) / sqrt(12), (a + b) / 2 + (b - a) / sqrt(12)):
            found = found + (b - a) / 2 * np.multiply.outer(hat_functions(places, s), traction(s))
    return found


def hat_functions(places: Sequence[float], s: float) -> Array:
    """Values at s of the linear functions that are 1 at one place and 0 at the others."""
    k = min(max(int(np.searchsorted(places, s)), 1), len(places) - 1)
    values = np.zeros(len(places))
    values[k] = (s - places[k - 1]) / (places[k] - places[k - 1])
    values[k - 1] = 1 - values[k]
    return values


def field_traction(joint: Joint, stress: Callable[[float, float], Array]) -> Callable[[float], Array]:
    """Traction on block 1 of a stress field s(x, y), shape (2, 2), tension positive: s times the normal."""

    def traction(s: float) -> Array:
        (x, y), normal = joint.at(s)
        return np.asarray(stress(x, y)) @ np.asarray(normal)

    return traction
