"""A ball that skids begins to roll

A ball is thrown along a floor without turning. Friction slows it down and turns it, until it rolls:

     v0 --> ( )          v = v0 mR^2/(m R^2 + I)        whatever the friction is
    ----------------     t = (v0 - v)/(mu g)            until then

The angular momentum about a point of the floor stays. The ball is a square that is rounded with the
radius R, half its edge but for a part in 1000; its moment of inertia is the square's, m L^2/6, and not
a disc's.

Tolerance. The four arcs have their centres c = sqrt(2) (L/2 - R) beside the centroid: rising by up to
2c, the ball loses 2 g c of v^2/2. The contact gives way in shear by mu W/KS and swings with that to and
fro when it holds.

Source: J.-A. Coriolis, Theorie mathematique des effets du jeu de billard (1835).
"""

from math import pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import now, push, row

BLOCKS = ("rigid",)
G, MU, L, K, DENSITY, V0 = 10.0, 0.3, 1.0, 1e8, 2000.0, 3.0
R, MASS, INERTIA = 0.4995 * L, DENSITY * L**2, DENSITY * L**4 / 6


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, friction=MU)
    m.fraction(0.05)
    m.gravity(0, -G)
    m.round(R)
    m.block(0, -1, 0, 1, 12, 1, 12, -1)
    m.split(-1, 0, 13, 0)
    m.split(1, -0.5, 1, 2)
    m.delete(1, 12, 0, 1)
    m.fix(0, 12, -1, 0)
    m.damping(2.0, sqrt(K / MASS) / (2 * pi), "stiffness")
    m.cycle(1000)
    blocks = m.table("block")
    address = int(blocks["address"][blocks["KBFIX"] == 0][0])
    m.damping(0.2, sqrt(K / MASS) / (2 * pi), "stiffness")
    push(m, address, KXD=V0)
    begin, seen = now(m), []
    for k in range(150):
        if k % 50 == 0:
            case.draw(m, window=(-0.2, 4, -0.7, 1.3))
        m.cycle(10)
        ball = row(m, "block", address)
        seen.append((now(m) - begin, ball["KXD"], -R * ball["KTD"]))
    case.draw(m, window=(-0.2, 4, -0.7, 1.3))
    t, v, rim = np.array(seen).T
    rolling = MASS * R**2 / (MASS * R**2 + INERTIA) * V0
    exact = (V0 - rolling) / (MU * G)
    late = t > 1.2 * exact
    c = sqrt(2) * (L / 2 - R)
    rise = 2 * G * c / rolling
    swing = MU * G * sqrt(MASS / K)
    got = float(v[late].mean())
    yield Answer(
        "velocity when it rolls",
        "m/s",
        got,
        rolling,
        {"centres of the arcs": rise, "swing of the contact": swing},
    )
    skids = t < 0.9 * exact  # there the velocities of ball and rim are straight lines, which meet
    slope, apart = np.polyfit(t[skids], v[skids] - rim[skids], 1)
    yield Answer(
        "time after which it rolls",
        "s",
        float(-apart / slope),
        exact,
        {"centres of the arcs": rise / (MU * G), "swing of the contact": swing / (MU * G)},
    )
