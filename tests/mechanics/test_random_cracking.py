"""Random scenes with blocks that crack: sound after every command and cycle."""

from __future__ import annotations

from collections import Counter

import pytest
from support.random_crack_scenes import play
from support.replayable_steps import Scene


class Unsound(AssertionError):
    """A scene went wrong; the message ends with its deck."""


def sound(scene: Scene) -> None:
    """The checker finds nothing, and blocks stay with a strength of their own."""
    found = list(map(str, scene.model.check()[:5]))
    hosts = scene.model.table("breakable")["KBKB"].tolist()
    if len(hosts) != len({*hosts}):
        found.append("a block has two strengths")
    if found:
        raise Unsound("\n".join([*found, scene.deck]))


@pytest.mark.parametrize("first", range(0, 40, 10))
def test_every_cycle_is_sound(first: int) -> None:
    for seed in range(first, first + 10):
        play(seed, watch=sound, cycles=(5, 40))


def test_a_sliver_pressed_from_both_sides_needs_no_contact_through_it() -> None:
    """Two blocks overlap through the wedge of a third one, behind the circle at its tip (seed 238)."""
    play(238, watch=sound)


def test_scenes_are_not_degenerate() -> None:
    """Blocks crack for every cause, and few scenes end in an error."""
    scenes = [play(seed, cycles=(20, 80)) for seed in range(60, 100)]
    causes = Counter(cause for scene in scenes for cause in scene.model.cracks()["cause"].tolist())
    assert all(causes[cause] >= 5 for cause in ("forces", "tension", "shear"))
    assert sum(scene.ended for scene in scenes) <= 6
