"""The region of a range as a shapely polygon, in which JSET and VORONOI cut."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.reader.group_ranges import Part, Selection, blocks_of_part
from udec_ia.reader.group_tables import table

ARC = 16  # chords of a quarter of a circle


def region_of(array: MainArray, where: Selection, frame: Any) -> Any:
    """What is within `frame`, a polygon around all blocks, and in the range. Errors 10 and 28.

    Of a part about blocks, as MATERIAL or GROUP, it is the area of these blocks.
    """
    region = frame
    for part in where.parts:
        shape = _shape(array, part, frame)
        region = region.difference(shape) if part.negated else region.intersection(shape)
    if not region.area > 0:
        raise UdecError(28, f"{where.text} has no area", "give a range with rock in it", parameter="within")
    return region


def _shape(array: MainArray, part: Part, frame: Any) -> Any:
    n = part.numbers
    if part.keyword == "RECTANGLE":
        return shapely.box(n[0], n[2], n[1], n[3]) if n[0] < n[1] and n[2] < n[3] else shapely.Polygon()
    if part.keyword == "ALL":
        return frame
    if part.keyword == "CIRCLE":
        return shapely.Point(n[:2]).buffer(n[2], quad_segs=ARC)
    if part.keyword == "ANNULUS":
        inner, outer = (shapely.Point(n[:2]).buffer(r, quad_segs=ARC) for r in n[2:])
        return outer.difference(inner)
    if part.keyword == "POLYGON":
        return shapely.make_valid(shapely.Polygon(np.reshape(n, (-1, 2))))
    if part.keyword in ("ABOVE", "BELOW"):
        return _side_of_line(n, part.keyword == "ABOVE", frame)
    if part.keyword == "OUTSIDE":
        raise UdecError(10, "OUTSIDE has no area", "give another range", parameter="within")
    return _area_of_blocks(array, blocks_of_part(array, part))


def _side_of_line(n: tuple[float, ...], above: bool, frame: Any) -> Any:
    """The part of the frame above or below the line through two points."""
    slope = (n[3] - n[1]) / (n[2] - n[0])
    left, low, right, high = frame.bounds
    ends = [(x, n[1] + slope * (x - n[0])) for x in (left - 1, right + 1)]
    far = max(high, *(y for _, y in ends)) + 1 if above else min(low, *(y for _, y in ends)) - 1
    return shapely.Polygon([*ends, (right + 1, far), (left - 1, far)])


def _area_of_blocks(array: MainArray, chosen: Any) -> Any:
    """The area of the blocks at the addresses `chosen`."""
    corners = table(array, "corner")
    rings = [corners[corners["KNB"] == ib] for ib in chosen.tolist()]
    polygons = [shapely.Polygon(np.stack([ring["KXP"], ring["KYP"]], axis=1)) for ring in rings]
    return shapely.union_all(polygons) if polygons else shapely.Polygon()
