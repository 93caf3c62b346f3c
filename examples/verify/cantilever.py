"""Deflection of a cantilever

A beam of the height h and the length L is clamped on the left; a shear stress pulls the right end down:

     ///|------------|          u = P L^3/(3 E I) + P L/(k G h)
     ///|____________| | P      I = h^3/12,  k = 5/6
             L         v

There is no Poisson effect, K = 2G/3, so that E = 2G in plane strain, too. Zones with one strain are too
stiff in bending; the error goes with the square of their size d, so that u(d) and u(d/2) give u(0) = (4
u(d/2) - u(d))/3.

Tolerance. What the two meshes differ in beyond the square: a quarter of the last correction. The clamp
keeps the section plane, for which k is 1 and not 5/6: P L/(5 G h), as far as it reaches. Strain, and
the force ratio of rest.

Source: S. Timoshenko and J. Goodier, Theory of Elasticity (1934); L. Richardson (1911) for the
extrapolation.
"""

from math import sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, rectangle

BLOCKS = ("fdef",)
REALS = 64  # strains are some 1e-5
LENGTH, HIGH, SHEAR, DENSITY, STRESS = 5.0, 1.0, 1e9, 2000.0, 1e4
EXACT = 4 * STRESS * LENGTH**3 / (2 * SHEAR * HIGH**2) + 1.2 * STRESS * LENGTH / SHEAR


def deflection(case, n, draw):
    """Of the end, with n zones over the height, m."""
    m = case.model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=2 * SHEAR / 3, g=SHEAR)
    m.round(0.02)
    m.block(0, 0, 0, HIGH, LENGTH, HIGH, LENGTH, 0)
    generate(m, rectangle(0, LENGTH, 0, HIGH, int(n * LENGTH), n))
    m.boundary(-0.01, 0.01, -1, HIGH + 1, xvel=0, yvel=0)
    m.boundary(LENGTH - 0.01, LENGTH + 0.01, -1, HIGH + 1, stress=(0, -STRESS, 0))
    m.fraction(0.5)
    m.damping(2.0, 3.52 / 6.28 * sqrt(2 * SHEAR * HIGH**2 / 12 / DENSITY) / LENGTH**2, "mass")
    points = m.table("gridpoint")
    end = points["KXG"] > LENGTH - 1e-6
    before = float(points["KYG"][end].mean())
    m.solve(1e-4, 40_000)
    if draw:
        case.draw(m, contour="s11")
    return before - float(m.table("gridpoint")["KYG"][end].mean())


def solve(case):
    coarse, fine = deflection(case, 6, False), deflection(case, 12, True)
    correction = (fine - coarse) / 3
    yield Answer(
        "deflection of the end",
        "m",
        fine + correction,
        EXACT,
        {
            "a quarter of the last correction": correction / 4,
            "clamp, P L/(5 G h)": 0.2 * STRESS * LENGTH / SHEAR,
            "strain": EXACT * 6 * STRESS * LENGTH / HIGH / (2 * SHEAR),
            "force ratio of rest": 1e-3 * EXACT,
        },
    )
