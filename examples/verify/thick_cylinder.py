r"""A thick cylinder under pressure from inside

A tube of the radii a and b is pressed apart by p. It is the one problem of a hole that has no infinite
rock around it:

        ____           radial stress   A - B/r^2      A = p a^2/(b^2 - a^2)
      /  __  \         hoop stress     A + B/r^2      B = p a^2 b^2/(b^2 - a^2)
     |  (p )  |        moves outwards by
      \  --  /            u = A r/(2 (K + G/3)) + B/(2 G r)
        ----

(tension positive; plane strain). A quarter of it is a ring of zones with rollers.

Tolerance. The two zones of a quadrilateral have the stress of its middle to the second order: (h/a)^2,
with its longest side h at the wall. The polygon of the wall has sides, not an arc: the pressure acts on
cos(h/2a) of it, (h/a)^2/8 less. Strain, and the force ratio at which the run was ended.

Source: G. Lame and B. Clapeyron (1833); S. Timoshenko and J. Goodier, Theory of Elasticity (1934).
"""

from math import sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, outline, polar, quarter_ring

BLOCKS = ("fdef",)
A, B, P, BULK, SHEAR, DENSITY, AROUND, ACROSS = 1.0, 2.0, 1e5, 1e9, 6e8, 2000.0, 16, 8


def solve(case):
    nodes = quarter_ring(A, B, AROUND, ACROSS)
    m = case.model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    m.round(0.02)
    m.block(*outline(nodes))
    generate(m, nodes)
    m.boundary(-0.001, 0.001, -1, B + 1, xvel=0)
    m.boundary(-1, B + 1, -0.001, 0.001, yvel=0)
    m.boundary(-0.001, A + 0.001, -0.001, A + 0.001, stress=(-P, 0, -P))
    m.fraction(0.6)
    m.damping(0.6, sqrt(1.8e9 / DENSITY) / B / 4, "mass")
    points = m.table("gridpoint")
    before = np.hypot(points["KXG"], points["KYG"])
    m.solve(1e-5)
    points = m.table("gridpoint")
    moved = np.hypot(points["KXG"], points["KYG"]) - before
    one = P * A**2 / (B**2 - A**2)
    two = one * B**2
    side = np.hypot(np.pi / 2 / AROUND, (B / A) ** (1 / ACROSS) - 1)
    within = {
        "zones, (h/a)^2": side**2,
        "polygon, (h/a)^2/8": side**2 / 8,
        "force ratio of rest": 1e-4,
        "strain": 4e-4,
    }
    for what, radius in (("inner wall", A), ("outer wall", B)):
        exact = one * radius / (2 * (BULK + SHEAR / 3)) + two / (2 * SHEAR * radius)
        got = float(moved[abs(before - radius) < 1e-3].mean())
        yield Answer(
            f"the {what} moves by", "m", got, exact, {name: part * exact for name, part in within.items()}
        )
    r, radial, hoop, _ = polar(m)
    for what, got, exact in (("hoop", hoop, one + two / r**2), ("radial", radial, one - two / r**2)):
        off = float(np.sqrt(((got - exact) ** 2).mean()))
        yield Answer(
            f"{what} stress, root of the mean square of errors",
            "Pa",
            off,
            0.0,
            {name: part * 2 * two for name, part in within.items()},
        )
    case.draw(m, contour="shear")
