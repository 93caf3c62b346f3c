"""Ranges in words: which blocks, edges, grid-points and contacts they select, by shapely and by hand."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from support.random_cuts import polygons

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g
from udec_ia.ops.common.block_ranges import blocks_in, edges_in, points_in
from udec_ia.reader.group_ranges import read_range


@pytest.fixture(scope="module")
def wall() -> Model:
    """A square of 10 by 10 blocks, the upper half of material 2; two joints; some blocks with zones."""
    m = Model()
    for n in (1, 2):
        m.property(n, density=2000, kn=1e8, ks=1e8, bulk=1e9, g=1e9)
        m.jproperty(n, kn=1e9, ks=1e9)
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    for k in range(1, 10):
        joint = {4: {"joint": 7, "jmaterial": 2}}.get(k, {})
        m.split(-1, k, 11, k, **joint)
        m.split(k, -1, k, 11)
    m.change(0, 10, 5, 10, material=2)
    m.change(0, 2, 0, 1, type="fdef")
    m.generate(0, 2, 0, 1, "automatic", edge=0.5)
    return m


def selected(m: Model, text: str) -> set[tuple[float, float]]:
    """Centroids of the blocks in a range."""
    rows = {int(one["address"]): one for one in m.table("block")}
    found = [rows[ib] for ib in blocks_in(m.array, read_range(text))]
    return {(round(float(one["KX"]), 6), round(float(one["KY"]), 6)) for one in found}


ALL = {(i + 0.5, j + 0.5) for i in range(10) for j in range(10)}
SHAPES = [
    ("0 5 0 5", shapely.box(0, 0, 5, 5)),
    ("CIRCLE 5 5 3", shapely.Point(5, 5).buffer(3, quad_segs=4000)),
    ("circle (5,5) 3", shapely.Point(5, 5).buffer(3, quad_segs=4000)),
    ("ANNULUS 5 5 2 4", shapely.Point(5, 5).buffer(4, 4000) - shapely.Point(5, 5).buffer(2, 4000)),
    ("POLYGON 1 1 9 2 5 9.2 3.9 4.3", shapely.Polygon([(1, 1), (9, 2), (5, 9.2), (3.9, 4.3)])),
    ("ABOVE 0 2 10 7", shapely.Polygon([(0, 2), (10, 7), (10, 20), (0, 20)])),
    ("ABOVE 10 7 0 2", shapely.Polygon([(0, 2), (10, 7), (10, 20), (0, 20)])),
    ("BELOW 0 2 10 7", shapely.Polygon([(0, 2), (10, 7), (10, -20), (0, -20)])),
    ("NOT CIRCLE 5 5 3", shapely.box(0, 0, 10, 10) - shapely.Point(5, 5).buffer(3, 4000)),
    ("0 5 0 5 CIRCLE 5 5 3", shapely.box(0, 0, 5, 5) & shapely.Point(5, 5).buffer(3, 4000)),
]


@pytest.mark.parametrize(("text", "shape"), SHAPES, ids=[text for text, _ in SHAPES])
def test_shapes(wall: Model, text: str, shape: Any) -> None:
    assert selected(wall, text) == {place for place in ALL if shape.contains(shapely.Point(place))}


def test_other_parts(wall: Model) -> None:
    assert selected(wall, "ALL") == ALL
    assert selected(wall, "MATERIAL 2") == {place for place in ALL if place[1] > 5}
    assert selected(wall, "NOT MATERIAL 2 BELOW 0 1 10 1") == {place for place in ALL if place[1] < 1}
    assert selected(wall, "JOINT 7") == {place for place in ALL if 3 < place[1] < 5}
    assert selected(wall, "JMATERIAL=2") == {place for place in ALL if 3 < place[1] < 5}
    assert selected(wall, "WHERE KX > 8 and KMAT == 1") == {(x, y) for x, y in ALL if x > 8 and y < 5}
    assert selected(wall, "AREA < 0.5") == set()
    assert selected(wall, "AREA 1.5") == ALL


def test_areas_are_those_of_the_polygons() -> None:
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    m.voronoi(1.0)
    areas = sorted(one.area for one in polygons(m))
    limit = (areas[5] + areas[6]) / 2
    assert len(blocks_in(m.array, read_range(f"AREA < {limit!r}"))) == 6
    assert m.delete(f"AREA < {limit!r}") == 6
    assert min(one.area for one in polygons(m)) > limit


def test_edges_and_grid_points(wall: Model) -> None:
    """Edges count with both ends, grid-points with their own place."""
    h = wall.h
    circle = shapely.Point(5, 5).buffer(3, 4000)
    corners = {int(one["address"]): (float(one["KXP"]), float(one["KYP"])) for one in wall.table("corner")}
    back = {int(one["address"]): int(one["KR"]) for one in wall.table("corner")}
    inside = {ip for ip, place in corners.items() if circle.contains(shapely.Point(place))}
    wanted = {ip for ip in inside if back[ip] in inside}
    assert {int(ip) for _, ip in edges_in(wall.array, read_range("CIRCLE 5 5 3"))} == wanted
    points = wall.table("gridpoint")
    near = points["address"][np.hypot(points["KXG"], points["KYG"]) < 1.1]
    found = points_in(wall.array, read_range("CIRCLE 0 0 1.1"))
    assert {int(ig) for _, ig in found} - {0} == {*near.tolist()}
    assert len(found) == len(near)
    assert len(points_in(wall.array, read_range("MATERIAL 2"))) == 50
    assert h.ci[g.NBLK] == 100


def test_commands_take_ranges_in_words(tmp_path: Path) -> None:
    """As limits, in front and behind RANGE; the deck of the session says the same."""
    m = Model(out=tmp_path)
    text = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E9 G=1E9
PROP MAT=3 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E9 G=1E9
JPROPERTY JMATERIAL=2 KN=1E9 KS=1E9
BLOCK 0,0 0,10 10,10 10,0
SPLIT -1,5 11,5
SPLIT 5,-1 5,11
FIX BELOW 0 5 10 5
FREE RANGE ALL
FIX WHERE KY < 5  ; the lower half
CHANGE CIRCLE (2.5,7.5) 1 MATERIAL=3
CHANGE MATERIAL=1 RANGE MATERIAL=3
CHANGE JMATERIAL=2 RANGE ABOVE 0 1 10 1
CHANGE ALL SDEF
INSITU CIRCLE 2.5 2.5 1 -1E6 0 -2E6
BOUNDARY YVEL=0 RANGE POLYGON 0,0 10,0 10,5 0,5
BOUNDARY 0 10 7 8 XFORCE=5
DELETE RANGE 5 10 5 10 NOT MATERIAL 3
"""
    out = io.StringIO()
    m.run(text, out)
    shown = out.getvalue()
    for line in (
        "2 blocks fixed",
        "4 blocks set free",
        "1 block changed",
        "7 contacts changed",
        "1 block stressed",
    ):
        assert line in shown, line
    again = Model()
    again.run(m.deck(), io.StringIO())
    assert np.array_equal(again.h.ia, m.h.ia)


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("DELETE", 7),
        ("FIX ROUND 1", 10),
        ("FIX CIRCLE 1 2", 10),
        ("FIX CIRCLE 1 2 3 4", 10),
        ("FIX POLYGON 1 2 3 4", 10),
        ("FIX NOT", 10),
        ("FIX WHERE KXX > 1", 10),
        ("FIX WHERE", 10),
        ("FIX 0 1 0 1 RANGE ALL", 10),
        ("CHANGE MATERIAL=1", 7),
        ("DELETE AREA < x", 10),
    ],
)
def test_wrong_ranges_are_answered(tmp_path: Path, line: str, error: int) -> None:
    m = Model(out=tmp_path)
    with pytest.raises(UdecError) as caught:
        m.run(f"START\nPROP MAT=1 DENS=1 KN=1 KS=1\nBLOCK 0,0 0,1 1,1 1,0\n{line}\n", io.StringIO())
    assert caught.value.number == error


def test_outside_is_the_outline_of_all_blocks(wall: Model) -> None:
    rim = {(x, y) for x, y in ALL if min(x, y) < 1 or max(x, y) > 9}
    assert selected(wall, "OUTSIDE") == rim
    assert selected(wall, "NOT OUTSIDE") == ALL - rim
    edges = edges_in(wall.array, read_range("OUTSIDE"))
    assert len(edges) == 40 + 3  # zones divide edges of two blocks in two
    ends = {int(one["address"]): one for one in wall.table("corner")}
    for _, ip in edges.tolist():
        x, y = float(ends[ip]["KXP"]), float(ends[ip]["KYP"])
        assert x in (0, 10) or y in (0, 10)
    assert len(edges_in(wall.array, read_range("OUTSIDE BELOW 0 0.4 10 0.4"))) == 10 + 2
    grid = {int(one["address"]): one for one in wall.table("gridpoint")}
    points = [grid[ig] for _, ig in points_in(wall.array, read_range("OUTSIDE")).tolist() if ig]
    places = {(round(float(one["KXG"]), 6), round(float(one["KYG"]), 6)) for one in points}
    assert places == {(x / 2, 0.0) for x in range(5)} | {(0.0, 0.5), (0.0, 1.0)}


def test_a_single_block_is_outside() -> None:
    m = Model()
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    assert len(edges_in(m.array, read_range("OUTSIDE"))) == 4


@pytest.mark.parametrize("words", ["JOINT 5", "NOT JOINT 6", "JMATERIAL 1"])
def test_a_joint_selects_its_own_contacts(words: str) -> None:
    """CHANGE JMATERIAL: two joints that cross, of which one is changed."""
    m = Model()
    for n in (1, 2, 3):
        m.jproperty(n, kn=1e9, ks=1e9)
    m.block(0, 0, 0, 40, 60, 40, 60, 0)
    m.split(-1, 20, 61, 20, joint=5, jmaterial=1)
    m.split(30, -1, 30, 41, joint=6, jmaterial=2)
    m.change(words, jmaterial=3)
    contacts = m.table("contact")
    materials = m.table("joint")["KCJMAT"]
    on = np.abs(contacts["KYC"] - 20) < 1e-6
    assert (materials[on] == 3).all()
    assert (materials[~on] == 2).all()


@pytest.mark.parametrize(
    "text", ["CIRCLE 5 5 -1", "ANNULUS 5 5 3 2", "ABOVE 1 0 1 5", "BELOW 2 2 2 2", "OUTSIDE 3"]
)
def test_parts_that_select_nothing_are_refused(text: str) -> None:
    with pytest.raises(UdecError) as error:
        read_range(text)
    assert error.value.number in (10, 28)


def test_a_size_needs_no_blanks(wall: Model) -> None:
    assert selected(wall, "AREA<0.5") == set()
    assert selected(wall, "AREA<1.5") == ALL


@pytest.mark.parametrize(
    ("text", "is_inside"),
    [
        ("NOT RANGE 0 3 0 3", lambda x, y: not (x < 3 and y < 3)),
        (
            "CIRCLE 2.5 2.5 1.1 RANGE 0 3 0 3",
            lambda x, y: np.hypot(x - 2.5, y - 2.5) < 1.1 and x < 3 and y < 3,
        ),
        ("RANGE 0 3 0 3 NOT CIRCLE 0.5 0.5 0.1", lambda x, y: x < 3 and y < 3 and (x, y) != (0.5, 0.5)),
        ("CIRCLE 2.5 2.5 1.1 NOT RANGE 2 3 2 3", lambda x, y: abs(np.hypot(x - 2.5, y - 2.5) - 1) < 0.1),
    ],
)
@pytest.mark.parametrize("in_deck", [False, True])
def test_a_rectangle_is_a_part(
    text: str, is_inside: Callable[[float, float], bool], in_deck: bool, tmp_path: Path
) -> None:
    deck = "START\nPROPERTY MAT=1 DENSITY=1 KN=1 KS=1\nBLOCK 0,0 0,5 5,5 5,0\n"
    deck += "".join(f"SPLIT -1 {k} 6 {k}\nSPLIT {k} -1 {k} 6\n" for k in range(1, 5))
    m = Model(out=tmp_path)
    m.tell = m.inform = lambda _: None
    m.run(deck + f"FIX {text}\n" * in_deck)
    if not in_deck:
        m.fix(text)
    rows = m.table("block")
    assert len(rows) == 25
    for row in rows:
        assert (row["KBFIX"] != 0) == is_inside(round(float(row["KX"]), 6), round(float(row["KY"]), 6))


def test_a_wrong_word_behind_range_is_answered_once(tmp_path: Path) -> None:
    """FIX RANGE is also a line of UDEC 7, which is read in our words: the same line."""
    m = Model(out=tmp_path)
    with pytest.raises(UdecError) as error:
        m.run("START\nBLOCK 0,0 0,5 5,5 5,0\nFIX RANGE FOO 5 5\n")
    assert error.value.number == 10
