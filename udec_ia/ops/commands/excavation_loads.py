"""DELETE ... FUNCTION: the forces of deleted blocks on the others stay as loads, times a FUNCTION of time.

So an excavated boundary can be relaxed by a factor, or bit by bit. A load acts at both ends of the edge on
which the contact was, with the same resultant and moment; on a block with zones at the grid-points that had
the force.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.boundary_point import lever
from udec_ia.kernels.constitutive.joint_stresses import place_of_force
from udec_ia.kernels.geometry.contact_geometry import coord_called
from udec_ia.kernels.links.linked_lists import corner_of, is_corner, next_corner, other
from udec_ia.kernels.map.domain_segments import is_on_arc
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.boundary_command import Loads, add_to_load
from udec_ia.ops.common.block_ranges import items

PLACE_AND_FORCE = 4  # x, y (m), force in x and y (N/m)


@kernel
def contact_forces(h: Memory, contacts: Any, found: Any) -> None:
    """Where the forces of contacts act, and those on their second blocks.

    contacts: (n,) addresses. found: (n, 4) reals: x, y (m), and the force in x and y (N/m).
    """
    for k in range(len(contacts)):
        ic = contacts[k]
        nx, ny, _, _ = coord_called(h, ic)
        fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
        found[k, 0], found[k, 1] = place_of_force(h, ic)
        found[k, 2], found[k, 3] = nx * fn + ny * fs, ny * fn - nx * fs


def loads_of_blocks(array: MainArray, blocks: list[int]) -> Loads:
    """The loads that take the place of the contact forces of `blocks` on others."""
    h, gone, loads = array.h, set(blocks), Loads()
    touching = dict.fromkeys(ic for ib in blocks for ic in items(h, ib) if not is_corner(h, ic))
    contacts = [
        ic
        for ic in touching
        if iget(h, ic, g.KCCOD) != g.VIRTUAL and not {iget(h, ic, g.KB1), iget(h, ic, g.KB2)} <= gone
    ]
    found = np.empty((len(contacts), PLACE_AND_FORCE), h.cr.dtype)
    contact_forces(h, np.array(contacts, np.int64), found)
    for ic, (x, y, fx, fy) in zip(contacts, found.tolist(), strict=True):
        ib = iget(h, ic, g.KB2)
        if ib in gone:
            ib, fx, fy = other(h, ib, ic), -fx, -fy
        if iget(h, ib, HEAD) == g.MFDEF:
            _load_grid_points(h, ib, ic, (x, y), (fx, fy), loads)
        else:
            _load_edge(h, ib, ic, (x, y), (fx, fy), loads)
    return loads


def _load_grid_points(
    h: Memory, ib: int, ic: int, place: tuple[float, float], force: tuple[float, float], loads: Loads
) -> None:
    """Load the grid-points of the corner or the edge of contact `ic` of block `ib`, as the contact does."""
    ip = int(corner_of(h, ib, ic))
    part = 1.0 if is_on_arc(h, ib, ic) else float(lever(h, ip, *place))
    for corner, share in ((ip, part), (iget(h, ip, g.KR), 1 - part)):
        ig = iget(h, corner, g.KGP)
        if ig and share:
            add_to_load(loads, (ib, ig, 0, 0), (force[0] * share, force[1] * share, 0.0, 0.0, 0.0))


def _load_edge(
    h: Memory, ib: int, ic: int, place: tuple[float, float], force: tuple[float, float], loads: Loads
) -> None:
    """Load the two ends of the edge of contact `ic` of block `ib`, which has no grid-points.

    At a corner it is that of the two edges which is nearer to the place of the force.
    """
    ip = int(corner_of(h, ib, ic))
    ends = [ip, int(next_corner(h, ib, ip))] if is_on_arc(h, ib, ic) else [ip]
    edges = [_Edge(h, iget(h, end, g.KR), end, place) for end in ends]
    edge = min(edges, key=lambda one: one.distance)
    dx, dy = edge.vector
    couple = (edge.off[0] * force[1] - edge.off[1] * force[0]) / edge.square  # of forces across the edge
    for corner, end, share, sign in (
        (edge.end, edge.start, edge.part, 1),
        (edge.start, edge.end, 1 - edge.part, -1),
    ):
        fx, fy = force[0] * share - sign * couple * dy, force[1] * share + sign * couple * dx
        add_to_load(loads, (ib, 0, corner, end), (fx, fy, 0.0, 0.0, 0.0))


class _Edge:
    """The edge from corner `start` to corner `end`, and a place beside it.

    part: of the line, at which the place is; off: the vector from there to the place, across the line;
    distance: of the place from the edge.
    """

    def __init__(self, h: Memory, start: int, end: int, place: tuple[float, float]) -> None:
        (ax, ay), (bx, by) = ((float(getr(h, i, g.KXP)), float(getr(h, i, g.KYP))) for i in (start, end))
        dx, dy = bx - ax, by - ay
        self.start, self.end, self.vector, self.square = start, end, (dx, dy), dx * dx + dy * dy
        self.part = ((place[0] - ax) * dx + (place[1] - ay) * dy) / self.square
        nearest = min(max(self.part, 0.0), 1.0)
        self.off = place[0] - ax - self.part * dx, place[1] - ay - self.part * dy
        self.distance = math.hypot(place[0] - ax - nearest * dx, place[1] - ay - nearest * dy)
