"""Stiffness of structures for the time-step: in the 1980 estimate, and in the row sums of the safe bound.

A spring of a structure has the stiffness k along a displacement q of its ends, which is linear in their
displacements and rotations (kernels/structures). It adds to the row sums as a contact does: k times the
products of what a unit of each degree of freedom adds to q (critical_stiffness.py).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.kernels.body.fdef import gradient
from udec_ia.kernels.drive.critical_stiffness import DOFS, add_matrix, enter_displacements
from udec_ia.kernels.structures.attached_points import shares
from udec_ia.kernels.structures.bolts import bolt_axis, bolt_stiffness
from udec_ia.layout import offsets as g

ROWS = 3  # of an end: the grid-points of a zone
AXIAL, SHEAR = 0, 1


@kernel
def greatest_stiffness_of_structures(h: Memory, stiffness: Any) -> float:
    """Greatest stiffness of a spring; that of ends in zones is also added to `stiffness` of grid-points.

    stiffness: one real for every word of IA() in use.
    """
    largest = 0.0
    ia = int64(h.ci[g.IBTPNT])
    while ia != 0:
        kn, ks = bolt_stiffness(h, ia)
        largest = max(largest, max(kn, ks))
        for iz in (iget(h, ia, g.KAZ1), iget(h, ia, g.KAZ2)):
            for i in range(3 if iz != 0 else 0):
                stiffness[iget(h, iz, g.KZG, i)] += kn + ks
        ia = iget(h, ia, g.KA)
    return largest


@kernel
def enter_end(
    h: Memory, ib: int, iz: int, x: float, y: float, q: Any, row: Any, frame: Any, at: Any, moves: Any
) -> None:
    """Enter what the degrees of freedom of an end add to the displacement of a spring.

    ib, iz: block, and zone or 0, at (x, y). q: what a unit of its displacement in x, in y and of its rotation
    adds. at, moves: rows (3) and what their degrees of freedom add (3 by DOFS).
    """
    cx, cy, turn = q
    if iz == 0:
        at[0] = row[ib]
        enter_displacements(h, ib, x, y, cx, cy, at[0], frame, moves[0])
        moves[0, 2] += turn / frame[at[0], 0]
        return
    g1, g2, g3, n1, n2, n3 = shares(h, iz, x, y, 0.0)
    _, _, _, b1, c1, b2, c2, twice = gradient(h, iz, h.cr[g.TDEL] * 0)
    couple = turn / (np.float64(twice) + twice)
    points, share = (g1, g2, g3), (n1, n2, n3)
    b, c = (b1, b2, -(b1 + b2)), (c1, c2, -(c1 + c2))
    for i in range(ROWS):
        at[i] = row[points[i]]
        moves[i, 0] = share[i] * cx - c[i] * couple
        moves[i, 1] = share[i] * cy + b[i] * couple


@kernel
def add_structures(h: Memory, row: Any, frame: Any, weight: Any, own: Any, total: Any) -> None:
    """Add the stiffness of all structures to the row sums. Arguments as of add_contacts."""
    at, moves = np.zeros(2 * ROWS, np.int64), np.zeros((2 * ROWS, 2, DOFS))
    ia = int64(h.ci[g.IBTPNT])
    while ia != 0:
        kn, ks = bolt_stiffness(h, ia)
        length, nx, ny = bolt_axis(h, ia)
        lever = -length * 0.5
        at[:] = 0
        moves[:] = 0.0
        ib, iz, x, y = iget(h, ia, g.KAB1), iget(h, ia, g.KAZ1), getr(h, ia, g.KAX1), getr(h, ia, g.KAY1)
        for end in range(2):
            side = 1.0 if end == 1 else -1.0
            if end == 1:
                ib, iz, x, y = iget(h, ia, g.KAB2), iget(h, ia, g.KAZ2), getr(h, ia, g.KAX2), getr(h, ia, g.KAY2)
            first = ROWS * end
            axial, shear = (side * nx, side * ny, 0.0), (-side * ny, side * nx, lever)
            for k, q in ((AXIAL, axial), (SHEAR, shear)):
                some = moves[first : first + ROWS, k]
                enter_end(h, ib, iz, np.float64(x), np.float64(y), q, row, frame, at[first : first + ROWS], some)
        add_matrix(kn, ks, at, moves, weight, own, total)
        ia = iget(h, ia, g.KA)
