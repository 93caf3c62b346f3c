"""A beam in three-point bending cracks at midspan

A beam of zones rests on two points at the distance L. A point above its middle is pressed down slowly:

                | P
     +----------v----------+       s = 3 P L/(2 h^2) - 0.266 P/h     at the lower edge, midspan
     |                     | h
     +--+---------------+--+       cracks at s = T
        ^               ^
        |<----- L ----->|          the crack runs along zone sides, from edge to edge

The second term is the local effect of the load. Zones of constant strain have the stress of their centroids,
1 - 2/(3 n) of that at the edge with n rows of zones, so that P is greater by as much.

Tolerance. Rows of zones: half of that share. Steps of the load at which it is read. Reactions swing a little.

Source: S. Timoshenko and J. Goodier, Theory of Elasticity (1951), section 40.
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, outline, rectangle

BLOCKS = ("fdef",)
REALS = 64  # it is bent by a few micrometres in a step
ROWS, SPAN, BEYOND, HIGH, D = 16, 4.0, 0.25, 1.0, 0.01
T, DENSITY, BULK, SHEAR = 1e5, 2000.0, 1e9, 6e8
SPEED, PIECE = 5e-4, 50  # m/s, cycles
ALL = (-9.0, 9.0, -9.0, 9.0)


def beam(case):
    """The beam, on its supports and under the moving point."""
    m = case.model()
    m.property(1, density=DENSITY, bulk=BULK, g=SHEAR)
    wide = SPAN / 2 + BEYOND
    nodes = rectangle(-wide, wide, 0.0, HIGH, round(2 * wide / HIGH * ROWS), ROWS)
    m.block(*outline(nodes))
    m.round(D)
    generate(m, nodes)
    m.jproperty(1, kn=1e11, ks=1e11, friction=0.6)
    for x in (-SPAN / 2, SPAN / 2):
        m.boundary(x - 0.01, x + 0.01, -0.01, 0.01, yvel=0.0)
    m.boundary(-0.01, 0.01, HIGH - 0.01, HIGH + 0.01, xvel=0.0, yvel=-SPEED)
    m.damping(local=0.8)
    m.fraction(0.5, safe=True)
    m.breakage(*ALL, tension=T, smallest=0.5, jmaterial=1)
    return m


def force(m):
    """Of the point, N/m."""
    rows = m.reactions(-0.01, 0.01, HIGH / 2, HIGH + 0.1)
    return -float(rows["fy"].sum())


def solve(case):
    m = beam(case)
    before = after = 0.0
    while not len(m.cracks()):
        before, after = after, force(m) if after or before else 0.0
        m.cycle(PIECE)
        after = force(m)
    (crack,) = m.cracks()
    case.draw(m, contour="s11", cracks=True)
    share = 2 / (3 * ROWS)
    exact = T / (1 - share) / (1.5 * SPAN / HIGH**2 - 0.266 / HIGH)
    yield Answer(
        "force at which it cracks",
        "N/m",
        (before + after) / 2,
        exact,
        {"rows of zones": share / 2 * exact, "steps of the load": abs(after - before)},
    )
    yield Answer("place of the crack", "m", (crack["x1"] + crack["x2"]) / 2, 0.0, {"a zone": HIGH / ROWS})
