"""A jointed rock mass that is released under its stress

Rock is cut by joints, some at 45 degrees, and has a stress that grows with the depth as gravity wants it
to, and differs from it sideways:

      s11 = a + c y               +----/---/-+
      s12 = const                 |   /   /  |         INSITU ... YGRAD c 0 rho g
      s22 = b + rho g y           +--/---/---+
                                  | /   /    |
                                  +/---/-----+

The stress is in balance with gravity and with the loads on the outer edges. So nothing may move on release,
whatever the joints and the meshes of the blocks: each joint begins with the force that the field has there.
What does move is compared with what the mass would move without such forces, s H/E.

Tolerance. The last digits of places, 20 of them over 300 cycles.

Source: equilibrium, ds22/dy = rho g; J. Jaeger and N. Cook, Fundamentals of Rock Mechanics (1969).
"""

import numpy as np

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # last digits are what is left
STRESS, GRADIENT, DENSITY = (-2e6, 0.3e6, -3e6), (12500.0, 0.0, 25000.0), 2500.0
BULK, G, PER_LENGTH, PER_CONTACT = 5e9, 3e9, 1e10, 1e9
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


def mass(case, per_length):
    """The jointed mass under loads and gravity, with joint materials or with the contacts of 1980."""
    m = case.model()
    m.property(1, density=DENSITY, bulk=BULK, g=G, kn=PER_CONTACT, ks=PER_CONTACT, friction=0.9)
    if per_length:
        m.jproperty(1, kn=PER_LENGTH, ks=PER_LENGTH, friction=0.9, between=(1, 1))
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
    for per_length in (True, False):
        m = mass(case, per_length)
        m.insitu(0, WIDE, 0, HIGH, *STRESS, ygrad=GRADIENT)
        before = m.table("corner")
        m.cycle(300)
        after = m.table("corner")
        moved = max(np.abs(after[name] - before[name]).max() for name in ("KXP", "KYP"))
        yield Answer(
            f"greatest move over s H/E, stiffness per {'length' if per_length else 'contact'}",
            "",
            float(moved / elastic),
            0.0,
            {"last digits of places": 20 * case.last_digit * WIDE / elastic},
        )
        if per_length:
            case.draw(m, contacts=True)
