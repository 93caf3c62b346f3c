"""GENERATE ... AUTOMATIC: a block is divided into zones with sides of about a given length.

The mesh comes from triangles.py. Its grid-points on the outline stand on the edges exactly, so none is moved;
they become corners that are not rounded, as those of MANUAL do. A part of an edge next to a rounded corner
must leave room for the rounding.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.generate import Outline, Place, divide
from udec_ia.ops.mesh.triangles import Mesh, mesh

SLACK = 1e-6  # part of a rounding length that a part of an edge may be too short


def generate_automatically(array: MainArray, ib: int, edge: float, paired: bool = False) -> str:
    """Divide block `ib` into zones with sides of about `edge` (m). Returns one line on the mesh.

    paired: zones 1 and 2, 3 and 4 ... are pairs for mixed discretisation. Errors 1, 14, 23 and 28; nothing
    is changed then.
    """
    outline = Outline(array.h, ib)
    found = mesh(outline.end, edge, paired, array.h.cr.dtype.type)
    _check_room(found, len(outline.corners), edge, float(array.h.cr[g.DTOL]))
    divide(array, ib, _places(outline, found), [(i, j, k) for i, j, k in found.zones.tolist()], paired)
    return (
        f"block@{ib} has {len(found.zones)} zones and {len(found.points)} grid-points, "
        f"the least angle is {found.smallest_angle:.1f} degrees"
    )


def _check_room(found: Mesh, corners: int, edge: float, d: float) -> None:
    """Error 14 if a grid-point on an edge stands in the rounding of a corner."""
    ends = np.append(found.ring, found.ring[0])
    for i, j in pairwise(ends.tolist()):
        distance = float(np.hypot(*(found.points[i] - found.points[j])))
        if (i < corners) != (j < corners) and distance < d * (1 - SLACK):
            x, y = found.points[min(i, j)]
            detail = f"an edge of {edge:g} sets a grid-point {distance:g} from the corner ({x:g}, {y:g})"
            raise UdecError(
                14,
                f"{detail}, which is rounded by {d:g}",
                f"use a longer edge, or first ROUND {0.9 * distance:.2g} before",
                parameter="edge",
            )


def _places(outline: Outline, found: Mesh) -> list[Place]:
    """Where the points of the mesh, whose first points are the corners, go in the block."""
    places = [Place(float(x), float(y)) for x, y in found.points]
    for place, ip in zip(places, outline.corners, strict=False):
        place.corner = ip
    edge = 1  # the ring begins at corner 0, with the edge that ends at corner 1
    for i in found.ring[1:].tolist():
        k = edge % len(outline.corners)
        if i < len(outline.corners):
            edge += 1
            continue
        place = places[i]
        place.corner, place.on_edge = outline.corners[k], True
        place.along = float(np.hypot(*(found.points[i] - outline.start[k])))
    return places
