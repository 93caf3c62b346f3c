"""Natural frequencies of a block on two contacts

A rigid block on a floor has three modes. It bounces; and since the springs in shear are below its
centroid, at the distance h/2, it sways and rocks at once:

       +----+         m x'' = -2 KS (x + h/2 th)
       |  o-|-> x     I th'' = -2 KS h/2 (x + h/2 th) - 2 KN e^2 th + W (h/2 - D) th
       +----+         m y'' = -2 KN y
       ^    ^         e = b/2 - D

Each mode begins with its own velocities, so small that both contacts stay closed and hold.

Tolerance. Central differences raise a frequency by (w dt)^2/24. Zeros are found by straight lines
between steps. As the block leans, its weight moves over its contacts, which then close by other
amounts, and shear springs that hold turn with it: a share W h/(4 KN e^2). Last digits of places, over
the swing.

Source: R. Clough and J. Penzien, Dynamics of Structures (1975), modes of two degrees of freedom.
"""

from math import asin, pi

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import on_base, period, push, row, settle, step

BLOCKS = ("rigid",)
REALS = 64  # a swing is a micrometre
G, DENSITY, KN, KS, B, H, D = 10.0, 2000.0, 1e9, 5e8, 2.0, 3.0, 0.1
MASS, INERTIA, E = DENSITY * B * H, DENSITY * B * H * (B**2 + H**2) / 12, B / 2 - D


def modes():
    """Frequencies and shapes (x, y, th) of the three modes."""
    masses = np.array([MASS, MASS, INERTIA])
    k = np.zeros((3, 3))
    k[0, 0], k[0, 2], k[2, 0], k[1, 1] = 2 * KS, KS * H, KS * H, 2 * KN
    k[2, 2] = KS * H**2 / 2 + 2 * KN * E**2 - MASS * G * (H / 2 - D)
    root = 1 / np.sqrt(masses)
    squares, shapes = np.linalg.eigh(k * np.outer(root, root))
    return np.sqrt(squares), (shapes * root[:, None]).T


def solve(case):
    exact, computed = {}, []
    for w, shape in zip(*modes(), strict=True):
        m = case.model()
        m.property(1, density=DENSITY, kn=KN, ks=KS, friction=2.0)
        m.fraction(0.05)
        m.round(D)
        on_base(case, m, B, H, width=4)
        m.gravity(0, -G)
        settle(case, m, KS, MASS)
        blocks = m.table("block")
        address = int(blocks["address"][blocks["KBFIX"] == 0][0])
        name = ("KXD", "KYD", "KTD")[int(abs(shape).argmax())]
        sink = MASS * G / (2 * KN)
        speed = 0.02 * sink * w * shape / abs(shape).max()
        push(m, address, KXD=speed[0], KYD=speed[1], KTD=speed[2])
        m.cycle(1)
        t, v = [], []
        for k in range(round(6.5 * pi / w / step(m))):
            m.cycle(1)
            t.append((k + 1) * step(m))
            v.append(float(row(m, "block", address)[name]))
        dt = step(m)
        what = {"KXD": "sway", "KYD": "bounce", "KTD": "rock"}[name]
        yield Answer(
            f"frequency, mostly {what}",
            "rad/s",
            2 * pi / period(t, v),
            float(w),
            {
                "central differences": w * (2 / (w * dt) * asin(w * dt / 2) - 1),
                "zeros between steps": w * 0.032 * (w * dt) ** 3 / (5 * pi),
                "weight at the corners": w * MASS * G * (H / 2) / (2 * KN * E**2),
                "last digits of places": w * 20 * case.last_digit * H / (0.02 * sink),
            },
        )
        t = np.array(t)
        exact[f"{what}, {w:.0f} rad/s"] = t[::2] * 1e3, np.cos(w * t[::2])
        computed.append((t[::12] * 1e3, np.array(v[::12]) / max(v)))
    case.graph("time (ms)", "velocity, of its largest", exact, computed)
