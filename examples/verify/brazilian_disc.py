r"""A disc splits between two platens

A disc is pressed between two platens, of which the upper one moves down slowly:

        =========
          .---.  | P
         /  |  \            tension across the loaded diameter:  2 P/(pi d)
        |   |   | d         splits at                            P = (pi/2) d T
         \  |  /
          '---'             the crack is that diameter
        =========

The disc is a polygon with corners at both ends of the diameter. A rigid block and a simply-deformable one
crack by this law (docs/cracking.md): the problem tests that force, place and moment of the crack are found.

Tolerance. The last step of the load. The force acts on the rounded corner, nearer to the centre.

Source: H. Hertz (1883), stress in a cylinder under line loads; F. Carneiro (1943), the Brazilian test.
"""

import numpy as np

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid", "sdef")
SIDES, RADIUS, D, T = 48, 1.0, 0.005, 1e5
SPEED, PIECE = 0.02, 1  # m/s, cycles


def press(case):
    """The disc between its platens."""
    m = case.model()
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e10, g=6e9)
    angle = np.pi / 2 - 2 * np.pi * np.arange(SIDES) / SIDES
    m.block(*np.column_stack([RADIUS * np.cos(angle), RADIUS * np.sin(angle)]).ravel().tolist())
    m.block(-1, RADIUS, -1, RADIUS + 0.5, 1, RADIUS + 0.5, 1, RADIUS)
    m.block(-1, -RADIUS - 0.5, -1, -RADIUS, 1, -RADIUS, 1, -RADIUS - 0.5)
    m.round(D)
    if case.blocks == "sdef":
        m.change(-1, 1, -RADIUS / 2, RADIUS / 2, type="sdef")
    m.fix(-1, 1, -2, -RADIUS)
    m.boundary(-1, 1, RADIUS, 2, xvel=0.0, yvel=-SPEED)
    m.damping(local=0.8)
    m.damping(1.0, 100.0, "internal")
    m.breakage(-1, 1, -RADIUS / 2, RADIUS / 2, tension=T, smallest=0.1)
    return m


def solve(case):
    m = press(case)
    p = step = 0.0
    while not len(m.cracks()):
        now = float(m.table("contact")["KCFN"].min())  # of both contacts the lesser force
        step, p = max(now - p, 0.0), now
        m.cycle(PIECE)
    crack = m.cracks()[0]
    case.draw(m, cracks=True)
    exact = np.pi / 2 * 2 * RADIUS * T
    parts = {"steps of the load": step, "rounding": D / RADIUS * exact}
    yield Answer("force at which it splits", "N/m", p + step / 2, exact, parts)
    length = abs(crack["y2"] - crack["y1"])
    yield Answer("length of the crack", "m", length, 2 * RADIUS, {"overlaps": 2 * exact / 1e9})
    yield Answer("its distance from the centre", "m", (crack["x1"] + crack["x2"]) / 2, 0.0, {"D": D})
