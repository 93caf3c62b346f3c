r"""Factor of safety of a slope with two joint sets that topples forward (published)

A slope 260 m high, at 55 degrees, with joints at 70 degrees, 20 m apart, and at -20 degrees, 30 m apart:

      ______
     / / / /\
    /-/-/-/-/\______
    / / / / / / / /

Columns of blocks topple forward on the joints at -20 degrees. Friction is 40 degrees, without cohesion; the
outermost blocks at the sides and at the base are fixed.

Tolerance. Half a unit of the second decimal, and 4 %: two programs have 1.09 to 1.13, and close to failure
trials that neither come to rest nor fall make the bracket wide.

Source: L. Lorig, P. Varona, Numerical analysis, chapter 10 of D. C. Wyllie, C. W. Mah, Rock slope
engineering, 4th edition (2004), with UDEC: 1.13. It is problem 3 of the joint verification manual of RS2,
which has 1.12.
"""

from math import radians, tan

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64
KN, KS, ROUNDING, DENSITY = 1e11, 1e10, 0.04, 2660.0
OUTLINE = ((0, 0), (0, 400), (377.785587, 400), (560, 140), (700, 140), (700, 0))
PUBLISHED = 1.13


def solve(case):
    m = case.model()
    m.gravity(0, -9.81)
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=KN, ks=KS, friction=5.0, between=(1, 1))  # holds until the slope is at rest
    m.block(*(c for corner in OUTLINE for c in corner))
    m.jset(70, spacing=20)
    m.jset(-20, spacing=30)
    m.round(ROUNDING)
    for outermost in ((0, 20, 0, 400), (680, 700, 0, 400), (0, 700, 0, 20)):
        m.fix(*outermost)
    m.solve(1e-5, static=True)
    m.jproperty(1, friction=tan(radians(40)))
    found = m.fos(joints=True, tolerance=0.01, picture=False)
    within = {"difference between programs": 0.04 * PUBLISHED, "printed digits": 0.005}
    yield Answer("factor of safety", "", found.factor, PUBLISHED, within)
    case.draw(m, contacts=True)
