"""A cantilever of blocks that are glued together

Blocks in a row hang on a wall by joints with the stiffness k (Pa/m) and the tensile strength T (Pa).
Gravity bends the joint at the root most:

     ///|----+----+----+----|          turns by th = M/(k h^3/12)     while it is closed
     ///|    |    |    |    | h        breaks at M = T h^2/6          stress is linear
     ///|----+----+----+----|          M = rho g h l^2/2
              l

Gravity grows until the blocks fall.

Tolerance. Contacts stand D inside the edge, where the stress reaches T later: M is greater by 2D/h. Half of
the last increment of gravity. Arms change by the closure of the joint, th h/2.

Source: S. Timoshenko and J. Goodier, Theory of Elasticity (1934), for a linear stress over the section.
"""

import numpy as np

from udec_ia.layout.offsets import JOINT_BROKEN
from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64  # the joints close by 1e-5
K, TENSION, DENSITY, HIGH, SPAN, D = 1e10, 1e6, 2000.0, 1.0, 4.0, 0.002
BREAKING = TENSION / (3 * DENSITY * HIGH * (SPAN / HIGH) ** 2) * HIGH  # gravity, m/s2
STEP = 0.002  # increments of gravity, of that


def beam(case):
    """The wall, four blocks of 1 m, and the joint at the root."""
    m = case.model()
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=K, ks=K, cohesion=TENSION, tension=TENSION)
    m.block(0, 0, 0, HIGH, SPAN + 1, HIGH, SPAN + 1, 0)
    for x in range(1, int(SPAN) + 1):
        m.split(x, -1, x, HIGH + 1, joint=1, jmaterial=1)
    m.fix(0, 1, 0, HIGH)
    m.round(D)
    m.damping(local=0.8)
    return m


def turn(m):
    """Of the joint at the root, rad: the closures of its two contacts over their distance."""
    contacts = m.table("contact")
    root = np.abs(contacts["KXC"] - 1) < 0.1
    return float(abs(np.diff(contacts["KCN"][root])[0] / np.diff(contacts["KYC"][root])[0]))


def breaks(m):
    """True if a joint breaks in the next cycles, which are enough to come to rest."""
    for _ in range(15):
        m.cycle(100)
        if (m.table("joint")["KCJFLAG"] & JOINT_BROKEN).any():
            return True
    return False


def solve(case):
    m = beam(case)
    for share in (0.5, 0.9):
        m.gravity(0, -share * BREAKING)
        m.solve(1e-6, 20_000)
        moment = DENSITY * share * BREAKING * HIGH * SPAN**2 / 2
        exact = moment / (K * HIGH**3 / 12)
        yield Answer(
            f"turn of the root at {100 * share:g} % of the load",
            "rad",
            turn(m),
            exact,
            {"closure of the joint over h": exact * exact / 2, "force ratio of rest": 1e-4 * exact},
        )
    while not breaks(m) and share < 1.1:
        share += STEP
        m.gravity(0, -share * BREAKING)
    exact = TENSION * HIGH**2 / 6
    case.draw(m, joints="state")
    yield Answer(
        "moment at which it breaks",
        "N",
        DENSITY * (share - STEP / 2) * BREAKING * HIGH * SPAN**2 / 2,
        exact,
        {"contacts inside the edge, 2 D/h": 2 * D / HIGH * exact, "half an increment": STEP / 2 * exact},
    )
