"""Force at which a joint slips

A block of the length L is pressed down by the stress s and pushed along a joint, which has the cohesion c
and the friction angle phi along its whole length:

          s | | | |
           +-------+
     T --> |       |            T = L (c + s tan phi)
        ---+-------+----
               L

T does not depend on how many contacts the joint has, two or those of a block with zones, and stays the same
while the block slides. Beyond that force there is no rest.

Tolerance. The block moves at a constant velocity, without weight. The stress acts on its edge, whose length
changes by the strain; last digits of places make those of an overlap, which is 1/1000 of them.

Source: C.-A. Coulomb, Essai sur une application des regles de maximis et minimis (1773).
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, generate, rectangle

BLOCKS = ("fdef", "sdef", "rigid")
K, DENSITY, COHESION, FRICTION, STRESS = 1e8, 2000.0, 4.4e4, 0.5, 1e5
BULK, G, LENGTH, PUSH, WAYS = 2e9, 1e9, 5.0, 0.01, (0.01, 0.02, 0.04)


def on_joint(case):
    """The block on its joint, under its stress."""
    m = case.model()
    m.property(1, density=DENSITY, bulk=BULK, g=G)
    m.jproperty(1, kn=K, ks=K, friction=FRICTION, cohesion=COHESION)
    m.block(0, -1, 0, 1, 7, 1, 7, -1)
    m.split(-1, 0, 8, 0, joint=1, jmaterial=1)
    for x in (1, 6):
        m.split(x, 0, x, 1)
    m.delete(0, 1, 0, 1)
    m.delete(6, 7, 0, 1)
    m.fix(0, 7, -1, 0)
    m.round(0.02)
    if case.blocks == "fdef":
        generate(m, rectangle(1, 6, 0, 1, 10, 2))
    else:
        case.deform(m, 1, 6, 0, 1)
    m.boundary(0.9, 6.1, 0.9, 1.1, stress=(0, 0, -STRESS))
    m.solve(1e-8, static=True)
    return m


def solve(case):
    exact = LENGTH * (COHESION + STRESS * FRICTION)
    within = {"strain, s/K": STRESS / BULK * exact, "last digits": 1e5 * case.last_digit * exact}
    m = on_joint(case)
    m.damping(local=0.8)
    if case.blocks == "fdef":
        m.boundary(0.9, 6.1, -0.01, 1.01, xvel=PUSH)
    else:
        m.boundary(1, 6, 0, 1, xvel=PUSH, rotation=0)
    gone = 0.0
    for way in WAYS:
        m.cycle(1)
        cycle_for(m, (way - gone) / PUSH)
        gone = way
        force = float(m.reactions(0.9, 6.1, -0.1, 1.1)["fx"].sum())
        yield Answer(f"force after {1000 * way:g} mm", "N/m", force, exact, within)
    case.draw(m, joints="slip")
