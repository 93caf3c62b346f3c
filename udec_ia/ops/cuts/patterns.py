"""Patterns of lines along which blocks are cut: arcs, joint sets, Voronoi cells, bricks and arches.

Numbers with a deviation are drawn evenly from value - deviation to value + deviation, by a generator with a
seed, so that a pattern can be made again bit for bit.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.ops.cuts.block_division import Reals

MAX_LINES = 1_000_000  # of a joint set
MAX_CHORDS = 10_000  # of an arc
MAX_BRICKS = 100_000  # also stones of an arch
MAX_CELLS = 300_000
SHORTEST_PART = 0.05  # of a spacing or a trace: what a deviation leaves at least
HEXAGON = 1.5 * 3**0.5  # area of a regular hexagon with edges of length 1
CENTRING = 8  # times that points move to the centroids of their cells
SHORT_EDGE = 0.15  # of the edge length of cells: shorter edges become points
NEAR = 1e-9  # of a length: places that near are the same

Pair = tuple[float, float]


# ---- Arcs


def arc(x: float, y: float, x1: float, y1: float, angle: float, chords: int) -> Reals:
    """Points (n + 1, 2) of an arc about (x, y) that begins at (x1, y1) and turns by `angle` degrees.

    angle: positive anticlockwise, at most 360. All points lie on the arc. The last of 360 is the first.
    """
    if not 1 <= chords <= MAX_CHORDS:
        raise UdecError(28, f"{chords} chords", f"give 1 to {MAX_CHORDS}", parameter="n")
    if not 0 < abs(angle) <= 360:
        raise UdecError(28, f"the arc turns by {angle:g} degrees", "give up to 360", parameter="angle")
    radius = np.hypot(x1 - x, y1 - y)
    if not radius > 0:
        raise UdecError(28, "the arc begins at its centre", "give a point on the arc", parameter="x1")
    first = np.arctan2(y1 - y, x1 - x)
    turn = first + np.radians(angle) * np.arange(chords + 1) / chords
    points = np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)])
    points[0] = x1, y1
    if abs(angle) == 360:
        points[-1] = points[0]
    return points


def circle(x: float, y: float, radius: float, chords: int) -> Reals:
    """Points (n + 1, 2) of a circle, the first and last to the left of its centre."""
    if not radius > 0:
        raise UdecError(28, f"r is {radius:g}", "give a radius above 0", parameter="r")
    if chords < 3:
        raise UdecError(28, f"{chords} chords", "a tunnel has at least 3", parameter="n")
    return arc(x, y, x - radius, y, 360.0, chords)


# ---- Joint sets


class JointSet(NamedTuple):
    """A joint set. Each pair is a value and its deviation.

    angle: degrees from the x-axis, anticlockwise. spacing: distance of the joints. trace: length of a joint,
    0 if it is endless. gap: distance from one joint to the next on a line. origin: a joint begins there.
    """

    angle: Pair
    spacing: Pair
    trace: Pair = (0.0, 0.0)
    gap: Pair = (0.0, 0.0)
    origin: Pair = (0.0, 0.0)


def joint_lines(joints: JointSet, low: Reals, high: Reals, seed: int) -> list[Reals]:
    """The joints of a set in the rectangle from `low` to `high`, each (2, 2); they may leave it."""
    _check(joints)
    rng = np.random.default_rng(seed)
    angle = np.radians(joints.angle[0])
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    corners = np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])]) - joints.origin
    t, n = corners @ along, corners @ across
    reach = float(np.hypot(*(high - low)))
    offsets = _places(rng, joints.spacing, n.min(), n.max())
    _check_number(len(offsets))
    lines = []
    for offset in offsets:
        base = joints.origin + offset * across
        for first, last in _traces(rng, joints, float(t.min()), float(t.max())):
            turn = np.radians(_draw(rng, (0.0, joints.angle[1])))
            direction = along * np.cos(turn) + across * np.sin(turn)
            middle, half = base + (first + last) / 2 * along, (last - first) / 2
            if joints.trace[0] == 0:
                half = reach
            lines.append(np.array([middle - half * direction, middle + half * direction]))
        _check_number(len(lines))
    return lines


def _check(joints: JointSet) -> None:
    """Error 28 for a spacing or trace that makes no sense."""
    if joints.spacing[0] <= 0:
        raise UdecError(28, f"spacing is {joints.spacing[0]:g}", "give one above 0", parameter="spacing")
    for name in ("trace", "gap"):
        value = getattr(joints, name)[0]
        if value < 0:
            raise UdecError(28, f"{name} is {value:g}", f"{name} must not be negative", parameter=name)
    for name in ("angle", "spacing", "trace", "gap"):
        deviation = getattr(joints, name)[1]
        if deviation < 0:
            detail = f"the deviation of {name} is {deviation:g}"
            raise UdecError(28, detail, "it must not be negative", parameter=name)
    if joints.gap[0] > 0 and joints.trace[0] == 0:
        raise UdecError(7, "TRACE t", "a GAP lies between joints of a finite TRACE", parameter="gap")


def _check_number(n: int) -> None:
    if n > MAX_LINES:
        detail = f"more than {MAX_LINES:,} joints"
        raise UdecError(28, detail, "give a greater spacing or a smaller range", parameter="spacing")


def _draw(rng: np.random.Generator, pair: Pair) -> float:
    """A value within its deviation."""
    value, deviation = pair
    return value + deviation * float(rng.uniform(-1, 1)) if deviation > 0 else value


def _places(rng: np.random.Generator, spacing: Pair, low: float, high: float) -> list[float]:
    """Distances of the joints from the origin, which has one, between `low` and `high`."""
    if max(high - low, abs(low), abs(high)) / spacing[0] > MAX_LINES:
        _check_number(MAX_LINES + 1)
    found = [0.0]
    for sign, end in ((1.0, high), (-1.0, low)):
        place = 0.0
        while place * sign < end * sign:
            place += sign * max(_draw(rng, spacing), SHORTEST_PART * spacing[0])
            found.append(place)
    return sorted(place for place in found if low <= place <= high)


def _traces(rng: np.random.Generator, joints: JointSet, low: float, high: float) -> list[tuple[float, float]]:
    """First and last place of each joint along a line from `low` to `high`; one joint begins at 0."""
    if joints.trace[0] == 0:
        return [(low, high)]
    shortest = SHORTEST_PART * joints.trace[0]
    found, end = [], 0.0
    while end < high:
        first, end = end, end + max(_draw(rng, joints.trace), shortest)
        found.append((first, end))
        end += max(_draw(rng, joints.gap), 0.0)
        _check_number(len(found))
    start = 0.0
    while start > low:
        last = start - max(_draw(rng, joints.gap), 0.0)
        start = last - max(_draw(rng, joints.trace), shortest)
        found.append((start, last))
        _check_number(len(found))
    return [(first, last) for first, last in sorted(found) if last > low and first < high]


# ---- Voronoi cells


def voronoi_edges(region: Any, edge: float, seed: int) -> list[Reals]:
    """Edges, each (2, 2), of cells with edges of about `edge` that cover the shapely polygon `region`.

    Points are drawn and moved to the centroids of their cells a few times, so that cells become alike. Edges
    much shorter than the others become points.
    """
    if not edge > 0:
        raise UdecError(28, f"edge is {edge:g}", "give one above 0", parameter="edge")
    low, high = np.array(region.bounds[:2]) - 3 * edge, np.array(region.bounds[2:]) + 3 * edge
    cells = float(np.prod(high - low)) / (HEXAGON * edge**2)
    if cells > MAX_CELLS:
        raise UdecError(28, f"{cells:.3g} cells", "give longer edges or a smaller range", parameter="edge")
    points = np.random.default_rng(seed).uniform(low, high, (max(int(cells), 4), 2))
    frame = shapely.box(*low, *high)
    for _ in range(CENTRING):
        found = shapely.voronoi_polygons(shapely.MultiPoint(points), extend_to=frame, ordered=True)
        inside = shapely.clip_by_rect(np.array(shapely.get_parts(found)), *low, *high)
        points = shapely.get_coordinates(shapely.centroid(inside))
    lines = shapely.voronoi_polygons(shapely.MultiPoint(points), extend_to=frame, only_edges=True)
    ends = shapely.get_coordinates(_segments(lines)).reshape(-1, 2, 2)
    near = shapely.intersects(shapely.linestrings(ends), shapely.buffer(region, 2 * edge))
    return _merge_short(ends[near], SHORT_EDGE * edge)


def _segments(lines: Any) -> Any:
    """All lines, in parts with two ends, as points in pairs."""
    parts = [shapely.get_coordinates(part) for part in shapely.get_parts(lines)]
    pairs = np.concatenate([np.stack([part[:-1], part[1:]], axis=1) for part in parts])
    return shapely.linestrings(pairs)


def _merge_short(ends: Reals, short: float) -> list[Reals]:
    """The edges with `ends` (n, 2, 2); those shorter than `short` become points, the middle of their ends."""
    points, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    pairs = number.reshape(-1, 2)
    root = np.arange(len(points))
    length = np.hypot(*(points[pairs[:, 0]] - points[pairs[:, 1]]).T)
    for i, j in pairs[length < short].tolist():
        a, b = root[i], root[j]
        root[root == b] = a
    together = np.zeros((len(points), 2))
    np.add.at(together, root, points)
    middle = together / np.bincount(root, minlength=len(points)).clip(1)[:, None]
    merged = np.sort(root[pairs], axis=1)
    merged = np.unique(merged[merged[:, 0] != merged[:, 1]], axis=0)
    return list(middle[merged])


# ---- Masonry


def running_bond(
    where: tuple[float, float, float, float], length: float, height: float, offset: float
) -> tuple[list[Reals], list[Reals]]:
    """Bed joints and head joints, each (2, 2), of a wall in the range x1, x2, y1, y2.

    length, height: of a brick with its joints. offset: part of its length by which every second course is
    moved. The first course begins with a whole brick at x1, y1. The limits of the range are joints too.
    """
    x1, x2, y1, y2 = where
    for name, value in (("length", length), ("height", height)):
        if not value > 0:
            raise UdecError(28, f"{name} is {value:g}", "give one above 0", parameter=name)
    if not (x1 < x2 and y1 < y2):
        detail = f"the range is {x1:g} to {x2:g}, {y1:g} to {y2:g}"
        raise UdecError(28, detail, "give x1 below x2 and y1 below y2", parameter="x1")
    if not 0 <= offset < 1:
        raise UdecError(28, f"offset is {offset:g}", "give a part of a brick, 0 to 1", parameter="offset")
    if (x2 - x1) / length * (y2 - y1) / height > MAX_BRICKS:
        raise UdecError(28, f"more than {MAX_BRICKS:,} bricks", "give larger ones", parameter="length")
    courses = int(np.ceil((y2 - y1) / height - NEAR))
    levels = [min(y1 + k * height, y2) for k in range(courses + 1)]
    beds = [np.array([(x1, y), (x2, y)]) for y in levels]
    heads = [np.array([(x, y1), (x, y2)]) for x in (x1, x2)]
    for k in range(courses):
        low, high = levels[k], levels[k + 1]
        first = x1 + (offset * length if k % 2 else 0.0)
        places = first + length * np.arange(int((x2 - first) / length) + 1)
        heads += [
            np.array([(x, low), (x, high)]) for x in places if x1 + NEAR * length < x < x2 - NEAR * length
        ]
    return beds, heads


def voussoir_arch(
    x1: float, x2: float, y: float, rise: float, thickness: float, stones: int
) -> tuple[Reals, Reals, list[Reals]]:
    """Inner and outer line (n + 1, 2) of a circular arch, and its radial joints, those at its feet included.

    x1, x2, y: the feet of the inner line. rise: height of its crown above them, at most half the span.
    """
    span = x2 - x1
    if not span > 0:
        raise UdecError(28, f"x2 - x1 is {span:g}", "x1 is the left foot", parameter="x2")
    if not 0 < rise <= span / 2 * (1 + NEAR):
        detail = f"the rise is {rise:g}, the span {span:g}"
        raise UdecError(28, detail, "give a rise up to half the span", parameter="rise")
    if not thickness > 0:
        raise UdecError(28, f"thickness is {thickness:g}", "give one above 0", parameter="thickness")
    if not 1 <= stones <= MAX_BRICKS:
        raise UdecError(28, f"{stones} stones", f"give 1 to {MAX_BRICKS}", parameter="n")
    radius = (span * span / 4 + rise * rise) / (2 * rise)
    half = np.arctan2(span / 2, radius - rise)
    turn = np.pi / 2 + half * (1 - 2 * np.arange(stones + 1) / stones)
    centre = np.array([(x1 + x2) / 2, y + rise - radius])
    out = np.column_stack([np.cos(turn), np.sin(turn)])
    inner, outer = centre + radius * out, centre + (radius + thickness) * out
    inner[0], inner[-1] = (x1, y), (x2, y)
    return inner, outer, [np.array([a, b]) for a, b in zip(inner, outer, strict=True)]
