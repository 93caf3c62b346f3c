"""A block slides down an incline, or stays

A block lies on a plane that is inclined by psi. Its weight has a part along the plane, and friction
with the coefficient mu = tan phi acts against it:

          ___
      .-'   /            a = g (sin psi - mu cos psi)       if psi > phi
     /___.-'             a = 0                              if psi < phi
    .-' psi              u = W sin psi (1/(2 KS) + (h/2)^2/(2 KN e^2))

The plane is drawn level here, and gravity is turned: it is the same problem. A rigid block that stays
gives way by u on the springs of its two contacts, which are at the distance e = b/2 - D from its
middle: it shifts, and as the weight acts at half its height h/2 it also leans.

Tolerance. A constant force is integrated exactly. Around the mean the block swings on its springs:
velocities that leave the straight line through them by A tilt it by at most 3 A/T in a time T. At rest
there is the force ratio at which the run was ended, and the lean makes the weight's arm longer by a
share of u/h.

Source: C. A. Coulomb, Theorie des machines simples (1785); any textbook of mechanics.
"""

from math import cos, pi, radians, sin, sqrt, tan

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, now, on_base, row, settle, straight_line, tilt

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # it gives way by 13 micrometres
G, DENSITY, K, D = 10.0, 2000.0, 1e9, 0.1
WIDE, HIGH, PSI = 2.0, 1.0, radians(30)
MASS = DENSITY * WIDE * HIGH
LOWEST = sqrt(2 * K / MASS)  # a mass on the springs of two contacts, rad/s


def on_plane(case, phi):
    """The model with friction tan phi, at rest on the level, and the address of its block."""
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, bulk=4e9, g=2e9, friction=tan(radians(phi)))
    m.fraction(0.1)
    m.round(D)
    on_base(case, m, WIDE, HIGH, width=40)
    m.gravity(0, -G)
    settle(case, m, 2 * K, MASS)
    blocks = m.table("block")
    return m, blocks["address"][blocks["KBFIX"] == 0][0]


def solve(case):
    m, block = on_plane(case, 20)
    m.damping(0.1, LOWEST / (2 * pi), "stiffness")
    m.gravity(G * sin(PSI), -G * cos(PSI))
    cycle_for(m, 0.2)
    times, speeds = [], []
    for k in range(50):
        if k % 16 == 0:
            case.draw(m, window=(-3, 8, -1.5, 2))
        cycle_for(m, 0.04)
        times.append(now(m))
        speeds.append(row(m, "block", block)["KXD"])
    slope, swing = straight_line(times, speeds)
    exact = G * (sin(PSI) - tan(radians(20)) * cos(PSI))
    yield Answer(
        "acceleration, phi = 20 degrees", "m/s2", slope, exact, {"swing on the springs, 3 A/T": swing}
    )

    m, block = on_plane(case, 50)
    before = row(m, "block", block)["KX"]
    m.damping(2.0, LOWEST / (2 * pi), "mass")
    tilt(m, G, PSI)
    m.solve(1e-6)
    cycle_for(m, 1.0)
    now_at = row(m, "block", block)
    yield Answer(
        "velocity, phi = 50 degrees", "m/s", now_at["KXD"], 0, {"force ratio of rest, in 1 s": 1e-6 * G}
    )
    if case.blocks == "rigid":
        exact = MASS * G * sin(PSI) * (1 / (2 * K) + (HIGH / 2) ** 2 / (2 * K * (WIDE / 2 - D) ** 2))
        yield Answer(
            "it gives way by u",
            "m",
            now_at["KX"] - before,
            exact,
            {
                "force ratio of rest": 1e-6 * exact,
                "lean of the weight, u/h": exact**2 / HIGH,
                "last digits of places": 4 * case.last_digit * WIDE,
            },
        )
