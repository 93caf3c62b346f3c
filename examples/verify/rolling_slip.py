"""A ball rolls down a slope, or slips as it rolls

On a slope of the angle b a ball rolls as long as friction can turn it fast enough; on a steeper one it
slips:

          ( )            rolls:  a = g sin b/(1 + I/(m R^2))      if tan b < mu (1 + m R^2/I)
        .-'              slips:  a = g (sin b - mu cos b)         if not,
     .-'  b                      R w' = mu g cos b m R^2/I

The ball is a square that is rounded with the radius R, half its edge L but for a part in 1000; its
moment of inertia is the square's, m L^2/6. The slope is drawn level, and gravity is turned.

Tolerance. The four arcs have their centres c = sqrt(2) (L/2 - R) beside the centroid: by the law of
energy that is a shift of the way by c/sin b, and of the velocity reached, v, by a c/(v sin b); normal
forces change as if g did by w^2 c. At the beginning the contact swings with the give of its spring.

Source: any textbook of mechanics, as E. Routh, Dynamics of a System of Rigid Bodies (1860).
"""

from math import cos, pi, radians, sin, sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, now, row

BLOCKS = ("rigid",)
G, MU, L, K, DENSITY = 10.0, 0.3, 1.0, 1e8, 2000.0
R, MASS, INERTIA = 0.4995 * L, DENSITY * L**2, DENSITY * L**4 / 6
TIME = 1.5


def solve(case):
    for degrees in (25, 50):
        b = radians(degrees)
        m = case.model()
        m.property(1, density=DENSITY, kn=K, ks=K, friction=MU)
        m.fraction(0.05)
        m.gravity(0, -G * cos(b))
        m.round(R)
        m.block(0, -1, 0, 1, 15, 1, 15, -1)
        m.split(-1, 0, 16, 0)
        m.split(1, -0.5, 1, 2)
        m.delete(1, 15, 0, 1)
        m.fix(0, 15, -1, 0)
        m.damping(2.0, sqrt(K / MASS) / (2 * pi), "stiffness")
        m.cycle(1000)
        blocks = m.table("block")
        address = int(blocks["address"][blocks["KBFIX"] == 0][0])
        first = row(m, "block", address)
        m.damping(0.2, sqrt(K / MASS) / (2 * pi), "stiffness")
        m.gravity(G * sin(b), -G * cos(b))
        begin = now(m)
        for _ in range(4 if degrees == 50 else 1):
            if degrees == 50:
                case.draw(m, window=(-0.2, 9, -1.2, 1.5))
            cycle_for(m, TIME / (4 if degrees == 50 else 1))
        ball, t = row(m, "block", address), now(m) - begin
        slips = degrees == 50
        a = G * (sin(b) - MU * cos(b)) if slips else G * sin(b) / (1 + INERTIA / (MASS * R**2))
        turn = MU * G * cos(b) * MASS * R**2 / INERTIA if slips else a
        c = sqrt(2) * (L / 2 - R)
        speed = float(ball["KXD"] - first["KXD"])
        arcs = a * c / (a * t * sin(b)) + (a * t / R) ** 2 * c * MU
        swing = G * sqrt(MASS / K) * sin(b) / t
        for what, got, exact in (
            ("down the slope", speed, a),
            ("of the rim, R w'", -R * float(ball["KTD"]), turn),
        ):
            yield Answer(
                f"{degrees} degrees, it {'slips' if slips else 'rolls'}: {what}",
                "m/s2",
                got / t,
                exact,
                {"centres of the arcs": arcs / t + c * exact / R, "swing of the contact": swing},
            )
    case.draw(m, window=(-0.2, 9, -1.2, 1.5))
