"""Beams by the stiffness matrices of the textbook."""

from __future__ import annotations

from typing import Any

import numpy as np


def element_matrix(young: float, area: float, inertia: float, one: Any, two: Any) -> Any:
    """Forces on the nodes at `one` and `two` for displacements x, y and rotation of each, (6, 6)."""
    dx, dy = np.subtract(two, one)
    length = float(np.hypot(dx, dy))
    c, s = dx / length, dy / length
    a, b = young * area / length, young * inertia / length
    side, slope = 12 * b / length**2, 6 * b / length
    local = np.array(
        [
            [a, 0, 0, -a, 0, 0],
            [0, side, slope, 0, -side, slope],
            [0, slope, 4 * b, 0, -slope, 2 * b],
            [-a, 0, 0, a, 0, 0],
            [0, -side, -slope, 0, side, -slope],
            [0, slope, 2 * b, 0, -slope, 4 * b],
        ]
    )
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    both = np.block([[turn, np.zeros((3, 3))], [np.zeros((3, 3)), turn]])
    return both.T @ local @ both


def loaded_beam(young: float, area: float, inertia: float, at: Any, springs: Any, weights: Any) -> Any:
    """Displacement x, y and rotation (n, 3) of the nodes of a beam at `at` (n, 2), pulled down by `weights`.

    springs: stiffness in x and in y that holds each node.
    """
    n = len(at)
    matrix, load = np.zeros((3 * n, 3 * n)), np.zeros(3 * n)
    for k in range(n - 1):
        some = slice(3 * k, 3 * k + 6)
        matrix[some, some] += element_matrix(young, area, inertia, at[k], at[k + 1])
    for k in range(n):
        matrix[3 * k, 3 * k] += springs[k]
        matrix[3 * k + 1, 3 * k + 1] += springs[k]
        load[3 * k + 1] = -weights[k]
    return np.linalg.solve(matrix, load).reshape(n, 3)
