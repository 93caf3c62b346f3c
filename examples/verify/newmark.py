"""Newmark's sliding block

A block rests on ground that is accelerated by A for a time t0; friction holds the block up to an
acceleration N = mu g. If A is greater the block is left behind, and slides on until it has the velocity
V = A t0 of the ground:

      A |----.                 d = V^2/(2 N) (1 - N/A)
      N |....|.........
        +----+-------- t       way that the block slides on the ground
            t0

In the model the ground is fixed, and gravity has a part A along it for the time t0: seen from the
ground it is the same. The way of a second pulse adds to that of the first.

Tolerance. Both ends of a pulse fall on steps, but velocities are those half a step before: the block
slides for dt/2 more or less, at the velocity V - N t0 that it then has. Before it slides the joint
gives way, a spring in shear, as does a deformable block between its foot and its middle. With the
frequency w of that the block gains a velocity of at most N/w too much; sliding with it until the end of
the pulse and then until it stops, it comes (N/w) A t0/N farther.

Source: N. Newmark, Effects of earthquakes on dams and embankments, Geotechnique 15 (1965) 139-160.
"""

from math import pi, radians, sqrt, tan

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import now, on_base, row, settle, step

BLOCKS = ("rigid", "sdef", "fdef")
G, MU, A, K, DENSITY, PULSE = 10.0, tan(radians(20)), 6.0, 4e9, 2000.0, 0.3
WIDE, HIGH = 4.0, 1.0
SHEAR = 4e9
MASS = DENSITY * WIDE * HIGH


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, bulk=8e9, g=SHEAR, friction=MU)
    m.fraction(0.1)
    m.round(0.1)
    on_base(case, m, WIDE, HIGH, width=16)
    m.gravity(0, -G)
    settle(case, m, 2 * K, MASS)
    blocks = m.table("block")
    address = int(blocks["address"][blocks["KBFIX"] == 0][0])
    m.damping(0.1, sqrt(2 * K / MASS) / (2 * pi), "stiffness")
    t, way, begin, start = [0.0], [0.0], now(m), float(row(m, "block", address)["KX"])
    case.draw(m)
    n, yields = round(PULSE / step(m)), MU * G
    for _ in range(2):
        for gx, cycles in ((A, n), (0.0, 2 * n)):
            m.gravity(gx, -G)
            for _ in range(cycles // 40):
                m.cycle(40)
                t.append(now(m) - begin)
                way.append(float(row(m, "block", address)["KX"]) - start)
    lasts = 40 * (n // 40) * step(m)
    exact = (A * lasts) ** 2 / (2 * yields) * (1 - yields / A)
    soft = 0.0 if case.blocks == "rigid" else HIGH / 2 / (SHEAR * WIDE)
    give = A * lasts * sqrt(MASS * (1 / (2 * K) + soft))
    half_step = (A - yields) * lasts * step(m) / 2
    for k, what in ((1, "one pulse"), (2, "two pulses")):
        moved = float(np.interp(k * (len(t) - 1) / 2, np.arange(len(t)), way))
        yield Answer(
            f"way after {what}",
            "m",
            moved,
            k * exact,
            {"half a step": 2 * k * half_step, "spring before it slides": k * give},
        )
    s = np.linspace(0, 3 * lasts, 200)
    slides = np.clip(s, 0, lasts), np.clip(s - lasts, 0, (A - yields) * lasts / yields)
    curve = (A - yields) * slides[0] ** 2 / 2 + (A - yields) * lasts * slides[1] - yields * slides[1] ** 2 / 2
    both = np.r_[s, s + 3 * lasts], np.r_[curve, exact + curve]
    case.graph("time (s)", "way on the ground (m)", {"Newmark": both}, [(t[::25], way[::25])])
