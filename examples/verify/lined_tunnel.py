r"""A lined tunnel

A tunnel of the radius a, with a lining on its wall, is loaded by the pressure p at the distance b:

         p            rock      d = a (p b^2 - q a^2)/(2 (K + G/3)(b^2 - a^2))
       ____                         + (p - q) a b^2/(2 G (b^2 - a^2))
     / ____ \         lining    u = q a^2/(E A)
    | | a  | | b      between   q = kn (d - u)
    | |____| |
     \ ____ /         d: way of the wall inwards, q: pressure on the lining, whose axial force is q a

K, G: of the rock, in plane strain; kn: of the interface, which slips without friction.

Tolerance. The two zones of a quadrilateral have the stress of its middle to the second order: (h/a)^2 with
its longest side h at the wall; a polygon has sides, not an arc: (h/a)^2/8. Four joints divide the ring, each
shortened by the hoop stress over their stiffness, which is at most 2 p b^2/(b^2 - a^2). Strain, and the force
ratio of rest.

Source: S. Timoshenko and J. Goodier, Theory of elasticity (1934); compatibility of the three.
"""

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, outline, quarter_ring

BLOCKS = ("fdef",)
REALS = 64
A, B, P, BULK, SHEAR, DENSITY, AROUND, ACROSS = 1.0, 3.0, 1e5, 1e9, 6e8, 2000.0, 16, 11
YOUNG, AREA, INERTIA, HEAVY, KN, JOINT, REST = 3e10, 0.05, 1e-5, 2400.0, 1e10, 2e11, 1e-6


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    m.jproperty(1, kn=JOINT, ks=JOINT, friction=1.0, between=(1, 1))
    m.round(0.01)
    nodes = quarter_ring(A, B, AROUND, ACROSS)
    for _ in range(4):
        m.block(*outline(nodes))
        generate(m, nodes)
        nodes = np.stack([nodes[..., 1], -nodes[..., 0]], axis=-1)
    m.sproperty(1, young=YOUNG, area=AREA, inertia=INERTIA, density=HEAVY, kn=KN, ks=KN / 10)
    m.beam(around=(0, 0))
    edge = f"ANNULUS 0 0 {B - 0.02} {B + 0.02}"
    m.boundary(edge, stress=(-P, 0, -P))
    m.fraction(0.5, scaled=True)
    m.damping(kinetic=True)
    m.solve(REST, 200_000)
    case.draw(m, structures=True)
    span = B**2 - A**2
    soft = A**3 / (2 * (BULK + SHEAR / 3)) + A * B**2 / (2 * SHEAR)
    free = P * A * B**2 / span * (1 / (2 * (BULK + SHEAR / 3)) + 1 / (2 * SHEAR))
    q = free / (1 / KN + A**2 / (YOUNG * AREA) + soft / span)
    inner, elements = m.table("node"), m.table("element")
    way = A - np.hypot(inner["KNAX"], inner["KNAY"])
    side = np.hypot(np.pi / 2 / AROUND, (B / A) ** (1 / ACROSS) - 1)
    hoop = 2 * P * B**2 / span
    joints = 4 * hoop / JOINT / (2 * np.pi * free)
    within = {
        "zones, (h/a)^2": side**2,
        "polygon, (h/a)^2/8": side**2 / 8,
        "joints": joints,
        "strain": free / A,
        "force ratio": 1e2 * REST,
    }
    for what, unit, got, exact in (
        ("axial force of the lining, -N", "N/m", -elements["KMFN"], q * A),
        ("pressure on the lining", "Pa", inner["KNFN"] / inner["KNLEN"], q),
        ("way of the wall", "m", way, free - q * soft / span),
    ):
        parts = {name: part * exact for name, part in within.items()}
        yield Answer(f"mean {what}", unit, float(got.mean()), exact, parts)
