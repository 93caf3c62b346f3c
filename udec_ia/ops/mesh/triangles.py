"""Zones for GENERATE ... AUTOMATIC: the outline of a block divided into triangles of a wanted size.

    m = mesh(corners, edge)      corners clockwise; m.points, m.zones, m.ring, m.smallest_angle, m.worst_ratio

1. Each edge of the outline is divided evenly, into parts as near to `edge` as a whole number of them allows.
2. Points are laid inside, as a lattice of equilateral triangles, and then moved so that the worst-shaped
   zones gain most (inside.py). Which points form a zone is decided by the constrained Delaunay
   triangulation of the package pythoncdt, every time anew.
3. For mixed discretisation the zones are made into pairs, each pair two zones with a common side
   (pairs.py). B points on the outline and I inside make 2I + B - 2 triangles, so B must be even: one
   edge of the outline is divided into one part more or less.

Nothing here knows of IA(). The same input gives the same mesh, bit for bit; what an edge is divided into
does not depend on the sense in which it is run through, so two blocks with a common edge get the same
points on it wherever they divide it into the same number of parts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from udec_ia.errors import UdecError
from udec_ia.ops.mesh.inside import Floats, Ints, areas, fill, following, lattice, relax, sides, triangulate
from udec_ia.ops.mesh.pairs import pair_up

MAX_ZONES = 2_000_000
EQUILATERAL = 3**0.5 / 4  # area of an equilateral triangle of side 1


@dataclass(frozen=True, eq=False)
class Mesh:
    """A block outline divided into zones.

    points: coordinates, one row a grid-point; the first rows are the corners as given, bit for bit.
    zones: three row numbers of `points` each, clockwise. If paired, rows 2i and 2i + 1 are a pair.
    ring: row numbers of the points on the outline, clockwise, beginning with the first corner.
    """

    points: Floats
    zones: Ints
    ring: Ints

    @property
    def angles(self) -> Floats:
        """The least angle of each zone, degrees."""
        lengths = np.sort(sides(self.points, self.zones), axis=1)
        sine = 2 * areas(self.points, self.zones) / (lengths[:, 1] * lengths[:, 2])
        return np.asarray(np.degrees(np.arcsin(np.minimum(sine, 1))))

    @property
    def ratios(self) -> Floats:
        """The longest side of each zone over its height on it, 1 for an equilateral triangle."""
        longest = sides(self.points, self.zones).max(axis=1)
        return np.asarray(EQUILATERAL * longest**2 / areas(self.points, self.zones))

    @property
    def smallest_angle(self) -> float:
        """The least angle of any zone, degrees."""
        return float(self.angles.min())

    @property
    def worst_ratio(self) -> float:
        """The greatest of `ratios`."""
        return float(self.ratios.max())


def mesh(corners: ArrayLike, edge: float, paired: bool = True, real: type = np.float64) -> Mesh:
    """Divide the outline with the given corners (clockwise, m) into zones with sides of about `edge` (m).

    paired: zones are made into pairs. real: type that holds all coordinates of the mesh exactly. Error 23
    without the package pythoncdt, 28 for an edge or an outline that makes no mesh.
    """
    given = _checked(corners, edge)
    parts = divisions(np.linalg.norm(following(given) - given, axis=1) / edge, even=paired)
    outline = divide(given, parts)
    b = len(outline)
    unit = min(edge, float(np.ptp(given, axis=0).max()))  # so that no number becomes too small
    local = (outline - given[0]) / unit
    if not closed(zones := triangulate(local, b), b):
        raise UdecError(28, "the outline touches or crosses itself", "no block can have such an outline")
    if unit == edge:
        local = fill(np.vstack([local, lattice(local, parts)]), b)
        local, zones = relax(local, np.arange(b))
    points, ring = np.vstack([outline, given[0] + unit * local[b:]]), np.arange(b)
    if paired:
        points, zones, ring = pair_up(points, zones, b)
        if len(ring) > b:  # there are new points on the outline
            points, zones = relax(points, ring, zones)
    points = points.astype(real).astype(np.float64)
    if not (areas(points, zones) > 0).all():
        advice = "use a longer edge, put the origin nearer to the block, or use a --build with 64-bit reals"
        raise UdecError(
            28, "zones are too small for the precision of their coordinates", advice, parameter="edge"
        )
    return _corners_first(points, zones, ring, np.concatenate([[0], np.cumsum(parts[:-1])]))


def _checked(corners: ArrayLike, edge: float) -> Floats:
    """The corners as an array. Error 28 for what no mesh can be made of."""
    given = np.array(corners, dtype=np.float64)
    if not edge > 0 or not np.isfinite(edge):
        raise UdecError(28, f"the edge of a zone must be positive, it is {edge:g}", parameter="edge")
    if given.ndim != 2 or given.shape[0] < 3 or given.shape[1] != 2 or not np.isfinite(given).all():
        raise UdecError(28, "an outline must have three corners or more, with finite coordinates")
    x, y = (given - given[0]).T
    area = 0.5 * float((following(x) * y - x * following(y)).sum())
    if not area > 0:
        raise UdecError(28, "the corners must run clockwise and enclose an area")
    round_it = float(np.linalg.norm(following(given) - given, axis=1).sum())
    zones = area / EQUILATERAL / edge / edge + round_it / edge
    if zones > MAX_ZONES:
        smallest_edge = max((2 * area / (EQUILATERAL * MAX_ZONES)) ** 0.5, 2 * round_it / MAX_ZONES)
        detail = f"zones with an edge of {edge:g} would be {zones:.2g} in number, over {MAX_ZONES:.0g}"
        raise UdecError(28, detail, f"take an edge of {smallest_edge:.1g} or more", parameter="edge")
    return given


def divisions(lengths: Floats, even: bool) -> Ints:
    """Into how many parts each edge of an outline is divided, so that the parts are about 1 long.

    If `even`, the number of all parts is even: where it would be odd, one edge gets a part more or
    less, the edge whose parts then are nearest to 1.
    """
    parts = np.maximum(np.rint(lengths), 1).astype(np.int64)
    if even and parts.sum() % 2:
        more = np.abs(np.log(lengths / (parts + 1)))
        fewer = np.where(parts > 1, np.abs(np.log(lengths / np.maximum(parts - 1, 1))), np.inf)
        k = int(np.argmin(np.minimum(more, fewer)))
        parts[k] += 1 if more[k] <= fewer[k] else -1
    return parts


def divide(corners: Floats, parts: Ints) -> Floats:
    """The outline with edge k divided into parts[k] equal parts.

    Each point is reckoned from the nearer end, the middle from both: both senses give the same point.
    """
    k = np.repeat(np.arange(len(parts)), parts)
    number = (np.arange(len(k)) - np.repeat(np.cumsum(parts) - parts, parts))[:, None]
    all_parts, a, b = parts[k][:, None], corners[k], following(corners)[k]
    from_a = a + (b - a) * (number / all_parts)
    from_b = b + (a - b) * ((all_parts - number) / all_parts)
    at_end = np.where(2 * number > all_parts, from_b, (a + b) / 2)
    return np.asarray(np.where(2 * number < all_parts, from_a, at_end))


def closed(zones: Ints, b: int) -> bool:
    """True if the zones of the first `b` points fill their outline and nothing else."""
    if len(zones) != b - 2:
        return False
    start, end = zones.ravel(), np.roll(zones, -1, axis=1).ravel()
    return np.array_equal(np.sort(start[end == (start + 1) % b]), np.arange(b))


def _corners_first(points: Floats, zones: Ints, ring: Ints, corners: Ints) -> Mesh:
    """The mesh with its points in the order corners, others of the outline, inside."""
    old = np.concatenate([corners, ring[~np.isin(ring, corners)]])
    old = np.concatenate([old, np.setdiff1d(np.arange(len(points)), old)])
    new = np.empty_like(old)
    new[old] = np.arange(len(old))
    return Mesh(points[old], new[zones], new[ring])
