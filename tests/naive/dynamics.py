"""Tiny integrators and closed forms for the mechanics of one or two rigid blocks."""

from __future__ import annotations

from math import atan2, cos, sin


def bounce(
    mass: float, kn: float, g: float, dt: float, alpha: float, beta: float, u: float, n: int
) -> list[float]:
    """Overlaps of a mass on a spring after each of `n` steps; it starts at rest with the overlap `u`.

    Velocities at half steps; mass damping centred, the dashpot fed with the last half step's velocity.
    """
    overlaps, v, force = [], 0.0, kn * u
    for _ in range(n):
        v = (v * (1 - alpha * dt / 2) + (g - force / mass) * dt) / (1 + alpha * dt / 2)
        u += v * dt
        force = kn * u + beta * kn * v
        overlaps.append(u)
    return overlaps


def peaks(values: list[float]) -> list[tuple[float, float]]:
    """(step, value) of the maxima, by a parabola through three neighbours; steps count from 0."""
    found = []
    for k in range(1, len(values) - 1):
        a, b, c = values[k - 1 : k + 2]
        if a < b >= c:
            shift = (a - c) / (2 * (a - 2 * b + c))
            found.append((k + shift, b - (a - c) * shift / 4))
    return found


def slide(g: float, slope: float, friction: float) -> float:
    """Acceleration of a block down a plane of the angle `slope`; `friction` is a coefficient."""
    return g * (sin(slope) - friction * cos(slope))


def slide_two(
    g: float, masses: tuple[float, float], slopes: tuple[float, float], friction: float
) -> tuple[float, float]:
    """Accelerations along their slopes when a block slides on a block that slides on a plane.

    masses, slopes: of the lower block and of the upper one. The first acceleration is the lower block's,
    the second that of the upper block relative to it, both down to the left.

    Unit vectors down the slope t = (-cos, -sin) and away from the plane n = (-sin, cos). Lower block:
    a1 = a t1, upper one a2 = a t1 + r t2; the planes carry N (n - friction t). With p2 = n2 - friction t2:

        m2 (a t1 + r t2) = m2 g + N2 p2          m1 a t1 = m1 g + N1 p1 - N2 p2
    """
    (m1, m2), (s1, s2) = masses, slopes
    t1, n1 = (-cos(s1), -sin(s1)), (-sin(s1), cos(s1))
    t2, n2 = (-cos(s2), -sin(s2)), (-sin(s2), cos(s2))
    p1 = (n1[0] - friction * t1[0], n1[1] - friction * t1[1])
    p2 = (n2[0] - friction * t2[0], n2[1] - friction * t2[1])
    rows = [
        [m2 * t1[0], m2 * t2[0], 0.0, -p2[0], 0.0],
        [m2 * t1[1], m2 * t2[1], 0.0, -p2[1], -m2 * g],
        [m1 * t1[0], 0.0, -p1[0], p2[0], 0.0],
        [m1 * t1[1], 0.0, -p1[1], p2[1], -m1 * g],
    ]
    a, r, _, _ = solve(rows)
    return a, r


def solve(rows: list[list[float]]) -> list[float]:
    """Gaussian elimination with pivoting; each row ends with its right-hand side."""
    rows = [row[:] for row in rows]
    n = len(rows)
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(n):
            if i != k:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return [rows[k][n] / rows[k][k] for k in range(n)]


def angle_between(ux: float, uy: float, vx: float, vy: float) -> float:
    """Angle by which (ux, uy) has to be turned anticlockwise to point along (vx, vy)."""
    return atan2(ux * vy - uy * vx, ux * vx + uy * vy)
