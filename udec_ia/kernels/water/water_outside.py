"""Water outside: the conditions of exposed edges, at the edges and at the contacts between them (report 2.8).

A condition gives a pressure, linear in x and y and not below 0, or the flow into contacts, or closes them,
or keeps an edge dry. It belongs to edges (KEOUT). A wall that is exposed later, as a joint opens, has that of
the nearest edge along the outline of the outer domain. A contact has the lower code of its two walls.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti
from udec_ia.kernels.links.linked_lists import is_corner
from udec_ia.kernels.links.longer_groups import edge_at, pipe_at
from udec_ia.kernels.water.domain_outline import Outlines, Point, edge_after, is_true_corner, trace_outlines
from udec_ia.kernels.water.wall_forces import press_below_level
from udec_ia.layout import offsets as g

ROUNDED = 2.0  # times D: greatest length from a contact to the corner where its joint ends, in its rounding


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
    """Pressure at (x, y) that condition `iou` gives; 0 if it gives none."""
    if iou == 0 or iget(h, iou, g.KOKIND) != g.PRESSURE_OUTSIDE:
        return 0.0
    return max(linear_pressure(h, iou, (x, y)), 0.0) * max(factor_of(h, iou), 0.0)


@kernel
def outer_outline(h: Memory, line: Outlines) -> tuple[int, int]:
    """First place of the outline of the outer domain, and the place after it."""
    idm, k, first = int64(h.ci[g.IDPNT]), 0, 0
    while idm != h.ci[g.IODPNT] and idm != 0:
        idm, k, first = iget(h, idm, g.KD), k + 1, line.ends[k]
    return first, line.ends[k] if idm != 0 else first


@inlined
def own_condition(h: Memory, line: Outlines, k: int, length: float) -> int:
    """Condition of the edge of the piece of that length before place `k`; 0 in the rounding of a joint."""
    if length <= h.cr[g.DTOL] * ROUNDED and not (
        is_corner(h, line.item[k - 1]) and is_corner(h, line.item[k])
    ):
        return int64(0)
    return iget(h, edge_at(h, line.edge[k]), g.KEOUT)


@kernel
def spread_conditions(h: Memory, line: Outlines, first: int, end: int, step: int, near: Any) -> None:
    """Give the pieces of the outer outline the last condition before them, if none is nearer.

    step: 1 or -1, the direction. near: (end - first,) distance of the condition that each has.
    """
    n, found, distance = end - first, int64(0), np.inf
    for count in range(2 * n):
        i = count % n if step > 0 else n - 1 - count % n
        k = first + i
        if line.edge[k] == 0:  # the wall of another block begins: its own walls are nearer to a corner
            distance += h.cr[g.DTOL] * ROUNDED
            continue
        length = np.hypot(line.x[k] - line.x[k - 1], line.y[k] - line.y[k - 1])
        own = own_condition(h, line, k, length)
        if own != 0:
            found, distance = own, 0.0
        if distance < near[i]:
            near[i], line.outside[k] = distance, found
        if own == 0:
            distance += length


@kernel
def find_conditions(h: Memory, line: Outlines) -> None:
    """Conditions of all pieces of the outer outline (outside), and of the contacts there (KPOUT)."""
    first, end = outer_outline(h, line)
    line.outside[first:end] = 0
    near = np.full(end - first, np.inf)
    spread_conditions(h, line, first, end, 1, near)
    spread_conditions(h, line, first, end, -1, near)
    before = end - 1
    for k in range(first, end):
        ic = line.item[k]
        if line.edge[k] == 0 and iget(h, ic, g.KCCOD) != g.VIRTUAL:
            one, two = line.outside[before], line.outside[k + 1]
            if one == 0 or (two != 0 and iget(h, two, g.KOKIND) < iget(h, one, g.KOKIND)):
                one = two
            puti(h, pipe_at(h, ic), g.KPOUT, one)
        before = k


@kernel
def outlines_with_conditions(h: Memory) -> Outlines:
    """The outlines of all domains, and the conditions outside if there are any."""
    line = trace_outlines(h)
    if h.ci[g.IOUPNT] != 0:
        find_conditions(h, line)
    return line


@kernel
def press_outside(h: Memory, line: Outlines, k: int) -> float:
    """Pressure outside on the piece of the outer outline that ends at its point `k`; its power."""
    iou = line.outside[k]
    if iou == 0 or iget(h, iou, g.KOKIND) != g.PRESSURE_OUTSIDE:
        return 0.0
    a, b = (line.x[k - 1], line.y[k - 1]), (line.x[k], line.y[k])
    factor = max(factor_of(h, iou), 0.0)
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
        if is_true_corner(h, corner) and np.hypot(px - x, py - y) < found:
            found, ex, ey = np.hypot(px - x, py - y), px, py
    return ex, ey
