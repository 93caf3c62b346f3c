"""Natural frequencies of a chain of masses and springs

A column of n rigid blocks on a fixed base is a chain of masses m and springs k = 2 KN, free at its
upper end. Mode j swings with

      +--+ n
      +--+ ..      w_j = 2 sqrt(k/m) sin((2j - 1) pi/(2 (2n + 1)))
      +--+ 1
     ------

The blocks rest under their weight. Then each gets the velocity of a mode, too small for a joint to
open, and the velocity of the uppermost block passes zero twice in every period.

Tolerance. Central differences raise a frequency by (w dt)^2/24. Zeros are found by straight lines
between steps, to 0.016 (w dt)^2 of a step; two of them are 2.5 periods apart. A share of the swing is
not of this mode: what the force ratio of rest and the last digits of places leave.

Source: J.-L. Lagrange, Mecanique analytique (1788); S. Timoshenko, Vibration Problems in Engineering
(1937).
"""

from math import asin, pi, sin, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import on_base, period, push, row, settle, step

BLOCKS = ("rigid",)
REALS = 64  # a swing is 2.5 micrometres, the last digit of a height of 5 m 0.5
G, DENSITY, KN, SIDE, N = 10.0, 2000.0, 1e8, 1.0, 5
MASS, K = DENSITY * SIDE**2, 2 * KN


def frequency(j):
    return 2 * sqrt(K / MASS) * sin((2 * j - 1) * pi / (2 * (2 * N + 1)))


def solve(case):
    shapes, exact = [], {}
    for j in range(1, N + 1):
        m, w = case.model(), frequency(j)
        m.property(1, density=DENSITY, kn=KN, ks=KN, friction=1.0)
        m.fraction(0.05)
        m.round(0.1)
        on_base(case, m, SIDE, SIDE, N, width=4)
        m.gravity(0, -G)
        settle(case, m, K, 8 * N**2 * MASS / pi**2)
        blocks = np.sort(m.table("block")[m.table("block")["KBFIX"] == 0], order="KY")
        mode = np.array([sin((2 * j - 1) * pi * k / (2 * N + 1)) for k in range(1, N + 1)])
        largest = 0.05 * MASS * G / K  # of the swing, a twentieth of what the uppermost joint is closed by
        for one, part in zip(blocks, mode, strict=True):
            push(m, int(one["address"]), KYD=float(largest * w * part))
        m.cycle(1)
        t, v = [], []
        top, cycles = int(blocks["address"][-1]), int(6.5 * pi / w / step(m))
        for k in range(cycles):
            m.cycle(1)
            t.append(k * step(m))
            v.append(float(row(m, "block", top)["KYD"]))
        got, dt = 2 * pi / period(t, v), step(m)
        exact[f"mode {j}, {w:.0f} rad/s"] = (
            np.linspace(0, N, 60),
            np.sin((2 * j - 1) * pi * np.linspace(0, N, 60) / (2 * N + 1)),
        )
        now = np.sort(m.table("block")[m.table("block")["KBFIX"] == 0], order="KY")["KYD"]
        shapes.append((np.arange(1, N + 1), now / now[-1] * mode[-1]))
        yield Answer(
            f"frequency of mode {j}",
            "rad/s",
            got,
            w,
            {
                "central differences": w * (2 / (w * dt) * asin(w * dt / 2) - 1),
                "zeros between steps": w * 0.032 * (w * dt) ** 3 / (5 * pi),
                "force ratio of rest, and last digits": w * 20 * case.last_digit * N * SIDE / largest,
            },
        )
    case.graph("block, from the base", "velocity", exact, shapes)
