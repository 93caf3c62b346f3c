"""BLOCK: a block from which SPLIT cuts others, or a free one apart from those there are (CREATE)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, getr, puti
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.geometry.block_shape import crad, density_of, makeb
from udec_ia.kernels.geometry.box_sweep import overlapping_boxes
from udec_ia.kernels.geometry.tolerances import default_rounding, set_rounding
from udec_ia.kernels.links.longer_groups import (
    block_words,
    contact_words,
    corner_words,
    domain_words,
    edge_at,
)
from udec_ia.kernels.map.block_insertion import domain_at, link_block
from udec_ia.kernels.map.bridge import maked
from udec_ia.kernels.split.spli import makep, new_block
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.corner_rounding import check_rounding, settle_default, update_flagged
from udec_ia.ops.commands.generate_zones import Outline
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.common.number_limits import (
    EDGE_DIGITS,
    NMAT,
    ROUNDING_DIGITS,
    check_mass_range,
    check_resolution,
    constitutive_number,
    finite,
    last_digit,
    material_number,
)

Point = tuple[float, float]
OVERLAP_DIGITS = 100  # last digits of coordinates by which blocks that fit may overlap
PART = 0.01  # length of the smallest parts to be cut over that of the block
CLOCKWISE = "give the corners in clockwise order, along an outline that does not cross itself"


def create(array: MainArray, corners: Sequence[Point], material: int = 1, constitutive: int = 1) -> int:
    """Create the block with the given corners (clockwise). Returns its address.

    It may touch other blocks. Errors 4, 5, 6, 9, 28; 14 for an edge too short for the rounding length, 18 if
    it overlaps a block.
    """
    material_number(material)
    constitutive_number(constitutive)
    if len(corners) < 3:
        raise UdecError(5, f"{len(corners)} given", "give at least three corners, clockwise")
    for k, (x, y) in enumerate(corners, 1):
        finite(array, **{f"x{k}": x, f"y{k}": y})
    size = _check_size(array, corners)
    check_mass_range(array, float(array.h.cr[g.DENS : g.DENS + NMAT].max()), size)
    _check_outline(array, corners)
    _check_edges(array, corners, size)
    if array.h.ci[g.NBLK] > 0:
        _check_overlaps(array, corners)
    return add_block(array, corners, material, constitutive)


def add_block(
    array: MainArray, corners: Sequence[Point], material: int, constitutive: int, joints: Sequence[int] = ()
) -> int:
    """Create a block that has been checked. joints: numbers of the joints that made the edges at its corners.

    Its contacts are found at once.
    """
    is_first = array.h.ci[g.NBLK] == 0
    words = block_words(array.h) + len(corners) * corner_words(array.h)
    require(array, words + domain_words(array.h) + (0 if is_first else contact_words(array.h)))
    h = array.h
    ib, ips = _make_block(h, corners, material, constitutive)
    for ip, joint in zip(ips, joints, strict=False):
        puti(h, edge_at(h, ip), g.KEJ, joint)
    if is_first:
        h.ci[g.IODPNT] = maked(h)
        set_rounding(h, h.cr[g.DTOL] if h.ci[g.LROUND] else default_rounding(h))
    else:
        _insert(array, ib, corners)
    return ib


def _make_block(
    h: Memory, corners: Sequence[Point], material: int, constitutive: int
) -> tuple[int, list[int]]:
    """A rigid block at rest, which has no contact and no domain yet, and its corners."""
    ib = int(new_block(h, material, constitutive))
    ips = [makep(h, ib, h.cr.dtype.type(x), h.cr.dtype.type(y)) for x, y in corners]
    for here, following in zip(ips, ips[1:] + ips[:1], strict=True):
        puti(h, here, g.KL, following)
        puti(h, following, g.KLB, here)
        puti(h, following, g.KR, here)
    puti(h, ib, g.KP, ips[0])
    makeb(h, ib, density_of(h, ib))
    return ib, ips


def _insert(array: MainArray, ib: int, corners: Sequence[Point]) -> None:
    """Put block `ib` into the domain in which it lies, and find its contacts."""
    h = array.h
    inside = shapely.Polygon(corners).representative_point()
    idm = domain_at(h, h.cr.dtype.type(inside.x), h.cr.dtype.type(inside.y))
    crad(h, ib, False)
    link_block(h, ib, idm)
    settle_default(array)
    update_flagged(array)
    if array.h.ci[g.MCTOT] > 0:
        renew_forces(array)


def _check_overlaps(array: MainArray, corners: Sequence[Point]) -> None:
    """Error 18 if the block would overlap another one: by 2 FTOL after cycles, by rounding errors before."""
    h = array.h
    new = shapely.Polygon(corners)
    digits = OVERLAP_DIGITS * last_digit(array, float(np.abs(new.bounds).max()))
    core = new.buffer(-2 * float(h.cr[g.FTOL]) if h.ci[g.MCTOT] > 0 else -digits, join_style="mitre")
    left, below, right, above = new.bounds
    blocks = list_of(h, "block")
    x, y, reach = (getr(h, blocks, k).astype(np.float64) for k in (g.KX, g.KY, g.KBRO))
    near = (left <= x + reach) & (right >= x - reach) & (below <= y + reach) & (above >= y - reach)
    for ib in blocks[near].tolist():
        overlap = core.intersection(shapely.Polygon(Outline(h, ib).end))
        if not overlap.is_empty:
            place = overlap.representative_point()
            detail = f"block@{ib} is at ({place.x:g}, {place.y:g})"
            raise UdecError(18, detail, parameter="x1")


def _check_size(array: MainArray, corners: Sequence[Point]) -> float:
    """The greatest |x| + |y| of the block. Error 28 unless the reals can hold its fourth power."""
    reals = np.finfo(array.scheme.real_type)
    size = max(abs(x) + abs(y) for x, y in corners)
    smallest, largest = float(reals.smallest_normal) ** 0.25 / PART, float(reals.max) ** 0.25 * PART
    if not smallest <= size <= largest:
        bits = array.scheme.real_bits
        detail = f"a block {size:g} across, where {bits}-bit reals allow {smallest:.0e} to {largest:.0e}"
        raise UdecError(28, detail, "use another unit of length", parameter="x1")
    return size


def _check_edges(array: MainArray, corners: Sequence[Point], size: float) -> None:
    """Error 28 if the reals cannot resolve the shortest edge, error 14 if it cannot hold two roundings.

    size: greatest |x| + |y| of the block.
    """
    ends = zip(corners, (*corners[1:], corners[0]), strict=True)
    shortest, x, y = min((math.dist(a, b), *b) for a, b in ends)
    check_resolution(array, "x1", "an edge", shortest, EDGE_DIGITS, size)
    if array.h.ci[g.LROUND] or array.h.ci[g.MCTOT]:
        d = float(array.h.cr[g.DTOL])
        check_rounding(d, shortest, x, y)
        check_resolution(array, "x1", "a rounding length", d, ROUNDING_DIGITS, size)


def _check_outline(array: MainArray, corners: Sequence[Point]) -> None:
    """Error 6 unless the corners, taken clockwise, enclose an area and no two edges meet elsewhere."""
    n = len(corners)
    edges = [(corners[k], corners[(k + 1) % n]) for k in range(n)]
    for i, (a, b) in enumerate(edges):
        if a == b:
            raise _wrong_outline(f"the corner ({a[0]:g}, {a[1]:g}) is given twice in a row", (i + 1) % n)
    for i, j in _near(array, edges):
        (a, b), (c, d) = edges[i], edges[j]
        if j - i in (1, n - 1):
            start, shared, end = (a, b, d) if j - i == 1 else (b, a, c)
            if _turn(start, shared, end) == 0 and _along(start, shared, end) < 0:
                corner = corners.index(shared)
                raise _wrong_outline(f"it turns back on itself at ({shared[0]:g}, {shared[1]:g})", corner)
        elif _meet(a, b, c, d):
            raise _wrong_outline(f"its outline crosses itself near ({a[0]:g}, {a[1]:g})", i)
    x, y = corners[0]  # far from the origin the products of coordinates would lose the area
    if not sum((b[0] - x) * (a[1] - y) - (a[0] - x) * (b[1] - y) for a, b in edges) > 0:
        raise UdecError(6, "its corners are in anticlockwise order", CLOCKWISE)


def _near(array: MainArray, edges: Sequence[tuple[Point, Point]]) -> list[tuple[int, int]]:
    """Pairs of edges whose bounding boxes meet, in ascending order."""
    ends = np.array(edges, array.scheme.real_type)
    boxes = np.hstack([ends.min(axis=1), ends.max(axis=1)])
    if np.ptp(boxes[:, 1]) > np.ptp(boxes[:, 0]):  # the sweep is along x
        boxes = boxes[:, [1, 0, 3, 2]]
    pairs = np.sort(overlapping_boxes(np.ascontiguousarray(boxes), len(boxes)), axis=1)
    return [(i, j) for i, j in pairs[np.lexsort(pairs.T[::-1])].tolist()]


def _wrong_outline(detail: str, k: int) -> UdecError:
    """Error 6 at corner `k`, counted from 0."""
    return UdecError(6, detail, CLOCKWISE, parameter=f"x{k + 1}")


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def _along(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1])


def _meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    """True if the closed segments ab and cd have a point in common."""

    def between(p: Point, q: Point, r: Point) -> bool:
        inside_x = min(p[0], q[0]) <= r[0] <= max(p[0], q[0])
        return inside_x and min(p[1], q[1]) <= r[1] <= max(p[1], q[1])

    t = (_turn(a, b, c), _turn(a, b, d), _turn(c, d, a), _turn(c, d, b))
    if (t[0] > 0) != (t[1] > 0) and (t[2] > 0) != (t[3] > 0) and 0 not in t:
        return True
    pairs = zip(t, ((a, b, c), (a, b, d), (c, d, a), (c, d, b)), strict=True)
    return any(turn == 0 and between(*points) for turn, points in pairs)
