"""Division of one polygon by curves: the faces that they enclose, and what is left of them.

The curves and the outline are noded together, on a grid of some roundings of the coordinates, so that points
closer than these are one point. Parts that end inside are dead ends; they divide nothing. Curves that close
inside the polygon enclose a hole. As a block must not have holes, each gets two slits, which run left and
right from its ends to the next face.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from udec_ia.errors import UdecError

Reals = NDArray[np.float64]
Edge = tuple[int, int]
SLIT = -1  # the curve of an edge of a slit
SMALLEST_SINE = 0.01  # of the angle between two edges at a point, as of SPLIT
SAME_POINT = 2.5  # grids: points that noding may leave so near to each other are one point
OVERLAP = 200  # grids by which lines are longer: they cross what they end at, at the smallest angle too
SLOPES = (0.0, 0.1, -0.1)  # of slits: the first that is not almost parallel to an edge
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
    """A place where a division leaves too short an edge, or too sharp an angle, and the curves there."""

    x: float
    y: float
    curves: tuple[int, ...]
    length: float  # of the edge, 0 if it is the angle


def divide(outline: Reals, curves: Sequence[Reals], grid: float) -> Division:
    """Divide the polygon with that outline, (n, 2), by `curves`, each (k, 2).

    Points move by less than `grid`. The curves may leave the polygon; parts along its outline are left out.
    Error 27 for a curve that closes inside and gets no slit.
    """
    polygon = shapely.Polygon(outline)
    beyond = OVERLAP * grid
    low, high = outline.min(axis=0) - 4 * beyond, outline.max(axis=0) + 4 * beyond
    inside = shapely.intersection([shapely.LineString(curve) for curve in curves], polygon)
    longer = [shapely.LineString(curve) for curve in _longer(curves, outline, beyond)]
    lines = shapely.clip_by_rect(longer, *low, *high)
    lines[shapely.length(inside) <= beyond] = shapely.LineString()  # it only touches the outline
    lines = shapely.difference(lines, polygon.exterior, grid_size=grid)
    noded = shapely.unary_union([polygon.exterior, *lines], grid_size=grid)
    slits: list[Any] = []
    loose: list[Any] = []
    for _ in range(PASSES):
        found, bridges, dangles, _ = shapely.polygonize_full([noded])
        loose.append(dangles)
        faces = [face for face in found.geoms if _is_inside(face, polygon, grid)]
        more = [slit for face in faces for hole in face.interiors for slit in _slits(face, hole)]
        if not more:
            break
        slits += more
        connected = shapely.difference(noded, dangles)  # slits end at what encloses a face
        noded = shapely.unary_union([connected, *more], grid_size=grid)
    if holes := [hole for face in faces for hole in face.interiors]:
        x, y = holes[0].coords[0]
        detail = f"no slit leads from the curve that closes at ({x:.10g}, {y:.10g}) to an edge of its block"
        raise UdecError(27, detail, "cut from there to an edge first, with GLUED")
    pieces = shapely.get_parts(shapely.intersection(shapely.union_all([bridges, *loose]), polygon))
    dead_ends, dead_curves = _merge(pieces, lines, slits, grid, curves)
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


def _merge(
    pieces: Any, lines: Any, slits: list[Any], grid: float, curves: Sequence[Reals]
) -> tuple[list[Reals], list[int]]:
    """Dead ends of these pieces, each of one curve, and the numbers of the curves; without slits.

    They end where the curves did before they were made longer.
    """
    pieces = pieces[shapely.length(pieces) > 0]
    middles = shapely.line_interpolate_point(pieces, 0.5, normalized=True)
    labels = np.array(_curves_at(shapely.get_coordinates(middles), lines, slits, grid), np.int64)
    ends, numbers = list[Reals](), list[int]()
    for k in np.unique(labels[labels != SLIT]).tolist():
        merged = shapely.line_merge(shapely.union_all(pieces[labels == k]))
        merged = shapely.simplify(merged, 4 * grid)
        long = [one for one in shapely.get_parts(merged) if shapely.length(one) > 2 * OVERLAP * grid]
        for end in map(shapely.get_coordinates, long):
            for row in (0, -1):
                own = curves[k][[0, -1]]
                near = np.hypot(*(own - end[row]).T) < 2 * OVERLAP * grid
                if near.any():
                    end[row] = own[near][0]
            ends.append(end)
        numbers += [k] * len(long)
    return ends, numbers


def _slits(face: Any, hole: Any) -> list[Any]:
    """Two lines from the ends of a hole in a face to the next outline."""
    points = shapely.get_coordinates(hole)[:-1]
    left = int(np.lexsort((points[:, 1], points[:, 0]))[0])
    right = int(np.lexsort((points[:, 1], -points[:, 0]))[0])
    west, _, east, _ = shapely.bounds(face)
    width = east - west
    slits = []
    for k, way in ((left, -1.0), (right, 1.0)):
        x, y = points[k].tolist()
        to = points[[k - 1, (k + 1) % len(points)]] - points[k]
        slope = next((one for one in SLOPES if _is_apart(to, way, one)), 0.0)
        ray = shapely.LineString([(x, y), (x + 2 * way * width, y + 2 * slope * width)]) & face
        pieces = [piece for piece in shapely.get_parts(ray) if shapely.length(piece) > 0]
        nearest = min(pieces, key=lambda piece: piece.distance(shapely.Point(x, y)), default=None)
        if nearest is not None and nearest.distance(shapely.Point(x, y)) <= 1e-9 * width:
            slits.append(nearest)
    return slits


def _is_apart(to: Reals, way: float, slope: float) -> bool:
    """True if a slit of that slope is not almost parallel to edges from its end, vectors (n, 2)."""
    along, across = to[:, 0] * way + to[:, 1] * slope, to[:, 1] * way - to[:, 0] * slope
    return bool(((along <= 0) | (np.abs(across) > 2 * SMALLEST_SINE * along)).all())


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
    rings = _without_shortest(rings, noded, SAME_POINT * grid)
    keys = map(tuple, np.rint(noded / grid))
    points = np.array([given.get(key, row) for key, row in zip(keys, noded, strict=True)]).reshape(-1, 2)
    directed = {edge for ring in rings for edge in zip(ring, ring[1:] + ring[:1], strict=True)}
    inner = {(i, j): 0 for i, j in directed if i < j and (j, i) in directed}
    return Division(points, rings, inner, [], [], 0)


def _without_shortest(rings: list[list[int]], points: Reals, shortest: float) -> list[list[int]]:
    """The same rings with the ends of edges shorter than `shortest` as one point, which noding may leave."""
    directed = np.array([edge for ring in rings for edge in zip(ring, ring[1:] + ring[:1], strict=True)])
    short = directed[np.hypot(*(points[directed[:, 0]] - points[directed[:, 1]]).T) < shortest]
    if not len(short):
        return rings
    same = np.arange(len(points))
    for _ in range(len(short)):  # the lesser number goes along chains of short edges
        np.minimum.at(same, short[:, 0], same[short[:, 1]])
        np.minimum.at(same, short[:, 1], same[short[:, 0]])
    found = [[k for k, after in pairwise([*same[ring], same[ring[0]]]) if k != after] for ring in rings]
    return [[int(k) for k in ring] for ring in found if len(ring) > 2]


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
        worst = tuple(sorted({label for label in labels if label is not None}))
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
