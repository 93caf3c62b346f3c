"""GEOMETRY: shortest edges, smallest blocks and sharpest angles, by shapely."""

from __future__ import annotations

import io

import numpy as np
import pytest
import shapely
from support.random_cuts import cut_somehow, model_of, polygons, random_block

from udec_ia import Model, UdecError


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
