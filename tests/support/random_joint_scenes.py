"""Random scenes with joint materials: random_deformable_scenes.py with JPROPERTY and numbered joints.

Cuts belong to joints or not; joints, pairs of materials and ranges get joint materials, which change later.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from support import random_deformable_scenes as deformable
from support import random_scenes as scenes
from support.random_outlines import random_outline
from support.random_splits import split_somehow
from support.replayable_steps import Scene
from udec_ia.layout.offsets import NBLK
from udec_ia.model import Model

MATERIALS = 3
JOINTS = 4
MAX_BLOCKS = 8
MODELS: tuple[Callable[[float, float], dict[str, Any]], ...] = (
    lambda stiffness, friction: {"model": "coulomb", "unit": "length"},
    lambda stiffness, friction: {"model": "coulomb", "unit": "contact"},
    lambda stiffness, friction: {"model": "coulomb", "unit": "ends"},
    lambda stiffness, friction: {
        "model": "barton", "unit": "length", "kn_max": 10 * stiffness, "jrc": 8, "jcs": 1e8, "aperture": 1e-3
    },
    lambda stiffness, friction: {
        "model": "yielding", "unit": "length", "initial_friction": friction + 0.3, "roughness": 1e-3
    },
)  # fmt: skip
SHARES = (0.5, 0.15, 0.15, 0.1, 0.1)
Begin = Callable[..., None]  # of a scene, random numbers and the greatest number of blocks
Event = Callable[..., Any]  # of a scene and random numbers


class JointScene(Scene):
    """A scene whose cuts belong to joints, more often than not."""

    def __init__(self, model: Model, watch: Callable[[Scene], None] | None, rng: np.random.Generator) -> None:
        super().__init__(model, watch)
        self.rng = rng

    def do(self, name: str, *numbers: float, **words: Any) -> bool:
        """Do a step; cuts get the number of a joint, and some of them its joint material."""
        if name == "split" and self.rng.random() < 0.7:
            words["joint"] = int(self.rng.integers(1, JOINTS + 1))
            if self.rng.random() < 0.6:
                words["jmaterial"] = int(self.rng.integers(1, MATERIALS + 1))
        return super().do(name, *numbers, **words)


def define(scene: Scene, rng: np.random.Generator, jmaterial: int | None = None) -> None:
    """A joint material, new or changed: of any model, per length or, seldom, per contact or with its ends."""
    stiffness = scenes.STIFFNESS * float(rng.choice([0.1, 0.3]))
    strength = 1e-4 * stiffness
    words: dict[str, Any] = {
        "kn": stiffness,
        "ks": stiffness * float(rng.choice([0.5, 1.0])),
        "friction": float(rng.choice([0.0, 0.3, 1.0])),
        "cohesion": float(rng.choice([0.0, strength])),
        "tension": float(rng.choice([0.0, strength])),
    }
    if rng.random() < 0.3:
        words |= {"dilation": 0.1, "critical_slip": 1e-3, "residual_friction": 0.2, "residual_cohesion": 0.0}
    words |= MODELS[int(rng.choice(len(MODELS), p=SHARES))](stiffness, words["friction"])
    if rng.random() < 0.4:
        words["between"] = (1, int(rng.integers(1, 3)))
    number = int(rng.integers(1, MATERIALS + 1)) if jmaterial is None else jmaterial
    scene.do("jproperty", number, **words)


def give(scene: Scene, rng: np.random.Generator) -> None:
    """A joint material for the contacts in a range."""
    scene.do("change", *deformable.range_of(scene, rng), jmaterial=int(rng.integers(1, MATERIALS + 1)))


LATER = (*deformable.LATER, define, define, give, give)


def play_of(
    number: int,
    begin: Begin,
    later: Sequence[Event],
    most: int,
    seed: int,
    model: Model | None = None,
    watch: Callable[[Scene], None] | None = None,
    cycles: tuple[int, int] = (10, 60),
) -> Scene:
    """The scene of `seed` with up to `most` blocks, played on `model` in runs of `cycles` (from, to) cycles.

    number: of the kind of scenes, for its random numbers. begin, later: what they begin with, and what may
    happen between two runs.
    """
    rng = np.random.default_rng((seed, number))
    scene = JointScene(Model() if model is None else model, watch, rng)
    begin(scene, rng, most)
    return scenes.carry_on(scene, rng, later, 3, cycles)


def play_briefly_of(
    number: int,
    begin: Begin,
    later: Sequence[Event],
    seed: int,
    watch: Callable[[Scene], None] | None = None,
) -> Scene:
    """The same with few blocks, watched from its first cycle on: two runs of two cycles."""
    rng = np.random.default_rng((seed, number))
    scene = JointScene(Model(), None, rng)
    begin(scene, rng, 4)
    scene.watch = watch
    scene.cycle(2)
    later[int(rng.integers(len(later)))](scene, rng)
    scene.cycle(2)
    return scene


def begin(scene: JointScene, rng: np.random.Generator, most: int) -> None:
    """Materials, an outline cut into up to `most` blocks, what holds it and what loads it."""
    scene.model.tell = lambda _: None
    deformable.materials(scene, rng)
    for _ in range(20):
        corners = random_outline(rng)
        if scene.do("block", *(number for point in corners for number in point), material=1):
            break
    for jmaterial in range(1, MATERIALS + 1):
        define(scene, rng, jmaterial)
    for _ in range(60):
        if scene.model.h.ci[NBLK] >= 2 + rng.integers(most - 2):
            break
        split_somehow(scene, rng)
    if rng.random() < 0.5:
        scenes.round_some(scene, rng, most=0.35)
    if rng.random() < 0.6:
        deformable.soften_all(scene, rng)
    scene.do("group", "right", "ABOVE 0 -100 1 1000")
    scenes.fix_some(scene, rng)
    scenes.pull(scene, rng)
    if rng.random() < 0.5:
        scenes.damp(scene, rng)


play = partial(play_of, 36, begin, LATER, MAX_BLOCKS)
play_briefly = partial(play_briefly_of, 37, begin, LATER)
