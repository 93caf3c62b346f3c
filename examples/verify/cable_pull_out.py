r"""A grouted cable is pulled out of rock

A cable in rock that does not move is pulled with P at the face, x = 0, and grouted as far as x = L:

     P <--=========================      u(x) = P cosh(m (L - x))/(E A m sinh(m L))
          |//// rock ////////////          N(x) = P sinh(m (L - x))/sinh(m L)
          x = 0              x = L       m = sqrt(Kg/(E A)), Kg: shear stiffness of the grout

Pulled further, the grout slips along all of it, at P = Sg L; where the steel is weaker, it yields at its own
strength. A block outside the rock grips a greater length of the cable.

Tolerance. Elements of the length h lump the grout at nodes. With 2 sinh(t/2) = m h their displacement is that
of the formula with t/h for m, divided by cosh(t/2): (m h)^2/8 less at the face, and m x (m h)^2/24 more from
there. The force ratio of rest. For the ultimate loads inertia: the pulling speed over that of waves in the
cable, times E A.

Source: statics; P. Farmer, Stress distribution along a resin grouted rock anchor (1975).
"""

from math import sinh, sqrt

import numpy as np

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64  # displacements are micrometres at 2 m
LENGTH, FREE, GRIP, YOUNG, AREA, DENSITY, GROUT, H = 2.0, 0.5, 3.0, 2e11, 5e-4, 7800.0, 4e8, 0.05
IN_GAP = round((GRIP + FREE / 2) / H)  # element between the blocks
SPEED, REST = 2e-3, 1e-7


def pulled(case, way, cohesion, strength=0.0):
    """A cable whose other end has moved by `way`."""
    m = case.model()
    m.property(1, density=2500, kn=1e9, ks=1e9)
    m.block(-FREE - GRIP, -1, -FREE - GRIP, 1, LENGTH, 1, LENGTH, -1)
    m.split(0, -2, 0, 2)
    m.split(-FREE, -2, -FREE, 2)
    m.delete(-FREE, 0, -1, 1)
    m.round(0.02)
    m.fix(0, LENGTH, -1, 1)
    m.sproperty(1, young=YOUNG, area=AREA, density=DENSITY, ks=GROUT, cohesion=cohesion, yield_force=strength)
    m.cable(-FREE - GRIP, 0, LENGTH, 0, segments=round((LENGTH + FREE + GRIP) / H))
    m.fraction(0.5, safe=True)
    m.boundary(-FREE - GRIP, -FREE, -1, 1, xvel=-SPEED, yvel=0, rotation=0)
    m.cycle(time=way / SPEED)
    return m


def solve(case):
    rate = sqrt(GROUT / (YOUNG * AREA))
    m = pulled(case, 1e-5, 1e9)
    m.damping(local=0.8)
    m.boundary(-FREE - GRIP, -FREE, -1, 1, xvel=0, yvel=0, rotation=0)
    m.solve(REST)
    nodes, elements = m.table("node"), m.table("element")
    load = float(elements["KMFN"][IN_GAP])
    grouted = nodes[nodes["KNX"] > -1e-6]
    x, u = grouted["KNAX"], grouted["KNAX"] - grouted["KNX"]
    exact = load * np.cosh(rate * (LENGTH - x)) / (YOUNG * AREA * rate * sinh(rate * LENGTH))
    lumped = (rate * H) ** 2
    for part in (0.0, 0.25, 0.5):
        k = int(np.argmin(np.abs(x - part * LENGTH)))
        within = {
            "elements, at the face": lumped / 8 * exact[k],
            "elements, from there": lumped / 24 * rate * x[k] * exact[k],
            "force ratio": 1e-4 * exact[k],
        }
        yield Answer(f"displacement at x = {part:g} L", "m", float(u[k]), float(exact[k]), within)
    case.graph("x (m)", "u (m)", {"formula": (x, exact)}, [(x, u)])
    for what, cohesion, strength in (("grout slips", 5e4, 0.0), ("steel yields", 2e5, 5e4)):
        m = pulled(case, 5e-3, cohesion, strength)
        elements = m.table("element")
        load = float(elements["KMFN"][IN_GAP])
        exact = strength or cohesion * LENGTH
        inertia = SPEED / sqrt(YOUNG / DENSITY) * YOUNG * AREA
        yield Answer(f"ultimate load, {what}", "N/m", load, exact, {"inertia": inertia})
