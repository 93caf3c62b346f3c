r"""Least thickness of a semicircular arch

An arch of voussoirs under its own weight stands as long as there is a line of thrust within it. The
thinner it is, the less room there is; at last it turns to a mechanism with five hinges:

          .-o-.
       o'   _   'o          t/R = 0.1075   many voussoirs, joints along the radius,
      /  .'   '.  \                        friction that holds
     o__/       \__o

Here there are 28 voussoirs, and forces act not farther out than D from their corners, where the rounding
begins. The line of thrust goes through the joint at the angle a from the crown at the radius

     r = (M + W x)/(W sin a + H cos a)

with the weight W above it, x the place of its centroid, and the thrust H and its moment M at the crown.
The least thickness is that for which one pair H, M keeps r within the faces less D, for all joints. With
720 voussoirs and no D that is Milankovitch's number; with 28 it is what the model is compared with, whose
least thickness is found by bisection.

Tolerance. Half of the last interval. All joints close by up to H/KN, and the crown sinks by that for each.

Source: M. Milankovitch, Theorie der Druckkurven, Z. Math. Phys. 55 (1907) 1-27; J. Heyman, The safety
of masonry arches, Int. J. Mech. Sci. 11 (1969) 363-385; J. Ochsendorf, The masonry arch on spreading
supports (2006).
"""

from math import cos, pi, radians, sin, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for

BLOCKS = ("rigid",)
G, DENSITY, K, R, N, D = 10.0, 2000.0, 2e10, 10.0, 28, 0.02
WATCHED, SUNK = 2.5, 0.1  # s, m
STEP = pi / N


def room(t, d=D, n=N):
    """Greatest room that a line of thrust has in an arch of the thickness t, N m/m; below 0 there is none."""
    inner, outer = R - t / 2, R + t / 2
    a = np.arange(n // 2 + 1) * pi / n  # joints, from the crown
    area = (outer**2 - inner**2) / 2 * sin(pi / n)  # of a voussoir with straight sides
    # centroid of one, on the radius in its middle
    middle = 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2) * cos(pi / n / 2)
    x = middle * np.sin(a[:-1] + pi / n / 2)
    w = np.r_[0.0, np.cumsum(np.full(n // 2, area * DENSITY * G))]
    wx = np.r_[0.0, np.cumsum(area * DENSITY * G * x)]

    def between(h):
        most = ((outer - d) * (w * np.sin(a) + h * np.cos(a)) - wx).min()
        return most - ((inner + d) * (w * np.sin(a) + h * np.cos(a)) - wx).max()

    low, high = 0.0, float(w[-1])
    for _ in range(100):  # concave in h
        one, two = low + (high - low) / 3, high - (high - low) / 3
        low, high = (one, high) if between(one) < between(two) else (low, two)
    return between((low + high) / 2)


def least(d=D, n=N):
    low, high = 0.02 * R, 0.4 * R
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (middle, high) if room(middle, d, n) < 0 else (low, middle)
    return high


def falls(case, t, draw=False):
    """True if the arch of the thickness t falls."""
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, friction=1.5)
    m.fraction(0.1)
    m.round(D)
    inner, outer, more = R - t / 2, R + t / 2, radians(6)
    joints = np.r_[-more, np.arange(N + 1) * STEP, pi + more]
    corners = [(outer * cos(a), outer * sin(a)) for a in joints[::-1]] + [
        (inner * cos(a), inner * sin(a)) for a in joints
    ]
    m.block(*[float(x) for corner in corners for x in corner])
    for a in joints[1:-1]:
        m.split(
            (inner - 0.1) * cos(a), (inner - 0.1) * sin(a), (outer + 0.1) * cos(a), (outer + 0.1) * sin(a)
        )
    m.fix(-2 * R, 2 * R, -R, 0)  # the feet
    m.gravity(0, -G)
    m.damping(1.0, sqrt(K / 2e3) / (2 * pi) / 30, "mass")
    m.cycle(4000)
    m.damping(0.02, sqrt(K / 2e3) / (2 * pi), "stiffness")
    if draw:
        case.draw(m)
    for _ in range(10):
        cycle_for(m, WATCHED / 10)
        if m.table("block")["KY"].max() < R - SUNK - 0.05:
            break
    if draw:
        cycle_for(m, 0.7)
        case.draw(m)
    return m.table("block")["KY"].max() < R - SUNK - 0.05


def solve(case):
    exact = least()
    yield Answer(
        "t/R by the formula, many voussoirs",
        "",
        least(0.0, 720) / R,
        0.1075,
        {"digits of the source": 5e-5, "joints at 1/4 degree": 1e-5},
    )
    low, high = 0.08 * R, 0.15 * R
    falls(case, low, draw=True)
    while high - low > 0.01:
        middle = (low + high) / 2
        low, high = (middle, high) if falls(case, middle) else (low, middle)
    thrust = DENSITY * G * exact * R * 0.6
    yield Answer(
        "least t/R of 28 voussoirs",
        "",
        (low + high) / 2 / R,
        exact / R,
        {"bisection": (high - low) / 2 / R, "closure of joints, N H/KN": N * thrust / K / R},
    )
