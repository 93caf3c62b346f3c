"""Random outlines of a first block: rectangles, convex ones, and those with notches."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
from naive.geometry import Outline


def _rectangle(rng: np.random.Generator) -> Outline:
    w, h = rng.integers(2, 13, 2) if rng.random() < 0.5 else rng.uniform(2, 12, 2)
    return [(0, 0), (0, h), (w, h), (w, 0)]


def _convex(rng: np.random.Generator) -> Outline:
    """Points on an ellipse, at least 20 degrees apart."""
    n = int(rng.integers(3, 9))
    gaps = rng.uniform(1, 3, n)
    angles = -2 * pi * np.cumsum(gaps) / gaps.sum()
    a, b = rng.uniform(2, 6, 2)
    return [(a * cos(angle), b * sin(angle)) for angle in angles]


def _ell(rng: np.random.Generator) -> Outline:
    a, b, c, d = rng.integers(1, 6, 4)
    return [(0, 0), (0, b + d), (a, b + d), (a, b), (a + c, b), (a + c, 0)]


def _u(rng: np.random.Generator) -> Outline:
    a, b, c, f, g, k = rng.integers(1, 5, 6)
    right = a + b + c
    return [(0, 0), (0, f + g), (a, f + g), (a, f), (a + b, f), (a + b, f + k), (right, f + k), (right, 0)]


def _tee(rng: np.random.Generator) -> Outline:
    a, b, c, f, g = rng.integers(1, 5, 5)
    right = a + b + c
    return [(a, 0), (a, f), (0, f), (0, f + g), (right, f + g), (right, f), (a + b, f), (a + b, 0)]


def _comb(rng: np.random.Generator) -> Outline:
    teeth, base = int(rng.integers(2, 5)), float(rng.integers(1, 4))
    points: Outline = [(0, 0)]
    x = 0.0
    for k in range(teeth):
        high, wide, gap = rng.integers(1, 4, 3)
        points += [(x, base + high), (x + wide, base + high)]
        x += wide
        if k + 1 < teeth:
            points += [(x, base), (x + gap, base)]
            x += gap
    return [*points, (x, 0)]


OUTLINES = (_rectangle, _rectangle, _convex, _ell, _u, _tee, _comb)


def random_outline(rng: np.random.Generator) -> Outline:
    """A random outline, turned by any angle or none, and perhaps far from the origin."""
    points = OUTLINES[int(rng.integers(len(OUTLINES)))](rng)
    if rng.random() < 0.3:
        angle = rng.uniform(0, 2 * pi)
        points = [(cos(angle) * x - sin(angle) * y, sin(angle) * x + cos(angle) * y) for x, y in points]
    dx, dy = rng.choice([0.0, -5.0, 100.0], 2) if rng.random() < 0.5 else (0.0, 0.0)
    return [(float(x + dx), float(y + dy)) for x, y in points]
