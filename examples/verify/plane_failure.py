"""Factor of safety of a block on a plane

Friction and cohesion hold a block on a plane of the inclination psi. How many times weaker could both
be?

           ___
       .-'   /         F = tan phi/tan psi + c L/(W sin psi)
      /___.-'
     .-' psi           c L: the sum of the cohesions of both contacts

Friction and cohesion are divided by a trial factor and the block is watched: it holds or it slides. The
factor is found by bisection, each time from the same state of rest.

Tolerance. Half of the last interval. A block that is too weak by d is not seen to slide if d g sin psi
T^2/2 is less than the way that is looked for; and a block that still swings by a share of its weight
slips a little early.

Source: E. Hoek and J. Bray, Rock Slope Engineering (1974), plane failure.
"""

from math import pi, radians, sin, sqrt, tan

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, on_base, row, settle, tilt

BLOCKS = ("rigid", "sdef", "fdef")
G, DENSITY, K, D = 10.0, 2000.0, 1e9, 0.1
WIDE, HIGH, PSI, PHI, COHESION = 4.0, 1.0, radians(35), radians(30), 2e4  # N/m of each contact
MASS = DENSITY * WIDE * HIGH
WATCHED, SLID = 0.4, 1e-3


def slides(case, factor, draw=False):
    """True if the block slides with friction and cohesion divided by `factor`."""
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, bulk=4e9, g=2e9, friction=2.0)
    m.fraction(0.2)
    m.round(D)
    on_base(case, m, WIDE, HIGH, width=12)
    m.gravity(0, -G)
    settle(case, m, 2 * K, MASS)
    m.damping(2.0, sqrt(2 * K / MASS) / (2 * pi), "mass")
    m.damping(1.0, sqrt(2 * K / MASS) / (2 * pi), "internal")
    tilt(m, G, PSI, steps=4)
    m.solve(1e-6)
    blocks = m.table("block")
    address = int(blocks["address"][blocks["KBFIX"] == 0][0])
    before = float(row(m, "block", address)["KX"])
    m.damping(0.1, sqrt(2 * K / MASS) / (2 * pi), "stiffness")
    if draw:
        case.draw(m, contacts=True)
    m.property(1, friction=tan(PHI) / factor, cohesion=COHESION / factor)
    cycle_for(m, WATCHED)
    return float(row(m, "block", address)["KX"]) - before > SLID


def solve(case):
    exact = tan(PHI) / tan(PSI) + 2 * COHESION / (MASS * G * sin(PSI))
    low, high = 0.5, 3.0
    slides(case, low, draw=True)
    while high - low > 0.005:
        middle = (low + high) / 2
        low, high = (low, middle) if slides(case, middle) else (middle, high)
    yield Answer(
        "factor of safety",
        "",
        (low + high) / 2,
        exact,
        {
            "bisection": (high - low) / 2,
            f"{1e3 * SLID:g} mm in {WATCHED:g} s": exact * 2 * SLID / (G * sin(PSI) * WATCHED**2),
            "force ratio of rest": 1e-6 * exact,
        },
    )
