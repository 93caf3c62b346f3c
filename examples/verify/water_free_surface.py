"""Free surface in a dam of jointed rock

Water seeps through a rectangular dam with level and vertical joints of the spacing S. Above the free surface
joints are partly filled; the downstream face is wet above the level h2, where water leaves at p = 0:

     h1 ~~~~+--__----+             q = k (h1^2 - h2^2)/(2 L)         k = a^3 rho g/(12 mu S)
            |    --__|
            |        |-_
            |        |~~~~ h2      for any k of the vertical joints
            +--------+
                L

That is exact for a continuum: the head lost along a level line is h1 - y, less h2 - y below the level h2, and
these add up to L q/k. The same holds for joints. Head is lost along a level joint where it is full; where it
is partly filled p = 0 and the head is y. So with joints at S/2, 3S/2, 5S/2 ... the sum

     q = a^3 rho g/(12 mu L) times the sum of (h1 - y) - (h2 - y), where positive, over the level joints

is the integral if h1 and h2 are multiples of S. If one of them is not, h1^2 - h2^2 differs by up to S^2/4.

Tolerance. FLOW STEADY ends when no domain lacks more than 1e-9 of the greatest flow, which is less than q;
there are as many domains as joints between crossings, and crossings. Last digits of places are those of an
aperture.

Source: J. Dupuit, Etudes theoriques et pratiques sur le mouvement des eaux (1863); I. Charny (1951), in P.
Polubarinova-Kochina, Theory of ground water movement (1962).
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import flow_through

BLOCKS = ("rigid",)
L, H, S, D, A, MU, WATER, G = 1.0, 1.1, 0.05, 0.01, 1e-3, 1e-3, 1000.0, 10.0
NX, NY = round(L / S), round(H / S)
CASES = ((1.0, 0.2, 1.0), (1.0, 0.0, 0.75), (1.03, 0.4, 1.0))  # h1, h2, aperture of vertical joints over A


def dam(case):
    """The dam with water, closed below."""
    m = case.model()
    m.property(1, density=2500.0)
    m.jproperty(1, kn=1e9, ks=1e9, aperture=A)
    m.jproperty(2, kn=1e9, ks=1e9)
    m.block(0, 0, 0, H, L, H, L, 0)
    for j in range(NY):
        m.split(-1, (j + 0.5) * S, L + 1, (j + 0.5) * S, joint=1, jmaterial=1)
    for i in range(NX):
        m.split((i + 0.5) * S, -1, (i + 0.5) * S, H + 1, joint=2, jmaterial=2)
    m.round(D)
    m.gravity(0, -G)
    m.fluid(density=WATER, viscosity=MU)
    m.boundary(-0.001, L + 0.001, -0.001, 0.001, impermeable=True)
    return m


def solve(case):
    m, points = dam(case), []
    for h1, h2, vertical in CASES:
        m.jproperty(2, aperture=vertical * A)
        m.boundary(-0.001, 0.001, -0.001, H + 0.001, level=h1)
        m.boundary(L - 0.001, L + 0.001, -0.001, H + 0.001, level=h2)
        m.ppressure(-1, L + 1, -1, H + 1, -1.0)  # no water at first
        m.flow(steady=True)
        exact = A**3 * WATER * G / (12 * MU * S) * (h1**2 - h2**2) / (2 * L)
        within = {
            "balance of the flow": 3 * NX * NY * 1e-9 * exact,
            "last digits of places": 3 * 4 * case.last_digit * H / A * exact,
        }
        odd = sum(h / S % 1 > 1e-9 and h / S % 1 < 1 - 1e-9 for h in (h1, h2))
        if odd:
            within["levels between joints"] = odd * S**2 / 4 / (h1**2 - h2**2) * exact
        name = f"h1 = {h1:g}, h2 = {h2:g} m" + (", narrower vertical joints" if vertical < 1 else "")
        into = flow_through(m, 0, 0.1, -0.1, H + 0.1)
        out = -flow_through(m, L - 0.1, L, -0.1, H + 0.1)
        yield Answer(f"inflow, {name}", "m2/s", into, exact, within)
        yield Answer(f"outflow, {name}", "m2/s", out, exact, within)
        points.append((h1**2 - h2**2, out))
    case.draw(m)
    line = [A**3 * WATER * G / (12 * MU * S) * h / (2 * L) for h in (0, 1.2)]
    case.graph(
        "h1^2 - h2^2 (m2)", "q (m2/s)", {"Dupuit": ((0, 1.2), line)}, [tuple(zip(*points, strict=True))]
    )
