r"""A wedge in the roof of an opening

A wedge hangs between two joints in the roof, each inclined by al to the vertical. The rock has pressed
on it horizontally with the force H; now the rock is held and the wedge is pulled down. How much does it
bear?

            ____
     H ->  /    \  <- H      N = H cos al - KN v sin al      S = H sin al + KS v cos al
    ______/______\______         slips when S = N tan phi
             |               P = 2 (S cos al - N sin al)
             P                 = 2 H (KS cos^2 al + KN sin^2 al) sin(phi - al)
                                 / (cos phi (KS cos al + KN sin al tan phi))

N and S are the forces of a joint, v the way of the wedge. The wedge is fixed while the rock moves in,
with KS = KN so that the forces are horizontal; then the rock stays where it is, KS is given its value,
the wedge is set free and gravity grows until the wedge comes out.

Tolerance. H: half a step of the rock's way. P: half of the last increment of gravity, and the force
ratio at which each increment was ended.

Source: B. Brady and E. Brown, Rock Mechanics for Underground Mining (1985), chapter 9, after J. Bray (1977).
"""

from math import cos, pi, radians, sin, sqrt, tan

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, row, step

BLOCKS = ("rigid",)
REALS = 64  # overlaps are 0.5 mm at 4 m, and rest is to be to 1e-5
AL, PHI, KN, KS, DENSITY, DEPTH, TOP = radians(20), radians(45), 1e9, 2.5e8, 2000.0, 4.0, 1.0
FORCE = 1e6  # H, N/m


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=KN, ks=KN, friction=2.0)
    m.fraction(0.1)
    m.round(0.1)
    slant = DEPTH * tan(AL)
    m.block(-4, 0, -4, DEPTH, 4, DEPTH, 4, 0)
    m.split(-TOP, DEPTH, -TOP - slant, 0)
    m.split(TOP, DEPTH, TOP + slant, 0)
    m.fix(-0.5, 0.5, 0, DEPTH)
    wedge = block(m, 0, DEPTH / 2)
    # both sides move in by d: N = 2 KN d cos al, S = 2 KN d sin al, so that H = 2 KN d
    m.boundary(-4, -1, 0, DEPTH, xvel=0.01, yvel=0)
    m.boundary(1, 4, 0, DEPTH, xvel=-0.01, yvel=0)
    m.cycle(0)
    m.cycle(round(FORCE / (2 * KN) / 0.01 / step(m)))
    m.boundary(-4, -1, 0, DEPTH, xvel=0, yvel=0)
    m.boundary(1, 4, 0, DEPTH, xvel=0, yvel=0)
    m.free(-0.5, 0.5, 0, DEPTH)
    m.property(1, ks=KS, friction=tan(PHI))
    mass, address = float(wedge["KBM"]), int(wedge["address"])
    mass = DENSITY * DEPTH * (2 * TOP + slant)
    pressed = m.table("contact")
    h = float((pressed["KCFN"] * cos(AL) + abs(pressed["KCFS"]) * sin(AL)).sum()) / 2
    yield Answer("H, by the way of the rock", "N/m", h, FORCE, {"half a step": 0.5 * step(m) * 0.01 * 2 * KN})
    case.draw(m, contacts=True)
    m.damping(2.0, sqrt(4 * KS / mass) / (2 * pi), "mass")
    exact = (
        2
        * h
        * (KS * cos(AL) ** 2 + KN * sin(AL) ** 2)
        * sin(PHI - AL)
        / (cos(PHI) * (KS * cos(AL) + KN * sin(AL) * tan(PHI)))
    )
    g, more = 0.4837 * exact / mass, 0.001 * exact / mass
    m.gravity(0, -g)
    m.solve(1e-5)
    while row(m, "block", address)["KY"] > float(wedge["KY"]) - 0.005:
        g += more
        m.gravity(0, -g)
        if not m.solve(1e-5, 5000):
            break
    m.cycle(2000)
    case.draw(m)
    yield Answer(
        "weight that pulls it out, P",
        "N/m",
        (g - more / 2) * mass,
        exact,
        {"half of an increment": more * mass / 2, "force ratio of rest": 1e-5 * exact},
    )
