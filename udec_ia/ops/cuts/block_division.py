"""Division of one polygon by curves: the faces that they enclose, and what is left of them.

The curves and the outline are noded together, on a grid of some roundings of the coordinates, so that points
closer than these are one point. Parts that end inside are dead ends; they divide nothing. Curves that close
inside the polygon enclose a hole. As a block must not have holes, each gets two slits, which run
left and right from its ends to the next face.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Edge = tuple[int, int]
SLIT = -1  # the curve of an edge of a slit
SMALLEST_SINE = 0.01  # of the angle between two edges at a point, as of SPLIT
OVERLAP = 200  # grids by which lines are longer: they cross what they end at, at the smallest angle too
PASSES = 20  # most rounds of slits; each links holes to what lies beside them


class Division(NamedTuple):
    """Faces of a polygon that curves divide.

    points: (n, 2). faces: of each the numbers of its points, clockwise. curve: of each edge inside, from
    point i to point j with i < j, the number of its curve, or SLIT. dead_ends: (k, 2) arrays of points, and
    dead_curves: the number of the curve of each. slits: number of them.
    """

    points: Reals
    faces: list[list[int]]
    curve: dict[Edge, int]
    dead_ends: list[Reals]
    dead_curves: list[int]
    slits: int


class Refused(NamedTuple):
    """A place where a division leaves too short an edge, or too sharp an angle, and the curve there."""

    x: float
    y: float
    curve: int
    length: float  # of the edge, 0 if it is the angle


def divide(outline: Reals, curves: Sequence[Reals], grid: float) -> Division:
    """Divide the polygon with that outline, (n, 2), by `curves`, each (k, 2).

    Points move by less than `grid`. The curves may leave the polygon; parts along its outline have no effect.
    """
    polygon = shapely.Polygon(outline)
    beyond = OVERLAP * grid
    low, high = outline.min(axis=0) - 4 * beyond, outline.max(axis=0) + 4 * beyond
    longer = [shapely.LineString(curve) for curve in _longer(curves, outline, beyond)]
    lines = shapely.clip_by_rect(longer, *low, *high)
    slits: list[Any] = []
    for _ in range(PASSES):
        noded = shapely.unary_union([polygon.exterior, *lines, *slits], grid_size=grid)
        found, bridges, dangles, _ = shapely.polygonize_full([noded])
        faces = [face for face in found.geoms if _is_inside(face, polygon, grid)]
        more = [slit for face in faces for hole in face.interiors for slit in _slits(face, hole, beyond)]
        if not more:
            break
        slits += more
    loose = shapely.get_parts(shapely.intersection(shapely.union_all([bridges, dangles]), polygon))
    dead_ends, dead_curves = _merge(loose, lines, slits, grid)
    network = _number(faces, outline, curves, grid)
    labels = _curves_at(_middles(network), lines, slits, grid)
    return network._replace(
        curve=dict(zip(network.curve, labels, strict=True)),
        dead_ends=dead_ends,
        dead_curves=dead_curves,
        slits=len(slits),
    )


def _is_inside(face: Any, polygon: Any, grid: float) -> bool:
    """True if the face is part of the polygon."""
    point = face.representative_point()
    return bool(polygon.contains(point)) and shapely.area(face) > grid * shapely.length(face)


def _longer(curves: Sequence[Reals], outline: Reals, beyond: float) -> list[Reals]:
    """The curves, longer by `beyond` at ends that are no points of other curves or corners of the outline.

    So they reach what they end at.
    """
    _, number, count = np.unique(
        np.concatenate([*curves, outline]), axis=0, return_inverse=True, return_counts=True
    )
    alone = (count == 1)[number.ravel()]
    found, first = [], 0
    for curve in curves:
        longer, last = curve.copy(), first + len(curve) - 1
        for row, end, before in ((first, 0, 1), (last, -1, -2)):
            if alone[row]:
                to = curve[end] - curve[before]
                longer[end] += to * (beyond / np.hypot(*to))
        found.append(longer)
        first = last + 1
    return found


def _merge(pieces: Any, lines: Any, slits: list[Any], grid: float) -> tuple[list[Reals], list[int]]:
    """Dead ends of these pieces, each of one curve, and the numbers of the curves; without slits."""
    pieces = pieces[shapely.length(pieces) > 0]
    middles = shapely.line_interpolate_point(pieces, 0.5, normalized=True)
    labels = np.array(_curves_at(shapely.get_coordinates(middles), lines, slits, grid), np.int64)
    ends, curves = [], []
    for k in np.unique(labels[labels != SLIT]).tolist():
        merged = shapely.line_merge(shapely.union_all(pieces[labels == k]))
        long = [one for one in shapely.get_parts(merged) if shapely.length(one) > 2 * OVERLAP * grid]
        ends += [shapely.get_coordinates(one) for one in long]
        curves += [k] * len(long)
    return ends, curves


def _slits(face: Any, hole: Any, beyond: float) -> list[Any]:
    """Two lines from the ends of a hole in a face to the next outline, and `beyond` it."""
    points = shapely.get_coordinates(hole)
    left = points[np.lexsort((points[:, 1], points[:, 0]))[0]]
    right = points[np.lexsort((points[:, 1], -points[:, 0]))[0]]
    west, _, east, _ = shapely.bounds(face)
    width = east - west
    slits = []
    for (x, y), end in ((left, west - width), (right, east + width)):
        ray = shapely.LineString([(x, y), (end, y)]) & face
        pieces = [piece for piece in shapely.get_parts(ray) if shapely.length(piece) > 0]
        nearest = min(pieces, key=lambda piece: piece.distance(shapely.Point(x, y)), default=None)
        if nearest is not None and nearest.distance(shapely.Point(x, y)) <= 1e-9 * width:
            slits.append(shapely.LineString(_from(nearest, x, y, beyond)))
    return slits


def _from(line: Any, x: float, y: float, beyond: float) -> Reals:
    """The ends of a horizontal line, that at (x, y) first, the other one moved on by `beyond`."""
    ends: Reals = shapely.get_coordinates(line)[[0, -1]]
    if abs(ends[1, 0] - x) < abs(ends[0, 0] - x):
        ends = ends[::-1].copy()
    ends[0] = x, y
    ends[1, 0] += np.copysign(beyond, ends[1, 0] - x)
    return ends


def _number(faces: list[Any], outline: Reals, curves: Sequence[Reals], grid: float) -> Division:
    """The faces by numbers of their points; inner edges, with curve 0 as yet.

    A point that is one of the given points, to within the grid, is exactly that.
    """
    given = {}
    for row in np.concatenate([*curves, outline]):
        given[tuple(np.rint(row / grid))] = row
    number: dict[tuple[float, float], int] = {}
    rings = []
    for face in faces:
        ring = shapely.get_coordinates(shapely.orient_polygons(face, exterior_cw=True).exterior)[:-1]
        rings.append([number.setdefault((x, y), len(number)) for x, y in ring.tolist()])
    noded = np.array(list(number)).reshape(-1, 2)
    keys = map(tuple, np.rint(noded / grid))
    points = np.array([given.get(key, row) for key, row in zip(keys, noded, strict=True)]).reshape(-1, 2)
    directed = {edge for ring in rings for edge in zip(ring, ring[1:] + ring[:1], strict=True)}
    inner = {(i, j): 0 for i, j in directed if i < j and (j, i) in directed}
    return Division(points, rings, inner, [], [], 0)


def _middles(division: Division) -> Reals:
    ends = np.array(list(division.curve), np.int64).reshape(-1, 2)
    middles: Reals = division.points[ends].mean(axis=1)
    return middles


def _curves_at(places: Reals, lines: Any, slits: list[Any], grid: float) -> list[int]:
    """The number of the curve on which each of the `places` lies, the first of several, or SLIT."""
    if len(places) == 0:
        return []
    tree = shapely.STRtree([*lines, *slits])
    place, line = tree.query(shapely.points(places), predicate="dwithin", distance=4 * grid)
    found = np.full(len(places), len(lines) + len(slits))
    np.minimum.at(found, place, line)
    return [int(k) if k < len(lines) else SLIT for k in found]


def refusals(division: Division, shortest: float) -> list[Refused]:
    """Places where the division leaves an edge shorter than `shortest`, or two that are almost parallel."""
    points, curve = division.points, division.curve
    around: dict[int, list[int]] = {}
    edges = {edge for ring in division.faces for edge in zip(ring, ring[1:] + ring[:1], strict=True)}
    for i, j in edges:
        around.setdefault(i, []).append(j)
        if (j, i) not in edges:
            around.setdefault(j, []).append(i)
    found = []
    for i, others in around.items():
        to = points[others] - points[i]
        length = np.hypot(*to.T)
        labels = [curve.get((min(i, j), max(i, j)), None) for j in others]
        if all(label is None for label in labels):
            continue
        worst = max(label for label in labels if label is not None)
        x, y = points[i].tolist()
        if length.min() < shortest:
            found.append(Refused(x, y, worst, float(length.min())))
            continue
        order = np.argsort(np.arctan2(to[:, 1], to[:, 0]))
        unit = (to / length[:, None])[order]
        after = np.roll(unit, -1, axis=0)
        sine = unit[:, 0] * after[:, 1] - unit[:, 1] * after[:, 0]
        if ((np.abs(sine) < SMALLEST_SINE) & ((unit * after).sum(axis=1) > 0)).any():
            found.append(Refused(x, y, worst, 0.0))
    return found
