"""Meshes of block outlines: what shapely says of them, pairs, shapes, and what makes no mesh."""

from __future__ import annotations

import runpy
import sys
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from udec_ia import UdecError
from udec_ia.ops.commands.grid_points_inside import triangulate
from udec_ia.ops.commands.triangulation import CUT, Mesh, match, mesh, pair_up

EPS = float(np.finfo(float).eps)
SQUARE = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
ELL = [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (1.0, 1.0), (2.0, 1.0), (2.0, 0.0)]
TOOL = runpy.run_path(str(Path(__file__).parents[2] / "docs" / "studies" / "mesh_quality.py"))
SMALLEST_ANGLE = {False: 20.0, True: 15.0}  # degrees: what docs/meshes.md promises, and with MIXED
SHARP = 0.75  # of the sharpest corner, as docs/meshes.md promises


@st.composite
def outlines(draw: st.DrawFn) -> list[tuple[float, float]]:
    """Corners of a block around the origin, clockwise, convex or concave, perhaps far away."""
    gaps = draw(st.lists(st.floats(0.5, 1.0), min_size=4, max_size=9))
    radius = draw(st.lists(st.floats(0.1, 1.0), min_size=len(gaps), max_size=len(gaps)))
    x, y = draw(st.sampled_from([(0.0, 0.0), (-300.0, 1e4)]))
    angles = -2 * pi * np.cumsum(gaps) / sum(gaps)
    return [(x + r * cos(a), y + r * sin(a)) for r, a in zip(radius, angles, strict=True)]


def is_mesh_of(found: Mesh, corners: Any, paired: bool) -> None:
    """Zones, all clockwise, fill the outline side to side without overlap; pairs have a common side."""
    given, n = np.array(corners), len(corners)
    assert (found.points[:n] == given).all()
    block = shapely.Polygon(given)
    zones = shapely.polygons(found.points[found.zones])
    slack = 64 * EPS * float(np.abs(given).max())  # of a coordinate
    assert not shapely.is_ccw(shapely.get_exterior_ring(zones)).any()
    whole = shapely.union_all(zones, grid_size=slack)
    length = block.length * len(found.ring)
    assert abs(shapely.area(zones).sum() - block.area) <= slack * length
    assert whole.symmetric_difference(block).area <= slack * length
    outer = set(zip(found.ring.tolist(), np.roll(found.ring, -1).tolist(), strict=True))
    sides = [(int(t[k - 1]), int(t[k])) for t in found.zones for k in range(3)]
    once = set(sides)
    assert len(once) == len(sides)
    assert {(i, j) for i, j in once if (j, i) not in once} == outer
    assert sorted(np.unique(found.zones)) == list(range(len(found.points)))
    on = shapely.distance(block.exterior, shapely.points(found.points[found.ring]))
    assert (on <= slack).all()
    if paired:
        assert len(found.zones) % 2 == 0
        for one, two in found.zones.reshape(-1, 2, 3):
            assert len({*one.tolist(), *two.tolist()}) == 4


@settings(max_examples=50)
@given(outlines(), st.floats(0.04, 3.0), st.booleans())
def test_zones_fill_any_block(corners: list[tuple[float, float]], edge: float, paired: bool) -> None:
    is_mesh_of(mesh(corners, edge, paired), corners, paired)


@pytest.mark.parametrize("paired", [False, True])
@pytest.mark.parametrize("edge", [5.0, 0.7, 0.3, 0.02])
def test_a_concave_block(edge: float, paired: bool) -> None:
    is_mesh_of(mesh(ELL, edge, paired), ELL, paired)


def test_zones_are_as_large_as_asked_for() -> None:
    """The mean area is that of an equilateral triangle, within a fifth: sides within a tenth."""
    for edge in (0.2, 0.05, 0.01):
        area = 3.0 / len(mesh(ELL, edge).zones)
        assert 0.8 < area / (3**0.5 / 4 * edge**2) < 1.2


@pytest.mark.parametrize("paired", [False, True])
@pytest.mark.parametrize("fraction", [1.0, 0.5, 0.25])
def test_shapes_are_as_good_as_the_documents_say(fraction: float, paired: bool) -> None:
    """Edges as long as a block is wide, or shorter; blocks that the tool has not shown."""
    outlines = list(TOOL["blocks"](100, 4711))
    found = TOOL["measure"](outlines, fraction, paired)
    assert len(found) > 50
    for quality in found:
        assert quality.angles.min() >= min(SMALLEST_ANGLE[paired], SHARP * quality.corner)


def test_the_same_block_gets_the_same_mesh() -> None:
    one, two = mesh(ELL, 0.13), mesh(ELL, 0.13)
    for name in ("points", "zones", "ring"):
        assert getattr(one, name).tobytes() == getattr(two, name).tobytes()


@pytest.mark.parametrize("edge", [0.4, 0.25, 0.07])
def test_neighbours_have_the_same_points_on_a_common_edge(edge: float) -> None:
    """An edge that one block runs through upwards and one downwards."""
    ends = [(0.1, 0.2), (1.3, 2.7)]
    right, left = mesh([*ends, (2.0, 0.3)], edge, False), mesh([*ends[::-1], (-1.0, 2.0)], edge, False)

    def on_common(found: Mesh) -> set[tuple[float, float]]:
        line = shapely.LineString(ends)
        points = found.points[found.ring]
        near = shapely.distance(line, shapely.points(points)) < 1e-9
        return {(float(x), float(y)) for x, y in points[near]}

    assert len(on_common(left)) >= 2.6 / edge / 1.5
    assert on_common(left) == on_common(right)


def test_coordinates_are_those_that_32_bits_hold() -> None:
    shifted = (np.array(ELL) + 1000).astype(np.float32)
    found = mesh(shifted, 0.3, real=np.float32)
    assert (found.points == found.points.astype(np.float32)).all()
    assert (found.angles > 15).all()


# ---- pairs


def test_a_zone_between_three_others_takes_one_and_the_others_are_cut() -> None:
    """A triangle with one more on each side: the middle one pairs with one, the other two are cut in two."""
    outline = np.array([(0, 0), (-1, 1.5), (1, 2), (3, 1.5), (2, 0), (1, -1.5)], float)
    zones = np.array([(0, 2, 4), (0, 1, 2), (2, 3, 4), (4, 5, 0)])
    points, paired, ring = pair_up(outline, zones, 6)
    assert len(points) == 8
    assert len(paired) == 6
    is_mesh_of(Mesh(points, paired, ring), outline, True)


@settings(max_examples=100)
@given(st.integers(4, 30), st.integers(0, 10_000))
def test_no_zone_is_cut_where_all_can_be_paired(n: int, seed: int) -> None:
    """Zones 2i and 2i + 1 have a common side, so all could be paired, whatever other sides there are."""
    rng = np.random.default_rng(seed)
    neighbours: list[set[int]] = [{k ^ 1} for k in range(2 * n)]
    for i, j in rng.integers(0, 2 * n, (2 * n, 2)):
        if i != j and max(len(neighbours[i]), len(neighbours[j])) < 3:
            neighbours[i].add(int(j))
            neighbours[j].add(int(i))
    shuffled = [list(rng.permutation(sorted(each)).tolist()) for each in neighbours]
    partner = match(shuffled, [1] * (2 * n))
    assert CUT not in partner
    assert all(partner[partner[k]] == k and partner[k] in neighbours[k] for k in range(2 * n))


# ---- what makes no mesh


@pytest.mark.parametrize(
    ("corners", "edge", "says"),
    [
        (SQUARE, 0.0, "must be positive"),
        (SQUARE, -1.0, "must be positive"),
        (SQUARE, float("nan"), "must be positive"),
        (SQUARE, 1e-6, "in number"),
        (SQUARE[:2], 0.1, "three corners"),
        (SQUARE[::-1], 0.1, "clockwise"),
        ([(0, 0), (0, 3), (3, 3), (3, 0), (-1, 1)], 0.1, "crosses itself"),
        ([(0, 0), (1, 1), (1, 2), (1, 1), (2, 0)], 0.1, "crosses itself"),
    ],
)
def test_what_makes_no_mesh(corners: Any, edge: float, says: str) -> None:
    with pytest.raises(UdecError, match=says) as caught:
        mesh(corners, edge)
    assert caught.value.number == 28


def test_zones_smaller_than_the_digits_of_their_coordinates() -> None:
    far = np.array(SQUARE) + 1e5  # where 32-bit reals are 1/128 apart
    assert mesh(far, 0.01).angles.min() > 15
    with pytest.raises(UdecError, match="precision of their coordinates") as caught:
        mesh(far, 0.01, real=np.float32)
    assert caught.value.number == 28


def test_without_the_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pythoncdt", None)
    with pytest.raises(UdecError, match="pythoncdt") as caught:
        triangulate(np.array(SQUARE), 4)
    assert caught.value.number == 23
    assert "pip install" in caught.value.advice
