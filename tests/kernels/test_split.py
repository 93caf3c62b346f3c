"""SPLIT along the edges of concave blocks: exactly along the floor of a notch, on and on, from both sides."""

from __future__ import annotations

import subprocess
import sys
from math import hypot

import pytest
from naive.geometry import Outline, Point, centroid
from naive.geometry import split as naive_split
from support.mechanics_scenes import sound

from udec_ia import Model

U = [(0, 0), (0, 3), (1, 3), (1, 1), (2, 1), (2, 3), (3, 3), (3, 0)]
T = [(1, 0), (1, 2), (0, 2), (0, 3), (3, 3), (3, 2), (2, 2), (2, 0)]
L = [(0, 0), (0, 3), (1, 3), (1, 1), (3, 1), (3, 0)]
Z = [(0, 0), (0, 2), (1, 2), (1, 3), (3, 3), (3, 1), (2, 1), (2, 0)]
H = [(0, 0), (0, 3), (1, 3), (1, 2), (2, 2), (2, 3), (3, 3), (3, 0), (2, 0), (2, 1), (1, 1), (1, 0)]
CUTS = [
    ("the floor of a U", U, (-1, 1), (4, 1), 2),
    ("from end to end of that floor and no farther", U, (1, 1), (2, 1), 0),
    ("one side of that floor", U, (-1, 1), (1.5, 1), 1),
    ("a wall of a U", U, (1, -1), (1, 4), 1),
    ("under the arms of a T", T, (-1, 2), (4, 2), 1),
    ("the step of an L", L, (-1, 1), (4, 1), 1),
    ("that step, up to its corner", L, (1, 1), (0, 1), 1),
    ("two steps one after the other", Z, (1, -1), (1, 4), 1),
    ("two notches that share a line", H, (1, -1), (1, 4), 1),
    ("the ceiling of the lower notch of an H", H, (-1, 1), (4, 1), 2),
]


DIGITS = 3 * 8 * 2.0**-23  # of centroids of blocks 3 across: some last digits of 32-bit reals


def turned(point: Point, times: int) -> Point:
    x, y = point
    for _ in range(times):
        x, y = -y, x
    return x, y


def in_order(points: list[Point]) -> list[Point]:
    return sorted(points, key=lambda point: (round(point[0], 3), round(point[1], 3)))


@pytest.mark.parametrize("build", ["i32r64", "i16r32"])
@pytest.mark.parametrize("times", range(4))
@pytest.mark.parametrize(("where", "outline", "start", "end", "cuts"), CUTS, ids=[cut[0] for cut in CUTS])
def test_along_an_edge(
    build: str, times: int, where: str, outline: Outline, start: Point, end: Point, cuts: int
) -> None:
    """The blocks are those that a library of polygons cuts out, whichever way the line runs."""
    corners = [turned(point, times) for point in outline]
    one, two = turned(start, times), turned(end, times)
    wanted = in_order([centroid(part) for part in naive_split(corners, one, two)])
    for line in ((*one, *two), (*two, *one)):
        model = Model(build=build)
        model.block(*(number for point in corners for number in point))
        assert model.split(*line) == cuts, where
        found = in_order([(float(row["KX"]), float(row["KY"])) for row in model.table("block")])
        for here, there in zip(found, wanted, strict=True):
            assert here == pytest.approx(there, abs=DIGITS)
        assert model.check() == []


@pytest.mark.parametrize("teeth", [33, 100])
def test_a_line_through_all_teeth_of_a_comb(teeth: int) -> None:
    """A block has as many crossings as it has, and is cut at each pair of them."""
    outline: list[Point] = [(0, 0)]
    for k in range(teeth):
        outline += [(2 * k, 3), (2 * k + 1, 3), (2 * k + 1, 1), (2 * k + 2, 1)]
    model = Model()
    model.block(*(number for point in [*outline, (2 * teeth, 0)] for number in point))
    assert model.split(-1, 2, 2 * teeth + 1, 2) == teeth
    tips = model.table("block")
    assert sorted(float(tip["KX"]) for tip in tips if tip["KY"] > 2) == [2 * k + 0.5 for k in range(teeth)]
    sound(model)


def test_neighbours_agree_whether_a_line_goes_through_their_corner() -> None:
    """Far from the origin of 32-bit reals, where a corner is 110 last digits from the line: on it, for all.

    If one of its blocks saw it beside the line, an edge of these 110 digits would be left.
    """
    m = Model(build="i32r32")
    m.block(-5, 100, -5, 106, 3, 106, 3, 100)
    for line in (
        (12.725288765601249, 103.18117306386678, -12.317607059713801, 100.13861561671055),
        (2.1661295806292014, 90.027018088278552, 2.1661295806292014, 111.02701808827855),
        (8.3725118246375541, 92.159029425755662, -7.2063822355567435, 111.84097057424434),
        (-0.20779716683294414, 92.804297808143048, -0.20779716683294414, 113.80429780814305),
        (-3.5, 101, 6.9663181702823671, 109.96985583676484),
        (-15, 103, 13, 103),
    ):
        m.split(*line)
    sound(m)
    corners = m.table("corner")
    before = dict(zip(corners["address"].tolist(), corners, strict=True))
    for end in corners:
        start = before[int(end["KR"])]
        assert hypot(float(end["KXP"] - start["KXP"]), float(end["KYP"] - start["KYP"])) > 0.1


# Two blocks have been deleted, what is left of the wall has drifted, and one block hangs beside the one that
# is cut. The digits count.
HANGING = """
from udec_ia.layout.offsets import NVIRT
from udec_ia import Model
m = Model("i16r32")
m.property(1, density=2000.0, kn=491915782.7896072, ks=491915782.7896072, friction=0.0)
m.block(-0.8407140858875568, 0.8624143440201957, -7.455569719884591, -1.7773446160445632,
        -11.594716449207512, 8.594760745321626, -4.979860815210477, 11.234519705386383)
m.split(9.474929731751613, 15.316439443264638, -17.009109822365716, -14.660145567305673)
m.split(4.564039308449089, 24.568807397148287, -11.669507038251664, -11.98898210125435)
m.split(6.225720553482501, -15.677360700504071, -9.939530476238028, 20.910679136936242)
m.split(0.346712357211592, 28.064776676480236, -13.346427063554732, -9.518436767868224)
m.round(0.021446461627985875)
m.fix(-8.867829751064301, -8.850584555576324, 7.224007178256988, 7.241252373744965)
m.gravity(-0.005402126099415442, -7.409758352957441e-06)
m.damping(0.3360117727876062, 3.313377797975771, "mass")
m.cycle(0)
m.delete(-4.3904, -4.3805, 8.9996, 9.0094)
m.cycle(355)
m.property(1, friction=0.46526862201502994)
m.cycle(439)
m.delete(-4.1999, -4.1838, 2.0550, 2.0711)
m.cycle(754)
m.boundary(-2.5028, -2.4955, 0.88386, 0.89105, xvel=0.42255594848208217, yvel=0.0884907033695499)
m.cycle(378)
assert m.h.ci[NVIRT] == 1
assert m.split(-5.976388531794649, 0.23104924243382285, 1.0701375781203333, 1.5631521316201322) == 2
assert m.check() == []
m.cycle(100)
assert m.check() == []
"""


def test_an_update_after_a_cut_may_hang_blocks_elsewhere() -> None:
    """It went on for ever along the list of the block on which it had found the virtual contact."""
    subprocess.run([sys.executable, "-W", "ignore", "-c", HANGING], check=True, timeout=300)
