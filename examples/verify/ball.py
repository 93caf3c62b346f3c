"""A ball rests, and rolls down a slope

The first example of the report: a square block, rounded until it is nearly a circle of the radius R,
lies on a slope of the angle b, tan b = 1/2. First gravity is at right angles to the slope, and the ball
sinks in until its one contact carries its weight. Then gravity points downwards and it rolls:

                 ( )             F = m g cos b,  u = F/KN
              .-'                a = g sin b/(1 + I/(m R^2))
           .-'                   travelled s = a t^2/2
        .-'  b

I is the square's moment of inertia, m L^2/6: blocks are rounded for their contacts only, not for their
mass.

Tolerance. The swing on the contact has died down by exp(-ALPHA t/2) when the ball rests. R is a little
less than half the edge L: the ball stands on one of four arcs, whose centre is beside the centroid by d
= L/2 - R. So it rolls even then, held by mass damping, which takes a share d^2/(I/m + R^2) of the
weight. As it rolls down, the centroid rises and sinks by c = sqrt(2) d, which by the law of energy is a
shift of s by c/sin b. And the contact gives way in shear by T/KS, with the friction T that makes the
ball turn; it may swing to twice that.

Source: P. Cundall, UDEC - A Generalised Distinct Element Program for Modelling Jointed Rock (1980),
Appendix II-1; the formulas are those of any textbook of mechanics.
"""

from math import atan, cos, exp, hypot, sin, sqrt

from udec_ia.layout.offsets import ALPHA
from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, now

BLOCKS = ("rigid",)
G, R, KN = 10.0, 1.115, 1e8
L, SLOPE = sqrt(5), atan(1 / 2)  # of the deck: the edge of the ball, the angle b
MASS = 2000 * L**2
FORCE = MASS * G * cos(SLOPE)  # gravity (4, -8) is at right angles to the slope, and as strong as that part
ROLLING = G * sin(SLOPE) / (1 + L**2 / (6 * R**2))
SETTLE = """
START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=2.
GRAVITY 4. -8.
DAMP 0.5 16. MASS
FRAC 0.10
BLOCK 0.,-2.  0.,10.5  14.,10.5  14.,-2.
* the slope, then the four sides of the ball
SPLIT -1.,.5  15.,8.5
SPLIT 10.5,5.  7.5,11.
SPLIT 12.5,6.  10.,11.
SPLIT -1.,3.  12.,9.5
DELETE 0.,9.  4.,7.
DELETE 0.,9.  6.,10.
DELETE 8.,11. 8.,11.
DELETE 11.,14. 7.,11.
FIX 0.,14. 0.,6.
ROUND 1.115
CYCLE 300
"""


def solve(case):
    m = case.model()
    m.run(SETTLE)
    case.draw(m)
    (contact,) = (one for one in m.table("contact") if one["KCFN"] > 0)
    swing = exp(-float(m.h.cr[ALPHA]) * now(m) / 2)
    places = 8 * case.last_digit * 14 / (FORCE / KN)  # two coordinates, a centre and a radius; of 14 m
    rolls = (L / 2 - R) ** 2 / (L**2 / 6 + R**2)
    within = {"rest of the swing": 1.1 * swing, "slow roll": rolls, "last digits of places": places}
    for what, unit, computed, exact in (
        ("normal force F", "N/m", contact["KCFN"], FORCE),
        ("overlap u", "m", contact["KCN"], FORCE / KN),
    ):
        yield Answer(what, unit, computed, exact, {name: part * exact for name, part in within.items()})

    start, t0 = block(m, 10, 9), now(m)
    m.run("PROP MAT=1 F=0.80\nDAMP 0.10 30 STIFFNESS\nGRAVITY 0. -10.\n")
    give = 2 * MASS * (G * sin(SLOPE) - ROLLING) / KN
    for _ in range(5):
        m.cycle(200)
        case.draw(m)
        ball = next(one for one in m.table("block") if one["KBFIX"] == 0)
        exact = ROLLING * (now(m) - t0) ** 2 / 2
        way = hypot(ball["KX"] - start["KX"], ball["KY"] - start["KY"])
        yield Answer(
            f"travelled in {now(m) - t0:.1f} s",
            "m",
            way,
            exact,
            {
                "centres of the arcs, c/sin b": sqrt(2) * (L / 2 - R) / sin(SLOPE),
                "give of the contact": give,
                "last digits of places": 200 * case.last_digit * 14,
            },
        )
