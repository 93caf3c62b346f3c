"""Water outside: the conditions of exposed edges, at the edges and at the contacts between them (report 2.8).

A condition gives a pressure, linear in x and y and not below 0, or the flow into contacts, or closes them. It
belongs to edges (KEOUT). A contact on the outside has that of the edge at its foot or beyond the corner
there. Without one the pressure is 0.

The walls of a joint from its last contact to its end, within its roundings, have the pressure outside.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.kernels.links.linked_lists import is_corner, next_corner
from udec_ia.kernels.links.longer_groups import edge_at
from udec_ia.kernels.water.domain_outline import Outlines, Point, edge_after, ends_a_joint
from udec_ia.kernels.water.wall_forces import press_below_level
from udec_ia.layout import offsets as g

ROUNDED = 2.0  # times D: greatest length from a contact to the corner where its joint ends


@inlined
def factor_of(h: Memory, iou: int) -> float:
    """Present factor of condition `iou`."""
    isg = iget(h, iou, g.KOS)
    return np.float64(getr(h, isg, g.KTNOW)) if isg != 0 else 1.0


@kernel
def linear_pressure(h: Memory, iou: int, at: Point) -> float:
    """Pressure of condition `iou` at a point, which may be below 0, without its factor."""
    return np.float64(getr(h, iou, g.KOP)) + getr(h, iou, g.KOGX) * at[0] + getr(h, iou, g.KOGY) * at[1]


@kernel
def pressure_outside(h: Memory, iou: int, x: float, y: float) -> float:
    """Pressure at (x, y) that condition `iou` gives; 0 if it gives a flow."""
    if iou == 0 or iget(h, iou, g.KOKIND) != g.PRESSURE_OUTSIDE:
        return 0.0
    return max(linear_pressure(h, iou, (x, y)) * factor_of(h, iou), 0.0)


@kernel
def outside_on_wall(h: Memory, ib: int, ic: int, ahead: bool) -> int:
    """Condition of the edge of block `ib` at contact `ic`, or of the one beyond the corner there; 0 for none.

    ahead: the outside is ahead of the contact in the list of the block.
    """
    ip = edge_after(h, ib, ic)
    iou = iget(h, edge_at(h, ip), g.KEOUT)
    if iou != 0:
        return iou
    beyond = next_corner(h, ib, ip) if ahead else iget(h, ip, g.KR)
    corner = ip if ahead else iget(h, ip, g.KR)
    return iget(h, edge_at(h, beyond), g.KEOUT) if ends_a_joint(h, corner) else int64(0)


@kernel
def outside_at(h: Memory, ic: int) -> int:
    """Condition of water outside at contact `ic` between the outer domain and another; 0 for none.

    Of two different ones a pressure counts, then a flow.
    """
    from_one = iget(h, ic, g.KD2) == h.ci[g.IODPNT]  # the wall outside goes on ahead on block KB1
    one = outside_on_wall(h, iget(h, ic, g.KB1), ic, from_one)
    two = outside_on_wall(h, iget(h, ic, g.KB2), ic, not from_one)
    if one == 0 or two == 0:
        return one + two
    return one if iget(h, one, g.KOKIND) <= iget(h, two, g.KOKIND) else two


@kernel
def outside_of_piece(h: Memory, line: Outlines, k: int) -> int:
    """Condition on the piece of the outer outline that ends at its point `k`; 0 for none.

    It is that of the edge, or at the end of a joint that of the contact.
    """
    iou = iget(h, edge_at(h, line.edge[k]), g.KEOUT)
    if iou != 0:
        return iou
    length = np.hypot(line.x[k] - line.x[k - 1], line.y[k] - line.y[k - 1])
    if length > h.cr[g.DTOL] * ROUNDED:
        return int64(0)
    for item in (line.item[k - 1], line.item[k]):
        if not is_corner(h, item) and iget(h, item, g.KCCOD) != g.VIRTUAL:
            return outside_at(h, item)
    return int64(0)


@kernel
def press_outside(h: Memory, line: Outlines, k: int) -> float:
    """Pressure outside on the piece of the outer outline that ends at its point `k`; its power."""
    iou = outside_of_piece(h, line, k)
    if iou == 0 or iget(h, iou, g.KOKIND) != g.PRESSURE_OUTSIDE:
        return 0.0
    a, b = (line.x[k - 1], line.y[k - 1]), (line.x[k], line.y[k])
    factor = factor_of(h, iou)
    pa, pb = linear_pressure(h, iou, a) * factor, linear_pressure(h, iou, b) * factor
    return press_below_level(h, line.block[k], line.edge[k], a, b, pa, pb)


@kernel
def outer_end(h: Memory, ic: int) -> tuple[float, float]:
    """The end of the joint of contact `ic` at the outer domain: the nearest corner there, or the contact."""
    x, y = np.float64(getr(h, ic, g.KXC)), np.float64(getr(h, ic, g.KYC))
    found, ex, ey = np.float64(h.cr[g.DTOL]) * ROUNDED, x, y
    from_one = iget(h, ic, g.KD2) == h.ci[g.IODPNT]
    for ib, ahead in ((iget(h, ic, g.KB1), from_one), (iget(h, ic, g.KB2), not from_one)):
        ip = edge_after(h, ib, ic)
        corner = ip if ahead else iget(h, ip, g.KR)
        px, py = np.float64(getr(h, corner, g.KXP)), np.float64(getr(h, corner, g.KYP))
        if ends_a_joint(h, corner) and np.hypot(px - x, py - y) < found:
            found, ex, ey = np.hypot(px - x, py - y), px, py
    return ex, ey
