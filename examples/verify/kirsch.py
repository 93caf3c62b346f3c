"""A round hole in rock that is pressed from two sides

Rock with a hole of the radius a is under the stress p in the direction of x only:

            _             hoop stress at the wall  p (1 - 2 cos 2t)
    p ->   ( )   <- p       3 p above and below the hole, t = 90 degrees
            -               -p, tension, at its sides, t = 0

and in the rock around, with the angle t from x and q = a^2/r^2:

    hoop stress    p/2 (1 + q) - p/2 (1 + 3 q^2) cos 2t
    radial stress  p/2 (1 - q) + p/2 (1 - 4 q + 3 q^2) cos 2t

A quarter of it, with rollers, is a ring of zones from a to b = 15 a, and the stress is given at b: the
formulas get terms of (a/b)^2, which follow from J. Michell's functions of stress for a ring. The rock
begins with its stress, then the wall is set free.

Tolerance. The two zones of a quadrilateral have the stress of its middle to the second order: (h/a)^2,
with the longest side h of a zone at the wall, of a stress that is up to 3 p. The force ratio at which
the run was ended.

Source: G. Kirsch, Die Theorie der Elasticitaet und die Beduerfnisse der Festigkeitslehre,
VDI-Zeitschrift 42 (1898); S. Timoshenko and J. Goodier, Theory of Elasticity (1934), for the ring.
"""

from math import sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, outline, polar, quarter_ring

BLOCKS = ("fdef",)
A, B, P, BULK, SHEAR, DENSITY, AROUND, ACROSS = 1.0, 15.0, 1e6, 1e9, 6e8, 2000.0, 24, 34


def ring(r, t):
    """Radial and hoop stress, Pa, at the distance r and the angle t."""
    even = -P / 2 * B**2 / (B**2 - A**2)
    # the part with cos 2t: stress function (f r^2 + g r^4 + h/r^2 + k) cos 2t; no stress at a, -p at b
    rows = [[-2, 0, -6 / x**4, -4 / x**2] for x in (A, B)] + [
        [2, 6 * x**2, -6 / x**4, -2 / x**2] for x in (A, B)
    ]
    f, g, h, k = np.linalg.solve(rows, [0, -P / 2, 0, P / 2])
    radial = even * (1 - (A / r) ** 2) - (2 * f + 6 * h / r**4 + 4 * k / r**2) * np.cos(2 * t)
    hoop = even * (1 + (A / r) ** 2) + (2 * f + 12 * g * r**2 + 6 * h / r**4) * np.cos(2 * t)
    return radial, hoop


def solve(case):
    nodes = quarter_ring(A, B, AROUND, ACROSS)
    m = case.model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    m.round(0.02)
    m.block(*outline(nodes))
    generate(m, nodes)
    m.insitu(0, B, 0, B, -P, 0, 0)
    m.boundary(-0.001, 0.001, -1, B + 1, xvel=0)
    m.boundary(-1, B + 1, -0.001, 0.001, yvel=0)
    m.boundary(-0.001, B + 0.001, -0.001, B + 0.001, stress=(-P, 0, 0))
    m.boundary(-0.001, A + 0.001, -0.001, A + 0.001, stress=(P, 0, 0))  # the wall is free
    m.fraction(0.6)
    m.damping(0.6, sqrt(1.8e9 / DENSITY) / B / 4, "mass")
    m.solve(1e-4)
    r, radial, hoop, t = polar(m)
    radial_exact, hoop_exact = ring(r, t)
    side = A * np.hypot(np.pi / 2 / AROUND, (B / A) ** (1 / ACROSS) - 1)
    within = {
        "zones, (h/a)^2 of 3 p": 3 * P * (side / A) ** 2,
        "force ratio of rest": 1e-3 * P,
    }
    near = r < A + side
    for what, where in (("above the hole", t > np.radians(86)), ("at its side", t < np.radians(4))):
        k = near & where
        yield Answer(f"hoop stress {what}", "Pa", float(hoop[k].mean()), float(hoop_exact[k].mean()), within)
    inside = r < 3 * A
    for what, got, exact in (("hoop", hoop, hoop_exact), ("radial", radial, radial_exact)):
        off = float(np.sqrt(((got - exact)[inside] ** 2).mean()))
        yield Answer(f"{what} stress for r < 3 a, root of the mean square of errors", "Pa", off, 0.0, within)
    line, mean = np.linspace(0, 90, 91), float(r[near].mean())
    case.graph(
        "angle from the direction of the stress (degrees)",
        f"hoop stress/p at r = {mean:.3f} a",
        {"exact": (line, -ring(mean, np.radians(line))[1] / P)},
        [(np.degrees(t[near]), -hoop[near] / P)],
    )
