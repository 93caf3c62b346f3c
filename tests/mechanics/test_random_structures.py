"""Random scenes with structures, water and cracks: sound after every command and cycle."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from support.interpreted_kernels import both_ways, unlike
from support.random_crack_scenes import play_mixed_briefly
from support.random_structure_scenes import play
from support.replayable_steps import Scene

from udec_ia.layout import offsets as g

BRIEF, BATCH = 1000, 100
SHORT = (2, 8)


class Unsound(AssertionError):
    """A scene went wrong; the message ends with its deck."""


def sound(scene: Scene) -> None:
    """The checker finds nothing, and no force is beyond its strength."""
    m = scene.model
    found = list(map(str, m.check()[:5]))
    rows, strength = m.table("node"), m.h.cr[g.STCOH : g.STCOH + 50]
    inside = rows["KNSIDE"] == g.EMBEDDED
    pressed = np.where(inside, np.abs(rows["KNFN"]), np.maximum(rows["KNFN"], 0))
    most = (
        strength[rows["KNMAT"] - 1] * rows["KNLEN"]
        + pressed * m.h.cr[g.STMU : g.STMU + 50][rows["KNMAT"] - 1]
    )
    slipped = rows["KNSTAT"] & g.NODE_SLIPPED != 0
    if (
        len(scene.steps)
        and scene.steps[-1].name == "cycle"
        and (np.abs(rows["KNFS"]) > 1.0001 * most)[slipped].any()
    ):
        found.append("a shear force is greater than the strength of its interface")
    if (rows["KNGAP"] > 0).any() and (rows["KNFN"][rows["KNGAP"] > 0] != 0).any():
        found.append("an open interface carries a force")
    if found:
        raise Unsound("\n".join([*found, scene.deck]))


@pytest.mark.parametrize("first", range(0, BRIEF, BATCH))
def test_every_cycle_of_brief_scenes_is_sound(first: int) -> None:
    for seed in range(first, first + BATCH):
        play_mixed_briefly(seed, sound)


def test_a_virtual_contact_between_two_contacts_hides_no_wrong_order() -> None:
    play_mixed_briefly(6503, sound)


@pytest.mark.parametrize("first", [0, 10])
def test_every_cycle_is_sound(first: int) -> None:
    for seed in range(first, first + 10):
        play(seed, watch=sound, cycles=SHORT)


@both_ways
@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_interpreted_kernels_give_the_same_bits(build: str) -> None:
    assert unlike(play, build, 2) == []


def test_scenes_are_not_degenerate() -> None:
    """Structures of all kinds yield, part and slip, in blocks of all types; commands of all kinds occur."""
    scenes = [play(seed, cycles=SHORT) for seed in range(40)]
    nodes = [scene.model.table("node") for scene in scenes]
    assert sum(len(scene.model.table("bolt")) for scene in scenes) > 40
    assert sum(len(rows) for rows in nodes) > 200
    assert sum(bool((rows["KNSTAT"] > 0).any()) for rows in nodes) > 8
    assert sum(bool((rows["KNZN"] > 0).any()) for rows in nodes) > 8
    assert sum(bool((rows["KNSIDE"] == g.ROCK_ON_LEFT).any()) for rows in nodes) >= 2
    done = Counter(step.name for scene in scenes for step in scene.steps)
    assert set(done) >= {"bolt", "cable", "beam", "sproperty", "split", "delete", "generate", "jproperty"}
    assert sum(scene.ended for scene in scenes) <= 5
