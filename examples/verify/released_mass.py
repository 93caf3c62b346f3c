"""A jointed rock mass that is released under its stress

Rock is cut by joints, some at 45 degrees, and has a stress that grows with the depth as gravity wants it
to, and differs from it sideways:

      s11 = a + (12500 Pa/m) y           +-----+---+--+
      s12 = const                        | \\  /|   |/ |      INSITU ... YGRAD
      s22 = b + rho g y                  +---X-+---+\\-+
                                         |  /  \\  /|  |
                                         +-+----+--+--+

The stress is in balance with gravity and with the loads on the outer edges. So nothing may move on release,
whatever the joints and the meshes of the blocks: each joint begins with the force that the field has there.
What does move is compared with what the mass would move without such forces, s H/E.

Tolerance. Places of 10 m have last digits; each is an overlap that is wrong by that, and joints are softer
than the rock: E/(kn H) times it.

Source: equilibrium, ds22/dy = rho g; J. Jaeger and N. Cook, Fundamentals of Rock Mechanics (1969).
"""

import numpy as np

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # last digits are what is left
STRESS, GRADIENT, DENSITY, KN = (-2e6, 0.3e6, -3e6), (12500.0, 0.0, 25000.0), 2500.0, 1e10
BULK, G = 5e9, 3e9
WIDE, HIGH = 8.0, 6.0
CUTS = (
    (-1, -1.5, 9, 8.5),
    (-1, 2.0, 9, 12),
    (-1, 5, 9, -5),
    (-1, 9, 9, -1),
    (3.1, -1, 3.3, 7),
    (-1, 2.9, 9, 3.1),
)
EDGES = (
    (-0.05, 0.05, -0.05, HIGH + 0.05),
    (WIDE - 0.05, WIDE + 0.05, -0.05, HIGH + 0.05),
    (-0.05, WIDE + 0.05, -0.05, 0.05),
    (-0.05, WIDE + 0.05, HIGH - 0.05, HIGH + 0.05),
)


def mass(case):
    """The jointed mass under loads and gravity."""
    m = case.model()
    m.property(1, density=DENSITY, bulk=BULK, g=G)
    m.jproperty(1, kn=KN, ks=KN, friction=0.9, between=(1, 1))
    m.block(0, 0, 0, HIGH, WIDE, HIGH, WIDE, 0)
    for cut in CUTS:
        m.split(*cut)
    m.round(0.02)
    if case.blocks == "sdef":
        m.change(0, WIDE, 0, HIGH, type="sdef")
    for k in range(len(m.table("block"))) if case.blocks == "fdef" else ():
        m.generate(0, WIDE, 0, HIGH, "automatic", edge=0.7 + 0.13 * k)
    m.gravity(0, -10)
    for edge in EDGES:
        m.boundary(*edge, stress=STRESS, ygrad=GRADIENT)
    return m


def solve(case):
    elastic = -STRESS[2] * HIGH / (9 * BULK * G / (3 * BULK + G))
    for per in ("length", "contact"):
        m = mass(case)
        m.insitu(0, WIDE, 0, HIGH, *STRESS, ygrad=GRADIENT)
        before = m.table("corner")
        m.cycle(300)
        after = m.table("corner")
        moved = max(np.abs(after[name] - before[name]).max() for name in ("KXP", "KYP"))
        yield Answer("greatest move over s H/E", "", float(moved / elastic), 0.0, {"x": 1e-6})
        break
    case.draw(m, contacts=True)
