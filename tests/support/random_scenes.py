"""Random scenes: a block, random joints, holes, materials, motion and all of it again while it runs.

A scene is drawn from a seed and depends on the blocks as they are (which one to delete, through which
corner to split), so it is drawn while it is played, and what was done is kept (replayable_steps.py). Speeds,
stiffnesses and rounding lengths are drawn relative to each other, so that blocks fly, strike and slide within
a few dozen cycles and an overlap too great stays the exception.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, hypot, pi, sin, sqrt
from typing import Any

import numpy as np
from naive.geometry import Point

from support.random_outlines import random_outline
from support.random_splits import box_of, point_in, split_somehow
from support.replayable_steps import Numbers, Scene, blocks, outline
from udec_ia.heap.accessors import getr, iget
from udec_ia.layout.offsets import DTOL, KBFIX, KBM, KBRO, KX, KY, NBLK, TDEL
from udec_ia.model import Model

STIFFNESS = 1e8  # order of all joint stiffnesses


def _centroid(scene: Scene, ib: int) -> Point:
    return float(getr(scene.model.h, ib, KX)), float(getr(scene.model.h, ib, KY))


def _around(x: float, y: float, reach: float) -> Numbers:
    return x - reach, x + reach, y - reach, y + reach


def delete_one(scene: Scene, rng: np.random.Generator) -> None:
    """Delete one block (or those whose centroids are at the same place)."""
    x, y = _centroid(scene, int(rng.choice(blocks(scene.model))))
    scene.do("delete", *_around(x, y, 1e-3))


def delete_region(scene: Scene, rng: np.random.Generator) -> None:
    """Delete what has its centroid in a rectangle: a hole, a bite, or a strip that cuts the scene in two."""
    (ax, ay), (bx, by) = box_of(scene)
    x, y = point_in(scene, rng)
    w, h = float(rng.uniform(0.05, 0.3)) * (bx - ax), float(rng.uniform(0.05, 0.3)) * (by - ay)
    if rng.random() < 0.3:
        w, h = (bx - ax, h) if rng.random() < 0.5 else (w, by - ay)
    h_, inside = scene.model.h, 0
    for ib in blocks(scene.model):
        inside += abs(getr(h_, ib, KX) - x) < w and abs(getr(h_, ib, KY) - y) < h
    if inside and inside <= h_.ci[NBLK] // 2:
        scene.do("delete", x - w, x + w, y - h, y + h)


def fix_some(scene: Scene, rng: np.random.Generator) -> None:
    """Fix one block, or a strip."""
    (ax, ay), (bx, by) = box_of(scene)
    x, y = _centroid(scene, int(rng.choice(blocks(scene.model))))
    if rng.random() < 0.6:
        scene.do("fix", *_around(x, y, 1e-3))
    else:
        scene.do("fix", ax - 1, bx + 1, ay - 1, ay + 0.3 * (by - ay))


def free_some(scene: Scene, rng: np.random.Generator) -> None:
    """Set a block free; another one stays fixed, or is fixed."""
    x, y = _centroid(scene, int(rng.choice(blocks(scene.model))))
    scene.do("free", *_around(x, y, 1e-3))
    if not any(iget(scene.model.h, ib, KBFIX) for ib in blocks(scene.model)):
        fix_some(scene, rng)


def change_some(scene: Scene, rng: np.random.Generator) -> None:
    """Another material in a strip."""
    (ax, ay), (bx, by) = box_of(scene)
    y = float(rng.uniform(ay, by))
    scene.do("change", ax - 1, bx + 1, y, by + 1, material=int(rng.integers(1, 3)))


def throw_some(scene: Scene, rng: np.random.Generator) -> None:
    """Velocities for some free blocks, slow enough for the rounding length.

    A block of mass m that strikes a spring KN with v overlaps by v sqrt(m/KN), which must be less than half
    of the rounding length; and it must not move by more than a part of that in one time-step.
    """
    h = scene.model.h
    for k, ib in enumerate(blocks(scene.model)):
        if iget(h, ib, KBFIX) or rng.random() < 0.6:
            continue
        slow = min(0.3 / sqrt(float(getr(h, ib, KBM)) / STIFFNESS), 0.06 / float(h.cr[TDEL]))
        v = float(rng.uniform(0, 1) * h.cr[DTOL] * slow)
        angle, spin = float(rng.uniform(0, 2 * pi)), float(rng.normal(0, 0.3))
        scene.do("throw", k, v * cos(angle), v * sin(angle), v * spin / float(getr(h, ib, KBRO)))


def pull(scene: Scene, rng: np.random.Generator) -> None:
    """Gravity in any direction, along an axis or none."""
    g = float(rng.choice([0.0, 10.0, 30.0]))
    angle = float(rng.choice([-pi / 2, rng.uniform(0, 2 * pi)]))
    scene.do("gravity", round(g * cos(angle), 12), g * sin(angle))


def damp(scene: Scene, rng: np.random.Generator) -> None:
    """Damping of any kind, or none."""
    kind = rng.choice(["none", "both", "mass", "stiffness", "internal"])
    words = {} if kind in ("none", "both") else {"only": str(kind)}
    fraction = 0.0 if kind == "none" else float(rng.uniform(0.01, 0.1))
    scene.do("damping", fraction, float(rng.uniform(10, 100)), **words)


def materials(scene: Scene, rng: np.random.Generator) -> None:
    """Properties of materials 1 and 2, and a fraction of the critical time-step."""
    for n in (1, 2):
        kn, ks = (float(STIFFNESS * rng.choice([1.0, rng.uniform(1, 5)])) for _ in range(2))
        values = {"density": float(rng.uniform(500, 3000)), "kn": kn, "ks": ks}
        values["friction"] = float(rng.choice([0.0, 0.5, rng.uniform(0, 2)]))
        values["cohesion"] = float(rng.choice([0.0, 1e4]))
        scene.do("property", n, **values)
    scene.do("fraction", float(rng.choice([0.03, 0.1, 0.1, 0.2])))


def round_some(scene: Scene, rng: np.random.Generator, most: float = 0.5) -> None:
    """A rounding length that fits, from sharp corners to `most` of the shortest edge."""
    shortest = min(
        hypot(p[0] - q[0], p[1] - q[1])
        for ib in blocks(scene.model)
        for ring in (outline(scene.model, ib),)
        for p, q in zip(ring, [ring[-1], *ring[:-1]], strict=True)
    )
    scene.do("round", shortest * min(float(rng.choice([0.03, 0.1, 0.2, 0.35, 0.5])), most) * (1 - 1e-9))


LATER = (
    *(split_somehow, split_somehow, delete_one, delete_one, delete_region, fix_some, free_some, change_some),
    *(throw_some, throw_some, throw_some, pull, damp),
)


def play(
    seed: int,
    model: Model | None = None,
    watch: Callable[[Scene], None] | None = None,
    cycles: tuple[int, int] = (10, 60),
) -> Scene:
    """The scene of `seed`, played on `model` with runs of `cycles` (from, to) cycles each."""
    rng = np.random.default_rng(seed)
    scene = Scene(Model() if model is None else model, watch)
    materials(scene, rng)
    material = int(rng.integers(1, 3))
    for _ in range(20):
        corners = random_outline(rng)
        if scene.do("block", *(number for point in corners for number in point), material=material):
            break
    if rng.random() < 0.15:
        round_some(scene, rng)
    while scene.model.h.ci[NBLK] < 2 or rng.random() < 0.75:
        split_somehow(scene, rng)
        if len(scene.lines) > 150:
            break
    for _ in range(int(rng.integers(0, 3))):
        (delete_one if rng.random() < 0.5 else delete_region)(scene, rng)
    if rng.random() < 0.6:
        round_some(scene, rng)
    fix_some(scene, rng)
    pull(scene, rng)
    if rng.random() < 0.5:
        damp(scene, rng)
    return carry_on(scene, rng, LATER, 2, cycles)


def carry_on(
    scene: Scene,
    rng: np.random.Generator,
    later: Sequence[Callable[[Scene, np.random.Generator], Any]],
    most: int,
    cycles: tuple[int, int],
) -> Scene:
    """Runs of `cycles` (from, to) cycles, with one to `most` of the commands `later` before each."""
    scene.cycle(1)
    for _ in range(int(rng.integers(2, 6))):
        if scene.ended:
            break
        for _ in range(int(rng.integers(1, most + 1))):
            later[int(rng.integers(len(later)))](scene, rng)
        scene.cycle(int(rng.integers(cycles[0], cycles[1] + 1)))
    return scene
