"""The oracles agree with each other and with what can be worked out by hand."""

from __future__ import annotations

from math import hypot, pi, sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import contacts as naive
from naive.geometry import Outline, area, centroid, moments, split
from naive.memory import Memory
from shapely.geometry import Polygon

SQUARE: Outline = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
ELL: Outline = [(0.0, 0.0), (0.0, 3.0), (1.0, 3.0), (1.0, 1.0), (2.0, 1.0), (2.0, 0.0)]  # concave at (1, 1)


def moved(outline: Outline, dx: float, dy: float, c: float = 1.0, s: float = 0.0) -> Outline:
    return [(dx + c * x - s * y, dy + s * x + c * y) for x, y in outline]


def test_moments_of_a_square_and_of_an_ell() -> None:
    assert moments(SQUARE) == pytest.approx((1.0, 0.5, 0.5, 1 / 6))
    # two rectangles: 1 x 3 at (0.5, 1.5) and 1 x 1 at (1.5, 0.5)
    second = 3 * (10 / 12) + 3 * (0.25**2 + 0.25**2) + 2 / 12 + (0.75**2 + 0.75**2)
    assert moments(ELL) == pytest.approx((4.0, 0.75, 1.25, second))
    assert (area(ELL), *centroid(ELL)) == pytest.approx(moments(ELL)[:3])


def test_split_cuts_across_and_leaves_whole() -> None:
    assert sorted(area(part) for part in split(SQUARE, (-1, 0.25), (2, 0.25))) == pytest.approx([0.25, 0.75])
    assert split(SQUARE, (-1, 0.25), (0.5, 0.25)) == [SQUARE]
    assert len(split(ELL, (-1, 2.0), (3, 2.0))) == 2


def test_rounding_of_a_square_and_of_an_ell() -> None:
    for corner in naive.round_corners(SQUARE, 0.1):
        assert corner.radius == pytest.approx(0.1)
        assert hypot(corner.centre[0] - 0.5, corner.centre[1] - 0.5) == pytest.approx(0.4 * sqrt(2))
    radii = [corner.radius for corner in naive.round_corners(ELL, 0.1)]
    assert [radius < 0 for radius in radii] == [False, False, False, True, False, False]
    assert naive.rounded_polygon(SQUARE, 0.5, 720).area == pytest.approx(pi / 4, rel=1e-5)


@pytest.mark.parametrize(
    ("dx", "dy", "on_edge", "overlap"),
    [
        (0.5, 0.99, {(False, True), (True, False)}, 0.01),  # an arc of each on the edge of the other
        (0.9, 0.95, {(False, False)}, 0.2 - hypot(0.1, 0.15)),  # corner to corner: centres 0.1 and 0.15 apart
        (0.0, 1.04, {(False, False)}, -0.04),
    ],
)
def test_contacts_of_two_squares(
    dx: float, dy: float, on_edge: set[tuple[bool, bool]], overlap: float
) -> None:
    found = naive.contacts({1: SQUARE, 2: moved(SQUARE, dx, dy)}, 0.1, gap=0.05)
    assert {contact.on_edge for contact in found} >= on_edge
    assert [contact.overlap for contact in found] == pytest.approx([overlap] * len(found))


@settings(deadline=None, max_examples=200)
@given(
    st.floats(-1.3, 1.3),
    st.floats(-1.3, 1.3),
    st.floats(-pi, pi),
    st.floats(0.02, 0.4),
    st.sampled_from([SQUARE, ELL]),
)
def test_contacts_are_where_the_outlines_touch(
    dx: float, dy: float, a: float, d: float, outline: Outline
) -> None:
    """Apart: the nearest contact's gap is the distance that shapely finds; overlaps share an area.

    All corners are right ones, so r = d and every circle lies in its block. A chord of 1/64 of the arc of a
    right angle lies within r (pi/256)^2/2 of the arc.
    """
    chord = d * (pi / 256) ** 2 / 2
    one, two = SQUARE, moved(outline, dx, dy, *_direction(a))
    apart = naive.distance(one, two, d)
    overlaps = [contact.overlap for contact in naive.contacts({1: one, 2: two}, d, gap=d)]
    if 2 * chord < apart < 0.9 * d:
        assert max(overlaps) == pytest.approx(-apart, abs=2 * chord)
    elif apart >= 0.9 * d:
        assert all(overlap <= 2 * chord - apart for overlap in overlaps)
    elif any(overlap > 2 * chord for overlap in overlaps):
        assert naive.common_area(one, two, d) > 0


def _direction(a: float) -> tuple[float, float]:
    t = a / 2
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


def test_the_dict_tiles() -> None:
    memory = Memory(10)
    a, b = memory.find(4), memory.find(4)
    assert (a, b, memory.find(4)) == (1, 5, 0)
    memory.lose(a)
    memory.lose(b)
    assert (memory.find(4), memory.find(2), memory.find(4)) == (b, 9, a)
    assert memory.words() == list(range(1, 11))


def test_rounded_block_lies_in_its_polygon() -> None:
    for outline in (SQUARE, ELL):
        assert Polygon(outline).buffer(1e-9).contains(naive.rounded_polygon(outline, 0.2))
