r"""Factor of safety of a wedge on a plane

A wedge of rock lies on a plane that dips out of a slope:

        .--------
       /    . '       F = (W cos psi tan phi + c L)/(W sin psi)
      / . ' psi
     ''------         W: weight, L: length of the plane

FOS divides tan phi and c until the wedge slides.

Tolerance. Half the last bracket, and the force ratio of a stable state.

Source: statics; E. Hoek and J. Bray, Rock slope engineering (1974), plane failure.
"""

from math import cos, radians, sin, tan

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64
HEIGHT, FACE, PSI, PHI = 10.0, radians(60), radians(35), radians(30)
WEIGHT, KN, WITHIN = 25e3, 1e9, 2e-3  # N/m3, Pa/m, tolerance of FOS
CREST, BACK = HEIGHT / tan(FACE), HEIGHT / tan(PSI)
AREA, LENGTH = HEIGHT * (BACK - CREST) / 2, HEIGHT / sin(PSI)


def slope(case, cohesion):
    """The wedge at rest on its plane."""
    m = case.model()
    m.gravity(0, -10)
    m.property(1, density=WEIGHT / 10)
    m.jproperty(1, kn=KN, ks=KN, friction=5.0, between=(1, 1))
    m.block(-5, -5, -5, -1, 0, -1, 0, 0, CREST, HEIGHT, BACK + 5, HEIGHT, BACK + 5, -5)
    m.polyline(0, 0, BACK, HEIGHT)
    m.round(0.01)
    m.fix(f"NOT AREA < {1.01 * AREA}")
    m.solve(1e-7, static=True)
    m.jproperty(1, friction=tan(PHI), cohesion=cohesion)
    return m


def solve(case):
    for cohesion in (0.0, 1e4, 2e4):
        m = slope(case, cohesion)
        found = m.fos(joints=True, tolerance=WITHIN, picture=False)
        weight = WEIGHT * AREA
        exact = (weight * cos(PSI) * tan(PHI) + cohesion * LENGTH) / (weight * sin(PSI))
        within = {"bracket": WITHIN * exact / 2, "force ratio of a stable state": 1e-5}
        yield Answer(f"factor of safety, c = {cohesion:g} Pa", "", found.factor, exact, within)
    case.draw(m, contacts=True)
