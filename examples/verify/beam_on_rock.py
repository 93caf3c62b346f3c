r"""A cantilever that is held by rock

A beam lies in rock as deep as it needs, and reaches out of it by L. A block of the weight P hangs at its end:

     ///////                       deflection at the end
     ///////-----------------      P L^3/(3 E I) + q L^4/(8 E I)          of the beam outside
     ///////        L       |      + y + L th                            at the rock, with V = P + q L and
     ///////                P      M = P L + q L^2/2:  y = 2 b (V + b M)/k,  th = 2 b^2 (V + 2 b M)/k

q is the weight of the beam by length, k the stiffness of the interface by length, b = (k/(4 E I))^(1/4). Both
parts are exact for long beams on an elastic foundation. With k without limit, the cantilever is clamped.

Tolerance. The interface is lumped at nodes a distance h apart: (b h)^2 of the part from it. Strain: the
square of the deflection over L. The force ratio of rest.

Source: M. Hetenyi, Beams on elastic foundation (1946); statics.
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block

BLOCKS = ("rigid",)
REALS = 64
LENGTH, DEPTH, YOUNG, AREA, INERTIA, DENSITY, SEGMENTS = 2.0, 1.0, 3e10, 0.1, 8e-5, 2400.0, 60
SIDE, G, REST = 0.2, 10.0, 1e-8  # of the hanging block, its centroid at the end of the beam


def hung(case, k):
    """The beam with its load at rest."""
    m = case.model()
    m.property(1, density=2500, kn=1e9, ks=1e9)
    m.block(-DEPTH, -1, -DEPTH, 1, 0, 1, 0, -1)
    half = SIDE / 2
    m.block(LENGTH - half, -half, LENGTH - half, half, LENGTH + half, half, LENGTH + half, -half)
    m.round(0.02)
    m.fix(-DEPTH, 0, -1, 1)
    m.sproperty(1, young=YOUNG, area=AREA, inertia=INERTIA, density=DENSITY, kn=k, ks=k, cohesion=1e9)
    m.beam(-DEPTH, 0, LENGTH, 0, segments=SEGMENTS)
    m.gravity(0, -G)
    m.fraction(0.5, scaled=True)
    m.damping(kinetic=True)
    m.solve(REST, 400_000)
    return m


def solve(case):
    for what, k in (("rock", 1e9), ("stiffer rock", 1e10)):
        m = hung(case, k)
        load = float(block(m, LENGTH, 0)["KBM"]) * G
        nodes = m.table("node")
        got = -float(nodes["KNY"][-1])
        q, stiff = DENSITY * AREA * G, YOUNG * INERTIA
        shear, moment = load + q * LENGTH, load * LENGTH + q * LENGTH**2 / 2
        rate = (k / 4 / stiff) ** 0.25
        outside = load * LENGTH**3 / (3 * stiff) + q * LENGTH**4 / (8 * stiff)
        held = 2 * rate * (shear + rate * moment) / k + LENGTH * 2 * rate**2 * (shear + 2 * rate * moment) / k
        exact = outside + held
        h = (DEPTH + LENGTH) / SEGMENTS
        within = {
            "lumped interface": (rate * h) ** 2 * held,
            "strain": (exact / LENGTH) ** 2 * exact,
            "force ratio": 1e4 * REST * exact,
        }
        yield Answer(f"deflection at the end, {what}", "m", got, exact, within)
        elements = m.table("element")
        at_rock = float(abs(elements["KMM1"][round(DEPTH / h)]))
        rest = {"force ratio": 1e4 * REST * moment}
        yield Answer(f"moment at the face, {what}", "N", at_rock, moment, rest)
    case.draw(m, structures=True)
