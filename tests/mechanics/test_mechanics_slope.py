"""Two joint blocks of a slope: which of them slide, and how fast, from the friction angle alone.

The target, 0.3345 at 20 degrees, is that of rigid blocks on joints of just the given inclinations. The slope
is near its limit there: friction leaves a thirtieth of gravity, and a thousandth of a radian more adds 3
percent. On springs of 1.33e7 the blocks sink by up to 0.16 m, on the left by more than on the right, and as
the upper one slides, its weight moves farther to the left: the joint it slides on leans by 2 to 4
thousandths. That is what such springs do, and is seen in the corners' coordinates. So the acceleration is
measured twice: as the problem is given, to be that of the inclination which the joint really has; and with
gravity turned by as much as the joint leans, so that it is inclined as the target means it, to be 0.3345.

The blocks settle with mass damping and more friction than they need. When the friction is set, the load on
the springs changes at once, and stiffness damping lets them swing out; it acts along the normals only where a
contact slips. A straight line through the velocities over more than a period is the acceleration.
"""

from __future__ import annotations

from itertools import pairwise
from math import atan, cos, pi, radians, sin, tan
from typing import NamedTuple

import numpy as np
import pytest
from naive.dynamics import slide, slide_two
from support.mechanics_scenes import G, Row, at, block, box, model, sound, step

from udec_ia import Model
from udec_ia.layout import offsets as g
from udec_ia.layout.offsets import AKN

LOWER, UPPER = atan(6 / 20), atan(6 / 15)
MASSES = 2000 * 138.75, 2000 * 75.0
KN = (1.33e7, 1.33e9)  # the given stiffness, and one that is nearly rigid
SAMPLES = 50


def slope(friction: float, kn: float, turn: float = 0.0) -> Model:
    """Block 20 x 20, cracks (0,2)-(20,8), (5,3)-(5,20) and (5,12)-(20,18); what is left of x = 5 is taken
    away, the foot is fixed, and the rest has settled with more friction than it needs.

    turn: angle by which gravity is turned clockwise, so that the slope is the less inclined to it.
    """
    m = model(*box(0, 20, 0, 20), d=1.0, density=2000.0, stiffness=(kn, kn), friction=2.0)
    m.gravity(G * sin(turn), -G * cos(turn))
    m.split(0, 2, 20, 8)
    m.split(5, 3, 5, 20)
    m.split(5, 12, 20, 18)
    m.fix(0, 20, 0, 5)
    m.delete(0, 5, 5, 20)
    frequency = (2 * kn / 4e6) ** 0.5 / (2 * pi)
    m.damping(1.0, frequency, "mass")
    m.cycle(1000)
    m.property(1, friction=friction)
    m.damping(0.2, frequency, "stiffness")
    return m


def inclination(m: Model, address: int, near: float) -> float:
    """Inclination of the edge of the block at `address` that is inclined most nearly like `near`."""
    corners = m.table("corner")
    points = [(float(c["KXP"]), float(c["KYP"])) for c in corners[corners["KNB"] == address]]
    angles = [
        atan((y2 - y1) / (x2 - x1)) for (x1, y1), (x2, y2) in pairwise([*points, points[0]]) if x1 != x2
    ]
    return min(angles, key=lambda angle: abs(angle - near))


def lean(m: Model, one: int, two: int, given: float) -> float:
    """By how much the joint of two blocks is steeper than `given`: the edges it touches on, by their load."""
    rows = m.table("contact")
    rows = rows[np.isin(rows["KB1"], (one, two)) & np.isin(rows["KB2"], (one, two))]
    assert set(rows["KCCOD"]) <= {g.CORNER_EDGE, g.EDGE_CORNER}
    on = np.where(rows["KCCOD"] == g.CORNER_EDGE, rows["KB2"], rows["KB1"])
    edges = [inclination(m, int(ib), given) for ib in on]
    return float(np.average(edges, weights=rows["KCFN"])) - given


class Run(NamedTuple):
    """lower, upper: accelerations of the blocks (m/s2) down the given slopes. leans: mean leans of the lower
    and of the upper joint. give: what the springs can have added to an acceleration (m/s2).
    """

    lower: float
    upper: float
    leans: tuple[float, float]
    give: float


def run(m: Model, wait: float, time: float) -> Run:
    """Let the springs swing out for `wait` seconds, then watch for `time` seconds.

    A swing with the velocity A sin(w t + c) tilts the line that fits it best over a time T by no more than
    12 A/(w T^2) (1 + 2/(w T)). A is the greatest distance of a velocity from a parabola, for leans change
    steadily; w is at least that of both blocks on one of the two springs below them. And as a block leans
    more and more, it moves what lies on it by no more than its farthest corner moves about its centroid.
    """
    foot, low, up = (int(block(m, *place)["address"]) for place in ((10.0, 2.0), (12.5, 10.4), (11.0, 17.0)))
    m.cycle(1)
    m.cycle(round(wait / step(m)))
    many = round(time / step(m) / SAMPLES)
    seen, turns, leans = [], [], []
    for _ in range(SAMPLES):
        m.cycle(many)
        lower, upper = at(m, "block", low), at(m, "block", up)
        seen.append((down(lower, LOWER), down(upper, UPPER)))
        turns.append((lower["KTD"] * lower["KBRO"], upper["KTD"] * upper["KBRO"]))
        leans.append((lean(m, foot, low, LOWER), lean(m, low, up, UPPER)))
    t = np.arange(SAMPLES) * many * step(m)
    down_lower, down_upper = np.polyfit(t, seen, 1)[0]
    turning = float(np.abs(np.polyfit(t, turns, 1)[0]).sum())
    parabolas = np.vander(t, 3) @ np.polyfit(t, seen, 2)
    w, span = float(m.h.cr[AKN] / sum(MASSES)) ** 0.5, float(t[-1])
    swing = 12 * float(np.abs(seen - parabolas).max()) / (w * span**2) * (1 + 2 / (w * span))
    of_lower, of_upper = np.mean(leans, axis=0)
    return Run(float(down_lower), float(down_upper), (float(of_lower), float(of_upper)), swing + turning)


def down(row: Row, angle: float) -> float:
    """Velocity of a block down to the left, along `angle`."""
    return float(-row["KXD"] * cos(angle) - row["KYD"] * sin(angle))


@pytest.mark.parametrize("kn", KN)
def test_only_the_upper_block_slides_at_20_degrees(kn: float) -> None:
    friction = tan(radians(20))
    assert slide(G, UPPER, friction) == pytest.approx(0.3345, abs=5e-5)

    m = slope(friction, kn)
    given = run(m, 1.0, 1.6)
    assert given.lower == pytest.approx(0, abs=given.give)
    assert given.leans[0] == pytest.approx(0, abs=1e-12)
    assert given.upper == pytest.approx(slide(G, UPPER + given.leans[1], friction), abs=given.give)
    sound(m)

    turned = run(slope(friction, kn, given.leans[1]), 1.0, 1.6)
    other = abs(slide(G, UPPER + turned.leans[1] - given.leans[1], friction) - 0.3345)  # it leans differently
    assert turned.upper == pytest.approx(0.3345, abs=turned.give + other)


@pytest.mark.parametrize("kn", KN)
def test_both_blocks_slide_at_11_degrees(kn: float) -> None:
    friction = tan(radians(11))
    m = slope(friction, kn)
    masses = float(block(m, 12.5, 10.4)["KBM"]), float(block(m, 11.0, 17.0)["KBM"])
    assert masses == pytest.approx(MASSES)
    seen = run(m, 0.5, 0.8)
    leans = seen.leans
    lower, upper = slide_two(G, masses, (LOWER + leans[0], UPPER + leans[1]), friction)
    assert min(lower, upper) > 0.5
    assert seen.lower == pytest.approx(lower, abs=seen.give)
    assert seen.upper == pytest.approx(upper + lower * cos(UPPER - LOWER), abs=seen.give)
    sound(m)
