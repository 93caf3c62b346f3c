"""Courses of bricks on a slope, for chatter_by_damping.py in docs/studies."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from udec_ia import Model


def slope(out: Path | str) -> Model:
    """Bricks, 3 m long and 1 m high, on a slope of 30 degrees, whose friction would hold them at 45.

    Nothing bears a force at first; the weight comes at once.
    """
    m = Model(out=out)
    m.property(1, density=2500, kn=1e10, ks=1e10, friction=1)
    m.round(0.05)
    m.gravity(5, -8.66)
    m.block(0, -1, 0, 5, 24, 5, 24, -1)
    for y in range(5):
        m.split(-1, y, 25, y)
    for y in range(5):
        for x in np.arange(1.5 if y % 2 else 3.0, 24, 3):
            m.split(x, y - 0.01, x, y + 1.01)
    m.fix(0, 24, -1, 0)
    return m
