"""Compression between walls

A deformable block stands between two fixed walls, without friction, and is pressed from above by s. It
cannot spread, but for the give of the contacts with the walls:

     ||    s   ||         s22 = -s
     || +----+ ||         s11 h = -2 KN e11 w/2        two contacts on each wall
     || |    | ||         s11 = a e11 + b e22,  s22 = b e11 + a e22
     || +----+ ||         a = K + 4G/3,  b = K - 2G/3
    --------------

With stiff walls, e11 = 0: the modulus is a, and the stress on the walls is s b/a = s nu/(1 - nu), the
pressure at rest.

Tolerance. The force ratio at which the run was ended; a strain e changes the lengths that forces act on
by a share of 2e.

Source: K. Terzaghi (1925) for the test; R. Hooke's law in plane strain.
"""

from math import pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer

BLOCKS = ("sdef", "fdef")
BULK, SHEAR, KN, DENSITY, B, H, STRESS = 2e9, 1e9, 4e9, 2000.0, 2.0, 1.5, 1e5


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=KN, ks=KN, bulk=BULK, g=SHEAR, friction=0)
    m.fraction(0.2)
    m.round(0.1)
    m.block(-2, -1, -2, H, 2, H, 2, -1)
    m.split(-3, 0, 3, 0)
    m.split(-B / 2, -0.5, -B / 2, H + 1)
    m.split(B / 2, -0.5, B / 2, H + 1)
    m.fix(-2, -B / 2, 0, H)
    m.fix(B / 2, 2, 0, H)
    m.fix(-2, 2, -1, 0)
    case.deform(m, -B / 2, B / 2, 0, H)
    m.boundary(-B / 2 - 0.01, B / 2 + 0.01, H - 0.01, H + 0.01, stress=(0, 0, -STRESS))
    frequency = sqrt(KN / (DENSITY * B * H)) / (2 * pi)
    m.damping(1.0, frequency, "mass")
    m.damping(1.0, frequency, "internal")
    ratio = max(1e-9, 1e4 * case.last_digit)
    m.solve(ratio)
    a, b = BULK + 4 * SHEAR / 3, BULK - 2 * SHEAR / 3
    # s11 = -KN b/h e11 = a e11 + b e22  and  b e11 + a e22 = -s
    e11, e22 = np.linalg.solve([[a + KN * B / H, b], [b, a]], [0, -STRESS])
    if case.blocks == "sdef":
        own = m.table("sdef")
        s11, s22 = float(own["KS111"][0]), float(own["KS122"][0])
    else:
        s11, s22 = float(m.table("zone")["KZS11"].mean()), float(m.table("zone")["KZS22"].mean())
    strain = (a * s22 - b * s11) / (a**2 - b**2)
    inside = {
        "strain, 2 e": 2 * abs(e22),
        "force ratio of rest": 10 * ratio,
        "last digits": 4e3 * case.last_digit * B * KN / STRESS / 1e3,
    }
    for what, unit, got, exact in (
        ("stress on the walls", "Pa", s11, -KN * B / H * e11),
        ("vertical stress", "Pa", s22, -STRESS),
        ("vertical strain", "", strain, e22),
    ):
        yield Answer(
            what, unit, got, float(exact), {name: part * abs(float(exact)) for name, part in inside.items()}
        )
    case.draw(m, contacts=True)
