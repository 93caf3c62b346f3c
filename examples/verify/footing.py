r"""A strip footing on clay

A smooth, rigid strip of the half width B is pressed into weightless ground without friction, which
yields at the cohesion c. The load that it takes at last:

          | q |             q = (2 + pi) c
     _____|___|______
       \  /\ /\  /          Prandtl's mechanism: a wedge goes down, fans turn, wedges go up
        \/__V__\/

Half of it is meshed, in pairs of zones that have a common change of volume, which without friction is
none; without the pairs zones could flow only where they cannot change their volume one by one.

Tolerance. The strip ends at a grid-point; its pressure goes on to somewhere within the zone beside it,
of the width d, so the width is B + d/2 with an error of d/2 at most. The strip moves with the velocity
v: a wave brings rho Cp v to the pressure before the ground comes to rest.

Source: L. Prandtl, Ueber die Haerte plastischer Koerper (1920); R. Hill, The Mathematical Theory of
Plasticity (1950).
"""

from math import pi, sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, generate, rectangle

BLOCKS = ("fdef",)
WIDE, HIGH, HALF, N, COHESION, V = 10.0, 5.0, 2.0, 30, 1e5, 4e-3
BULK, SHEAR, DENSITY = 2e8, 1e8, 2000.0
CP = sqrt((BULK + 4 * SHEAR / 3) / DENSITY)


def press(case, mixed, n=N):
    """Settlement and load of the strip, m and Pa; mixed: with zones in pairs; n: zones over the width."""
    m = case.model("mohr-coulomb")
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    m.property(1, block_cohesion=COHESION, block_tension=1e9)
    m.round(0.02)
    m.block(0, 0, 0, HIGH, WIDE, HIGH, WIDE, 0, constitutive=2)
    generate(m, rectangle(0, WIDE, 0, HIGH, n, n // 2), mixed=mixed)
    for x in (0.0, WIDE):
        m.boundary(x - 0.001, x + 0.001, -1, HIGH + 1, xvel=0)
    m.boundary(-1, WIDE + 1, -0.001, 0.001, xvel=0, yvel=0)
    m.boundary(-1, HALF + 0.001, HIGH - 0.001, HIGH + 0.001, yvel=-V)
    m.fraction(0.5)
    m.damping(0.6, CP / 4 / HIGH, "mass")
    m.cycle(0)
    d = WIDE / n
    points = m.table("gridpoint")
    under = (points["KXG"] < HALF + 0.001) & (points["KYG"] > HIGH - 0.001)
    sinks, loads = [0.0], [0.0]
    for k in range(1, 41):
        cycle_for(m, 0.02 * HALF / V / 40)
        carried = float(m.table("gridpoint")["KGFY"][under].sum())
        sinks.append(0.02 * HALF * k / 40)
        loads.append(carried / (float(points["KXG"][under].max()) + d / 2))
    return sinks, loads


def solve(case):
    sinks, loads = press(case, mixed=True)
    d = WIDE / N
    exact = (2 + pi) * COHESION
    yield Answer(
        "load that it takes, q",
        "Pa",
        loads[-1],
        exact,
        {"width, d/2": exact * d / 2 / (HALF + d / 2), "waves, rho Cp v": DENSITY * CP * V},
    )
    case.graph(
        "settlement (mm)",
        "load/cohesion",
        {"2 + pi": ([0, 1e3 * sinks[-1]], [2 + pi] * 2)},
        [([1e3 * one for one in sinks], [one / COHESION for one in loads])],
    )
