"""Many loose blocks: those on a large domain search for contacts by themselves, and miss none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from naive.relocate import differences, essence
from support.interpreted_kernels import both_ways
from support.random_falls import play
from support.watched_model import WatchedModel

from udec_ia import Model
from udec_ia.compiling.interpreted_kernels import interpreted
from udec_ia.heap.accessors import integers
from udec_ia.kernels.detect.large_domains import FEW, MANY, ON_NONE
from udec_ia.layout import offsets as g
from udec_ia.ops.common.listed_groups import list_of

SIDE, PITCH = 100, 1.15
REST = 3e-3  # m/s, of blocks that fall by 18 m


def scene(n: int, seed: int = 1) -> Model:
    """`n` polygons of unit size in rows above a floor between two walls, at rest, with gravity."""
    rng = np.random.default_rng(seed)
    side = min(SIDE, int(np.ceil(np.sqrt(n))))
    w, h = side * PITCH, 2.0 * (n / side) * PITCH
    model = Model()
    model.start()
    model.round(0.05)
    model.block(-1, -1, -1, 0, w + 1, 0, w + 1, -1)
    model.block(-1, 0, -1, h, 0, h, 0, 0)
    model.block(w, 0, w, h, w + 1, h, w + 1, 0)
    model.fix(-2, w + 2, -2, h + 1)
    for k in range(n):
        x, y = (k % side + 0.5) * PITCH, (k // side + 0.5) * PITCH
        corners = int(rng.integers(3, 8))
        turns = -2 * np.pi * (np.arange(corners) + rng.uniform(-0.2, 0.2, corners)) / corners
        model.block(*(float(c) for t in turns for c in (x + 0.5 * np.cos(t), y + 0.5 * np.sin(t))))
    model.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5)
    model.gravity(0, -10)
    return model


def test_a_thousand_blocks_fall_to_rest_without_a_missed_contact() -> None:
    stage = WatchedModel(model=scene(1000))
    model = stage.model
    model.damping(0.1, 1.0, "mass")
    model.fraction(0.2)
    stage.do("cycle", 0)  # large models are renumbered before their first cycle
    for _ in range(20):
        stage.cycle(2000, 2000)
        stage.check()
        rows = model.table("block")
        if np.hypot(rows["KXD"], rows["KYD"]).max() < REST:
            break
    else:
        raise AssertionError("they are not at rest")
    assert model.h.ci[g.NMADE] > 5000
    assert model.h.ci[g.LLARGE] == 0  # one pile has few virtual contacts


@pytest.mark.parametrize("seed", [301, 303, 304])
def test_random_falls_miss_no_contact(seed: int) -> None:
    rng = np.random.default_rng((seed, 39))
    play(WatchedModel(), rng, int(rng.integers(MANY + 2, 110)), 3000, 20)


def test_random_falls_in_narrow_reals() -> None:
    play(WatchedModel("i32r32"), np.random.default_rng(7), MANY + 4, 400, 20)


def test_a_domain_is_large_from_many_pieces_on_until_few_are_left() -> None:
    model = scene(MANY - 3)
    model.cycle(1)
    assert model.h.ci[g.LLARGE] == 0
    model = scene(MANY + 2)
    model.cycle(1)
    assert model.h.ci[g.LLARGE] == 1
    assert int(model.table("domain")["KDLRG"].sum()) == 1
    blocks = list_of(model.h, "block")
    assert (integers(model.h, blocks, g.KBROOM) != ON_NONE).all()
    model.delete(-1, SIDE * PITCH, 1.5, 100)
    assert model.h.ci[g.NVIRT] < FEW
    model.cycle(1)
    assert model.h.ci[g.LLARGE] == 0
    assert not model.table("domain")["KDLRG"].any()


def test_blocks_that_fly_apart_search_seldom_and_those_at_rest_never() -> None:
    """A block searches after a displacement of half the gap to another one at the earliest."""
    model = scene(MANY + 2)
    model.gravity(0, 0)
    model.cycle(1)
    blocks = list_of(model.h, "block")
    before = integers(model.h, blocks, g.KBROOM)
    assert (before > 0).all()
    model.cycle(50)
    assert (integers(model.h, blocks, g.KBROOM) == before).all()


def in_the_fall(path: Path) -> Model:
    """A fall in which blocks have begun to collide, saved in a file."""
    model = scene(MANY + 6, 11)
    model.velocity(-1, SIDE * PITCH, 4, 100, vx=3.0, w=2.0)
    for _ in range(60):
        model.cycle(100)
        if model.h.ci[g.NMADE] > 8:
            break
    assert model.h.ci[g.NMADE] > 8
    assert model.h.ci[g.LLARGE] == 1
    model.save(path)
    return model


@both_ways
def test_compiled_and_interpreted_searches_are_the_same(tmp_path: Path) -> None:
    model = in_the_fall(tmp_path / "state.h5")
    blocks = list_of(model.h, "block")
    before = integers(model.h, blocks, g.KBROOM)
    other = Model()
    other.restart(tmp_path / "state.h5")
    model.cycle(6)
    with interpreted():
        other.cycle(6)
    assert (integers(model.h, blocks, g.KBROOM) > before).any()  # some have searched
    assert differences(essence(model.array), essence(other.array)) == []


def test_a_restart_in_the_fall_changes_no_bit(tmp_path: Path) -> None:
    model = in_the_fall(tmp_path / "state.h5")
    made = int(model.h.ci[g.NMADE])
    model.cycle(700)
    other = Model()
    other.restart(tmp_path / "state.h5")
    for n in (137, 463, 100):
        other.cycle(n)
        other.save(tmp_path / "other.h5")
        other = Model()
        other.restart(tmp_path / "other.h5")
    assert model.h.ci[g.NMADE] > made
    last = int(model.h.ci[g.MFREE])
    assert (model.h.ia[:last] == other.h.ia[:last]).all()


def test_columns_on_a_long_edge_get_all_their_contacts() -> None:
    """Each gap between two columns exposes a part of the same edge; bricks come in any order."""
    columns, rows = 40, 3
    m = Model()
    m.block(-1, -1, -1, 0, 1.5 * columns, 0, 1.5 * columns, -1)
    m.round(0.02)
    order = np.random.default_rng(1).permutation(columns).tolist()
    for column, row in ((c, r) for r in range(rows) for c in order):
        x, y = 1.5 * column, 0.5 * row
        m.block(x, y, x, y + 0.5, x + 1, y + 0.5, x + 1, y)
    contacts = m.table("contact")
    places = np.unique(np.column_stack([contacts["KXC"], contacts["KYC"]]).round(6), axis=0)
    assert len(contacts) == len(places) == 2 * columns * rows
    assert m.check() == []
