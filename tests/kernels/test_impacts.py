"""No two bodies overlap by more than the limit without a contact or error 15, whatever drives them.

Decks in which blocks went through others or stopped at nothing, and some impacts of the search
(tools/robustness.py impacts).
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from support.random_impacts import SHAPES
from support.watched_model import Over, WatchedModel
from trials import impact_search

from udec_ia import Model, UdecError
from udec_ia.compiling.compile_duration import compile_seconds
from udec_ia.heap.accessors import putr
from udec_ia.kernels.geometry.contact_geometry import faces
from udec_ia.layout.offsets import DTOL, FIXED, KYD, TDEL

BATCH = 6
SEED = 1

START = """
START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5
BLOCK 0,0 0,4 4,4 4,0
SPLIT -1,-1 5,5
FIX 2,4 0,2
ROUND 0.1
CYCLE 0
"""
CONSTANT_SPEED = """
BOUNDARY 0,2 2,4 XVEL=-0.302 YVEL=0.302
CYCLE 100
BOUNDARY 0,2 2,4 XVEL=1.146 YVEL=-1.146
CYCLE 13
BOUNDARY 0,2 2,4 XVEL=27.16 YVEL=-27.16
CYCLE 60
"""
FREE_BLOCK = """
BOUNDARY 0,2 2,4 XVEL=-0.373 YVEL=0.373
CYCLE 100
BOUNDARY 0,2 2,4 XVEL=25.16 YVEL=-25.16
CYCLE 1
BOUNDARY 0,2.5 1.5,4 FREE
CYCLE 60
"""
SPEED_RISES = """
BOUNDARY 0,2 2,4 XVEL=-0.3 YVEL=0.3
CYCLE 100
BOUNDARY 0,2 2,4 XVEL=0.7 YVEL=-0.7
CYCLE 25
BOUNDARY 0,2 2,4 XVEL=27.0 YVEL=-27.0
CYCLE 1
BOUNDARY 0,2 2,4 XVEL=1 YVEL=-1
CYCLE 100
"""

FLUNG = """
START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E9 G=6E8
BLOCK 0,0 0,4 6,4 6,0
SPLIT -1 1 7 1
SPLIT -1 2 7 2
SPLIT 2 1 2 4
SPLIT 4 1 4 4
FIX 0 6 0 1
GENERATE 0 2 1 2 MANUAL GRIDPOINTS 1,1.5 0,2 0,1 2,1 2,2 ZONES 1,2,5 2,3,5 3,4,5 4,1,5
GENERATE 2 4 1 2 MANUAL GRIDPOINTS 3,1.5 2,2 2,1 4,1 4,2 ZONES 1,2,5 2,3,5 3,4,5 4,1,5
CYCLE 1
GRAVITY 1E21 4.3
"""
GIVEN_UP = """
START
PROPERTY MAT=1 DENSITY 2000 KN 3.8E8 KS 1.1E8
BLOCK 0 0 0 10 20 10 20 0
SPLIT 5.29 -21.23 7.07 38.74
SPLIT -26.56 1.66 33.4 3.93
SPLIT -26.78 8.59 32.99 3.36
SPLIT -11.35 8.51 48.38 2.83
SPLIT -12.91 12.75 46.71 6.0
SPLIT -15.54 5.53 44.28 0.86
ROUND 0.05
BOUNDARY 3.007 3.027 5.023 5.043 XVEL 137 YVEL 56
BOUNDARY 2.733 2.753 3.425 3.445 XVEL 169 YVEL 28
CYCLE 1
"""

# What the search has found, cut down to what is needed.
FOUND = {
    # an overlap of 0.53 D without a contact
    "no-contact": """
START
PROP MAT=1 DENS=2000 KN=18400000 KS=18400000 F=1
BLOCK -14.77,-95.19 124.2,16.66 225.8,-109.6 86.85,-221.4
SPLIT -567 -68.4 794 -75.1
SPLIT -498.7 -369.3 725 225.8
DELETE 160.3 160.5 -62.4 -62.24
DELETE 36.1 36.4 -90.5 -90.2
ROUND 0.753
BOUNDARY 115.2 115.6 -132 -131.6 XVEL=-0.08366 YVEL=-0.7435
CYCLE 2
BOUNDARY 115.2 115.6 -132.2 -131.8 XVEL=1.83 YVEL=5.368
CYCLE 1
""",
    # error 15 for two blocks that have parted and do not meet again
    "alarm-apart": """
START
PROP MAT=1 DENS=2000 KN=248000000 KS=248000000 F=0
BLOCK -1.57,1.82 0.276,1.29 0.697,-0.949 -0.539,-2 -2.1,-1.28 -2.54,0.534
SPLIT 13.21 -14.2 -15.45 13.71
ROUND 0.192
FIX -0.603 -0.597 0.368 0.374
BOUNDARY -1.394 -1.388 -0.7464 -0.7406 XVEL=-74.85 YVEL=-76.88
CYCLE 3
BOUNDARY -1.63 -1.62 -0.986 -0.981 XVEL=76.9 YVEL=-74.8
CYCLE 3
BOUNDARY -1.39 -1.38 -1.22 -1.21 XVEL=119 YVEL=204
CYCLE 1
""",
    # the same, at another size and speed
    "alarm-apart-far": """
START
PROP MAT=1 DENS=2000 KN=16300000 KS=16300000 F=0
BLOCK 1.03,0.916 -1.37,1.23 -1.54,2.83 0.144,3.86 2.73,3.78 2.96,1.85
SPLIT -1.38 -17.2 3.67 22.4
ROUND 0.0287
BOUNDARY -0.05064 -0.04477 2.376 2.382 XVEL=-2.734 YVEL=0.3475
CYCLE 12
BOUNDARY -0.199 -0.193 2.39 2.4 XVEL=-0.429 YVEL=-3.37
CYCLE 28
BOUNDARY -0.2537 -0.2478 1.967 1.973 XVEL=8.713 YVEL=6.726
CYCLE 4
""",
    # a contact that overlaps by 0.43 D, of blocks 0.03 D apart
    "contact-of-nothing": """
START
PROP MAT=1 DENS=2000 KN=80500000 KS=80500000 F=0.5
BLOCK -2.23,0.833 -2.23,6.19 1.83,6.19 1.83,0.833
SPLIT -8.408 -15.3 6.18 21.94
SPLIT -4.936 -16.31 2.709 22.95
DELETE 0.404 0.415 3.24 3.25
ROUND 0.0188
BOUNDARY -0.555 -0.549 5.23 5.24 XVEL=8.23 YVEL=-1.6
CYCLE 3
BOUNDARY -0.536 -0.5302 5.228 5.234 XVEL=-11.45 YVEL=-16.19
CYCLE 3
""",
    # a contact that overlaps by 0.48 D, of blocks 0.13 D apart
    "contact-of-nothing-needles": """
START
PROP MAT=1 DENS=2000 KN=90700000 KS=90700000 F=0
BLOCK -17.303,-120.61 -12.987,-118.84 -10.968,-123.77 -15.284,-125.54
SPLIT -15.454 -141.91 -12.531 -102.02
SPLIT -13.331 -141.96 -14.654 -101.98
DELETE -12.867 -12.854 -122.2 -122.18
ROUND 0.00379
BOUNDARY -13.9565 -13.9507 -120.143 -120.137 XVEL=-1.718 YVEL=0.0365452
CYCLE 1
BOUNDARY -13.9575 -13.9517 -120.143 -120.137 XVEL=-0.396286 YVEL=-18.6295
CYCLE 1
""",
    # error 15 when a tip has gone through another, thinner than the overlap
    "alarm-late": """
START
PROP MAT=1 DENS=2000 KN=36200000 KS=36200000 F=0
BLOCK 232.02,-30.994 232.02,-25.549 236.91,-25.549 236.91,-30.994
SPLIT 220.974 -43.1586 249.093 -14.7105
SPLIT 223.36 -45.172 246.71 -12.697
DELETE 235.74 235.75 -29.628 -29.62
ROUND 0.0167
BOUNDARY 233.859 233.864 -30.3098 -30.3052 XVEL=-0.121893 YVEL=-0.120407
CYCLE 32
BOUNDARY 233.85 233.86 -30.314 -30.31 XVEL=-0.56473 YVEL=0.5717
CYCLE 1
BOUNDARY 233.85 233.86 -30.313 -30.309 XVEL=25.926 YVEL=25.61
CYCLE 2
""",
}


@pytest.mark.parametrize("way", [CONSTANT_SPEED, FREE_BLOCK, SPEED_RISES], ids=["constant", "free", "rises"])
def test_a_block_does_not_go_through_a_fixed_one(way: str) -> None:
    """A contact in time, or error 15."""
    stage = WatchedModel()
    with suppress(Over):
        stage.run(START + way)
    assert set(stage.errors) <= {15}
    assert stage.errors or stage.contacts()


@pytest.mark.parametrize("deck", FOUND.values(), ids=FOUND)
def test_what_the_search_has_found(deck: str) -> None:
    """Contacts where bodies overlap and only there; error 15 in time, and for a reason."""
    stage = WatchedModel()
    with suppress(Over):
        stage.run(deck)
    assert set(stage.errors) <= {15}


@pytest.mark.parametrize(
    ("kind", "seed", "number"),
    [
        ("extreme", 2000, 52),  # two tips in a gap that one of them fills, overlaps included
        ("extreme", 2000, 879),
        ("extreme", 2000, 1143),
        ("long", 2000, 564),  # the far side of a blunt corner's circle
        ("needles", 1000, 406),  # a contact that crossed another one of two tips that have crossed
        ("needles", 6000, 806),  # deepest between two sub-steps of the judge
        ("needles", 1000, 671),  # two contacts on an arc, deeper than its circle is wide
        ("bends", 15100, 919),  # a corner that has come to have an arc, between two updates
        ("bends", 13100, 290),  # a blunt arc in a notch, deep in both edges
        ("grazes", 19000, 51),  # the end of a blunt arc comes to the arc of a corner
        ("grazes", 19000, 52),  # it passes a straight corner
        ("grazes", 19001, 31),  # a corner that hardly turns, between long edges
        ("grazes", 19001, 308),  # out of a notch under force
        ("grazes", 19001, 343),
        ("grazes", 19002, 565),  # a point comes to stand beside a blunt arc
        ("acute", 12100, 979),  # the corner of a deformable block that turns from convex to concave in a step
    ],
)
def test_scenes_that_the_search_has_found(kind: str, seed: int, number: int) -> None:
    found = impact_search.play(kind, seed, number, "i32r64")
    assert not found.failure, f"{impact_search.describe(found, seed)}\n{found.snippet}"


def test_an_edge_finds_a_blunt_arc_where_it_would_keep_it() -> None:
    """Where the end of a blunt arc stands between an edge and its rounded end, in short reals."""
    kind, seed, number = "extreme", 41, 590
    found = impact_search.play(kind, seed, number, "i16r32")
    assert not found.failure, f"{impact_search.describe(found, seed)}\n{found.snippet}"


def test_an_update_after_a_long_step_comes_to_an_end(tmp_path: Path) -> None:
    """Contacts that what has come into their gaps takes away are not made and given up for ever."""
    (tmp_path / "deck.dat").write_text(GIVEN_UP)
    command = [sys.executable, "-m", "udec_ia", "run", "deck.dat"]
    path = str(Path(__file__).parents[2])
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert "error 15" in done.stderr


@pytest.mark.parametrize("rise", [0.02, 0.1, 0.5, 5.0])
def test_what_faces_an_arc(rise: float) -> None:
    """All directions: those between the normals of its two edges, and up to the slack beyond either."""
    model = Model()
    model.block(-1, -10, -1, 0, 0, rise, 1, 0, 1, -10)
    model.round(0.05)
    (corner,) = (row for row in model.table("corner") if row["KYP"] == rise)
    half, h = math.atan(rise), model.array.h
    for slack in (0.25, 0.3):
        for angle in np.arange(-179.5, 180, 1) * math.pi / 180:  # from the middle of the arc, upwards
            x, y = math.sin(angle), math.cos(angle)
            faced = faces(h, int(corner["address"]), x, y, h.cr.dtype.type(slack))
            assert faced == (abs(angle) <= half + math.asin(slack)), (slack, angle)


@pytest.mark.parametrize("speed", [1e4, 1e8, 1e13])
def test_however_fast_a_block_is_looking_where_it_went_takes_no_time(speed: float) -> None:
    """A cycle of it ends in an error, or nothing was in the way."""
    for turn in (0.0, 1.0):
        model = Model()
        model.run(START)
        model.boundary(0, 2, 2, 4, xvel=speed, yvel=-turn * speed)
        start = time.process_time()
        with suppress(UdecError):
            model.cycle(1)
        assert time.process_time() - start < 5 + compile_seconds()


@pytest.mark.parametrize("way", [1, -1])
def test_a_fixed_block_with_a_velocity_goes_nowhere(way: int) -> None:
    """RSET gives it one, which its contacts feel as a belt's: but nothing goes through it for that."""
    model = Model()
    model.property(1, density=2000, kn=1e8, ks=1e8)
    model.block(0, 0, 0, 4, 4, 4, 4, 0)
    model.split(-1, 2, 5, 2)
    model.split(2, 1.5, 2, 5)
    model.round(0.1)
    model.fix(0, 2, 2, 4)
    model.cycle(0)
    (fixed,) = (row for row in model.table("block") if row["KBFIX"] == FIXED)
    (free,) = (row for row in model.table("block") if row["KX"] > 2 and row["KY"] > 2)
    fast = 2 * model.h.cr[DTOL] / model.h.cr[TDEL]
    putr(model.array.h, int(fixed["address"]), KYD, way * fast)
    putr(model.array.h, int(free["address"]), KYD, 0.02 * fast)
    model.cycle(1)
    (now,) = (row for row in model.table("block") if row["KBFIX"] == FIXED)
    assert (now["KX"], now["KY"]) == (fixed["KX"], fixed["KY"])


def test_a_way_that_cannot_be_followed_is_no_way_round() -> None:
    """A load beyond measure flings zones away in a step: error 15 at once, and no looking for ever."""
    model = Model()
    model.run(FLUNG)
    start = time.process_time()
    with pytest.raises(UdecError, match="error 15"):
        model.cycle(20)
    assert time.process_time() - start < 20 + compile_seconds()


@pytest.mark.parametrize("kind", [*SHAPES, *impact_search.FACES])
def test_random_impacts(kind: str) -> None:
    """Nothing is missed, and no error 15 comes without an overlap."""
    found = [impact_search.play(kind, SEED, number, "i32r64") for number in range(BATCH)]
    assert sum(one.error == 15 for one in found) >= BATCH // 8  # they do strike
    failures = [f"{impact_search.describe(one, SEED)}\n{one.snippet}" for one in found if one.failure]
    assert not failures, "\n\n".join(failures)
