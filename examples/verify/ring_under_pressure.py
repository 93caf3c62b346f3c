r"""A ring under uniform pressure

Rock around a hole moves in by d, on all sides alike. A ring along its wall, of the radius r, resists:

       \ | /             p = kn (d - u)        pressure of the interface
      -- O --            u = p r^2/(E A)       way of the ring
       / | \             N = p r               its axial force; it is not bent

The hole is a regular polygon. With nodes at its corners all three are exact for it as well: a side has the
length 2 r sin(a), and the force p times that of a node balances 2 N sin(a).

Tolerance. Strain. The rock stops at the end of a step, and the run at a force ratio.

Source: statics; S. Timoshenko, Strength of Materials (1930).
"""

from math import cos, pi, sin

import numpy as np

from udec_ia.layout.offsets import TIME
from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64  # the rock moves by 1e-4 of the radius
RADIUS, SIDES, MOVED, SPEED, KN, YOUNG, AREA = 2.0, 24, 2e-4, 1e-2, 1e9, 3e10, 0.1
INERTIA, DENSITY, REST = 1e-4, 2400.0, 1e-7


def hole(case):
    """Blocks around a hole, one at each of its corners."""
    m = case.model()
    m.property(1, density=2500, kn=1e6, ks=1e6)
    m.block(-5, -5, -5, 5, 5, 5, 5, -5)
    m.tunnel(0, 0, RADIUS, SIDES)
    for k in range(SIDES // 2):
        x, y = 9 * cos((2 * k + 1) * pi / SIDES), 9 * sin((2 * k + 1) * pi / SIDES)
        m.split(-x, -y, x, y)
    m.delete(f"CIRCLE 0 0 {RADIUS * cos(pi / SIDES)}")
    m.round(0.01)
    return m


def solve(case):
    m = hole(case)
    m.sproperty(1, young=YOUNG, area=AREA, inertia=INERTIA, density=DENSITY, kn=KN, ks=KN / 10)
    m.beam(around=(0, 0))
    places = {}
    for row in m.table("block"):
        angle = round(np.arctan2(row["KY"], row["KX"]) / (2 * pi / SIDES)) * 2 * pi / SIDES
        places[float(row["KX"]), float(row["KY"])] = angle
    for speed in (SPEED, 0.0):
        for (x, y), angle in places.items():
            at = f"CIRCLE {x} {y} 0.01"
            m.boundary(at, xvel=-speed * cos(angle), yvel=-speed * sin(angle), rotation=0)
        if speed:
            m.fraction(0.3, safe=True)
            m.cycle(time=MOVED / SPEED)
    moved = SPEED * float(m.h.cd[TIME])
    m.damping(local=0.8)
    m.solve(REST)
    pressure = KN * moved / (1 + KN * RADIUS**2 / (YOUNG * AREA))
    nodes, elements = m.table("node"), m.table("element")
    side = 2 * RADIUS * sin(pi / SIDES)
    within = {"strain": moved / RADIUS, "force ratio": 1e3 * REST}
    for what, unit, got, exact in (
        ("pressure of the interface", "Pa", nodes["KNFN"] / side, pressure),
        ("axial force, -N", "N/m", -elements["KMFN"], pressure * RADIUS),
    ):
        parts = {name: part * exact for name, part in within.items()}
        for name, one in (("least", got.min()), ("greatest", got.max())):
            yield Answer(f"{name} {what}", unit, float(one), exact, parts)
    bent = float(max(np.abs(elements["KMM1"]).max(), np.abs(elements["KMM2"]).max()))
    yield Answer("greatest moment", "N", bent, 0.0, {"strain": moved / RADIUS * pressure * RADIUS**2})
    case.draw(m, structures=True)
