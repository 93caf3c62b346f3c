"""Cuts along polylines, arcs and patterns: faces and areas by shapely, what is kept, refused and reported."""

from __future__ import annotations

import io
import json
import logging
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from support.random_cuts import model_of, polygons, random_rock

from udec_ia import Model, UdecError
from udec_ia.kernels.links.longer_groups import edge_at
from udec_ia.layout import offsets as g
from udec_ia.ops.cuts import patterns
from udec_ia.ops.cuts.joint_of_cut import GLUE, GLUE_MATERIAL

AREA = 1e-12  # relative: coordinates of 20 and areas of 50 to 64 bits
BATCH = 50
SQUARE = shapely.box(0, 0, 10, 10)


@pytest.fixture(autouse=True)
def _quiet(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.CRITICAL, "udec_ia")


def square(build: str = "i32r64") -> Model:
    return model_of(SQUARE, build)


def areas(m: Model) -> Any:
    return np.sort([one.area for one in polygons(m)])


def sound(m: Model, whole: float) -> None:
    """Blocks are simple, fill the whole without overlap, and the map is sound."""
    found = polygons(m)
    assert all(one.is_valid for one in found)
    assert sum(one.area for one in found) == pytest.approx(whole, rel=AREA)
    assert shapely.union_all(found, grid_size=1e-9).area == pytest.approx(whole, rel=1e-7)
    assert list(map(str, m.check())) == []


@pytest.mark.parametrize("first", range(0, 100, BATCH))
def test_random_patterns_leave_sound_blocks_that_fill_the_rock(first: int) -> None:
    done: set[str] = set()
    for seed in range(first, first + BATCH):
        m, polygon, names = random_rock(seed)
        sound(m, polygon.area)
        done |= {*names}
    assert done >= {"jset", "traces", "voronoi", "tunnel", "polyline", "arc"}


@pytest.mark.parametrize("build", ["i16r32", "i32r32", "i16r64", "i64r64"])
def test_every_scheme_cuts_the_same(build: str) -> None:
    """To the digits of its reals."""
    found = []
    for scheme in ("i32r64", build):
        m = square(scheme)
        m.jset((35, 3), spacing=(3, 0.5), trace=6, gap=0.5)
        m.tunnel(4.1, 5.2, 1.5, 10)
        assert list(map(str, m.check())) == []
        found.append(areas(m))
    assert found[1] == pytest.approx(found[0], abs=1e-3)


def test_faces_are_those_of_shapely() -> None:
    """Joints through a circle: shapely's own division of the square has the same areas."""
    m = square()
    m.jset(20.0, spacing=1.7, origin=(0.3, 0.2))
    m.tunnel(5.2, 4.9, 2.3, 17)
    lines = patterns.joint_lines(
        patterns.JointSet((20.0, 0.0), (1.7, 0.0), origin=(0.3, 0.2)), np.zeros(2), np.full(2, 10.0), 1
    )
    circle = shapely.LineString(patterns.circle(5.2, 4.9, 2.3, 17))
    noded = shapely.unary_union([SQUARE.exterior, circle, *map(shapely.LineString, lines)])
    faces = [face for face in shapely.get_parts(shapely.polygonize([noded])) if SQUARE.covers(face.centroid)]
    assert areas(m) == pytest.approx(np.sort(shapely.area(faces)), rel=1e-9)


def test_four_cracks_inside_a_block_cut_out_an_opening() -> None:
    """Three are kept, and the last one closes the rectangle: two slits, and two parts around it."""
    m = square()
    for line in ((3, 3, 7, 3), (3, 5, 7, 5), (3, 3, 3, 5)):
        assert m.split(*line) == 0
    assert len(m.table("crack")) == 3
    assert m.split(7, 3, 7, 5) == 2
    assert len(m.table("crack")) == 0
    assert areas(m) == pytest.approx([8.0, 30.0, 62.0])
    assert m.delete(3, 7, 3, 5) == 1
    assert list(map(str, m.check())) == []


def test_a_kept_crack_is_saved_and_cuts_when_a_cut_meets_it(tmp_path: Path) -> None:
    m = square()
    m.split(5, 2, 5, 8, joint=3)
    m.save(tmp_path / "one.h5")
    for model in (m, Model.restore(tmp_path / "one.h5")):
        assert model.split(-1, 1, 11, 1) == 1
        assert len(model.table("crack")) == 1
        assert model.split(-1, 3, 11, 3) == 1
        assert model.split(-1, 7, 11, 7) == 2  # and the part of the crack between the two lines
        assert areas(model) == pytest.approx([10.0, 20.0, 20.0, 20.0, 30.0])
        assert 3 in model.table("edge")["KEJ"]
        assert list(map(str, model.check())) == []


def test_a_deck_whose_lines_all_cut_keeps_nothing() -> None:
    m = square()
    m.split(-1, 5, 11, 5)
    m.split(5, 2, 5, 11)  # its lower end lies inside a block, but the upper half is cut
    assert len(m.table("block")) == 3
    assert len(m.table("crack")) == 0


def test_dead_ends_are_dropped_unless_they_are_to_be_kept() -> None:
    m = square()
    assert m.polyline(2, 2, 2, 5, 4, 6) == 0
    assert len(m.table("crack")) == 0
    assert m.polyline(2, 2, 2, 5, 4, 6, keep=True) == 0
    assert len(m.table("crack")) == 2
    assert m.polyline(2, 2, 8, 2, 4, 6) == 2  # closes the loop
    assert len(m.table("crack")) == 0


def test_a_cut_that_turns() -> None:
    m = square()
    assert m.polyline(2, -1, 2, 3, 6, 3, 6, -1) == 1
    assert areas(m) == pytest.approx([12.0, 88.0])
    contacts = m.table("contact")
    assert len(contacts[contacts["KCCOD"] != g.VIRTUAL]) == 6  # two at each turn and at each end
    assert list(map(str, m.check())) == []


def test_a_notch_may_share_its_corners_with_the_block() -> None:
    """From one corner to the next, and from a corner to a place on its own edge."""
    m = square()
    assert m.polyline(0, 0, 4, 4, 10, 0) == 1
    assert areas(m) == pytest.approx([20.0, 80.0])
    assert m.polyline(0, 10, 2, 8, 5, 10) == 1
    assert areas(m) == pytest.approx([5.0, 20.0, 75.0])
    assert list(map(str, m.check())) == []


def test_a_cut_that_ends_at_a_filled_notch_touches_both_edges() -> None:
    """The corner of 90 degrees touches the edge along the cut, beside the tip of the block in the notch."""
    for d in (None, 0.05):
        m = square()
        if d is not None:
            m.round(d)
        m.polyline(5, 0, 2, 3, 9, 1, 6, 0)
        m.polyline(-1, 0, 7, 8)
        assert list(map(str, m.check())) == []


def test_the_outline_of_a_tunnel_is_glued_to_the_next_edges() -> None:
    m = square()
    assert m.tunnel(5, 5, 2, 16) == 2
    assert areas(m) == pytest.approx([8 * 4 * np.sin(np.pi / 8), *[(100 - 32 * np.sin(np.pi / 8)) / 2] * 2])
    edges = m.table("edge")["KEJ"]
    assert (edges == GLUE).sum() == 4  # two slits with two sides
    assert m.h.ci[g.JLINE + GLUE - 1] == GLUE_MATERIAL
    assert list(map(str, m.check())) == []


@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_a_later_cut_along_a_slit_ends_the_glue(build: str) -> None:
    """Where it runs along the whole slit, with the joint that it has, unless it is glued itself."""
    cuts: tuple[tuple[Callable[[Model], object], dict[int, int]], ...] = (
        (lambda m: m.split(-1, 5.3, 11, 5.3, joint=3), {3: 4}),
        (lambda m: m.jset(0, spacing=20, origin=(0, 5.3)), {}),
        (lambda m: m.polyline(0, 5.3, 3, 5.3, joint=7), {GLUE: 2, 7: 2}),
        (lambda m: m.polyline(1, 5.3, 3, 5.3, joint=7), {GLUE: 4}),
        (lambda m: m.polyline(-1, 5.3, 11, 5.3, glued=True), {GLUE: 4}),
        (lambda m: m.split(-1, 5.2, 11, 5.5), {GLUE: 4}),
    )
    for cut, expected in cuts:
        m = square(build)
        m.tunnel(5, 5.3, 2, 16)
        cut(m)
        rows = m.table("corner")
        x, y = ((rows[name] + 0.0) for name in ("KXP", "KYP"))
        before = {int(a): i for i, a in enumerate(rows["address"])}
        edges = dict(zip(m.table("edge")["address"].tolist(), m.table("edge")["KEJ"].tolist(), strict=True))
        found: Counter[int] = Counter()
        for i, row in enumerate(rows):
            j = before[int(row["KR"])]
            flat = abs(y[i] - 5.3) < 1e-4 and abs(y[j] - 5.3) < 1e-4  # noding in 32 bits
            if flat and abs((x[i] + x[j]) / 2 - 5) > 2:
                found[edges[edge_at(m.h, int(row["address"]))]] += 1
        found.pop(0, None)
        assert found == expected
        assert list(map(str, m.check())) == []


def test_glued_cuts_leave_the_rock_as_strong() -> None:
    """A pillar with a glued joint at 45 degrees carries a load at which one without cohesion slides."""
    for glued in (True, False):
        m = model_of(shapely.box(0, 0, 1, 2))
        m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.1)
        m.jproperty(1, kn=1e9, ks=1e9, friction=0.1, between=(1, 1))
        m.split(-1, 0.25, 2, 0.25)
        m.polyline(-1, 0.0, 2, 3.0, glued=glued)
        m.fix(0, 1, 0, 0.25)
        m.round(0.01)
        m.gravity(0, -10)
        m.damping(local=0.8)
        m.cycle(2000)
        top = m.table("block")
        fell = np.abs(top["KXD"]).max() > 1e-3
        assert fell != glued


def test_slivers_are_not_merged_across_glue_and_joints_stay() -> None:
    m = square()
    m.property(1, density=2500, bulk=5e9, g=3e9, kn=1e9, ks=1e9)
    m.jproperty(1, kn=1e9, ks=1e9)
    m.jset(60, spacing=1.5, joint=1, jmaterial=1)
    m.jset(-20, spacing=1.7, joint=2, jmaterial=1)
    m.polyline(3, 3, 7, 3, 7, 7, 3, 7, 3, 3, glued=True)
    blocks = len(polygons(m))
    assert len(m.tidy(0.3).merged) == blocks - len(polygons(m)) > 5
    sound(m, 100.0)
    opening = shapely.box(3, 3, 7, 7)
    for one in polygons(m):
        inside = (one & opening).area
        assert min(inside, one.area - inside) < 1e-9
    ends = {int(row["address"]): (float(row["KXP"]), float(row["KYP"])) for row in m.table("corner")}
    numbers = dict(zip(m.table("edge")["address"].tolist(), m.table("edge")["KEJ"].tolist(), strict=True))
    steep = {1: 60.0, 2: -20.0}
    seen = set()
    for row in m.table("corner"):
        (x, y), (u, v) = ends[int(row["KR"])], ends[int(row["address"])]
        joint = numbers[edge_at(m.h, int(row["address"]))]
        if joint in steep:
            seen.add(joint)
            assert abs(np.sin(np.arctan2(v - y, u - x) - np.radians(steep[joint]))) < 1e-6
        elif joint == 0:
            assert {x, u} <= {0.0} or {x, u} <= {10.0} or {y, v} <= {0.0} or {y, v} <= {10.0}
    assert seen == {1, 2}


def test_numbers_of_joints_that_are_in_use_are_not_taken_for_glue_or_again() -> None:
    m = square()
    m.split(-1, 8, 11, 8, joint=GLUE)
    with pytest.raises(UdecError) as caught:
        m.tunnel(5, 4, 2)
    assert caught.value.number == 4
    m = square()
    m.tunnel(5, 4, 2)
    with pytest.raises(UdecError) as caught:
        m.polyline(-1, 8, 11, 8, joint=GLUE)
    assert caught.value.number == 4
    m = square()
    m.jproperty(2, kn=1e9, ks=1e9)
    m.polyline(2, 2, 4, 3, joint=1, keep=True)
    m.polyline(-1, 5, 11, 6, jmaterial=2)
    assert m.h.ci[g.JLINE : g.JLINE + 2].tolist() == [0, 2]


def test_joints_of_cuts() -> None:
    """A joint material takes a free number of a joint, and bricks two."""
    m = square()
    for n in (1, 2, 3):
        m.jproperty(n, kn=1e9, ks=1e9, friction=0.1 * n)
    m.split(-1, 5, 11, 5, joint=1)
    m.polyline(-1, 2, 11, 2.5, jmaterial=2)
    assert m.h.ci[g.JLINE : g.JLINE + 3].tolist() == [0, 2, 0]
    m.bricks(0, 10, 5, 10, length=2, height=1, bed=1, head=3)
    assert m.h.ci[g.JLINE : g.JLINE + 4].tolist() == [0, 2, 1, 3]
    joints = m.table("joint")
    assert {1, 2, 3} <= {*joints["KCJMAT"].tolist()}
    assert list(map(str, m.check())) == []


def test_bricks_are_counted_and_have_their_size() -> None:
    m = square()
    m.bricks(0, 10, 0, 10, length=2, height=1)
    found = areas(m)
    assert len(found) == 5 * 5 + 5 * 6
    assert found == pytest.approx([1.0] * 10 + [2.0] * 45)


def test_an_arch_of_voussoirs() -> None:
    """A semicircle: stones of one size, and their inner corners on a circle."""
    m = square()
    m.voussoirs(3, 7, 2, 9, rise=2, thickness=1)
    found = polygons(m)
    stone = (9 - 4) / 2 * np.sin(np.pi / 9)
    stones = [one for one in found if one.area == pytest.approx(stone, rel=1e-9)]
    assert len(stones) == 9
    for one in stones:
        radius = np.hypot(*(shapely.get_coordinates(one) - [5, 2]).T)
        assert np.isclose(radius, 2).sum() + np.isclose(radius, 3).sum() == len(radius)
    again = square()
    again.voussoirs(3, 7, 2, 9, radius=2, thickness=1)
    assert areas(again) == pytest.approx(areas(m))


def test_voronoi_cells_have_about_the_edges_asked_for() -> None:
    """Cells inside have edges of 0.8 to 1.2 of the length on average, and none below a seventh."""
    m = square()
    m.voronoi(0.8, seed=4)
    inside = [one for one in polygons(m) if one.within(shapely.box(0.1, 0.1, 9.9, 9.9))]
    lengths = np.concatenate([np.hypot(*np.diff(shapely.get_coordinates(one), axis=0).T) for one in inside])
    assert lengths.mean() == pytest.approx(0.8, rel=0.2)
    assert lengths.min() > 0.1 * 0.8
    assert len(inside) > 30


def test_patterns_are_repeated_by_their_seed() -> None:
    one, two, other = square(), square(), square()
    for m, seed in ((one, 5), (two, 5), (other, 6)):
        m.jset((30, 5), spacing=(1, 0.3), trace=(4, 1), gap=(0.5, 0.2), seed=seed)
        m.voronoi(1.0, seed=seed, within=(2, 6, 2, 6))
    assert np.array_equal(one.h.ia, two.h.ia)
    assert len(areas(other)) != len(areas(one)) or not np.allclose(areas(one), areas(other))


def test_deviations_are_even_within_their_limits() -> None:
    joints = patterns.JointSet((40.0, 3.0), (1.0, 0.5))
    lines = patterns.joint_lines(joints, np.zeros(2), np.full(2, 2000.0), 1)
    to = np.array([line[1] - line[0] for line in lines])
    angles = np.degrees(np.arctan2(to[:, 1], to[:, 0]))
    assert angles.min() == pytest.approx(37, abs=0.1)
    assert angles.max() == pytest.approx(43, abs=0.1)
    across = np.array([-np.sin(np.radians(40)), np.cos(np.radians(40))])
    spacing = np.diff(np.sort([line.mean(axis=0) @ across for line in lines]))
    assert spacing.mean() == pytest.approx(1.0, abs=4 * 0.5 / np.sqrt(3 * len(lines)))
    assert spacing.min() >= 0.5
    assert spacing.max() <= 1.5


def test_traces_and_gaps() -> None:
    joints = patterns.JointSet((0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (1.0, 0.0), (0.5, 0.0))
    lines = patterns.joint_lines(joints, np.array([0.0, -0.5]), np.array([10.0, 0.5]), 1)
    ends = np.sort([line[:, 0] for line in lines], axis=0)
    assert ends.tolist() == [[0.5, 3.5], [4.5, 7.5], [8.5, 11.5]]


def test_sharp_and_short_cuts_are_refused_or_left_out() -> None:
    """With their place; a single cut changes nothing, and of a pattern the others are made."""
    m = square()
    m.split(-1, 5, 11, 5)
    before = m.h.ia.copy()
    with pytest.raises(UdecError) as caught:
        m.polyline(-1, 4.99, 11, 5.01)
    assert caught.value.number == 27
    assert np.array_equal(m.h.ia[: len(before)], before)
    told: list[Any] = []
    m.tell = told.append
    m.jset(0.05, spacing=1.0, origin=(5, 5))
    assert [one.key for one in told] == ["cuts-left-out"]
    assert len(m.table("block")) == 10


def test_fractures_from_files(tmp_path: Path) -> None:
    """The same lines as CSV and as GeoJSON."""
    lines = [[(-1, 3), (11, 4)], [(4, -1), (5, 11)], [(2, 7), (3, 8)]]
    table = tmp_path / "lines.csv"
    rows = [f"{a[0]},{a[1]},{b[0]},{b[1]},{k + 1}" for k, (a, b) in enumerate(lines)]
    table.write_text("\n".join(["X1, Y1, X2, Y2, Joint", *rows, ""]))
    features = [
        {
            "type": "Feature",
            "properties": {"joint": float(k + 1)},  # as exports have it
            "geometry": {"type": "LineString", "coordinates": line},
        }
        for k, line in enumerate(lines)
    ]
    shapes = tmp_path / "lines.geojson"
    shapes.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    found = []
    for path in (table, shapes):
        m = square()
        assert m.fractures(path) == 3
        assert {*m.table("edge")["KEJ"].tolist()} == {0, 1, 2}
        found.append(areas(m))
    assert np.array_equal(*found)


@pytest.mark.parametrize(
    ("name", "text", "where"),
    [
        ("a.csv", "x,y\n1,2\n", "line 1"),
        ("a.csv", "", "line 1"),
        ("a.csv", "x1,y1,x2,y2\n0,0,1,1\n0,0,one,1\n", "line 3"),
        ("a.csv", "x1,y1,x2,y2\n0,0,0,0\n", "line 2"),
        ("a.csv", "x1,y1,x2,y2\n0,0,nan,0\n", "line 2"),
        ("a.geojson", "{", "GeoJSON"),
        ("a.geojson", '{"type": "Polygon", "coordinates": 5}', "feature 1"),
        (
            "a.geojson",
            '{"properties": {"joint": 1.5}, "type": "LineString", "coordinates": [[0, 0], [1, 1]]}',
            "feature 1",
        ),
        ("a.geojson", '{"features": [3]}', "feature 1"),
        ("a.json", '{"type": "LineString", "coordinates": [[0, 0], ["a", 1]]}', "feature 1"),
    ],
)
def test_damaged_files_of_fractures(tmp_path: Path, name: str, text: str, where: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(UdecError, match=where) as caught:
        square().fractures(tmp_path / name)
    assert caught.value.number == 28


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.csv", "x1,y1,x2,y2,joint\n-1,5,11,5,999\n"),
        ("a.csv", "x1,y1,x2,y2,joint\n-1,5,11,5,200\n"),
        ("a.csv", "x1,y1,x2,y2,joint\n-1,5,11,5,-5\n"),
        (
            "a.json",
            '{"type": "Feature", "properties": {"joint": 3000000000}, "geometry": '
            '{"type": "LineString", "coordinates": [[-1, 5], [11, 5]]}}',
        ),
    ],
)
def test_files_with_numbers_that_no_joint_has(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    m = square()
    with pytest.raises(UdecError) as caught:
        m.fractures(tmp_path / name)
    assert caught.value.number == 4
    assert len(m.table("block")) == 1


def test_fractures_of_two_files_meet(tmp_path: Path) -> None:
    """Ends of the first are kept."""
    (tmp_path / "a.csv").write_text("x1,y1,x2,y2,joint\n3,-1,3,5,4\n7,-1,7,5,\n")
    (tmp_path / "b.json").write_text(
        '{"features": [{"geometry": {"type": "Point", "coordinates": [1, 2]}}, {"geometry": {"type": '
        '"GeometryCollection", "geometries": [{"type": "LineString", "coordinates": [[2, 4], [8, 4]]}]}}]}'
    )
    m = square()
    assert m.fractures(tmp_path / "a.csv", keep=True) == 0
    assert m.deck().splitlines()[-1] == f"FRACTURES {tmp_path / 'a.csv'} KEEP"
    assert m.fractures(tmp_path / "b.json") == 1
    assert areas(m) == pytest.approx([16, 84])


def test_a_network_of_kept_cracks_is_that_of_all_its_lines_at_once() -> None:
    """Segments that come one by one enclose the faces that shapely finds, and more only by slits."""
    rng = np.random.default_rng(3)
    for _ in range(4):
        m = square()
        lines = []
        for _ in range(25):
            middle, angle, half = rng.uniform(0, 10, 2), rng.uniform(0, np.pi), rng.uniform(1, 3)
            to = half * np.array([np.cos(angle), np.sin(angle)])
            m.polyline(*(middle - to).tolist(), *(middle + to).tolist(), keep=True)
            lines.append(shapely.LineString([middle - to, middle + to]))
        box = shapely.box(0, 0, 10, 10)
        faces = shapely.get_parts(shapely.polygonize([shapely.union_all([box.exterior, *lines])]))
        blocks = polygons(m)
        for face in faces[shapely.within(faces, box.buffer(1e-9))]:
            inside = [one for one in blocks if face.buffer(1e-6).contains(one)]
            assert sum(one.area for one in inside) == pytest.approx(face.area, rel=1e-6)
        sound(m, 100.0)


def test_traces_of_two_sets_that_are_kept_enclose_squares() -> None:
    m = Model()
    m.property(1, density=2500, kn=1e9, ks=1e9)
    m.block(0, 0, 0, 40, 60, 40, 60, 0)
    m.jset(90, spacing=3, trace=4, gap=1, keep=True)
    m.jset(0, spacing=3, trace=4, gap=1, keep=True)
    assert (np.abs(areas(m) - 9.0) < 1e-6).sum() > 40


def test_a_line_along_an_edge_may_be_crossed_by_one_that_ends_beyond() -> None:
    m = square()
    assert m.bricks(-1, 13, 0, 2, length=1, height=1) == 21
    assert areas(m)[2:21] == pytest.approx(1.0)


def test_patterns_leave_out_what_the_rounding_refuses() -> None:
    m = square()
    m.round(0.2)
    assert m.voronoi(1.2) > 5
    sound(m, 100.0)
    for one in polygons(m):
        corners = shapely.get_coordinates(one)
        assert np.hypot(*np.diff(corners, axis=0).T).min() >= 0.4 * (1 - 1e-9)


@pytest.mark.parametrize(
    ("command", "error"),
    [
        ("TUNNEL 5 5 0", 28),
        ("TUNNEL 5 5 2 2", 28),
        ("ARC 5 5 5 5 90 8", 28),
        ("ARC 5 5 6 5 400 8", 28),
        ("JSET ANGLE 0", 7),
        ("JSET ANGLE 0 SPACING 0", 28),
        ("JSET ANGLE 0 SPACING 1E-9", 28),
        ("JSET ANGLE 0 SPACING 1 GAP 1", 7),
        ("JSET ANGLE 0 SPACING 1 RANGE 3 2 0 1", 28),
        ("VORONOI EDGE 0", 28),
        ("VORONOI EDGE 1E-6", 28),
        ("BRICKS 0 10 0 10 LENGTH=1", 7),
        ("VOUSSOIRS 3 7 2 9 THICKNESS=1", 7),
        ("VOUSSOIRS 3 7 2 9 RISE=3 THICKNESS=1", 28),
        ("POLYLINE 1,1", 8),
        ("POLYLINE GLUED JOINT=1 0,0 1,1", 10),
        ("POLYLINE JMATERIAL=3 -1,1 11,1", 4),
        ("FRACTURES", 7),
        ("FRACTURES none.csv", 29),
        ("JSET ANGLE 30 SPACING 2 SEED -1", 28),
        ("JSET ANGLE 30 SPACING 1 2", 28),
        ("JSET ANGLE 30 SPACING 2 TRACE 1 5", 28),
    ],
)
def test_wrong_input_is_answered(tmp_path: Path, command: str, error: int) -> None:
    m = square()
    m.out = tmp_path
    with pytest.raises(UdecError) as caught:
        m.run(f"{command}\n", io.StringIO())
    assert caught.value.number == error
    assert len(m.table("block")) == 1
