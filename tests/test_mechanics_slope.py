"""Two joint blocks of a slope: which of them slide, and how fast, from the friction angle alone."""

from __future__ import annotations

from math import atan, cos, pi, radians, sin, tan
from typing import NamedTuple

import numpy as np
import pytest
from mechanics import G, block, box, model, sound, step
from naive.dynamics import slide, slide_two

from udec_ia import Model

LOWER, UPPER = atan(6 / 20), atan(6 / 15)


KN = (1.33e7, 1.33e9)  # the given stiffness, and one that is nearly rigid


def slope(friction: float, kn: float) -> Model:
    """Block 20 x 20, cracks (0,2)-(20,8), (5,3)-(5,20) and (5,12)-(20,18); what is left of x = 5 is taken
    away, the foot is fixed, and the rest has settled with more friction than it needs.

    Stiffness damping is left on: it acts along the normals only while a contact slips.
    """
    m = model(*box(0, 20, 0, 20), d=1.0, density=2000.0, stiffness=(kn, kn), friction=2.0, fraction=0.1)
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


def tilted(m: Model) -> float:
    """By how much the springs have let the lower block turn anticlockwise: its upper edge against UPPER."""
    corners = m.table("corner")
    corners = corners[corners["KNB"] == block(m, 12.5, 10.4)["address"]]
    left, right = np.sort(corners, order="KYP")[-2:]  # the ends of the upper edge are the highest corners
    if left["KXP"] > right["KXP"]:
        left, right = right, left
    return atan((right["KYP"] - left["KYP"]) / (right["KXP"] - left["KXP"])) - UPPER


class Run(NamedTuple):
    """Accelerations (m/s2) over half a second.

    lower, upper: down their slopes, the upper block's relative to the lower one. lean: greatest angle that
    the springs let the lower block lean by. turning: what the rotations give to points as far apart as the
    two centroids.
    """

    lower: float
    upper: float
    lean: float
    turning: float


def run(m: Model) -> Run:
    """Let the shear springs fill for half a second, then watch for as long."""
    m.cycle(1)
    n = round(0.5 / step(m))
    ends = []
    for _ in range(2):
        m.cycle(n)
        ends.append((block(m, 12.5, 10.4), block(m, 11.0, 17.0), tilted(m)))
    (low0, up0, tilt0), (low1, up1, tilt1) = ends
    assert (low0["address"], up0["address"]) == (low1["address"], up1["address"])
    time = n * step(m)
    gain = [(b["KXD"] - a["KXD"], b["KYD"] - a["KYD"]) for a, b in ((low0, low1), (up0, up1))]
    relative = (gain[1][0] - gain[0][0], gain[1][1] - gain[0][1])
    arm = np.hypot(up0["KX"] - low0["KX"], up0["KY"] - low0["KY"])
    turning = arm * max(abs(low1["KTD"] - low0["KTD"]), abs(up1["KTD"] - up0["KTD"])) / time
    lean = max(abs(tilt0), abs(tilt1))
    return Run(_along(gain[0], LOWER) / time, _along(relative, UPPER) / time, lean, float(turning))


def _along(vector: tuple[float, float], angle: float) -> float:
    return float(-vector[0] * cos(angle) - vector[1] * sin(angle))


def give(seen: Run) -> float:
    """What elastic blocks may differ by from rigid ones: da/dpsi = g (cos psi + mu sin psi) < 1.2 g."""
    return seen.turning + 1.2 * G * seen.lean


@pytest.mark.parametrize("kn", KN)
def test_only_the_upper_block_slides_at_20_degrees(kn: float) -> None:
    """The lower block stays, but for a swing on its springs, which the relative acceleration contains."""
    friction = tan(radians(20))
    m = slope(friction, kn)
    assert slide(G, UPPER, friction) == pytest.approx(0.3345, abs=5e-5)
    seen = run(m)
    assert seen.lean < 0.1 * 1.33e7 / kn
    swing = abs(seen.lower)
    assert swing < 0.06 * seen.upper * 1.33e7 / kn
    assert seen.upper == pytest.approx(0.3345, abs=0.0033 + give(seen) + swing)
    sound(m)


@pytest.mark.parametrize("kn", KN)
def test_both_blocks_slide_at_11_degrees(kn: float) -> None:
    friction = tan(radians(11))
    m = slope(friction, kn)
    masses = float(block(m, 12.5, 10.4)["KBM"]), float(block(m, 11.0, 17.0)["KBM"])
    assert masses == pytest.approx((2000 * 138.75, 2000 * 75.0))
    seen = run(m)
    lower, upper = slide_two(G, masses, (LOWER, UPPER), friction)
    assert min(lower, upper) > 0.5
    assert seen.lower == pytest.approx(lower, abs=0.01 * lower + give(seen))
    assert seen.upper == pytest.approx(upper, abs=0.01 * upper + give(seen))
    sound(m)
