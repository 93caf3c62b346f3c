"""What problems build alike: blocks on a fixed base, and how they come to rest there."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from udec_ia.model import Model
from udec_ia.verify.case import Case

REST = 1e-10  # force ratio of a state of rest, as far as the reals can hold one


def on_base(case: Case, m: Model, b: float, h: float, n: int = 1, width: float = 12.0) -> None:
    """Build a column of `n` blocks, `b` broad and `h` high, on a fixed rigid base with its top at y = 0.

    The column stands in the middle of the base, which is `width` wide and 1 m high; the lowest block is
    centred at (0, h/2). The blocks are of the type of the case.
    """
    m.block(-width / 2, -1, -width / 2, n * h, width / 2, n * h, width / 2, -1)
    m.split(-width, 0, width, 0)
    for x in (-b / 2, b / 2):
        m.split(x, -0.5, x, n * h + 1)
    m.delete(-width, -b / 2, 0, n * h)
    m.delete(b / 2, width, 0, n * h)
    for k in range(1, n):
        m.split(-width, k * h, width, k * h)
    m.fix(-width, width, -1, 0)
    for k in range(n):
        case.deform(m, -b / 2, b / 2, k * h, (k + 1) * h)


def settle(case: Case, m: Model, stiffness: float, mass: float, limit: int = 20_000) -> None:
    """Let the blocks come to rest under critical damping of a mass on a spring; then take it away.

    The force ratio of rest is REST, or what the last digits of 32-bit reals leave.
    """
    frequency = sqrt(stiffness / mass) / (2 * pi)
    m.damping(2.0, frequency, "mass")
    m.damping(1.0, frequency, "internal")
    m.solve(max(REST, 1e4 * case.last_digit), limit)
    m.damping(0, 1)
    m.damping(0, 1, "internal")


def tilt(m: Model, g: float, angle: float, steps: int = 10, ratio: float = 1e-4) -> None:
    """Turn gravity g from downwards towards x, by `angle` (rad) in `steps`, with rest between them."""
    for k in range(1, steps + 1):
        m.gravity(g * sin(angle * k / steps), -g * cos(angle * k / steps))
        m.solve(ratio, 5000)
