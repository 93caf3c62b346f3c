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

In a disc with zones the stress is calculated. A pressure that grows slowly acts on two opposite arcs of the
half angle a, three sides each, and splits it from inside:

        tension in the centre:  p (sin 2a - a) 2/pi,      p = P/(d sin a)

Tolerance. The last step of the load. The force on a platen acts on the rounded corner, nearer to the centre.
With zones: the pressure acts on sides, not normal to the arc, a^2/6; area of the polygon, 2 (pi/n)^2/3; the
stress varies over a zone of the size s, (s/d)^2.

Source: H. Hertz (1883), stress in a cylinder under line loads; F. Carneiro (1943), the Brazilian test; G.
Hondros, Australian Journal of Applied Science 10 (1959), pressure on arcs.
"""

import numpy as np

from udec_ia.layout.offsets import TDEL, TIME
from udec_ia.studies.verification import Answer

BLOCKS = ("rigid", "sdef", "fdef")
SIDES, RADIUS, D, T = 48, 1.0, 0.005, 1e5
SPEED, PIECE = 0.02, 1  # m/s, cycles
ARC, ZONE, RAMP = 3, 0.13, 0.05  # sides of an arc; m; s in which the pressure grows by that of the splitting


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


def pressed_by_arcs(case, alpha):
    """The disc with zones, and a pressure on both arcs that is to split it after RAMP."""
    m = case.model()
    m.property(1, density=2000, kn=1e9, ks=1e9, bulk=1e10, g=6e9)
    angle = np.pi / 2 - 2 * np.pi * (np.arange(SIDES) + 0.5) / SIDES
    m.block(*np.column_stack([RADIUS * np.cos(angle), RADIUS * np.sin(angle)]).ravel().tolist())
    m.round(D)
    m.generate(-1, 1, -RADIUS / 2, RADIUS / 2, edge=ZONE)
    m.function(1, 0.0, 0.0, 1.0, 1 / RAMP)
    pressure = splitting_pressure(alpha)
    half = RADIUS * np.sin(alpha) + 1e-3
    for y1, y2 in ((0.9, 1.1), (-1.1, -0.9)):
        m.boundary(-half, half, y1, y2, stress=(0.0, 0.0, -pressure), function=1)
    m.damping(local=0.8)
    m.fraction(0.5, safe=True)
    m.breakage(-1, 1, -RADIUS / 2, RADIUS / 2, tension=T, smallest=0.1)
    return m


def splitting_pressure(alpha):
    return T * np.pi / (2 * (np.sin(2 * alpha) - alpha))


def solve_with_zones(case):
    alpha = ARC * np.pi / SIDES
    m = pressed_by_arcs(case, alpha)
    while not len(m.cracks()):
        m.cycle(20)
    case.draw(m, cracks=True)
    force = 2 * RADIUS * np.sin(alpha) * splitting_pressure(alpha)
    time, last = float(m.h.cd[TIME]), 20 * float(m.h.cr[TDEL])
    parts = {
        "steps of the load": force * last / RAMP,
        "pressure on sides": force * alpha**2 / 6,
        "polygon": force * 2 / 3 * (np.pi / SIDES) ** 2,
        "zones": force * (ZONE / (2 * RADIUS)) ** 2,
    }
    yield Answer("force at which it splits, on arcs", "N/m", force * time / RAMP, force, parts)
    crack = m.cracks()[0]
    middle = (crack["x1"] + crack["x2"]) / 2
    yield Answer("distance of the crack from the centre", "m", middle, 0.0, {"a zone": ZONE})


def solve(case):
    if case.blocks == "fdef":
        yield from solve_with_zones(case)
        return
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
