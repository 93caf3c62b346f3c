"""A flat arch of two blocks

Two blocks hang between two abutments, without mortar. They sag until they touch the abutments at the
bottom and each other at the top, and carry themselves by their thrust:

     |=============|=============|           H = W l/(2 z)
     |      W    ->|<-   W       |           W: weight of one block, l: its length
     |->___________|___________<-|           z = (h - 2D) cos th - l sin th

Contacts are where the rounding begins, at D from the corners. Blocks turn by th until the joints have
closed by H/KN each: th (h - 2D) = 3 H/(2 KN).

Before there is a thrust there is no friction, so the blocks slip down a little; that changes nothing.

Tolerance. That closure and lean are right to the first order: th of H, and as blocks get shorter by l
th^2/2 as they lean, (l/h) th/2 of th. The force ratio of rest.

Source: J. Heyman, The Stone Skeleton (1995); W. Evans, The strength of undermined strata, Trans. Instn
Min. Metall. 50 (1941), for the beam of blocks in a roof.
"""

from math import cos, pi, sin, sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block

BLOCKS = ("rigid",)
REALS = 64  # the blocks wait at rest until they have fallen by more than a last digit
G, DENSITY, KN, L, H, D = 10.0, 2000.0, 1e9, 5.0, 1.0, 0.05
WEIGHT = L * H * DENSITY * G


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=KN, ks=KN, friction=2.0)
    m.fraction(0.1)
    m.round(D)
    m.block(-L - 2, -1, -L - 2, H, L + 2, H, L + 2, -1)
    for x in (-L, L):
        m.split(x, -2, x, 2)
    m.split(-L - 0.5, 0, L + 0.5, 0)
    m.delete(-L, L, -1, 0)
    m.split(0, -1, 0, 2)
    m.fix(-L - 2, -L, -1, H)
    m.fix(L, L + 2, -1, H)
    m.gravity(0, -G)
    m.damping(1.0, sqrt(KN / (WEIGHT / G)) / (2 * pi) / 10, "mass")
    ratio = max(1e-9, 1e4 * case.last_digit)
    m.solve(ratio)
    thrust, th = WEIGHT * L / (2 * (H - 2 * D)), 0.0
    for _ in range(20):
        th = 1.5 * thrust / (KN * (H - 2 * D))
        thrust = WEIGHT * L / (2 * ((H - 2 * D) * cos(th) - L * sin(th)))
    contacts = m.table("contact")
    case.draw(m, contacts=True)
    middle = abs(contacts["KXC"]) < 0.1
    corners = m.table("corner")
    own = corners[corners["KNB"] == block(m, -L / 2, H / 2)["address"]]
    left, right = own["KXP"] < -L / 2, own["KXP"] > -L / 2
    lean = float(own["KYP"][left].mean() - own["KYP"][right].mean()) / L
    digits = 100 * case.last_digit * KN * L / thrust
    within = {"first order in th": th, "force ratio of rest": 10 * ratio, "last digits of places": digits}
    for what, unit, got, exact in (
        ("thrust H at midspan", "N/m", float(contacts["KCFN"][middle].sum()), thrust),
        ("thrust at an abutment", "N/m", float(contacts["KCFN"][contacts["KXC"] > 1].sum()), thrust),
        ("lean th", "rad", lean, th),
    ):
        more = {"(L/h) th/2": th * L / H / 2} if what == "lean th" else {}
        yield Answer(what, unit, got, exact, {name: part * exact for name, part in (within | more).items()})
