"""Stiffness of structures for the time-step: in the 1980 estimate, and in the row sums of the safe bound.

A spring of a structure has the stiffness k along a displacement q of its ends, which is linear in their
displacements and rotations (kernels/structures). It adds to the row sums as a contact does: k times the
products of what a unit of each degree of freedom adds to q (critical_stiffness.py).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, real
from udec_ia.kernels.body.fdef import gradient
from udec_ia.kernels.drive.critical_stiffness import DOFS, add_matrix, enter_displacements
from udec_ia.kernels.structures.attached_points import shares
from udec_ia.kernels.structures.beams import (
    element_axis,
    element_stiffness,
    interface_axes,
    interface_stiffness,
)
from udec_ia.kernels.structures.bolts import bolt_axis, bolt_stiffness
from udec_ia.layout import offsets as g

ROWS = 3  # of an end: the grid-points of a zone
AXIAL, SHEAR = 0, 1


@kernel
def add_to_zone(h: Memory, iz: int, k: float, stiffness: Any) -> None:
    """Add `k` to `stiffness` of the grid-points of zone `iz`, if that is not 0."""
    for i in range(3 if iz != 0 else 0):
        stiffness[iget(h, iz, g.KZG, i)] += k


@kernel
def node_step(h: Memory, stiffness: Any) -> tuple[float, int]:
    """Least mass over stiffness of the nodes of structures, and the node; stiffness of zones as below."""
    im = int64(h.ci[g.IELPNT])
    while im != 0:
        length, _, _ = element_axis(h, im)
        axial, bending = element_stiffness(h, im)
        for node in (iget(h, im, g.KMN1), iget(h, im, g.KMN2)):
            stiffness[node] += axial + 12.0 * bending / (length * length)
        im = iget(h, im, g.KM)
    smallest, at = np.inf, int64(0)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        kn, ks = interface_stiffness(h, node)
        stiffness[node] += kn + ks
        add_to_zone(h, iget(h, node, g.KNZN), kn + ks, stiffness)
        if getr(h, node, g.KNM) < smallest * stiffness[node]:
            smallest, at = getr(h, node, g.KNM) / stiffness[node], node
        node = iget(h, node, g.KN)
    return smallest, at


@kernel
def greatest_stiffness_of_structures(h: Memory, stiffness: Any) -> float:
    """Greatest stiffness of a spring on a block; in zones it is added to `stiffness` of grid-points.

    stiffness: one real for every word of IA() in use.
    """
    largest = 0.0
    ia = int64(h.ci[g.IBTPNT])
    while ia != 0:
        kn, ks = bolt_stiffness(h, ia)
        largest = max(largest, max(kn, ks))
        add_to_zone(h, iget(h, ia, g.KAZ1), kn + ks, stiffness)
        add_to_zone(h, iget(h, ia, g.KAZ2), kn + ks, stiffness)
        ia = iget(h, ia, g.KA)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        kn, ks = interface_stiffness(h, node)
        largest = max(largest, max(kn, ks))
        node = iget(h, node, g.KN)
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
    _, _, _, b1, c1, b2, c2, twice = gradient(h, iz, real(h, 0.0))
    couple = turn / (np.float64(twice) + twice)
    points, share = (g1, g2, g3), (n1, n2, n3)
    b, c = (b1, b2, -(b1 + b2)), (c1, c2, -(c1 + c2))
    for i in range(ROWS):
        at[i] = row[points[i]]
        moves[i, 0] = share[i] * cx - c[i] * couple
        moves[i, 1] = share[i] * cy + b[i] * couple


@kernel
def enter_node(node: int, q: Any, row: Any, frame: Any, at: Any, moves: Any) -> None:
    """As enter_end, for a node."""
    cx, cy, turn = q
    at[0] = row[node]
    moves[0, 0], moves[0, 1], moves[0, 2] = cx, cy, turn / frame[at[0], 0]


@kernel
def add_elements(h: Memory, row: Any, frame: Any, weight: Any, own: Any, total: Any) -> None:
    """Add the stiffness of all elements to the row sums."""
    at, moves = np.zeros(2, np.int64), np.zeros((2, 2, DOFS))
    im = int64(h.ci[g.IELPNT])
    while im != 0:
        axial, bending = element_stiffness(h, im)
        length, nx, ny = element_axis(h, im)
        n1, n2 = iget(h, im, g.KMN1), iget(h, im, g.KMN2)
        px, py = -2.0 * ny / length, 2.0 * nx / length
        for k1, k2, one, two in (
            (axial, bending, ((-nx, -ny, 0.0), (0.0, 0.0, -1.0)), ((nx, ny, 0.0), (0.0, 0.0, 1.0))),
            (3.0 * bending, 0.0, ((px, py, 1.0), (0.0, 0.0, 0.0)), ((-px, -py, 1.0), (0.0, 0.0, 0.0))),
        ):
            moves[:] = 0.0
            for k in range(2):
                enter_node(n1, one[k], row, frame, at[:1], moves[:1, k])
                enter_node(n2, two[k], row, frame, at[1:], moves[1:, k])
            add_matrix(k1, k2, at, moves, weight, own, total)
        im = iget(h, im, g.KM)


@kernel
def add_interfaces(h: Memory, row: Any, frame: Any, weight: Any, own: Any, total: Any) -> None:
    """Add the stiffness of the interfaces of all nodes to the row sums."""
    at, moves = np.zeros(1 + ROWS, np.int64), np.zeros((1 + ROWS, 2, DOFS))
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        ib, iz = iget(h, node, g.KNBL), iget(h, node, g.KNZN)
        if ib != 0:
            kn, ks = interface_stiffness(h, node)
            nx, ny, tx, ty = interface_axes(h, node)
            ax, ay = np.float64(getr(h, node, g.KNAX)), np.float64(getr(h, node, g.KNAY))
            rx, ry = getr(h, node, g.KNX) - ax, getr(h, node, g.KNY) - ay
            at[:] = 0
            moves[:] = 0.0
            for k, cx, cy in ((AXIAL, nx, ny), (SHEAR, tx, ty)):
                enter_node(node, (cx, cy, 0.0), row, frame, at[:1], moves[:1, k])
                q = (-cx, -cy, ry * cx - rx * cy)
                enter_end(h, ib, iz, ax, ay, q, row, frame, at[1:], moves[1:, k])
            add_matrix(kn, ks, at, moves, weight, own, total)
        node = iget(h, node, g.KN)


@kernel
def add_structures(h: Memory, row: Any, frame: Any, weight: Any, own: Any, total: Any) -> None:
    """Add the stiffness of all structures to the row sums. Arguments as of add_contacts."""
    add_elements(h, row, frame, weight, own, total)
    add_interfaces(h, row, frame, weight, own, total)
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
                ib, iz = iget(h, ia, g.KAB2), iget(h, ia, g.KAZ2)
                x, y = getr(h, ia, g.KAX2), getr(h, ia, g.KAY2)
            first = ROWS * end
            axial, shear = (side * nx, side * ny, 0.0), (-side * ny, side * nx, lever)
            for k, q in ((AXIAL, axial), (SHEAR, shear)):
                some = moves[first : first + ROWS, k]
                enter_end(
                    h, ib, iz, np.float64(x), np.float64(y), q, row, frame, at[first : first + ROWS], some
                )
        add_matrix(kn, ks, at, moves, weight, own, total)
        ia = iget(h, ia, g.KA)
