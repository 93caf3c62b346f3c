"""Random joints: ways to split a scene, right across or partly, through corners or along edges."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import numpy as np
from naive.geometry import Point

from support.replayable_steps import Scene, blocks, outline
from udec_ia.layout.offsets import NBLK

MAX_BLOCKS = 30


def box_of(scene: Scene) -> tuple[Point, Point]:
    """The least and the greatest coordinates of all corners."""
    points = [point for ib in blocks(scene.model) for point in outline(scene.model, ib)]
    xs, ys = zip(*points, strict=True)
    return (min(xs), min(ys)), (max(xs), max(ys))


def split_line(scene: Scene, p: Point, q: Point, before: float = 1.0, after: float = 1.0) -> bool:
    """SPLIT from p to q, lengthened at both ends by parts of the size of the scene."""
    if scene.model.h.ci[NBLK] >= MAX_BLOCKS or p == q:
        return False
    low, high = box_of(scene)
    size = hypot(high[0] - low[0], high[1] - low[1])
    z = hypot(q[0] - p[0], q[1] - p[1])
    c, s = (q[0] - p[0]) / z * size, (q[1] - p[1]) / z * size
    return scene.do("split", p[0] - before * c, p[1] - before * s, q[0] + after * c, q[1] + after * s)


def point_in(scene: Scene, rng: np.random.Generator) -> Point:
    """A point in the box, anywhere or on a grid."""
    low, high = box_of(scene)
    x, y = float(rng.uniform(low[0], high[0])), float(rng.uniform(low[1], high[1]))
    return (x, y) if rng.random() < 0.6 else (round(x * 2) / 2, round(y * 2) / 2)


def corner_of(scene: Scene, rng: np.random.Generator) -> Point:
    """A corner of some block."""
    points = outline(scene.model, int(rng.choice(blocks(scene.model))))
    return points[int(rng.integers(len(points)))]


def split_across(scene: Scene, rng: np.random.Generator) -> None:
    """A line through two random points, right across."""
    split_line(scene, point_in(scene, rng), point_in(scene, rng))


def split_straight(scene: Scene, rng: np.random.Generator) -> None:
    """A level or an upright line, right across."""
    x, y = point_in(scene, rng)
    split_line(scene, (x, y), (x + 1, y) if rng.random() < 0.5 else (x, y + 1))


def split_partly(scene: Scene, rng: np.random.Generator) -> None:
    """A line that ends somewhere in the scene."""
    split_line(scene, point_in(scene, rng), point_in(scene, rng), before=0.0, after=float(rng.integers(0, 2)))


def split_corners(scene: Scene, rng: np.random.Generator) -> None:
    """A line exactly through two corners, or from one to the other."""
    long = float(rng.integers(0, 2))
    split_line(scene, corner_of(scene, rng), corner_of(scene, rng), before=long, after=long)


def split_corner(scene: Scene, rng: np.random.Generator) -> None:
    """A line through one corner."""
    split_line(scene, corner_of(scene, rng), point_in(scene, rng))


def split_along(scene: Scene, rng: np.random.Generator) -> None:
    """A line along an edge and beyond."""
    points = outline(scene.model, int(rng.choice(blocks(scene.model))))
    k = int(rng.integers(len(points)))
    split_line(scene, points[k - 1], points[k])


def split_fan(scene: Scene, rng: np.random.Generator) -> None:
    """Lines through one point."""
    x, y = point_in(scene, rng) if rng.random() < 0.7 else corner_of(scene, rng)
    for k in range(int(rng.integers(2, 5))):
        angle = float(rng.uniform(0, pi)) if rng.random() < 0.5 else k * pi / 4
        split_line(scene, (x, y), (x + cos(angle), y + sin(angle)))


def split_parallel(scene: Scene, rng: np.random.Generator) -> None:
    """A set of parallel lines."""
    (ax, ay), (bx, by) = box_of(scene)
    n, angle = int(rng.integers(2, 5)), float(rng.choice([0, pi / 2, rng.uniform(0, pi)]))
    c, s = round(cos(angle), 15), round(sin(angle), 15)
    for k in range(1, n):
        x, y = ax + (bx - ax) * k / n, ay + (by - ay) * k / n
        split_line(scene, (x, y), (x + c, y + s))


def split_bricks(scene: Scene, rng: np.random.Generator) -> None:
    """A brick bond: bed joints right across, upright joints from one bed joint to the next."""
    (ax, ay), (bx, by) = box_of(scene)
    courses, bricks = rng.integers(2, 5, 2)
    levels = [ay + (by - ay) * float(k) / float(courses) for k in range(courses + 1)]
    for y in levels[1:-1]:
        split_line(scene, (ax, y), (bx, y))
    for k in range(courses):
        for j in range(bricks):
            x = ax + (bx - ax) * (j + 0.5 + 0.5 * (k % 2)) / float(bricks)
            if ax < x < bx:
                split_line(scene, (x, levels[k]), (x, levels[k + 1]), before=0.0, after=0.0)


SPLITS = (
    split_across,
    split_straight,
    split_straight,
    split_partly,
    split_corners,
    split_corner,
    split_along,
    split_fan,
    split_parallel,
    split_bricks,
)


def split_somehow(scene: Scene, rng: np.random.Generator) -> None:
    """One of the ways to split."""
    SPLITS[int(rng.integers(len(SPLITS)))](scene, rng)
