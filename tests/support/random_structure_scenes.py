"""Random scenes with structures: random_water_scenes.py with bolts, cables, beams and linings.

Their stiffness is of the order of that of joints, and their strength of the forces of these.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from support import random_deformable_scenes as deformable
from support import random_joint_scenes as joints
from support import random_scenes as scenes
from support import random_water_scenes as water
from support.random_splits import point_in
from support.replayable_steps import Scene, blocks
from udec_ia.heap.accessors import getr
from udec_ia.layout.offsets import KX, KY, NBLK

SMATERIALS = 2
MAX_BLOCKS = 10


def define(scene: Scene, rng: np.random.Generator, smaterial: int | None = None) -> None:
    """A structural material, new or changed."""
    stiffness = scenes.STIFFNESS * float(rng.choice([0.03, 0.3]))
    strength = 1e-3 * stiffness
    words: dict[str, Any] = {
        "kn": stiffness,
        "ks": float(rng.choice([0.0, 0.3])) * stiffness,
        "yield_force": float(rng.choice([0.0, strength])),
        "shear_strength": float(rng.choice([0.0, strength])),
        "break_strain": float(rng.choice([0.0, 1e-3])),
        "young": 10 * stiffness,
        "area": 0.1,
        "inertia": 1e-4,
        "density": 3000.0,
        "cohesion": float(rng.choice([0.0, strength])),
        "tension": float(rng.choice([0.0, strength])),
        "friction": float(rng.choice([0.0, 0.5])),
        "yield_moment": float(rng.choice([0.0, 0.03 * strength])),
    }
    words["ks"] = max(words["ks"], 0.03 * stiffness)
    scene.do("sproperty", int(rng.integers(1, SMATERIALS + 1)) if smaterial is None else smaterial, **words)


def bolt_some(scene: Scene, rng: np.random.Generator) -> None:
    """A bolt between two points."""
    words: dict[str, Any] = {"smaterial": int(rng.integers(1, SMATERIALS + 1))}
    if rng.random() < 0.3:
        words["pretension"] = 1e-4 * scenes.STIFFNESS
    scene.do("bolt", *point_in(scene, rng), *point_in(scene, rng), **words)


def reinforce(scene: Scene, rng: np.random.Generator) -> None:
    """A cable or beam between two points, or a lining of a space."""
    words: dict[str, Any] = {"smaterial": int(rng.integers(1, SMATERIALS + 1))}
    kind = int(rng.integers(3))
    if kind == 2:
        ib = int(rng.choice(blocks(scene.model)))
        x, y = (float(getr(scene.model.h, ib, k)) for k in (KX, KY))
        if scene.model.h.ci[NBLK] > 4:
            scene.do("delete", x - 1e-3, x + 1e-3, y - 1e-3, y + 1e-3)
        words["around"] = x, y
        if rng.random() < 0.3:
            words["within"] = deformable.range_of(scene, rng)
        scene.do("beam", segments=int(rng.integers(1, 4)), **words)
        return
    if kind == 1 and rng.random() < 0.3:
        words["pretension"] = 1e-4 * scenes.STIFFNESS
    ends = *point_in(scene, rng), *point_in(scene, rng)
    scene.do(("beam", "cable")[kind], *ends, segments=int(rng.integers(1, 7)), **words)


LATER = (*water.LATER, define, *3 * (bolt_some,), *5 * (reinforce,))


def begin(scene: joints.JointScene, rng: np.random.Generator, most: int) -> None:
    """A scene with joint materials, in half of them water, and structures."""
    (water if rng.random() < 0.5 else joints).begin(scene, rng, most)
    for smaterial in range(1, SMATERIALS + 1):
        define(scene, rng, smaterial)
    for _ in range(2):
        bolt_some(scene, rng)
        reinforce(scene, rng)


play = partial(joints.play_of, 41, begin, LATER, MAX_BLOCKS)
