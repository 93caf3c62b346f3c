"""Random scenes: after every command and every cycle the map is sound, and other ways of playing agree."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from itertools import chain, count, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.compare import disagreements
from naive.relocate import differences, essence, relocate
from support.interpreted_kernels import both_ways, unlike
from support.random_scenes import play
from support.replayable_steps import Scene, Step, blocks, outline, replay

from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout.offsets import ALPHA, DTOL, GRAVX, GRAVY, JUNK, MCTOT, NCON, NVIRT, TDEL
from udec_ia.model import Model

SCENES = 20
NARROW = 10  # scenes with the narrowest words
BATCH = 10
SHORT = (2, 10)  # cycles of a run, where every one of them is looked at


class Unsound(AssertionError):
    """A scene went wrong; the message ends with its deck."""


def sound(scene: Scene) -> None:
    """The checker finds nothing."""
    found = scene.model.check()
    if found:
        raise Unsound("\n".join([*map(str, found[:5]), scene.deck]))


def complete(scene: Scene) -> None:
    """As `sound`; and the heap has the contacts that brute force finds, and no two on the same segments."""
    sound(scene)
    model = scene.model
    if not blocks(model):
        return
    rows = model.table("contact")
    outlines = {ib: outline(model, ib) for ib in blocks(model)}
    size = max(abs(number) for points in outlines.values() for point in points for number in point)
    slack = 64 * size * np.finfo(model.h.cr.dtype).eps * np.sqrt(1.0 + model.h.ci[MCTOT])
    wrong = disagreements(outlines, rows, float(model.h.cr[DTOL]), float(slack))
    if wrong:
        raise Unsound("\n".join([*wrong[:5], scene.deck]))
    twice = [
        pair
        for pair, count in Counter(segments(row) for row in rows if row["KCCOD"] < 4).items()
        if count > 1
    ]
    if twice:
        raise Unsound("\n".join([f"two contacts on the same segments {twice[0]}", scene.deck]))


def segments(row: Any) -> tuple[Any, ...]:
    """The two segments of a contact, in an order that does not depend on which block is the first."""
    code = int(row["KCCOD"])
    return tuple(sorted([(int(row["KCP1"]), code == 3), (int(row["KCP2"]), code == 2)]))


# ---- soundness


@pytest.mark.parametrize("first", range(0, SCENES, BATCH))
def test_every_cycle_of_random_scenes_is_sound(first: int) -> None:
    for seed in range(first, first + BATCH):
        play(seed, watch=sound, cycles=SHORT)


@pytest.mark.parametrize("first", range(0, NARROW, BATCH))
def test_every_cycle_of_random_scenes_with_narrow_reals_is_sound(first: int) -> None:
    for seed in range(first, first + BATCH):
        play(seed, Model(build="i16r32"), watch=sound, cycles=SHORT)


@pytest.mark.parametrize("build", ["i32r64", "i16r32"])
@pytest.mark.parametrize("seed", [256, 434, 504, 512, 544, 549, 717])
def test_contacts_around_small_triangles_are_sound(seed: int, build: str) -> None:
    """Joints that almost meet in one point cut out triangles and wedges not much larger than the rounding."""
    play(seed, Model(build=build), watch=sound, cycles=SHORT)


@pytest.mark.parametrize("first", range(SCENES, SCENES + 10, 5))
def test_contacts_of_random_scenes_are_those_of_brute_force(first: int) -> None:
    for seed in range(first, first + 5):
        play(seed, watch=complete, cycles=(2, 6))


def test_random_scenes_are_not_degenerate() -> None:
    """Most scenes have many blocks, run to their end and contain what is hard: virtual contacts, errors."""
    played = [play(seed, cycles=SHORT) for seed in range(40)]
    done = [scene for scene in played if not scene.ended]
    assert len(done) >= 30
    assert np.median([len(blocks(scene.model)) for scene in played]) >= 4
    assert sum(int(scene.model.h.ci[NVIRT]) > 0 for scene in played) >= 4
    commands = {step.name for scene in played for step in scene.steps}
    assert commands >= {
        "split",
        "delete",
        "fix",
        "free",
        "change",
        "round",
        "throw",
        "gravity",
        "damping",
        "cycle",
    }


# ---- conservation


def momentum(model: Model) -> tuple[Any, Any]:
    """Momentum of all blocks, and the sum of the sizes of what is added up in it."""
    rows = model.table("block")
    parts = np.stack([rows["KBM"] * rows["KXD"], rows["KBM"] * rows["KYD"]])
    return parts.sum(axis=1), np.abs(parts).sum(axis=1)


@pytest.mark.parametrize("seed", range(20))
def test_momentum_changes_by_gravity_alone(seed: int) -> None:
    """Without damping and with all blocks free: contact forces cancel, whatever is made and broken.

    Each cycle rounds each block's velocity a few times, and the force sums once for each contact. A scene
    that error 15 has ended before gives way to the next one, 20 seeds later.
    """
    scene = next(found for k in count(seed, 20) if not (found := play(k, cycles=SHORT)).ended)
    model = scene.model
    model.free(-1e9, 1e9, -1e9, 1e9)
    model.damping(0, 1)
    assert model.h.cr[ALPHA] == 0
    mass = model.table("block")["KBM"].sum()
    before, _ = momentum(model)
    for done in range(1, 21):
        scene.cycle(1)
        if scene.ended:
            assert done > 1
            return
        h = model.h
        after, size = momentum(model)
        force = np.abs(model.table("contact")["KCFN"]).sum() * h.cr[TDEL]
        weight = mass * h.cr[TDEL] * np.array([h.cr[GRAVX], h.cr[GRAVY]])
        rounding = np.finfo(h.cr.dtype).eps * (size + force + np.abs(weight)) * (8 + h.ci[NCON])
        assert (np.abs(after - before - weight * done) <= rounding * done).all()


# ---- the same scene, played in another way


def state_after(seed: int, model: Model) -> dict[str, Any]:
    return essence(play(seed, model, cycles=(5, 20)).model.array)


def again(scene: Scene, model: Model, after: Callable[[Model], Model] | None = None) -> list[str]:
    """What differs when the scene is played again on `model`."""
    return differences(essence(scene.model.array), essence(replay(model, scene.steps, after).array))


SEEDS = [3, 12, 23, 26, 39]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("builds"), [("i16r64", "i32r64", "i64r64"), ("i16r32", "i32r32")])
def test_integer_widths_do_not_change_a_bit(builds: tuple[str, ...], seed: int) -> None:
    first, *others = [state_after(seed, Model(build)) for build in builds]
    assert [differences(first, other) for other in others] == [[]] * len(others)


@pytest.mark.parametrize("seed", SEEDS)
def test_reused_memory_does_not_change_a_bit(seed: int) -> None:
    """With an empty junk list FIND takes fresh memory every time."""
    scene = play(seed, cycles=(5, 20))

    def forget(model: Model) -> Model:
        model.array.h.ci[JUNK] = 0  # words are lost, which the proof after a write through `h` would refuse
        model.session.writes.pending = model.session.written = False
        return model

    assert again(scene, Model(), forget) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_addresses_do_not_change_a_bit(seed: int) -> None:
    """All groups are moved to other addresses between two runs, and before every command."""
    scene = play(seed, cycles=(5, 20))
    rng = np.random.default_rng(seed)

    def shuffle(model: Model) -> Model:
        other = Model()
        other.start()
        other.session.array = relocate(model.array, rng)
        assert other.check() == []
        return other

    assert again(scene, Model(), shuffle) == []


def longer(step: Step, k: int, density: float) -> Step:
    """`step` in a world 2^k times as large, of the same masses and stiffnesses, so at the same rate."""
    factor = 2.0**k
    if step.name == "property":
        words = dict(step.words)
        words["density"] *= density
        words["cohesion"] *= factor
        return Step(step.name, step.numbers, words)
    if step.name == "throw":
        which, x, y, spin = step.numbers
        return Step(step.name, (which, x * factor, y * factor, spin))
    if step.name in ("cycle", "fraction", "damping"):
        return step
    return Step(step.name, tuple(number * factor for number in step.numbers), step.words)


@pytest.mark.parametrize("k", [-30, 5])
@pytest.mark.parametrize("seed", SEEDS)
def test_scale_does_not_change_a_bit(seed: int, k: int) -> None:
    """Lengths and gravity times 2^k at equal masses: speeds and forces times 2^k, moments times 4^k."""
    scene = play(seed, cycles=(5, 20))
    steps = [longer(step, k, 4.0**-k) for step in scene.steps]
    large = essence(replay(Model(), steps).array)
    factor = 2.0**k
    units = dict.fromkeys(("m", "m/s", "N/m"), factor) | dict.fromkeys(("N", "kg.m"), factor**2)
    assert differences(large, essence(scene.model.array), units) == []


def turned(step: Step, x: tuple[float, float], y: tuple[float, float], spin: float) -> Step:
    """`step` with x and y replaced by the products of (x, y) with the rows x and y; blocks stay clockwise."""

    def at(a: float, b: float) -> tuple[float, float]:
        return x[0] * a + x[1] * b, y[0] * a + y[1] * b

    numbers = step.numbers
    if step.name in ("delete", "fix", "free", "change"):
        corners = [at(a, b) for a in numbers[:2] for b in numbers[2:]]
        xs, ys = zip(*corners, strict=True)
        numbers = (min(xs), max(xs), min(ys), max(ys))
    elif step.name == "throw":
        numbers = (numbers[0], *at(*numbers[1:3]), spin * numbers[3])
    elif step.name in ("block", "split", "gravity"):
        points = [at(*numbers[k : k + 2]) for k in range(0, len(numbers), 2)]
        if step.name == "block" and spin < 0:
            points.reverse()
        numbers = tuple(chain(*points))
    return Step(step.name, numbers, step.words)


TURNS = {
    "by 90 degrees": ((0.0, -1.0), (1.0, 0.0), 1.0),
    "by 180 degrees": ((-1.0, 0.0), (0.0, -1.0), 1.0),
    "to its mirror image": ((-1.0, 0.0), (0.0, 1.0), -1.0),
}


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("seed", SEEDS)
def test_directions_are_equal(seed: int, turn: str) -> None:
    """A scene that is turned or mirrored, up to its first cycles, is the same scene in another position.

    Rounding differs; a scene that depends on it multiplies it with every blow, so a few cycles must do.
    """
    x, y, spin = TURNS[turn]
    scene = play(seed, cycles=(2, 4))
    steps = [step for step in scene.steps if step.name != "throw"]  # which names a place in the block list
    one, two = Model(), Model()
    replay(one, steps)
    replay(two, [turned(step, x, y, spin) for step in steps])
    rows, others = one.table("block"), two.table("block")
    here = np.stack([x[0] * rows["KX"] + x[1] * rows["KY"], y[0] * rows["KX"] + y[1] * rows["KY"]], axis=1)
    there = np.stack([others["KX"], others["KY"]], axis=1)
    assert len(here) == len(there)
    gap = np.abs(here[:, None] - there[None, :]).max(axis=2)
    assert gap.min(axis=1).max() <= 1e-9 * np.abs(here).max()
    assert gap.min(axis=0).max() <= 1e-9 * np.abs(here).max()


@pytest.mark.parametrize("seed", SEEDS[:2])
def test_saving_and_restoring_does_not_change_a_bit(seed: int, tmp_path: Path) -> None:
    scene = play(seed, cycles=SHORT)

    def restored(model: Model) -> Model:
        return Model.restore(model.save(tmp_path / "scene.h5"))

    assert again(scene, Model(), restored) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_twenty_cycles_are_seven_and_thirteen(seed: int) -> None:
    scene = play(seed, cycles=SHORT)
    whole, parts = Model(), Model()
    for model, runs in ((whole, [20]), (parts, [7, 13])):
        replay(model, [*scene.steps, *(Step("cycle", (n,)) for n in runs)])
    assert differences(essence(whole.array), essence(parts.array)) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_growing_word_by_word_does_not_change_a_bit(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """The array starts with room for next to nothing."""
    scene = play(seed, cycles=(5, 20))
    monkeypatch.setattr("udec_ia.heap.main_array.FIRST_SIZE", 64)
    assert again(scene, Model()) == []


# ---- interpreted


@both_ways
@pytest.mark.parametrize("seed", [12, 33])
@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_interpreted_kernels_give_the_same_bits(build: str, seed: int) -> None:
    """The same source without the compiler."""
    assert unlike(play, build, seed) == []


# ---- blocks that fly


def thrown(lines: str, throws: dict[tuple[float, float], tuple[float, float, float]]) -> Scene:
    """A scene from commands; then every block whose centroid is a key is thrown with its (vx, vy, spin).

    Speeds are in rounding lengths a time-step, so that every flight is slow enough.
    """
    scene = Scene(Model())
    model = scene.model
    model.run("START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5\n" + lines)
    model.cycle(1)
    unit = float(model.h.cr[DTOL] / model.h.cr[TDEL])
    for place, (vx, vy, spin) in throws.items():
        assert scene.do("throw", blocks(model).index(block_at(model, *place)), vx * unit, vy * unit, spin)
    scene.watch = complete_now_and_then
    return scene


def complete_now_and_then(scene: Scene) -> None:
    """Sound in every cycle, and complete by brute force in every tenth."""
    (complete if scene.model.h.ci[MCTOT] % 10 == 0 else sound)(scene)


def block_at(model: Model, x: float, y: float) -> int:
    """Address of the block whose centroid is at (x, y)."""
    rows = model.table("block")
    (ib,) = rows["address"][np.hypot(rows["KX"] - x, rows["KY"] - y) < 0.1]
    return int(ib)


def meet(scene: Scene, one: int, two: int, most: int) -> bool:
    """Cycle until the two blocks have a real contact, at most `most` cycles."""
    for _ in range(most):
        scene.cycle(1)
        assert not scene.ended
        rows = scene.model.table("contact")
        rows = rows[rows["KCCOD"] < 4]
        if (np.minimum(rows["KB1"], rows["KB2"]) == min(one, two))[
            np.maximum(rows["KB1"], rows["KB2"]) == max(one, two)
        ].any():
            return True
    return False


ROW = """BLOCK 0 0 0 2 6 2 6 0
SPLIT -1 1 7 1
SPLIT 1 1 1 2
SPLIT 2 1 2 2
SPLIT 3 1 3 2
SPLIT 4 1 4 2
SPLIT 5 1 5 2
ROUND 0.3
FIX 0 6 0 1
"""


def test_a_block_thrown_over_another_lands_on_a_third() -> None:
    """It leaves the second one, hangs on a virtual contact in the air and lands on the third.

    The parabola y = 1.65 x - 0.35 x^2 is more than 1 high from x = 1 to x = 3 and comes down to 1 at x = 4.
    """
    lines = ROW + "DELETE 1 2 1 2\nDELETE 3 4 1 2\nDELETE 5 6 1 2\nGRAVITY 0 -200\n"
    scene = thrown(lines, {(0.5, 1.5): (0.0504, 0.0833, 0.0)})
    model = scene.model
    flying, over, third = (block_at(model, x, 1.5) for x in (0.5, 2.5, 4.5))
    scene.cycle(40)
    assert int(model.h.ci[NVIRT]) == 1
    assert not meet(scene, flying, over, 150)
    assert meet(scene, flying, third, 150)
    assert int(model.h.ci[NVIRT]) == 0


def test_several_blocks_are_detached_at_once() -> None:
    """All blocks of the row jump together, each in its own direction, and come down."""
    throws = {(k + 0.5, 1.5): (0.02 * (k - 2.5), 0.08, 2 * (k - 2.5)) for k in range(6)}
    scene = thrown(ROW + "GRAVITY 0 -200\n", throws)
    floor, middle = block_at(scene.model, 3, 0.5), block_at(scene.model, 2.5, 1.5)
    scene.cycle(60)
    assert int(scene.model.h.ci[NVIRT]) >= 5
    assert meet(scene, middle, floor, 400)


def test_halves_of_a_map_cut_in_two_fall_on_each_other() -> None:
    lines = """BLOCK 0 0 0 6 3 6 3 0
SPLIT -1 2 4 2
SPLIT -1 3 4 3
SPLIT 1 3 1 6
SPLIT 2 3 2 6
SPLIT 1 0 1 2
FIX 0 3 0 2
DELETE 0 3 2 3
ROUND 0.3
GRAVITY 0 -200
"""
    scene = thrown(lines, {})
    model = scene.model
    assert int(model.h.ci[NVIRT]) == 1
    above, below = block_at(model, 1.5, 4.5), block_at(model, 2, 1)
    assert meet(scene, above, below, 400)


def test_a_block_falls_into_a_closed_cavity() -> None:
    """A block under the roof of a cavity with walls all around comes loose and falls to the floor."""
    lines = """BLOCK 0 0 0 5 5 5 5 0
SPLIT -1 1 6 1
SPLIT -1 4 6 4
SPLIT 1 1 1 4
SPLIT 4 1 4 4
SPLIT 1 2.8 4 2.8
SPLIT 2 1 2 4
SPLIT 3 1 3 4
DELETE 1 4 1 2.8
DELETE 1 2 2 4
DELETE 3 4 2 4
ROUND 0.3
FIX -1 6 -1 6
FREE 2 3 3 4
GRAVITY 0 -200
"""
    scene = thrown(lines, {})
    falling, floor = block_at(scene.model, 2.5, 3.4), block_at(scene.model, 2.5, 0.5)
    assert meet(scene, falling, floor, 400)


def test_a_chain_of_virtual_contacts() -> None:
    """A column comes apart block by block, every joint becomes a virtual contact; then all close again."""
    lines = "BLOCK 0 0 0 5 1 5 1 0\n" + "".join(f"SPLIT -1 {k} 2 {k}\n" for k in range(1, 5))
    throws = {(0.5, k + 0.5): (0.0, 0.03 * k, 0.0) for k in range(1, 5)}
    scene = thrown(lines + "ROUND 0.3\nFIX 0 1 0 1\n", throws)
    model = scene.model
    column = [block_at(model, 0.5, k + 0.5) for k in range(5)]
    scene.cycle(60)
    assert int(model.h.ci[NVIRT]) == 4
    model.gravity(0, -300)
    for below, above in pairwise(column):
        assert meet(scene, below, above, 400)


def test_gaps_no_wider_than_the_reals_resolve_need_no_contact() -> None:
    """Blocks that fall together are 84 km down after 30 cycles, where 32-bit reals resolve 8 mm.

    They fall until the reals do not tell two contacts apart: half of what they resolve is more than D/20.
    """
    model = Model("i32r32")
    model.run("START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5\nBLOCK 0 0 0 4 6 4 6 0\nSPLIT -1 1 7 1\n")
    model.run("SPLIT -1 2 7 3\nSPLIT 2 0 3 4\nROUND 0.24\nGRAVITY 0 -10\nCYCLE 20\nGRAVITY 0 -1E8\n")

    def fall() -> None:
        for _ in range(200):
            model.cycle(1)
            assert model.check() == []

    with pytest.raises(UdecError) as caught:
        fall()
    assert caught.value.number == 36
    assert np.spacing(np.abs(model.table("block")["KY"]).max()) > 2 * 0.24 / 20
