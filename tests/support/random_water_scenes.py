"""Random scenes with water: random_joint_scenes.py with FLUID, pressures, conditions outside and flow.

The bulk modulus is of the order of the joint stiffness times a length, so that water and joints act alike.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from support import random_deformable_scenes as deformable
from support import random_joint_scenes as joints
from support import random_scenes as scenes
from support.replayable_steps import Scene
from udec_ia.model import Model

MAX_BLOCKS = 8
EVERYWHERE = (-1e3, 1e3, -1e3, 1e3)


def give_apertures(scene: Scene, rng: np.random.Generator) -> None:
    """Apertures of a joint material, and at times of all joints."""
    aperture = float(rng.choice([1e-4, 1e-3, 5e-3]))
    words: dict[str, Any] = {"kn": 3e5, "ks": 3e5, "friction": 0.3, "aperture": aperture}
    if rng.random() < 0.3:
        words["residual_aperture"] = 0.5 * aperture
    if rng.random() < 0.2:
        words["greatest_aperture"] = 2 * aperture
    if rng.random() < 0.2:
        words["permeability_factor"] = 1e-9
    if rng.random() < 0.7:
        words["between"] = (1, int(rng.integers(1, 3)))
    scene.do("jproperty", int(rng.integers(1, joints.MATERIALS + 1)), **words)


def fill(scene: Scene, rng: np.random.Generator) -> None:
    """A pressure in a range, held or not, or a level."""
    words: dict[str, Any] = {}
    if rng.random() < 0.3:
        words["state"] = str(rng.choice(["held", "free"]))
    if rng.random() < 0.5:
        words |= {"pxgrad": float(rng.uniform(-1e3, 1e3)), "pygrad": float(rng.uniform(-1e3, 1e3))}
    where = EVERYWHERE if rng.random() < 0.4 else deformable.range_of(scene, rng)
    scene.do("ppressure", *where, float(rng.choice([0.0, 1e2, 3e3])), **words)


def flood(scene: Scene, rng: np.random.Generator) -> None:
    """A condition of the water outside."""
    words: dict[str, Any] = [
        {"ppressure": float(rng.choice([0.0, 2e3])), "pygrad": float(rng.choice([0.0, -1e3]))},
        {"flow": float(rng.choice([-1e-5, 1e-5]))},
        {"impermeable": True},
        {"free": True},
    ][int(rng.integers(4))]
    where = EVERYWHERE if rng.random() < 0.4 else deformable.range_of(scene, rng)
    scene.do("boundary", *where, **words)


def set_fluid(scene: Scene, rng: np.random.Generator) -> None:
    """Other properties of the water, or another mode."""
    scene.do(
        "fluid",
        kw=float(rng.choice([1e4, 1e6])),
        viscosity=float(rng.choice([1e-3, 1.0])),
        mode=str(rng.choice(["coupled", "coupled", "undrained", "drained"])),
        every=int(rng.choice([1, 3])),
    )


def let_flow(scene: Scene, rng: np.random.Generator) -> None:
    """Flow while blocks do not move."""
    words: list[dict[str, Any]] = [{"steady": True}, {"steps": int(rng.integers(1, 20))}]
    scene.do("flow", **words[int(rng.integers(2))])


LATER = (*joints.LATER, give_apertures, fill, fill, flood, flood, set_fluid, let_flow)


def begin(scene: joints.JointScene, rng: np.random.Generator, most: int) -> None:
    """A scene with joint materials, and water in it."""
    joints.begin(scene, rng, most)
    give_apertures(scene, rng)
    set_fluid(scene, rng)
    fill(scene, rng)
    flood(scene, rng)


def play(
    seed: int,
    model: Model | None = None,
    watch: Callable[[Scene], None] | None = None,
    cycles: tuple[int, int] = (10, 60),
) -> Scene:
    """The scene of `seed`, played on `model` with runs of `cycles` (from, to) cycles each."""
    rng = np.random.default_rng((seed, 37))
    scene = joints.JointScene(Model() if model is None else model, watch, rng)
    begin(scene, rng, MAX_BLOCKS)
    return scenes.carry_on(scene, rng, LATER, 3, cycles)


def play_briefly(seed: int, watch: Callable[[Scene], None] | None = None) -> Scene:
    """The scene of `seed` with few blocks, watched from its first cycle on: two runs of two cycles."""
    rng = np.random.default_rng((seed, 38))
    scene = joints.JointScene(Model(), None, rng)
    begin(scene, rng, 4)
    scene.watch = watch
    scene.cycle(2)
    LATER[int(rng.integers(len(LATER)))](scene, rng)
    scene.cycle(2)
    return scene
