"""A wave passes a joint

A joint that is closed and elastic is a spring between two half-spaces: a part of a plane wave passes
it, the softer the joint the less, and the rest is sent back:

        -->  |  |   T        T = 1/sqrt(1 + (w z/(2 k))^2)        z = rho Cp
       <--   |  |
           joint k           T^2 + R^2 = 1

A bar with rollers, cut in its middle and pressed together, has viscous ends. A sine comes in from the
left, and the amplitude on the right is measured. The joint has two contacts on a width of 1 m: k = 2
KN.

Tolerance. In zones of the length d the stress is the mean over a wave that turns by k d: less by (k
d)^2/24; in a chain of zones the impedance is z cos(k d/2). Both ends send a little back, which
interferes: (k d)^2/16 for that reason, and w dt/4, since their dashpots are half a step late.

Source: M. Schoenberg, Elastic wave behavior across linear slip interfaces, J. Acoust. Soc. Am. 68
(1980) 1516-1521; L. Pyrak-Nolte, L. Myer and N. Cook, J. Geophys. Res. 95 (1990).
"""

from math import pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, generate, now, rectangle, step

BLOCKS = ("fdef",)
HALF, N, DENSITY, BULK, SHEAR = 5.0, 30, 2000.0, 2e8, 1e8
CP, PRESS, STRESS = sqrt((BULK + 4 * SHEAR / 3) / DENSITY), 4e4, 1e4
WAVE = 5.0  # its length, m
W = 2 * pi * CP / WAVE


def passes(case, stiffness):
    """Amplitude on the right over that which comes in."""
    m = case.model()
    m.property(1, density=DENSITY, kn=stiffness / 2, ks=stiffness / 2, bulk=BULK, g=SHEAR, friction=0.5)
    m.round(0.02)
    m.block(-HALF, 0, -HALF, 1, HALF, 1, HALF, 0)
    m.split(0, -1, 0, 2)
    for x in (-HALF, 0.0):
        generate(m, rectangle(x, x + HALF, 0, 1, N, 1))
    m.boundary(-HALF - 1, HALF + 1, -1, 2, yvel=0)
    m.insitu(-HALF, HALF, 0, 1, -PRESS, 0, 0)
    for x in (-HALF, HALF):
        m.boundary(x - 0.01, x + 0.01, -1, 2, stress=(-PRESS, 0, 0))
        m.boundary(x - 0.01, x + 0.01, -1, 2, viscous=True)
    m.fraction(0.2)
    m.damping(1.0, CP / (8 * HALF), "mass")
    m.solve(1e-7)  # the joint closes
    m.damping(0.0, 1.0)
    begin, lasts = now(m), 12 * WAVE / CP
    m.boundary(-HALF - 0.01, -HALF + 0.01, -1, 2, stress=(-2 * STRESS, 0, 0), sine=(CP / WAVE, lasts))
    points = m.table("gridpoint")
    x = dict(zip(points["address"].tolist(), points["KXG"].tolist(), strict=True))
    place = np.array([np.mean([x[i] for i in row]) for row in m.table("zone")["KZG"].tolist()])
    zones = np.argsort(abs(place - HALF / 2))[:2]  # both of one place
    m.cycle(1)
    cycle_for(m, 8 * WAVE / CP)
    t, s = [], []
    for _ in range(80):
        cycle_for(m, WAVE / CP / 40)
        t.append(now(m) - begin)
        s.append(float(m.table("zone")["KZS11"][zones].mean()))
    t, waves = np.array(t), np.c_[np.sin(W * np.array(t)), np.cos(W * np.array(t)), np.ones(len(t))]
    sine, cosine, _ = np.linalg.lstsq(waves, np.array(s), rcond=None)[0]
    return float(np.hypot(sine, cosine)) / STRESS, W * step(m)


def solve(case):
    z, kd, found = DENSITY * CP, 2 * pi / WAVE * HALF / N, []
    ratios = (0.1, 0.3, 1.0, 3.0, 10.0)
    for ratio in ratios:
        got, turn = passes(case, ratio * z * W)
        found.append(got)
        exact = 1 / sqrt(1 + 1 / (2 * ratio) ** 2)
        yield Answer(
            f"T for k/(z w) = {ratio:g}",
            "",
            got,
            exact,
            {
                "stress of a zone, (k d)^2/24": exact * kd**2 / 24,
                "ends, (k d)^2/16": 2 * exact * kd**2 / 16,
                "ends, w dt/4": 2 * exact * turn / 4,
                "impedance of zones, (k d)^2/8": exact * (1 - exact**2) * kd**2 / 8,
            },
        )
    soft = np.linspace(0, 5.5, 100)
    points = [1 / (2 * ratio) for ratio in ratios], found
    case.graph(
        "w z/(2 k)", "share of the amplitude that passes", {"T": (soft, 1 / np.sqrt(1 + soft**2))}, [points]
    )
