"""Verification problems that blocks of all three types share: sliding, toppling and a column on a plane."""

from __future__ import annotations

from math import atan, cos, pi, radians, sin, sqrt, tan
from typing import Any

import numpy as np
from figure import RHO, Figure, cycle_for, deform

from udec_ia import Model
from udec_ia.layout import offsets as g

GRAVITY = 10.0
TYPES = ("rigid", "sdef", "fdef")


def on_base(
    kind: str, b: float, h: float, d: float, friction: float, n: int = 1, width: float = 12.0
) -> Model:
    """A column of `n` blocks, `b` broad and `h` high, on a fixed rigid base with its top at y = 0."""
    m = Model()
    m.gravity(0, -GRAVITY)
    m.fraction(0.2)
    m.property(1, density=RHO, kn=1e9, ks=1e9, bulk=4e9, g=2e9, friction=friction)
    m.round(d)
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
        deform(m, kind, -b / 2, b / 2, k * h, (k + 1) * h)
    return m


def standing(m: Model) -> Any:
    """The blocks above the base, from the lowest one up."""
    blocks = m.table("block")
    return np.sort(blocks[blocks["KY"] > 0], order="KY")


def settle(m: Model, mass: float, n: int, cycles: int) -> None:
    """Critical damping of the lowest mode of a column of `n` blocks, until it rests."""
    lowest = 2 * sqrt(2 * 1e9 / mass) * sin(pi / (2 * (2 * n + 1)))
    m.damping(1.0, lowest / (2 * pi), "mass")
    m.damping(0.5, lowest / (2 * pi), "internal")
    m.cycle(cycles)


def incline() -> list[Figure]:
    """Acceleration down a slope of 30 degrees with friction 20 degrees: g (sin psi - mu cos psi)."""
    psi, mu = radians(30), tan(radians(20))
    figures = []
    for kind in TYPES:
        m = on_base(kind, 2, 1, 0.1, mu, width=40.0)
        settle(m, RHO * 2, 1, 1000)
        m.damping(0, 1)
        m.gravity(GRAVITY * sin(psi), -GRAVITY * cos(psi))
        cycle_for(m, 0.7)
        before, t0 = standing(m)[0], float(m.h.cd[g.TIME])
        cycle_for(m, 2)
        after, time_ = standing(m)[0], float(m.h.cd[g.TIME]) - t0
        got = float(after["KXD"] - before["KXD"]) / time_
        exact = GRAVITY * (sin(psi) - mu * cos(psi))
        figures.append(Figure(f"slide down an incline, {kind} (m/s2)", got, exact, 0.01))
    return figures


def column() -> list[Figure]:
    """Overlap at the foot of a column of n blocks on two contacts each: n W/(2 KN)."""
    n, b = 5, 2.0
    figures = []
    for kind in TYPES:
        m = on_base(kind, b, b, 0.1, 0.5, n)
        settle(m, RHO * b * b, n, 6000)
        contacts = m.table("contact")
        foot = contacts[(contacts["KYC"] < b / 2) & (contacts["KCFN"] > 0)]
        overlap, exact = float(foot["KCN"].mean()), n * RHO * b * b * GRAVITY / 2e9
        figures.append(Figure(f"column of {n}, overlap at its foot, {kind} (m)", overlap, exact, 1e-3))
    return figures


def falls(kind: str, b: float, h: float, d: float, slope: float) -> bool:
    """True if a block topples on a slope (tangent of its angle)."""
    m = on_base(kind, b, h, d, 3.0)
    settle(m, RHO * b * h, 1, 1000)
    m.damping(1.0, 1.0, "mass")
    angle = atan(slope)
    m.gravity(GRAVITY * sin(angle), -GRAVITY * cos(angle))
    cycle_for(m, 5)
    return bool(standing(m)[0]["KX"] > 0.05 * b)


def toppling() -> list[Figure]:
    """Slope at which a block topples, by bisection: base/height.

    Forces act at the ends of the roundings of rigid and simply-deformable blocks, base b - 2D, and at the
    corners of fully-deformable ones, base b.
    """
    b, h, d = 1.0, 2.0, 0.1
    figures = []
    for kind in TYPES:
        low, high = (b - 3 * d) / h, (b + d) / h
        while high - low > 0.004:
            middle = (low + high) / 2
            low, high = (low, middle) if falls(kind, b, h, d, middle) else (middle, high)
        base = b if kind == "fdef" else b - 2 * d
        name = f"toppling slope, {kind}: {'b/h' if base == b else '(b - 2D)/h'}"
        figures.append(Figure(name, (low + high) / 2, base / h, 0.01))
    return figures
