"""Random scenes with blocks of all types: sound after every command and cycle, the same however played."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from itertools import chain
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.relocate import differences, essence, relocate
from support import random_crack_scenes, random_joint_scenes, random_structure_scenes, random_water_scenes
from support.interpreted_kernels import both_ways, unlike
from support.random_deformable_scenes import play, types
from support.replayable_steps import Scene, Step, replay
from support.seldom_compiled import compiled_if_usual

from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout.offsets import JUNK, MRIG, NSOFT
from udec_ia.model import Model

SCENES = 10
BATCH = 10
SHORT = (2, 8)
SEEDS = [24, 40]
JOINT_SCENES = range(40, 100, 20)  # with joint materials
BRIEF_SCENES = range(0, 940, 94)  # the same, of few blocks and cycles
PLAYS = pytest.mark.parametrize(
    ("play", "seed"),
    [
        (play, 24),
        (play, 40),
        (random_joint_scenes.play, 45),
        (random_joint_scenes.play, 65),
        (random_water_scenes.play, 42),
        (random_water_scenes.play, 55),
        (random_structure_scenes.play, 1),
        (random_structure_scenes.play, 2),
        (random_crack_scenes.play, 23),
    ],
    ids=[
        *("contacts-24", "contacts-40", "joints-45", "joints-65"),
        *("water-42", "water-55", "structures-1", "structures-2", "cracks"),
    ],
)


class Unsound(AssertionError):
    """A scene went wrong; the message ends with its deck."""


def sound(scene: Scene) -> None:
    """The checker finds nothing, and deformable blocks are counted."""
    found = list(map(str, scene.model.check()[:5]))
    heads = scene.model.table("block")["HEAD"]
    if int(scene.model.h.ci[NSOFT]) != (heads != MRIG).sum():
        found.append(f"NSOFT is {scene.model.h.ci[NSOFT]}")
    if found:
        raise Unsound("\n".join([*found, scene.deck]))


@pytest.mark.parametrize("first", range(0, SCENES, BATCH))
def test_every_cycle_is_sound(first: int) -> None:
    for seed in range(first, first + BATCH):
        play(seed, watch=sound, cycles=SHORT)


@pytest.mark.parametrize("first", JOINT_SCENES)
def test_every_cycle_with_joint_materials_is_sound(first: int) -> None:
    for seed in range(first, first + 20):
        random_joint_scenes.play(seed, watch=sound, cycles=SHORT)


@pytest.mark.parametrize("first", BRIEF_SCENES)
def test_every_cycle_of_brief_scenes_is_sound(first: int) -> None:
    for seed in range(first, first + 94):
        random_joint_scenes.play_briefly(seed, sound)


@settings(max_examples=5, derandomize=True)
@given(st.integers(1000, 2**31))
def test_any_scene_is_sound(seed: int) -> None:
    play(seed, watch=sound, cycles=SHORT)


def test_scenes_are_not_degenerate() -> None:
    """All types and all commands occur; few scenes end by an overlap or a zone inside out."""
    played = [play(seed, cycles=SHORT) for seed in range(30)]
    assert sum(scene.ended for scene in played) <= 3
    counts = np.array([types(scene) for scene in played])
    assert (counts.sum(axis=0) >= 20).all()
    assert (counts > 0).all(axis=1).sum() >= 5
    done = Counter(step.name for scene in played for step in scene.steps)
    assert set(done) >= {"change", "generate", "boundary", "function", "insitu", "split", "delete", "free"}
    zones = [len(scene.model.table("zone")) for scene in played]
    assert np.median(zones) >= 5


# ---- the same scene, played in another way


def again(scene: Scene, model: Model, after: Callable[[Model], Model] | None = None) -> list[str]:
    """What differs when the scene is played again on `model`."""
    return differences(essence(scene.model.array), essence(replayed(scene.steps, model, after).array))


def replayed(steps: list[Step], model: Model, after: Callable[[Model], Model] | None = None) -> Model:
    """The scene played again cycle by cycle: CYCLE takes its time-step from the blocks as they are."""
    one = Step("cycle", (1,))
    single = [[one] * int(step.numbers[0]) if step.name == "cycle" else [step] for step in steps]
    return replay(quiet(model), list(chain.from_iterable(single)), after)


def quiet(model: Model) -> Model:
    """A model that does not warn of damping."""
    model.tell = lambda _: None
    return model


@pytest.mark.parametrize("builds", [("i16r64", "i32r64", "i64r64"), ("i16r32", "i32r32")])
@PLAYS
def test_integer_widths_do_not_change_a_bit(
    play: Callable[..., Scene], builds: tuple[str, ...], seed: int
) -> None:
    played = []
    for build in builds:
        with compiled_if_usual(build):
            played.append(essence(play(seed, Model(build), cycles=SHORT).model.array))
    first, *others = played
    assert [differences(first, other) for other in others] == [[]] * len(others)


@PLAYS
def test_where_groups_lie_does_not_change_a_bit(play: Callable[..., Scene], seed: int) -> None:
    """All groups are moved to other addresses before every command, or the junk list is forgotten."""
    scene = play(seed, cycles=(5, 20))
    rng = np.random.default_rng(seed)

    def shuffle(model: Model) -> Model:
        other = quiet(Model())
        other.start()
        other.session.array = relocate(model.array, rng)
        assert other.check() == []
        return other

    def forget(model: Model) -> Model:
        model.array.h.ci[JUNK] = 0  # as somebody who writes through `h` must not: the time-step stays
        return model

    assert again(scene, Model(), shuffle) == []
    assert again(scene, Model(), forget) == []


@PLAYS
def test_saving_and_restoring_does_not_change_a_bit(
    play: Callable[..., Scene], seed: int, tmp_path: Path
) -> None:
    scene = play(seed, cycles=SHORT)

    def restored(model: Model) -> Model:
        return quiet(Model.restore(model.save(tmp_path / "scene.h5")))

    assert again(scene, Model(), restored) == []


def longer(step: Step, factor: float) -> Step:
    """`step` in a world `factor` times as large, of the same masses and stiffnesses, so at the same rate.

    Stresses and moduli are those of before, for forces grow as areas of faces do.
    """
    if step.name in ("cycle", "fraction", "damping", "function"):
        return step
    powers = {"density": -2, "xgrad": -1, "ygrad": -1}
    powers |= dict.fromkeys(("cohesion", "xvel", "yvel", "xforce", "yforce", "gridpoints"), 1)
    words = {
        word: (np.array(value) * factor ** powers[word]).tolist() if word in powers else value
        for word, value in step.words.items()
    }
    size = {"property": 0, "insitu": 4}.get(step.name, len(step.numbers))
    numbers = [n * factor if k < size else n for k, n in enumerate(step.numbers)]
    if step.name == "throw":
        numbers[0], numbers[3] = step.numbers[0], step.numbers[3]
    return Step(step.name, tuple(numbers), words)


@pytest.mark.parametrize("k", [-10, 5])
@pytest.mark.parametrize("seed", SEEDS)
def test_scale_does_not_change_a_bit(seed: int, k: int) -> None:
    """Lengths and gravity times 2^k at equal masses: speeds and forces times 2^k, moments times 4^k."""
    scene = play(seed, cycles=(5, 20))
    factor = 2.0**k
    large = essence(replayed([longer(step, factor) for step in scene.steps], Model()).array)
    units = dict.fromkeys(("m", "m/s", "N/m"), factor) | dict.fromkeys(("N", "kg.m", "m2"), factor**2)
    differ = differences(large, essence(scene.model.array), units)
    assert {*differ} <= {f"{name} of joint" for name in PER_CONTACT}


# INSITU gives contacts forces for stresses, and 1 for a length
PER_CONTACT = ("KCJL", "KCJOWN", "KCJSN", "KCJTS")
TURNS = {
    "by 90 degrees": ((0.0, -1.0), (1.0, 0.0)),
    "to its mirror image": ((-1.0, 0.0), (0.0, 1.0)),
}


def turned(step: Step, x: tuple[float, float], y: tuple[float, float]) -> Step:
    """`step` with x and y replaced by the products of (x, y) with the rows x and y; blocks stay clockwise."""

    def at(a: float, b: float) -> tuple[float, float]:
        return x[0] * a + x[1] * b, y[0] * a + y[1] * b

    numbers, words = step.numbers, dict(step.words)
    if step.name in ("delete", "fix", "free", "change", "generate", "boundary"):
        corners = [at(a, b) for a in numbers[:2] for b in numbers[2:]]
        xs, ys = zip(*corners, strict=True)
        numbers = (min(xs), max(xs), min(ys), max(ys))
    elif step.name in ("block", "split", "gravity"):
        points = [at(*numbers[k : k + 2]) for k in range(0, len(numbers), 2)]
        if step.name == "block" and x[0] * y[1] - x[1] * y[0] < 0:
            points.reverse()
        numbers = tuple(chain(*points))
    if "gridpoints" in words:
        words["gridpoints"] = [at(*point) for point in words["gridpoints"]]
    return Step(step.name, numbers, words)


def has_direction(step: Step) -> bool:
    """True if `step` names a block by its place in a list, or a direction that `turned` does not turn."""
    return step.name in ("throw", "insitu", "function") or not step.words.keys().isdisjoint(
        {"xvel", "yvel", "xforce", "yforce", "stress"}
    )


def with_joints_alike(steps: list[Step]) -> list[Step]:
    """The same, with the joint properties of material 1 in material 2, too.

    A contact takes the material of the block that was first in a list, which a turn may change.
    """
    first = next(step.words for step in steps if step.name == "property" and "kn" in step.words)
    joints = {name: first[name] for name in ("kn", "ks", "friction", "cohesion")}
    return [
        Step(step.name, step.numbers, step.words | joints)
        if step.name == "property" and "kn" in step.words
        else step
        for step in steps
    ]


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("seed", SEEDS)
def test_directions_are_equal(seed: int, turn: str) -> None:
    """A scene that is turned or mirrored, up to its first cycles, is the same scene in another position."""
    x, y = TURNS[turn]
    scene = play(seed, cycles=(2, 4))
    steps = with_joints_alike([step for step in scene.steps if not has_direction(step)])
    one, two = quiet(Model()), quiet(Model())
    replay(one, steps)
    replay(two, [turned(step, x, y) for step in steps])
    for kind, names in (("block", ("KX", "KY")), ("gridpoint", ("KXG", "KYG"))):
        here, there = (np.stack([m.table(kind)[name] for name in names], axis=1) for m in (one, two))
        here = here @ np.array([x, y]).T
        assert len(here) == len(there)
        if len(here):
            gap = np.abs(here[:, None] - there[None, :]).max(axis=2)
            assert max(gap.min(axis=1).max(), gap.min(axis=0).max()) <= 1e-9 * np.abs(here).max()


@both_ways
@pytest.mark.parametrize("seed", [11, 40])
@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_interpreted_kernels_give_the_same_bits(build: str, seed: int) -> None:
    """The same source without the compiler."""
    assert unlike(play, build, seed) == []


@both_ways
@pytest.mark.parametrize("seed", [3, 55])
def test_interpreted_water_gives_the_same_bits_in_32_bit_reals(seed: int) -> None:
    assert unlike(random_water_scenes.play, "i32r32", seed) == []
