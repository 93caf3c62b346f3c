"""Rotation of a zoned block

A couple turns a free block of stiff material, b wide and h high, that has 2 to 256 zones:

      F ->  +-----+            alpha = F h/(r I)         I = rho b h (b2 + h2)/12
            |     |  h
            |     |            r = 1 + sum m (k2 + l2 + n2)/(12 I)
            +-----+ <- F
               b

A third of the mass m of each zone is at each of its corners. Their moment of inertia is greater than that
of the zone, whose sides are k, l and n, by m (k2 + l2 + n2)/12. So the block turns more slowly than the
body by the factor r, which is 3 with two zones and decreases with the square of their size.

Tolerance. The arms of the couple shorten by the square of the angle, and lengthen or shorten by the strain.

Source: moments of inertia of a triangle and of three points, H. Lamb, Dynamics (1914).
"""

from math import cos

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, now, rectangle

BLOCKS = ("fdef",)
B, H, DENSITY, SHEAR, FORCE = 1.0, 2.0, 2000.0, 1e10, 1e4
BODY = DENSITY * B * H * (B * B + H * H) / 12
CELLS = ((1, 1), (1, 2), (2, 4), (4, 8), (8, 16))
ANGLE = 0.01


def ratio(nx, ny):
    """Moment of inertia of the masses at the grid-points over that of the body."""
    dx, dy = B / nx, H / ny
    return 1 + DENSITY * B * H * 2 * (dx * dx + dy * dy) / 12 / BODY


def solve(case):
    zones, computed = [], []
    for nx, ny in CELLS:
        m = case.model()
        m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=2 * SHEAR, g=SHEAR)
        m.round(0.01)
        m.block(0, 0, 0, H, B, H, B, 0)
        generate(m, rectangle(0, B, 0, H, nx, ny))
        for y, force in ((H, FORCE), (0, -FORCE)):
            m.boundary(-0.01, 0.01, y - 0.01, y + 0.01, xforce=force / 2)
            m.boundary(B - 0.01, B + 0.01, y - 0.01, y + 0.01, xforce=force / 2)
        m.fraction(0.5)
        m.cycle(0)
        exact = -FORCE * H / (ratio(nx, ny) * BODY)
        m.cycle(1)
        start, t0 = float(m.table("block")["KTD"][0]), now(m)
        cycles = int((2 * ANGLE / abs(exact)) ** 0.5 / t0)
        m.cycle(cycles)
        found = (float(m.table("block")["KTD"][0]) - start) / (now(m) - t0)
        zones.append(2 * nx * ny)
        computed.append(found / (exact * ratio(nx, ny)))
        strain = FORCE / B / SHEAR
        yield Answer(
            f"acceleration with {2 * nx * ny} zones",
            "rad/s2",
            found,
            exact,
            {
                "angle": abs(exact) * (1 - cos(ANGLE)),
                "strain": abs(exact) * 4 * strain,
                "last digits": abs(exact) * 1e4 * case.last_digit,
            },
        )
    cells = np.array(CELLS, float)
    case.graph(
        "zones",
        "acceleration over that of the body",
        {"1/r": (np.array(zones, float), 1 / np.array([ratio(nx, ny) for nx, ny in cells]))},
        [(zones, computed)],
    )
