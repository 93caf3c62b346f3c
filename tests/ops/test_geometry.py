"""GEOMETRY: shortest edges, smallest blocks and sharpest angles, by shapely."""

from __future__ import annotations

import io

import numpy as np
import pytest
import shapely
from support.random_cuts import cut_somehow, model_of, polygons, random_block

from udec_ia import Model, UdecError
from udec_ia.remark import Remark


@pytest.mark.parametrize("seed", range(6))
def test_the_worst_shapes_are_those_of_shapely(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rock = random_block(rng)
    m = model_of(rock)
    m.tell = lambda _: None
    for _ in range(3):
        try:
            cut_somehow(m, rng, rock)
        except UdecError:
            continue
    found, lengths, angles = m.geometry(), [], []
    for one in polygons(m):
        ring = shapely.get_coordinates(shapely.orient_polygons(one).exterior)[:-1]
        along = np.roll(ring, -1, axis=0) - ring
        lengths += np.hypot(*along.T).tolist()
        before = np.roll(along, 1, axis=0)
        turn = np.arctan2(
            before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0], (before * along).sum(axis=1)
        )
        angles += (180 - np.degrees(turn)).tolist()
    areas = sorted(one.area for one in polygons(m))
    for shapes, expected in ((found.edges, lengths), (found.areas, areas), (found.angles, angles)):
        values = [one.value for one in shapes]
        assert values == pytest.approx(sorted(expected)[: len(values)], rel=1e-6, abs=1e-6)
    assert found.median_area == pytest.approx(float(np.median(areas)))
    smallest = min(polygons(m), key=lambda one: one.area)
    assert (found.areas[0].x, found.areas[0].y) == pytest.approx(smallest.centroid.coords[0], abs=1e-6)


def test_the_command_and_the_line_before_the_first_cycle() -> None:
    m = Model()
    with pytest.raises(UdecError) as error:
        m.geometry()
    assert error.value.number == 26
    out = io.StringIO()
    m.run(
        "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\nBLOCK 0,0 0,2 4,2 4,0\nSPLIT -1 0.5 5 0.5\n"
        "SPLIT 3 -1 3 1\nGEOMETRY\nFIX ALL\nCYCLE 1\nCYCLE 1\n",
        out,
    )
    text = out.getvalue()
    assert text.count("shortest edge 0.5 m at") == 1
    assert "smallest block 0.5 m2 at (3.5, 0.25)" in text
    assert str(m.geometry()) in text


def test_a_cut_reports_an_edge_that_keeps_the_rounding_length_small() -> None:
    m, told = Model(), list[Remark]()
    m.tell = lambda text: told.append(text)  # type: ignore[arg-type]
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    m.split(5, -1, 5, 11)
    assert told == []
    m.split(5.1, -1, 5.1, 11)  # of the edges on the left and on the right three quarters are far longer
    assert [one.key for one in told] == ["short-edge"]
    m.split(-1, 5, 11, 5)  # leaves no shorter one
    assert len(told) == 1
    m.polyline(8, -1, 8, 3, 8.01, 3, 8.01, -1)
    assert [one.key for one in told] == ["short-edge", "short-edge"]
    with pytest.raises(UdecError) as caught:
        m.round(0.0051)  # half of the shortest edge is 0.005
    assert caught.value.number == 14
    m.round(0.0049)
    with pytest.raises(UdecError) as caught:
        m.split(2, -1, 2.0, 11) and m.split(2.009, -1, 2.009, 11)
    assert caught.value.number == 14
