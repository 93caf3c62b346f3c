"""A block hits the floor and comes back

A block without weight flies at a floor that has a spring and a dashpot, a share xi of the critical one:

      +---+  |             e = v'/v = exp(-pi xi/sqrt(1 - xi^2))
      +---+  v v           contact lasts for pi/(w sqrt(1 - xi^2)),   w = sqrt(2 KN/m)
    -----------

The contact has ended when the block has come back to where it began; so the dashpot pulls a little at
last. e does not depend on the velocity.

Tolerance. The block meets the floor in the middle of a step, and leaves it so: for up to one step at
each end the dashpot's force, 2 xi w v, and that of the spring, w^2 v dt, act too long or too little. In
between the dashpot is late by half a step, as if the mass were less by xi w dt of itself.

Source: T. Schwager and T. Poeschel, Coefficient of restitution and linear-dashpot model revisited,
Granular Matter 9 (2007) 465-469, on how the contact ends.
"""

from math import exp, pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, now, push, row, step

BLOCKS = ("rigid",)
REALS = 64  # a step is some micrometres
K, DENSITY, GAP, V = 1e8, 2000.0, 0.02, 0.5
MASS = DENSITY * 2.0
W = sqrt(2 * K / MASS)


def solve(case):
    shares, found = (0.0, 0.05, 0.2, 0.5), []
    for xi in shares:
        m = case.model()
        m.property(1, density=DENSITY, kn=K, ks=K)
        m.fraction(0.005)
        m.round(0.1)
        m.block(-2, -1, -2, 2, 2, 2, 2, -1)
        m.split(-3, 0, 3, 0)
        m.split(-1, -0.5, -1, 3)
        m.split(1, -0.5, 1, 3)
        m.split(-3, 1, 3, 1)
        m.delete(-2, -1, 0, 2)
        m.delete(1, 2, 0, 2)
        m.delete(-1, 1, 0, 1)
        m.fix(-2, 2, -1, 0)
        m.damping(2 * xi, W / (2 * pi), "stiffness")
        flying = int(block(m, 0, 1.5)["address"])
        push(m, flying, KYD=-V)
        m.cycle(1)
        while now(m) * V < 1 - GAP / 2:
            m.cycle(100)
        t, v = [], []
        while now(m) * V < 1 or (v and abs(v[-1] - v[-9 if len(v) > 9 else 0]) > 0) or len(v) < 20:
            m.cycle(5)
            t.append(now(m))
            v.append(float(row(m, "block", flying)["KYD"]))
        dt = step(m)
        e = v[-1] / V
        found.append(e)
        exact = exp(-pi * xi / sqrt(1 - xi**2))
        yield Answer(
            f"e for xi = {xi:g}",
            "",
            e,
            exact,
            {
                "dashpot, a step at both ends": 2 * 2 * xi * W * dt,
                "spring, a step at both ends": 2 * (W * dt) ** 2,
                "dashpot, half a step late": exact * pi * xi * xi * W * dt / sqrt(1 - xi**2) ** 3,
                "last digits": 1e4 * case.last_digit,
            },
        )
    x = np.linspace(0, 0.6, 100)
    case.graph(
        "share of critical damping",
        "e",
        {"exact": (x, np.exp(-pi * x / np.sqrt(1 - x**2)))},
        [(shares, found)],
    )
