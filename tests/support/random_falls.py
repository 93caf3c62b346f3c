"""Random falls: many loose blocks in a box, of all shapes and sizes, thrown at each other.

Their domain is large (kernels/detect/large_domains.py). A fall is drawn from a generator and played on a
WatchedModel, whose oracle looks for missed contacts. Blocks are cut, deleted, added and thrown on the way.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np

from support.random_impacts import near
from support.watched_model import WatchedModel

Rng = np.random.Generator
Outline = list[tuple[float, float]]

DENSITY, KN = 2000.0, 1e8
WALL = 1.0


def polygon(rng: Rng, x: float, y: float, r: float) -> Outline:
    """A polygon within the distance `r` of (x, y), clockwise: convex, a star, or a needle."""
    kind = int(rng.integers(6))
    n = int(rng.integers(3, 9))
    angles = 2 * pi * (np.arange(n) + rng.uniform(-0.25, 0.25, n)) / n + rng.uniform(0, 2 * pi)
    far = np.full(n, r)
    if kind == 0 and n >= 6:
        far[::2] *= rng.uniform(0.45, 0.8)  # concave corners
    points = [(a * cos(-t), a * sin(-t)) for a, t in zip(far, angles, strict=True)]
    if kind == 1:
        turn, thin = rng.uniform(0, 2 * pi), rng.uniform(0.15, 0.4)
        points = [
            (p * cos(turn) - thin * q * sin(turn), p * sin(turn) + thin * q * cos(turn)) for p, q in points
        ]
    return [(float(x + p), float(y + q)) for p, q in points]


def box(stage: WatchedModel, w: float, h: float) -> None:
    """A floor and two walls, fixed."""
    t = WALL
    for ring in (
        [(-t, -t), (-t, 0), (w + t, 0), (w + t, -t)],
        [(-t, 0), (-t, h), (0, h), (0, 0)],
        [(w, 0), (w, h), (w + t, h), (w + t, 0)],
    ):
        stage.do("block", *(float(c) for point in ring for c in point))
    for limits in ((-2 * t, w + 2 * t, -2 * t, 0), (-2 * t, 0, 0, h + 1), (w, w + 2 * t, 0, h + 1)):
        stage.do("fix", *map(float, limits))


def begin(stage: WatchedModel, rng: Rng, many: int) -> None:
    """A box with `many` loose blocks above each other, which are thrown."""
    pitch = 2.02
    w = pitch * (int(np.sqrt(many)) + 1)
    rows = int(np.ceil(many / (w / pitch)))
    d = float(rng.choice([0.02, 0.05, 0.1]))
    stage.do("start")
    stage.do("round", d)
    box(stage, w, pitch * rows * 1.5)
    smallest = 0.2 if d < 0.1 else 0.7
    places = [(i, j) for j in range(rows) for i in range(round(w / pitch))]
    for i, j in places[:many]:
        r = float(rng.uniform(smallest, 1.0))
        stage.do("block", *(c for p in polygon(rng, (i + 0.5) * pitch, (j + 0.5) * pitch, r) for c in p))
    friction = float(rng.choice([0.0, 0.3, 1.0]))
    stage.do("property", 1, density=DENSITY, kn=KN, ks=KN, friction=friction, bulk=KN * 3, g=KN * 2)
    speed = (
        float(10.0 ** rng.uniform(-1.5, 0)) * 0.2 * d * (KN / (DENSITY * 4.0)) ** 0.5
    )  # a contact can stop that
    height = 0.5 * pitch * rows
    stage.do("gravity", 0.0, float(rng.choice([0.0, -1.0])) * 0.5 * speed * speed / height)
    stage.do("fraction", 0.5, safe=True)
    if rng.random() < 0.3:
        stage.do("damping", 0.1, 5.0, "mass")
    stage.do("cycle", 0)
    for ib in list(stage.bodies())[:-3]:
        turn = rng.uniform(0, 2 * pi)
        vx, vy, spin = speed * cos(turn), speed * sin(turn), float(rng.normal(0, speed))
        stage.do("velocity", *near(stage, ib), float(vx), float(vy), spin)


def _event(stage: WatchedModel, rng: Rng) -> Any:
    """A block is cut, deleted, thrown, made deformable, or another is put into the box."""
    blocks = list(stage.bodies())[3:]
    ib, what = int(rng.choice(blocks)), int(rng.integers(7))
    x, y = stage.centroid(ib)
    if what == 0:
        dx, dy = cos(t := rng.uniform(0, pi)), sin(t)
        stage.do("split", float(x - 3 * dx), float(y - 3 * dy), float(x + 3 * dx), float(y + 3 * dy))
    elif what == 1:
        stage.do("delete", *near(stage, ib))
    elif what == 2:
        stage.do("change", *near(stage, ib), type="sdef")
    elif what == 3:
        stage.do("generate", *near(stage, ib), "automatic", edge=1.0)
    elif what == 4:
        px, py = rng.uniform(0.5, 8), rng.uniform(1, 40)
        stage.do("block", *(c for p in polygon(rng, px, py, 0.4) for c in p))
    elif what == 5:
        stage.do("delete", f"OUTSIDE -50 50 -5 {float(rng.uniform(20, 60))}")


def play(stage: WatchedModel, rng: Rng, many: int, cycles: int, step: int) -> None:
    """Draw a fall of `many` blocks and play it. Raises Wrong or Over."""
    begin(stage, rng, many)
    while stage.cycles < cycles:
        stage.cycle(min(int(rng.integers(50, 300)), cycles - stage.cycles), step)
        stage.check()
        _event(stage, rng)
        stage.check()
