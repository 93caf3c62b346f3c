"""Random scenes with blocks of all types: those of random_scenes.py with zones, loads and changes.

Random triangulations go into random blocks, convex or not; what does not fit is refused and changes nothing.
The time-step is a part of the safe bound.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np
from naive.triangulate import triangulate

from support import random_scenes as scenes
from support.random_outlines import random_outline
from support.random_splits import split_somehow
from support.replayable_steps import Numbers, Scene, blocks, outline
from udec_ia.heap.accessors import HEAD, getr, iget
from udec_ia.layout.offsets import DTOL, KBM, KX, KY, MFDEF, MRIG, NBLK, TDEL
from udec_ia.model import Model

MAX_BLOCKS = 10
TYPES = ("rigid", "sdef", "fdef")
FIRST_FUNCTION = 1


def around(scene: Scene, ib: int) -> Numbers:
    """A range that holds the centroid of block `ib` alone."""
    x, y = float(getr(scene.model.h, ib, KX)), float(getr(scene.model.h, ib, KY))
    return x - 1e-4, x + 1e-4, y - 1e-4, y + 1e-4


def zone(scene: Scene, rng: np.random.Generator, ib: int) -> bool:
    """GENERATE MANUAL with a random triangulation of block `ib`."""
    points, triangles = triangulate(
        outline(scene.model, ib), rng, float(rng.choice([0.0, 0.3, 0.8])), int(rng.integers(3))
    )
    n = len(points)  # grid-points are numbered from the last one
    zones = [tuple(n - k for k in rng.permutation(t)) for t in triangles]
    return scene.do("generate", *around(scene, ib), mode="manual", gridpoints=points, zones=zones)


def soften(scene: Scene, rng: np.random.Generator) -> None:
    """Another type for one block. One that is to be fully-deformable gets its zones, or is rigid again."""
    ib = int(rng.choice(blocks(scene.model)))
    kind = str(rng.choice(TYPES))
    if kind == "fdef" and iget(scene.model.h, ib, HEAD) == MFDEF:
        return
    if kind != "fdef" or rng.random() < 0.3:
        scene.do("change", *around(scene, ib), type=kind)
    if kind == "fdef" and not zone(scene, rng, ib):
        scene.do("change", *around(scene, ib), type="rigid")


def soften_all(scene: Scene, rng: np.random.Generator) -> None:
    """A type for everything."""
    for _ in range(len(blocks(scene.model))):
        soften(scene, rng)


def range_of(scene: Scene, rng: np.random.Generator) -> Numbers:
    """A strip along one side of the scene, a rectangle in it, or all of it."""
    points = np.array([p for ib in blocks(scene.model) for p in outline(scene.model, ib)])
    (ax, ay), (bx, by) = points.min(axis=0) - 0.01, points.max(axis=0) + 0.01
    size = float(max(bx - ax, by - ay))
    side = int(rng.integers(5))
    if side == 4:
        x, y = np.sort(rng.uniform(ax, bx, 2)), np.sort(rng.uniform(ay, by, 2))
        return float(x[0]), float(x[1]), float(y[0]), float(y[1])
    limits = [float(ax), float(bx), float(ay), float(by)]
    depth = float(rng.choice([0.02, 0.5, 2.0])) * size
    limits[side ^ 1] = limits[side] + depth * (1 if side % 2 == 0 else -1)
    return tuple(limits)


def load_some(scene: Scene, rng: np.random.Generator) -> None:
    """A condition of any sort, with a history or none; forces of the order of weights."""
    h = scene.model.h
    mass = float(np.mean([float(getr(h, ib, KBM)) for ib in blocks(scene.model)]))
    slow = min(0.3 / sqrt(max(mass, 1.0) / scenes.STIFFNESS), 0.06 / max(float(h.cr[TDEL]), 1e-9))
    speed, force = 0.3 * slow * float(h.cr[DTOL]), 10 * max(mass, 1.0)
    kind = rng.integers(4)
    words: dict[str, object] = {}
    if kind == 0:
        words = {str(rng.choice(["xvel", "yvel"])): float(rng.choice([0.0, speed]))}
    elif kind == 1:
        words = {"xforce": float(rng.normal(0, force / 5)), "yforce": float(rng.normal(0, force / 5))}
    elif kind == 2:
        words = {"stress": tuple(rng.normal(0, force / 5, 3).tolist()), "ygrad": (0.0, 0.0, force / 50)}
    else:
        words = {"viscous": True}
    if kind < 3 and rng.random() < 0.4:
        if rng.random() < 0.5:
            words["sine"] = (float(rng.uniform(5, 50)), 0.1)
        elif scene.do("function", FIRST_FUNCTION, 0.0, 0.0, 0.01, 1.0, 0.1, float(rng.normal())):
            words["function"] = FIRST_FUNCTION
    scene.do("boundary", *range_of(scene, rng), **words)


def unload_some(scene: Scene, rng: np.random.Generator) -> None:
    scene.do("boundary", *range_of(scene, rng), free=True)


def stress_some(scene: Scene, rng: np.random.Generator) -> None:
    """Initial stresses that will spring free."""
    stress = rng.normal(0, 1e-5 * scenes.STIFFNESS, 3).tolist()
    scene.do("insitu", *range_of(scene, rng), *stress, xgrad=(0.0, float(rng.normal()), 1.0))


LATER = (
    *(soften, soften, soften, load_some, load_some, unload_some, stress_some),
    *(split_somehow, scenes.delete_one, scenes.fix_some, scenes.free_some, scenes.change_some),
    *(scenes.throw_some, scenes.throw_some, scenes.pull, scenes.damp),
)


def materials(scene: Scene, rng: np.random.Generator) -> None:
    """Those of rigid blocks, with moduli."""
    scenes.materials(scene, rng)
    for n in (1, 2):
        bulk = float(scenes.STIFFNESS * rng.choice([0.3, 1.0, 5.0]))
        scene.do("property", n, bulk=bulk, g=float(bulk * rng.uniform(0.2, 1.2)))
    scene.do("fraction", float(rng.choice([0.3, 0.8])), safe=True)


def play(
    seed: int,
    model: Model | None = None,
    watch: Callable[[Scene], None] | None = None,
    cycles: tuple[int, int] = (10, 60),
) -> Scene:
    """The scene of `seed`, played on `model` with runs of `cycles` (from, to) cycles each."""
    rng = np.random.default_rng((seed, 7))
    scene = Scene(Model() if model is None else model, watch)
    scene.model.tell = lambda _: None  # of steps that stiffness damping makes unstable
    materials(scene, rng)
    for _ in range(20):
        corners = random_outline(rng)
        if scene.do("block", *(number for point in corners for number in point), material=1):
            break
    for _ in range(60):
        if scene.model.h.ci[NBLK] >= 2 + rng.integers(MAX_BLOCKS - 2):
            break
        split_somehow(scene, rng)
    if rng.random() < 0.5:
        scenes.round_some(scene, rng, most=0.35)  # an edge that shortens must still hold two roundings
    soften_all(scene, rng)
    scenes.fix_some(scene, rng)
    scenes.pull(scene, rng)
    if rng.random() < 0.5:
        scenes.damp(scene, rng)
    if rng.random() < 0.7:
        load_some(scene, rng)
    return scenes.carry_on(scene, rng, LATER, 3, cycles)


def types(scene: Scene) -> list[int]:
    """How many blocks of each type there are."""
    heads = [int(iget(scene.model.h, ib, HEAD)) for ib in blocks(scene.model)]
    return [heads.count(kind) for kind in range(MRIG, MFDEF + 1)]
