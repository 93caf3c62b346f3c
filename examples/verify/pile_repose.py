"""Repose of a pile

Polygons lie in a bin whose right wall is taken away; what slides out is deleted. The surface that remains
stands at the angle of repose (outflow angle):

      |o              |o o o o o|
      |o o o          |o o o o o|   ->  gravity turns until the bed flows, and stays so:
      |o o o o o      |o o o o o|       the surface comes to rest at the same angle to the level

In the second test the same bed stays in its bin and gravity turns slowly. It holds up to a greater angle,
then flows, and comes to rest. Walls, floor, height and history are others; the angle is one of the material.

It is tilted by only 2 degrees beyond the angle at which it begins to flow, and so gathers little momentum.

Tolerance. The surface of some 25 polygons is uneven by half a size, which is 2 degrees, and so is that of the
other test.

Source: Bierwisch, Kraft, Riedel and Moseler, Journal of the Mechanics and Physics of Solids 57 (2009), for
angles of outflow; the comparison is one of the program with itself.
"""

from math import atan, cos, degrees, radians, sin

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import loose_polygons

BLOCKS = ("rigid",)
D, WIDE, ROWS, GRAVITY = 1.0, 28, 36, 10.0
FRICTIONS = (0.2, 0.4)
SETTLES, STEP, MOST, BEYOND, SLOW = 3.0, 0.4, 60, 2.0, 0.05
MOVED, SHARE = 2.0 * D, 0.05  # a bed flows when so many of its polygons have moved so far


def bed(case, friction):
    """A bin full of polygons of 5 to 7 corners, its width and its height."""
    m = case.model()
    m.round(0.1)
    w, h, pitch = WIDE * 1.08 * D, ROWS * 1.2 * D, 1.08 * D
    m.block(-2, -2, -2, h, 0, h, 0, -2)
    m.block(w, -2, w, h, w + 2, h, w + 2, -2)
    m.block(0, -2, 0, 0, w, 0, w, -2)
    loose_polygons(m, WIDE, ROWS, pitch, (5, 8), 0.8)
    m.property(1, density=2000, kn=3e8, ks=3e8, friction=friction)
    for limits in (-3, 0, -3, h), (w, w + 3, -3, h), (0, w, -3, 0):
        m.fix(*limits)
    m.gravity(0, -GRAVITY)
    m.fraction(0.12)
    m.damping(0.05, 1.0, "mass")
    m.cycle(time=SETTLES)
    return m, w, h


def loose(m):
    rows = m.table("block")
    return rows[rows["KBFIX"] == 0]


def rest(m):
    """Cycle until all but a few polygons are slow."""
    for _ in range(MOST):
        m.cycle(time=STEP)
        rows = loose(m)
        if np.quantile(np.hypot(rows["KXD"], rows["KYD"]), 0.98) < SLOW:
            return


def slope(m, left, right):
    """Angle (degrees) by which a line through the highest polygons of all strips falls to the right."""
    rows = loose(m)
    strip = np.floor(rows["KX"] / D).astype(int)
    tops = [np.flatnonzero(strip == k)[rows["KY"][strip == k].argmax()] for k in np.unique(strip)]
    tops = np.array(tops)[left : len(tops) - right]
    return -degrees(atan(np.polyfit(rows["KX"][tops], rows["KY"][tops], 1)[0]))


def outflow_angle(case, friction):
    m, w, h = bed(case, friction)
    m.delete(w, w + 3, -3, h)
    m.delete(f"OUTSIDE -3 {w} -3 {2 * h}")
    rest(m)
    if friction == FRICTIONS[-1]:
        case.draw(m)
    return slope(m, 2, 1)


def rest_angle(case, friction):
    """Angle at which the surface of a bed that has flowed comes to rest, to the level."""
    m, _, _ = bed(case, friction)
    before = {row["address"]: (row["KX"], row["KY"]) for row in loose(m)}

    def tilt(angle):
        m.gravity(GRAVITY * sin(radians(angle)), -GRAVITY * cos(radians(angle)))
        m.cycle(time=STEP)

    def share_moved():
        rows = loose(m)
        was = np.array([before[ib] for ib in rows["address"]])
        return np.mean(np.hypot(rows["KX"] - was[:, 0], rows["KY"] - was[:, 1]) > MOVED)

    angle = 0.0
    while share_moved() < SHARE and angle < 60:
        angle += 1.0
        tilt(angle)
    angle += BEYOND
    tilt(angle)
    rest(m)
    return angle + slope(m, 3, 3)


def solve(case):
    scatter = {"an uneven surface": 2.0, "that of the other test": 2.0}
    for friction in FRICTIONS:
        outflow, tilted = outflow_angle(case, friction), rest_angle(case, friction)
        yield Answer(f"outflow angle, friction {friction:g}", "degrees", outflow, tilted, scatter)
