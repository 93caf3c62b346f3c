r"""A bolted wedge on a plane

A wedge of rock lies on a plane that dips out of a slope. Bolts hold it with the force T, inclined by al to
the horizontal, downwards into the slope:

        .--------
       /    . '  -. T      F = (W cos psi + T sin(psi + al)) tan phi
      / . ' psi                / (W sin psi - T cos(psi + al))
     ''------                     W: weight

FOS divides tan phi until the wedge slides. Bolts of which the pretension is the yield force hold it with
that, also when it slides. On a plane without friction the force of a bolt follows from statics:

     T = W sin psi/cos(psi + al)

Tolerance. Half the last bracket, and the force ratio of a stable state. For T: force ratio of rest, and the
rotation of the bolt as the wedge slides by T/KN.

Source: statics; E. Hoek and J. Bray, Rock slope engineering (1974), reinforcement of a slope.
"""

from math import cos, radians, sin, tan

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64
HEIGHT, FACE, PSI, PHI, AL = 10.0, radians(60), radians(35), radians(30), radians(10)
WEIGHT, KN, STIFF, WITHIN, REST = 25e3, 1e9, 1e9, 2e-3, 1e-7  # N/m3, Pa/m, N/m2, tolerance of FOS
CREST, BACK = HEIGHT / tan(FACE), HEIGHT / tan(PSI)
AREA = HEIGHT * (BACK - CREST) / 2
LONG = 100.0  # bolts: a wedge that slides does not turn them


def slope(case, friction, force):
    """The wedge on its plane, with a bolt of that pretension, its yield force; 0 for one that is elastic."""
    m = case.model()
    m.gravity(0, -10)
    m.property(1, density=WEIGHT / 10)
    m.jproperty(1, kn=KN, ks=KN, friction=friction, between=(1, 1))
    right, below = BACK + LONG, -5 - LONG * sin(AL)
    m.block(-5, below, -5, -1, 0, -1, 0, 0, CREST, HEIGHT, right, HEIGHT, right, below)
    m.polyline(0, 0, BACK, HEIGHT)
    m.round(0.01)
    m.fix(f"NOT AREA < {1.01 * AREA}")
    m.sproperty(1, kn=STIFF, yield_force=force)
    x, y = (CREST + BACK) / 3, 2 * HEIGHT / 3  # centroid: no moment
    m.bolt(x, y, x + LONG * cos(AL), y - LONG * sin(AL), pretension=force)
    m.damping(local=0.8)
    m.solve(REST, 200_000)
    return m


def solve(case):
    weight, angle = WEIGHT * AREA, PSI + AL
    m = slope(case, 0.0, 0.0)
    (bolt,) = m.table("bolt")
    exact = weight * sin(PSI) / cos(angle)
    turned = exact / STIFF / LONG * tan(angle)
    within = {"rotation of the bolt": turned * tan(angle) * exact, "force ratio": 1e3 * REST * exact}
    yield Answer("T without friction", "N/m", float(bolt["KAFN"]), exact, within)
    case.draw(m, contacts=True, structures=True, window=(-5, BACK + 5, -5, HEIGHT + 1))
    for share in (0.1, 0.3):
        force = share * weight
        m = slope(case, 5.0, force)
        m.jproperty(1, friction=tan(PHI))
        found = m.fos(joints=True, tolerance=WITHIN, picture=False)
        pressed, driving = weight * cos(PSI) + force * sin(angle), weight * sin(PSI) - force * cos(angle)
        exact = pressed * tan(PHI) / driving
        within = {"bracket": WITHIN * exact / 2, "force ratio of a stable state": 1e-4}
        yield Answer(f"factor of safety, T = {share:g} W", "", found.factor, exact, within)
