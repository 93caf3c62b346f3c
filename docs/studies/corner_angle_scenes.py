"""One block with corners of a given angle above a fixed floor, for corner_angles.py."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from udec_ia import Model

BUILDS = {"64": "i32r64", "32": "i32r32"}
DENSITY, FRICTION, ROUNDING = 2000.0, 0.3, 0.02
GAP, LEFT, RIGHT = 1e-3, -3.0, 6.0  # under the block that will stand; ends of the floor
Shape = list[tuple[float, float]]
Tell = Callable[[str], None]


def standing(angle: float) -> Shape:
    """A base from 0 to 1 between two corners of that angle; clockwise."""
    a = math.radians(angle)
    if angle < 90:  # a trapezium, its top half as wide as its base
        top = GAP + 0.25 * math.tan(a)
        return [(0, GAP), (0.25, top), (0.75, top), (1, GAP)]
    out, up = -0.5 * math.cos(a), GAP + 0.5 * math.sin(a)
    if angle == 90:
        return [(0, GAP), (0, up), (1, up), (1, GAP)]
    return [(0, GAP), (-out, up), (-out, up + 0.5), (1 + out, up + 0.5), (1 + out, up), (1, GAP)]


def falling(angle: float) -> Shape:
    """A tip of that angle 5 cm above the floor, under a body half a metre high; clockwise."""
    half = math.radians(angle / 2)
    edge = min(1.0, 0.5 / math.sin(half))
    x, y = edge * math.sin(half), 0.05 + edge * math.cos(half)
    return [(0, 0.05), (-x, y), (-x, y + 0.5), (x, y + 0.5), (x, y)]


def area(shape: Shape) -> float:
    """Of a polygon."""
    x, y = np.array(shape).T
    return float(abs(x @ np.roll(y, 1) - y @ np.roll(x, 1))) / 2


def scene(build: str, shape: Shape, kn: float, tell: Tell) -> Model:
    """The block of that shape and the floor, which is fixed. kn: over the mass of the block.

    Both are parts of one outline, in the form of a C, so that no cut goes through the corners: a neck on the
    block's top, a beam and a column are cut off at right angles and deleted.
    """
    m = Model(BUILDS[build], out="/tmp")
    m.tell, m.inform = tell, lambda _: None
    stiffness = kn * DENSITY * area(shape)
    m.property(1, density=DENSITY, kn=stiffness, ks=stiffness, friction=FRICTION)
    top = max(y for _, y in shape)
    k = [y for _, y in shape].index(top)
    (left, _), (right, _) = shape[k], shape[k + 1]
    below = shape[k + 2 :] + shape[:k]  # from the right side round the tip to the left
    slanted = below[-1][0] != left
    outline = [(LEFT - 1, -1.0), (LEFT - 1, top + 2), (right, top + 2)]
    outline += [(right, top)] * slanted + below + [(left, top)] * slanted
    outline += [(left, top + 1), (LEFT, top + 1), (LEFT, 0.0), (RIGHT, 0.0), (RIGHT, -1.0)]
    m.block(*np.ravel(outline).tolist())
    m.split(LEFT + 0.5, top, RIGHT, top)
    m.split(LEFT - 2, 0.5, LEFT + 0.5, 0.5)
    x, y = next((float(row["KX"]), float(row["KY"])) for row in m.table("block") if row["KY"] > top)
    m.delete(x - 1e-3, x + 1e-3, y - 1e-3, y + 1e-3)
    m.fix(LEFT, RIGHT, -1, 0)
    m.round(ROUNDING)
    return m
