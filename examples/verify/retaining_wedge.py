r"""A wedge of rock leans on a wall

A wedge has slid down a plane of the inclination psi until it leans on a vertical wall. Friction, mu, is
mobilised on both:

         |.---. |         N sin psi - mu N cos psi - F = 0             N: normal force of the plane
     wall| \   \|         N cos psi + mu N sin psi + mu F - W = 0      F: normal force of the wall
         |  \ .'
         | .'  psi        F = W tan(psi - phi)/(1 + tan phi tan(psi - phi))

so that the wall bears less than W tan(psi - phi), Coulomb's pressure without friction on the wall.
Gravity grows little by little, with more than critical damping: so the wedge never comes back, and all
its contacts slip.

Tolerance. The force ratio at which the run was ended. The wedge turns as its contacts give way, W/KN
over their distances, and with it the faces that they are on.

Source: C. A. Coulomb, Essai sur une application des regles de maximis et minimis (1776).
"""

from math import cos, pi, radians, sin, sqrt, tan

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block

BLOCKS = ("rigid",)
REALS = 64  # overlaps are 0.1 mm at 8 m, and rest is to be to 1e-8
G, DENSITY, K, PSI, PHI, WIDE, HIGH = 10.0, 2000.0, 1e9, radians(55), radians(25), 3.0, 6.0


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, friction=tan(PHI))
    m.fraction(0.1)
    m.round(0.1)
    m.block(-2, -2, -2, HIGH, 8, HIGH, 8, -2)
    m.split(0, -3, 0, HIGH + 1)  # the wall
    m.split(-0.5, -0.5 * tan(PSI), 0.0 + 6, 6 * tan(PSI))
    m.fix(-2, 0, -2, HIGH)
    below = block(m, 5, 0)
    m.fix(
        float(below["KX"]) - 0.1, float(below["KX"]) + 0.1, float(below["KY"]) - 0.1, float(below["KY"]) + 0.1
    )
    m.gravity(0, -G)
    mass = DENSITY * HIGH**2 / tan(PSI) / 2
    m.damping(3.0, sqrt(4 * K / mass) / (2 * pi), "mass")
    ratio = max(1e-8, 1e4 * case.last_digit)
    for part in range(1, 21):
        m.gravity(0, -G * part / 20)
        m.solve(1e-4 if part < 20 else ratio)
    case.draw(m, contacts=True)
    contacts = m.table("contact")
    wall = (abs(contacts["KXC"]) < 0.02) & (contacts["KCFN"] > 0)
    plane = (contacts["KXC"] > 0.02) & (contacts["KCFN"] > 0)
    mu, weight = tan(PHI), mass * G
    n = weight / (cos(PSI) + mu * sin(PSI) + mu * (sin(PSI) - mu * cos(PSI)))
    sinks = weight / K / (HIGH / 3)
    for what, chosen, exact in (
        ("force on the wall, F", wall, n * (sin(PSI) - mu * cos(PSI))),
        ("force on the plane, N", plane, n),
    ):
        yield Answer(
            what,
            "N/m",
            float(contacts["KCFN"][chosen].sum()),
            exact,
            {"turn of the wedge": 2 * sinks * weight, "force ratio of rest": 10 * ratio * weight},
        )
