"""Random scenes with water: random_joint_scenes.py with FLUID, pressures, conditions outside and flow.

The bulk modulus is of the order of the joint stiffness times a length, so that water and joints act alike.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from support import random_deformable_scenes as deformable
from support import random_joint_scenes as joints
from support.replayable_steps import Scene

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


play = partial(joints.play_of, 37, begin, LATER, MAX_BLOCKS)
play_briefly = partial(joints.play_briefly_of, 38, begin, LATER)
