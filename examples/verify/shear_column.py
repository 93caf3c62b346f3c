"""Longest periods of a layer on rock

A layer of the thickness H is fixed below and free above. Its first mode is a quarter of a wave, for
compression and for shear:

     ~~~~~~~~~~     T = 4 H/C       Cp = sqrt((K + 4G/3)/rho), up and down, or
     |      | H                     Cs = sqrt(G/rho), to and fro
     ////////////

A column of it, one zone wide and 20 zones high, begins with the velocities of this mode, sin(pi y/2H).

Tolerance. Zones give waves of the wave number k as a chain of masses does, with a frequency lower by (k
d)^2/24, d the height of a zone; central differences raise it by (w dt)^2/24; the greatest strain e
changes arms by itself.

Source: S. Kramer, Geotechnical Earthquake Engineering (1996), chapter 7.
"""

from math import pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, now, period, rectangle, step

BLOCKS = ("fdef",)
H, N, DENSITY, BULK, SHEAR, V = 10.0, 20, 2000.0, 2e8, 1e8, 1e-3
SPEEDS = {"compression": sqrt((BULK + 4 * SHEAR / 3) / DENSITY), "shear": sqrt(SHEAR / DENSITY)}


def solve(case):
    exact, computed = {}, []
    for name, speed in SPEEDS.items():
        m = case.model()
        m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
        m.round(0.02)
        m.block(0, 0, 0, H, 1, H, 1, 0)
        generate(m, rectangle(0, 1, 0, H, 1, N))
        field = "KYDG" if name == "compression" else "KXDG"
        held = {"xvel": 0} if name == "compression" else {"yvel": 0}
        m.boundary(-0.1, 1.1, -1, H + 1, **held)
        m.boundary(-0.1, 1.1, -0.1, 0.1, xvel=0, yvel=0)
        m.fraction(0.4)
        m.cycle(0)
        points = m.table("gridpoint")
        m.patch(
            ", ".join(
                f"gridpoint@{one['address']}.{field} = {V * float(np.sin(pi * one['KYG'] / (2 * H)))!r}"
                for one in points
                if one["KYG"] > 0
            )
        )
        t, v, high, want = [], [], points["KYG"] > H - 1e-6, 4 * H / speed
        while now(m) < 2.2 * want:
            m.cycle(4)
            t.append(now(m))
            v.append(float(m.table("gridpoint")[field][high].mean()))
        w, dt = 2 * pi / want, step(m)
        yield Answer(
            f"period, {name}",
            "s",
            period(t, v),
            want,
            {
                "zones, (k d)^2/24": want * (pi / (2 * N)) ** 2 / 24,
                "central differences": want * (w * dt) ** 2 / 24,
                "strain, 4 e": want * 4 * V * pi / (2 * H) / w,
                "samples": want * (4 * w * dt) ** 3 / 100,
            },
        )
        exact[f"{name}, 4H/C"] = t, V * 1e3 * np.cos(w * np.array(t))
        computed.append((t[::6], 1e3 * np.array(v[::6])))
    case.graph("time (s)", "velocity of the surface (mm/s)", exact, computed)
