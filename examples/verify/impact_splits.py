r"""A blow splits a block above a speed that energy sets, and not below it

A heavy striker of the mass m falls on a light block that lies on an anvil. The springs KN of its two contacts
are one spring of half the stiffness:

        +-------+
        |   m   | | v         energy    m v^2/2 = P^2/(2 K)        K = KN/2
        +-------+ v           splits at P = (pi/2) d T
            /\
           /  \  d            v = P/sqrt(K m)
           \  /
        ____\/____

The speed is bisected between runs that split the block and runs that do not.

Tolerance. The bracket of the bisection. The weight under which all comes to rest first. The block has a mass,
which vibrates on both springs: the first wave has sqrt(mb/m)/2 of the force. Half a time-step in the force at
its peak, of (w dt)^2/8.

Source: energy of a mass on a spring; H. Hertz (1883) for the disc.
"""

from math import pi, sqrt

from udec_ia.layout import offsets as g
from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, push

BLOCKS = ("rigid",)
REALS = 64  # the block is a ten thousandth of the striker
KN, T, D, SEATING = 1e8, 1e5, 0.005, 0.01  # SEATING: gravity under which it comes to rest first, m/s2
LIGHT, HEAVY, HIGH = 10.0, 2e4, 1.0  # densities, height of the block (m)
HALVINGS = 7


def scene(case):
    """Anvil, block and striker; masses per m: of block and striker."""
    m = case.model()
    m.property(1, density=HEAVY, kn=KN, ks=KN, friction=0.5)
    m.property(2, density=LIGHT, kn=KN, ks=KN, friction=0.5)
    wide = HIGH / 2
    m.block(0, -HIGH / 2, -wide, 0, 0, HIGH / 2, wide, 0, material=2)
    m.block(-2, -HIGH / 2 - 1, -2, -HIGH / 2, 2, -HIGH / 2, 2, -HIGH / 2 - 1)
    m.block(-2, HIGH / 2, -2, HIGH / 2 + 2, 2, HIGH / 2 + 2, 2, HIGH / 2)
    m.round(D)
    m.fix(-2, 2, -HIGH / 2 - 1, -HIGH / 2)
    m.breakage(-1, 1, -0.1, 0.1, tension=T, smallest=0.01)
    return m


def strikes(case, v):
    """The model after a blow with the speed `v`, m/s."""
    m = scene(case)
    m.gravity(0, -SEATING)
    m.damping(local=0.8)
    m.solve(1e-3, 20_000)
    m.gravity(0, 0)
    m.damping(0, 1)
    push(m, int(block(m, 0, HIGH / 2 + 1)["address"]), KYD=-v)
    for _ in range(400):
        m.cycle(50)
        if len(m.cracks()) or float(block(m, 0, HIGH / 2 + 1)["KYD"]) > 0:
            break
    return m


def solve(case):
    m = scene(case)
    m.cycle(1)
    light, heavy = float(block(m, 0, 0)["KBM"]), float(block(m, 0, HIGH / 2 + 1)["KBM"])
    p, k = pi / 2 * HIGH * T, KN / 2
    exact = p / sqrt(k * heavy)
    low, high = 0.8 * exact, 1.25 * exact
    for _ in range(HALVINGS):
        v = (low + high) / 2
        m = strikes(case, v)
        low, high = (low, v) if len(m.cracks()) else (v, high)
    m = strikes(case, high)
    m.cycle(1500)
    case.draw(m, cracks=True)
    turn = sqrt(k / heavy) * float(m.h.cr[g.TDEL])
    yield Answer(
        "least speed that splits it",
        "m/s",
        (low + high) / 2,
        exact,
        {
            "bracket": (high - low) / 2,
            "mass of the block": sqrt(light / heavy) / 2 * exact,
            "weight at first": heavy * SEATING / p / 2 * exact,
            "steps": turn**2 / 8 * exact,
        },
    )
