r"""A round hole under equal pressure from all sides

A hole of the radius a is cut in elastic rock under the pressure p:

           p            wall moves in by   u = p a/(2G)
        \  |  /         radial stress      p (1 - a^2/r^2)
     p -- ( ) -- p      hoop stress        p (1 + a^2/r^2)
        /  |  \

A quarter of it, with rollers, is a ring of zones from a to b = 12 a. The rock begins with its stress,
then the wall is set free. As the pressure is given at b, p becomes q = p b^2/(b^2 - a^2) in the
stresses, and u = q a/(2G) + q (a/b)^2 a/(2 (K + G/3)) (see the thick cylinder).

Tolerance. The two zones of a quadrilateral have the stress of its middle to the second order: (h/a)^2,
with the longest side h of a zone at the wall. The force ratio at which the run was ended.

Source: G. Kirsch, Die Theorie der Elasticitaet und die Beduerfnisse der Festigkeitslehre,
VDI-Zeitschrift 42 (1898).
"""

from math import sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, outline, polar, quarter_ring

BLOCKS = ("fdef",)
A, B, P, BULK, SHEAR, DENSITY, AROUND, ACROSS = 1.0, 12.0, 1e6, 1e9, 6e8, 2000.0, 20, 32


def solve(case):
    nodes = quarter_ring(A, B, AROUND, ACROSS)
    m = case.model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    m.round(0.02)
    m.block(*outline(nodes))
    generate(m, nodes)
    m.insitu(0, B, 0, B, -P, 0, -P)
    m.boundary(-0.001, 0.001, -1, B + 1, xvel=0)
    m.boundary(-1, B + 1, -0.001, 0.001, yvel=0)
    m.boundary(-0.001, B + 0.001, -0.001, B + 0.001, stress=(-P, 0, -P))
    m.boundary(-0.001, A + 0.001, -0.001, A + 0.001, stress=(P, 0, P))  # the wall is free
    m.fraction(0.6)
    m.damping(0.6, sqrt(1.8e9 / DENSITY) / B / 4, "mass")
    points = m.table("gridpoint")
    wall = np.hypot(points["KXG"], points["KYG"]) < A + 1e-3
    m.solve(1e-5)
    points = m.table("gridpoint")
    moved = A - float(np.hypot(points["KXG"], points["KYG"])[wall].mean())
    side = A * np.hypot(np.pi / 2 / AROUND, (B / A) ** (1 / ACROSS) - 1)
    within = {"zones, (h/a)^2": (side / A) ** 2, "force ratio of rest": 1e-4}
    q = P * B**2 / (B**2 - A**2)
    exact = q * A / (2 * SHEAR) + q * (A / B) ** 2 * A / (2 * (BULK + SHEAR / 3))
    yield Answer(
        "the wall moves in by",
        "m",
        moved,
        exact,
        {name: part * exact for name, part in within.items()},
    )
    r, radial, hoop, _ = polar(m)
    for what, got, wanted in (("hoop", hoop, 1 + A**2 / r**2), ("radial", radial, 1 - A**2 / r**2)):
        off = float(np.sqrt(((got + q * wanted)[r < 3 * A] ** 2).mean()))
        yield Answer(
            f"{what} stress for r < 3 a, root of the mean square of errors",
            "Pa",
            off,
            0.0,
            {name: part * 2 * P for name, part in within.items()},
        )
    line = np.geomspace(A, 6 * A, 100)
    few = (r < 6 * A) & (np.arange(len(r)) % 2 == 0)
    case.graph(
        "r/a",
        "stress/p",
        {"hoop": (line, 1 + (A / line) ** 2), "radial": (line, 1 - (A / line) ** 2)},
        [(r[few], -hoop[few] / P), (r[few], -radial[few] / P)],
    )
