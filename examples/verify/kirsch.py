"""A round hole in rock that is pressed from two sides

Rock with a hole of the radius a is under the stress p in the direction of x only:

            _             hoop stress at the wall  p (1 - 2 cos 2t)
    p ->   ( )   <- p       3 p above and below the hole, t = 90 degrees
            -               -p, tension, at its sides, t = 0

and in the rock around, with the angle t from x and q = a^2/r^2:

    hoop stress    p/2 (1 + q) - p/2 (1 + 3 q^2) cos 2t
    radial stress  p/2 (1 - q) + p/2 (1 - 4 q + 3 q^2) cos 2t

A quarter of it, with rollers, is a ring of zones from a to b = 15 a. The rock begins with its stress, then the wall is set free.

Tolerance. Zones have one stress, that of their middle to the second order: (h/a)^2, with the longest side h of a zone at the
wall, for a stress that is up to 3 p. The ring ends at b: p (a/b)^2. The force ratio at which the run was ended.

Source: G. Kirsch, Die Theorie der Elasticitaet und die Beduerfnisse der Festigkeitslehre, VDI-Zeitschrift 42 (1898).
"""

from math import sqrt

import numpy as np

from udec_ia.verify import Answer
from udec_ia.verify.grids import generate, outline, polar, quarter_ring

BLOCKS = ("fdef",)
A, B, P, BULK, SHEAR, DENSITY, AROUND, ACROSS = 1.0, 15.0, 1e6, 1e9, 6e8, 2000.0, 24, 34


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
    q, c = (A / r) ** 2, np.cos(2 * t)
    hoop_exact = -P / 2 * ((1 + q) - (1 + 3 * q**2) * c)
    radial_exact = -P / 2 * ((1 - q) + (1 - 4 * q + 3 * q**2) * c)
    side = max(A * np.pi / 2 / AROUND, A * ((B / A) ** (1 / ACROSS) - 1))
    within = {
        "zones, (h/a)^2 of 3 p": 3 * P * (side / A) ** 2,
        "end of the ring": P * (A / B) ** 2,
        "force ratio of rest": 1e-3 * P,
    }
    near = r < A + side
    for what, where in (("above the hole", t > np.radians(86)), ("at its side", t < np.radians(4))):
        k = near & where
        yield Answer(
            f"hoop stress {what}", "Pa", float(hoop[k].mean()), float(hoop_exact[k].mean()), within
        )
    inside = r < 3 * A
    for what, got, exact in (("hoop", hoop, hoop_exact), ("radial", radial, radial_exact)):
        off = float(np.sqrt(((got - exact)[inside] ** 2).mean()))
        yield Answer(f"{what} stress for r < 3 a, root of the mean square of errors", "Pa", off, 0.0, within)
    line = np.linspace(0, 90, 91)
    ring = near & (np.arange(len(r)) % 2 == 0)
    mean = float(r[ring].mean())
    q = (A / mean) ** 2
    curve = 0.5 * ((1 + q) - (1 + 3 * q**2) * np.cos(2 * np.radians(line)))
    case.graph(
        "angle from the direction of the stress (degrees)",
        "hoop stress/p in the zones at the wall",
        {f"Kirsch, r = {mean:.3f} a": (line, curve)},
        {"zones": (np.degrees(t[ring]), -hoop[ring] / P)},
    )
