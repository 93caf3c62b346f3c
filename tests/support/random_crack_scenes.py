"""Random scenes with blocks that crack: those of random_joint_scenes.py with BREAKAGE at low strengths."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from support import random_deformable_scenes as deformable
from support import random_joint_scenes as joints
from support import random_scenes as scenes
from support import random_structure_scenes as structures
from support.replayable_steps import Scene
from udec_ia.layout.offsets import NBLK, NCON

MAX_BLOCKS = 8
EVERYWHERE = (-1e3, 1e3, -1e3, 1e3)


def weaken(scene: Scene, rng: np.random.Generator) -> None:
    """Strengths for everything or a range, at times none, with a joint material or without."""
    where = EVERYWHERE if rng.random() < 0.6 else deformable.range_of(scene, rng)
    if rng.random() < 0.15:
        scene.do("breakage", *where, state="off")
        return
    words: dict[str, Any] = {"smallest": float(rng.choice([0.01, 0.1, 1.0]))}
    if rng.random() < 0.8:
        words["tension"] = float(10 ** rng.uniform(0, 3.5))
    if "tension" not in words or rng.random() < 0.4:
        words |= {"cohesion": float(10 ** rng.uniform(1, 4)), "friction": float(rng.choice([0.0, 0.7]))}
    if rng.random() < 0.6:
        words["jmaterial"] = int(rng.integers(1, joints.MATERIALS + 1))
    scene.do("breakage", *where, **words)


LATER = (*joints.LATER, weaken, weaken, weaken)


def displace(scene: Scene) -> None:
    """Half of the scenes have displacements. This takes no random number, and is alike in all schemes."""
    if (scene.model.h.ci[NBLK] + scene.model.h.ci[NCON]) % 2:
        scene.do("displacements")


def begin(scene: joints.JointScene, rng: np.random.Generator, most: int) -> None:
    """A scene with joint materials whose blocks may crack."""
    joints.begin(scene, rng, most)
    scenes.pull(scene, rng)
    weaken(scene, rng)
    displace(scene)


play = partial(joints.play_of, 41, begin, LATER, MAX_BLOCKS)


def begin_mixed(scene: joints.JointScene, rng: np.random.Generator, most: int) -> None:
    """A scene with joint materials and structures, half of them with water, most of which may crack."""
    structures.begin(scene, rng, most)
    if rng.random() < 0.6:
        weaken(scene, rng)
    displace(scene)


play_mixed_briefly = partial(joints.play_briefly_of, 42, begin_mixed, (*structures.LATER, weaken))
