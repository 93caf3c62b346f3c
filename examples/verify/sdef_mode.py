"""Free vibration of a simply-deformable block

A simply-deformable block has one strain for all of it. It is pulled along its length L and let go:

     <-  +----------+  ->       w = sqrt(12) Cp/L       Cp = sqrt((K + 4G/3)/rho)
         +----------+
              L

That is the balance of its inertia, rho L^3/12, and its stiffness; a bar whose points move freely has w
= pi Cp/L, 9.3 % less. With K = 2G/3 a strain along the block has no stress across it. The two exact
numbers are those of the two directions.

Tolerance. Central differences raise a frequency by (w dt)^2/24. Zeros are found by straight lines
between steps. The block is strained by e, and its arms change by that.

Source: Lord Rayleigh, The Theory of Sound (1877), for the approximation by one shape; report of 1980,
2.6.
"""

from math import asin, pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import period, step

BLOCKS = ("sdef",)
LENGTH, HEIGHT, DENSITY, SHEAR = 2.0, 1.0, 2000.0, 1e9
CP = sqrt(2 * SHEAR / DENSITY)


def solve(case):
    for size, rate, stress in ((LENGTH, "KED11", "KS111"), (HEIGHT, "KED22", "KS122")):
        m = case.model()
        m.round(0.02)
        m.block(0, 0, 0, HEIGHT, LENGTH, HEIGHT, LENGTH, 0)
        m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=2 * SHEAR / 3, g=SHEAR)
        m.change(-1, 3, -1, 2, type="sdef")
        m.fraction(0.03)
        m.cycle(0)
        m.patch(f"sdef@{m.table('sdef')['address'][0]}.{rate} = 0.01")
        times, stresses = [], []
        w = sqrt(12) * CP / size
        m.cycle(1)
        for k in range(round(6.5 * pi / w / step(m))):
            m.cycle(1)
            times.append(k * step(m))
            stresses.append(float(m.table("sdef")[stress][0]))
        dt, strain = step(m), 0.01 / w
        name = "along" if size == LENGTH else "across"
        yield Answer(
            f"frequency {name} the block",
            "rad/s",
            2 * pi / period(times, stresses),
            w,
            {
                "central differences": w * (2 / (w * dt) * asin(w * dt / 2) - 1),
                "zeros between steps": w * 0.032 * (w * dt) ** 3 / (5 * pi),
                "strain": 4 * strain * w,
                "last digits": w * 1e3 * case.last_digit,
            },
        )
        if size == LENGTH:
            t = np.array(times)
            exact = max(stresses) * np.sin(w * (t + 2 * dt))
            case.graph(
                "time (ms)",
                "stress (Pa)",
                {"sqrt(12) Cp/L": (t * 1e3, exact)},
                [(t[::8] * 1e3, stresses[::8])],
            )
