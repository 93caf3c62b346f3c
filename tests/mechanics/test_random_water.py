"""Random scenes with water: sound after every command and cycle, and no energy from nowhere."""

from __future__ import annotations

import numpy as np
import pytest
from support.random_water_scenes import play, play_briefly
from support.replayable_steps import Scene

from udec_ia.layout import offsets as g
from udec_ia.reader.water_rows import domain_water

BRIEF, BATCH = 1000, 100
SHORT = (2, 8)


class Unsound(AssertionError):
    """A scene went wrong; the message ends with its deck."""


def sound(scene: Scene) -> None:
    """The checker finds nothing, volumes and the amount of water included; pressures are not below 0."""
    found = list(map(str, scene.model.check()[:5]))
    if scene.model.h.ci[g.LWATER]:
        rows = domain_water(scene.model.h)
        flowing = rows[rows["state"] == g.FLOWS]
        if not ((flowing["pressure"] >= 0) & (flowing["saturation"] <= 1)).all():
            found.append("a pressure is below 0, or a saturation above 1")
        if ((flowing["pressure"] > 0) & (flowing["saturation"] < 1)).any():
            found.append("a domain that is not filled has a pressure")
    if found:
        raise Unsound("\n".join([*found, scene.deck]))


@pytest.mark.parametrize("first", range(0, BRIEF, BATCH))
def test_every_cycle_of_brief_scenes_is_sound(first: int) -> None:
    for seed in range(first, first + BATCH):
        play_briefly(seed, sound)


@pytest.mark.parametrize("first", [0, 10])
def test_every_cycle_is_sound(first: int) -> None:
    for seed in range(first, first + 10):
        play(seed, watch=sound, cycles=SHORT)


def test_scenes_are_not_degenerate() -> None:
    """Water flows, is compressed, and moves blocks, in many scenes."""
    scenes = [play(seed, cycles=SHORT) for seed in range(40, 70)]
    wet = [domain_water(scene.model.h) for scene in scenes if scene.model.h.ci[g.LWATER]]
    assert sum(bool((rows["pressure"] > 0).any()) for rows in wet) >= 10
    assert sum(bool((np.abs(rows["inflow"]) > 0).any()) for rows in wet) >= 8
    done = {step.name for scene in scenes for step in scene.steps}
    assert done >= {"fluid", "ppressure", "flow", "boundary", "split", "delete", "generate"}
    assert sum(scene.ended for scene in scenes) <= 5
