"""What the contacts add to the row sums of the stiffness matrix (ops.run.timestep: the bound).

A contact of the stiffness k with the displacement u = sum_j s_j q_j of its point, q_j the degrees of freedom
of both sides and s_j how far a unit of each moves the point, has |K_ij| = k |s_i| |s_j|: row i gets k |s_i|
times the sum of |s_j| over what is free. This for x and for y.

What moves with one side: a body that is not meshed with all its degrees of freedom, or the two grid-points at
the ends of the edge, or the one at the corner, of a fully-deformable block.

All is calculated in 64 bits: np.float64 widens a real compiled and interpreted, float() only interpreted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.heap.jit import kernel
from udec_ia.layout import offsets as g

DOFS = 6  # of a block: x, y, rotation, strains 11, 22, 12; a grid-point has the first two
X, Y = 0, 1


@kernel
def _part(h: Memory, ip: int, x: float, y: float) -> float:
    """Where the point (x, y) stands on the edge that ends at corner `ip`: 0 at its start, 1 at its end."""
    ia = iget(h, ip, g.KR)
    ax, ay = np.float64(getr(h, ia, g.KXP)), np.float64(getr(h, ia, g.KYP))
    dx, dy = np.float64(getr(h, ip, g.KXP)) - ax, np.float64(getr(h, ip, g.KYP)) - ay
    square = dx * dx + dy * dy
    if not square > 0:
        return 1.0
    return min(max(((x - ax) * dx + (y - ay) * dy) / square, 0.0), 1.0)


@kernel
def _enter_body(h: Memory, ib: int, x: float, y: float, row: Any, length: Any, at: Any, moves: Any) -> None:
    """Row of block `ib`, and how far a unit of each of its degrees of freedom moves the point (x, y)."""
    at[0] = row[ib]
    rx = abs(x - np.float64(getr(h, ib, g.KX))) / length[at[0]]
    ry = abs(y - np.float64(getr(h, ib, g.KY))) / length[at[0]]
    moves[0, X, 0] = moves[0, Y, 1] = 1.0
    moves[0, X, 2] = moves[0, X, 5] = moves[0, Y, 4] = ry
    moves[0, Y, 2] = moves[0, Y, 5] = moves[0, X, 3] = rx


@kernel
def _enter_edge(h: Memory, ip: int, part: float, row: Any, at: Any, moves: Any) -> None:
    """Rows of the grid-points at the ends of the edge of corner `ip`, and how far they move its point."""
    at[0], at[1] = row[iget(h, ip, g.KGP)], row[iget(h, iget(h, ip, g.KR), g.KGP)]
    moves[0, X, 0] = moves[0, Y, 1] = part
    moves[1, X, 0] = moves[1, Y, 1] = 1.0 - part


@kernel
def _add(k: float, at: Any, moves: Any, free: Any, total: Any) -> None:
    """Add what a contact of the stiffness `k` gives to the row sums of both its sides."""
    for axis in range(2):
        moved = 0.0
        for side in range(2):
            for j in range(2):
                for i in range(DOFS):
                    moved += moves[side, j, axis, i] * free[at[side, j], i]
        for side in range(2):
            for j in range(2):
                for i in range(DOFS):
                    total[at[side, j], i] += moves[side, j, axis, i] * (k * moved)


@kernel
def add_contacts(h: Memory, row: Any, length: Any, free: Any, total: Any) -> None:
    """Add the stiffness of all contacts that are not virtual to the row sums `total`, n by 6.

    row: of the block or grid-point at each address; row 0 stands for nothing. length: radii of gyration of
    the rows. free: n by 6, 1 for a degree of freedom and 0 for what is held.
    """
    at, moves = np.zeros((2, 2), np.int64), np.zeros((2, 2, 2, DOFS))  # of both sides
    ic = h.ci[g.ICPNT]
    while ic != 0:
        code = iget(h, ic, g.KCCOD)
        if code != g.VIRTUAL:
            x, y = np.float64(getr(h, ic, g.KXC)), np.float64(getr(h, ic, g.KYC))
            moves[:] = 0.0
            at[:] = 0
            for side in range(2):
                ib = iget(h, ic, g.KB1 if side == 0 else g.KB2)
                if iget(h, ib, HEAD) == g.MFDEF:
                    ip = iget(h, ic, g.KCP1 if side == 0 else g.KCP2)
                    on_edge = code == (g.EDGE_CORNER if side == 0 else g.CORNER_EDGE)
                    part = _part(h, ip, x, y) if on_edge else 1.0
                    _enter_edge(h, ip, part, row, at[side], moves[side])
                else:
                    _enter_body(h, ib, x, y, row, length, at[side], moves[side])
            m = iget(h, ic, g.KCM) - 1
            _add(np.float64(max(h.cr[g.AKN + m], h.cr[g.AKS + m])), at, moves, free, total)
        ic = iget(h, ic, g.KC)
