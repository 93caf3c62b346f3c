"""Two blocks on the joints of a slope

A square of 20 m is cut by three joints; the foot is fixed and the left part taken away. Two blocks
remain, the upper one on a joint that dips 2 in 5, the lower one on a joint that dips 3 in 10:

        |      .-'|        friction 20 degrees: the upper block slides alone,
        |  .-'  B |          a = g (sin psi - mu cos psi) = 0.3345
        |-'    .-'|        friction 11 degrees: both slide, by Newton's law for two bodies
         |.-'  A  |          that push each other on an inclined plane
         |    .-'
    .-'

Tolerance. The joints give way by the weight on them over KN, and lean by that over the distance of the
contacts: a lean of d changes an acceleration by g d (cos psi + mu sin psi). A swing on the springs
tilts the straight line through the velocities by a bounded part.

Source: I. Newton, Principia (1687), for bodies that push each other; the geometry is that of many a
textbook slope, and ours.
"""

from math import atan, cos, pi, radians, sin, sqrt, tan

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, cycle_for, now, row, straight_line

BLOCKS = ("rigid",)
REALS = 64  # joints lean by 1e-4, overlaps are 0.5 mm at 20 m
G, K, DENSITY = 10.0, 1.33e9, 2000.0
LOWER, UPPER = atan(6 / 20), atan(6 / 15)  # inclination of the joints
MASSES = 138.75 * DENSITY, 75.0 * DENSITY


def slope(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, friction=2.0)
    m.fraction(0.05)
    m.gravity(0, -G)
    m.round(1.0)
    m.block(0, 0, 0, 20, 20, 20, 20, 0)
    m.split(0, 2, 20, 8)
    m.split(5, 3, 5, 20)
    m.split(5, 12, 20, 18)
    m.fix(0, 20, 0, 5)
    m.delete(0, 5, 5, 20)
    m.damping(1.0, sqrt(2 * K / 4e6) / (2 * pi), "mass")
    m.cycle(3000)
    return m


def both(mu):
    """Accelerations of the lower block, and of the upper one relative to it, down their joints.

    Unknown are these two, a and r, and the normal forces of both joints, each with its friction.
    """
    (t1, n1), (t2, n2) = ((np.array([-cos(s), -sin(s)]), np.array([-sin(s), cos(s)])) for s in (LOWER, UPPER))
    p1, p2 = n1 - mu * t1, n2 - mu * t2
    (m1, m2), none, weight = MASSES, np.zeros(2), np.array([0, -G])
    left = np.block([[np.c_[m2 * t1, m2 * t2, none, -p2]], [np.c_[m1 * t1, none, -p1, p2]]])
    a, r, _, _ = np.linalg.solve(left, np.r_[m2 * weight, m1 * weight])
    return a, r


def down(one, angle):
    return float(-one["KXD"] * cos(angle) - one["KYD"] * sin(angle))


def solve(case):
    for degrees, time in ((20, 1.6), (11, 0.8)):
        m, mu = slope(case), tan(radians(degrees))
        low, up = (int(block(m, *place)["address"]) for place in ((12.5, 10.4), (11.0, 17.0)))
        if degrees == 20:
            case.draw(m)
        m.property(1, friction=mu)
        m.damping(0.2, sqrt(2 * K / 4e6) / (2 * pi), "stiffness")
        m.cycle(1)
        cycle_for(m, 0.2)
        seen = []
        for _ in range(40):
            cycle_for(m, time / 40)
            seen.append((now(m), down(row(m, "block", low), LOWER), down(row(m, "block", up), UPPER)))
        t, lower, upper = np.array(seen).T
        sink = (
            sum(MASSES) * G / K / 14 + MASSES[1] * G / K / 11
        )  # both joints; their contacts lie 14 and 11 m apart
        lean = G * (1 + mu) * sink
        a, r = both(mu) if degrees == 11 else (0.0, G * (sin(UPPER) - mu * cos(UPPER)))
        exact = {"lower": (lower, a), "upper": (upper, r + a * cos(UPPER - LOWER))}
        for name, (speed, value) in exact.items():
            got, swing = straight_line(t, speed)
            yield Answer(
                f"{degrees} degrees, {name} block",
                "m/s2",
                got,
                value,
                {"lean of the joints": lean, "swing on the springs, 3 A/T": swing},
            )
        if degrees == 20:
            cycle_for(m, 1.5)
            case.draw(m)
