"""The oracle of overlaps is not blind: outlines and depths known beforehand, and a stage that must object."""

from __future__ import annotations

from math import hypot, pi, radians, sqrt, tan

import numpy as np
import pytest
import shapely
from naive.overlaps import Body, bare, deeper, deepest, depth, outline, parts, touching, within
from support.mechanics_scenes import box, model
from support.watched_model import WatchedModel, Wrong

D = 0.1
CLOSE = 2e-3 * D  # what chords and sampling cost
SQUARE = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
U = [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (3.0, 2.0), (3.0, 0.0)]


def at(x: float, y: float, ring: list[tuple[float, float]] | None = None, turn: float = 0.0) -> Body:
    """A body, a unit square if no other is given, turned about the origin and then shifted."""
    c, s = np.cos(turn), np.sin(turn)
    return Body.of([(x + c * p - s * q, y + s * p + c * q) for p, q in ring or SQUARE])


def test_a_rounded_square() -> None:
    """Each corner loses a square of D less a quarter of a circle; the outline runs along the true circle."""
    shape = outline(at(0, 0), D)
    assert shape.is_valid
    assert outline(at(0, 0), 0.5).is_valid  # all rounding
    assert outline(at(0, 0), 0.5).area == pytest.approx(pi / 4, rel=2e-3)
    assert shape.area == pytest.approx(1 - (4 - pi) * D**2, abs=2 * pi * D * CLOSE)
    points = shapely.get_coordinates(shape)
    corner = points[(points < D).all(axis=1)]
    assert len(corner) > 20
    assert np.allclose(np.hypot(*(corner - D).T), D, rtol=1e-12)


@pytest.mark.parametrize("angle", [5, 30, 60, 120])
def test_a_corner_of_any_angle(angle: float) -> None:
    """The tip of a wedge ends where its circle of radius D tan(angle/2) ends."""
    half = radians(angle) / 2
    wedge = [(0.0, 0.0), (-5 * tan(half), 5.0), (5 * tan(half), 5.0)]
    radius = D * tan(half)
    lowest = outline(Body.of(wedge), D).bounds[1]
    assert lowest == pytest.approx(hypot(D, radius) - radius, abs=CLOSE)


def test_concave_and_plain_corners_stay_sharp() -> None:
    assert {(1.0, 1.0), (2.0, 1.0)} <= set(outline(Body.of(U), D).exterior.coords)
    plain = Body(np.array(SQUARE), np.array([False, True, False, False]))
    assert outline(plain, D).bounds[0] == 0.0
    assert (0.0, 1.0) in set(outline(plain, D).exterior.coords)
    assert (1.0, 1.0) not in set(outline(plain, D).exterior.coords)


@pytest.mark.parametrize("by", [0.001, 0.02, 0.3, 1.2])
def test_squares_side_by_side(by: float) -> None:
    """Displaced by so many roundings, they overlap by that."""
    one, two = outline(at(0, 0), D), outline(at(1 - by * D, 0.3), D)
    assert depth(one, two, D) == pytest.approx(by * D, abs=CLOSE)
    assert deeper([one, two], [(0, 1)], by * D - CLOSE)
    assert deeper([one, two], [(1, 0)], by * D - CLOSE)
    assert not deeper([one, two], [(0, 1)], by * D + CLOSE)


def test_corner_on_corner_and_corner_on_edge() -> None:
    """The overlap of circles, and that of a circle and an edge."""
    aside = 1 - 2 * D + (2 - 0.2) * D / sqrt(2)  # the circles' centres are 1.8 D apart
    one, two = outline(at(0, 0), D), outline(at(aside, aside), D)
    assert depth(one, two, D) == pytest.approx(0.2 * D, abs=CLOSE)
    tip = at(0.5, 1 - (sqrt(2) - 1) * D - 0.4 * D, turn=pi / 4)
    assert depth(outline(at(0, 0), D), outline(tip, D), D) == pytest.approx(0.4 * D, abs=CLOSE)


def test_bodies_that_only_come_near() -> None:
    """The unrounded corners overlap, the bodies do not."""
    near = outline(at(1 - 0.3 * D, 1 - 0.25 * D), D)
    assert parts(outline(at(0, 0), D), near, D) == []
    assert not deeper([outline(at(0, 0), D), near], [(0, 1)], 0.01 * D)
    assert touching([at(0, 0), at(1 - 0.3 * D, 1 - 0.25 * D), at(2.5, 0)]) == [(0, 1)]


def test_every_part_wants_a_contact_of_its_own() -> None:
    """A bar on a U: two parts, and a contact on one of them is none for the other."""
    bar = outline(at(-0.5, 2 - 0.2 * D, [(0.0, 0.0), (0.0, 1.0), (4.0, 1.0), (4.0, 0.0)]), D)
    found = parts(outline(Body.of(U), D), bar, D)
    assert [part.depth for part in found] == pytest.approx([0.2 * D] * 2, abs=CLOSE)
    left = np.array([[0.5, 2.0]])
    assert sorted(bare(part, left, D) for part in found) == [False, True]
    assert all(bare(part, np.zeros((0, 2)), D) for part in found)


def test_what_happens_within_a_step() -> None:
    """A plate of 2 D that a square passes in one step, and a bar that turns through a square."""
    plate = at(1.5, 0, [(0.0, 0.0), (0.0, 1.0), (2 * D, 1.0), (2 * D, 0.0)])
    before, after = [at(0, 0), plate], [at(2, 0), plate]
    assert depth(*(outline(body, D) for body in before), D) == 0.0
    assert depth(*(outline(body, D) for body in after), D) == 0.0
    assert deepest(before, after, D) == pytest.approx(0.5)  # a side of the plate in the middle of the square
    bar = [(-2.0, -0.2), (-2.0, 0.2), (2.0, 0.2), (2.0, -0.2)]
    spun = [at(0, 0, bar, turn) for turn in (-0.5, 0.5)]
    still = at(1.6, -0.1, [(0.0, 0.0), (0.0, 0.2), (1.0, 0.2), (1.0, 0.0)])
    assert max(depth(*two, D) for two in within([spun[0], still], [spun[1], still], D)) > 0.9 * D
    assert deepest([at(0, 0), plate], [at(0, 3), plate], D) == 0.0


# ---- the stage


def gap() -> tuple[WatchedModel, int, int]:
    """Two blocks 1 m apart, without a contact, on a stage."""
    m = model(*box(0, 3, 0, 1), d=D)
    m.split(1, -1, 1, 2)
    m.split(2, -1, 2, 2)
    m.delete(1, 2, 0, 1)
    stage = WatchedModel(model=m)
    left, right = sorted(stage.bodies(), key=lambda ib: stage.centroid(ib)[0])
    return stage, left, right


def shifted(stage: WatchedModel, ib: int, by: float) -> dict[int, Body]:
    """The bodies, that of block `ib` moved to the left."""
    bodies = stage.bodies()
    return {**bodies, ib: Body(bodies[ib].corners - (by, 0), bodies[ib].plain)}


def test_the_stage_sees_an_overlap_without_a_contact() -> None:
    stage, _, right = gap()
    stage._look(None, stage.bodies())
    stage._look(None, shifted(stage, right, 1 + 0.04 * D))
    with pytest.raises(Wrong, match=r"bare: .* overlap by 0.100 D"):
        stage._look(None, shifted(stage, right, 1 + 0.1 * D))


def test_the_stage_sees_who_went_through_another() -> None:
    stage, _, right = gap()
    stage._look(stage.bodies(), shifted(stage, right, 0.9))
    with pytest.raises(Wrong, match="through"):
        stage._look(stage.bodies(), shifted(stage, right, 3.5))


def test_the_stage_sees_contacts_that_are_too_deep_and_such_that_touch_nothing() -> None:
    """Of two blocks that touch, when their bodies are elsewhere than their contacts."""
    m = model(*box(0, 2, 0, 1), d=D)
    m.split(1, -1, 1, 2)
    stage = WatchedModel(model=m)
    right = max(stage.bodies(), key=lambda ib: stage.centroid(ib)[0])
    stage._look(None, shifted(stage, right, 0.45 * D))
    with pytest.raises(Wrong, match=r"deep: .* by 0.600 D"):
        stage._look(None, shifted(stage, right, 0.6 * D))
    touching = stage.contacts()
    stage.contacts = lambda: {pair: np.add(rows, (0, 0, 0.1 * D)) for pair, rows in touching.items()}
    with pytest.raises(Wrong, match="phantom"):
        stage._look(None, shifted(stage, right, -0.1 * D))


def test_the_stage_sees_an_error_15_without_a_reason() -> None:
    stage, _, right = gap()
    with pytest.raises(Wrong, match="false alarm"):
        stage._justified(shifted(stage, right, -0.1))
    stage._justified(shifted(stage, right, 1.06))
