"""Flow along a joint

A joint of the length l and the aperture a is cut in n pieces by cross joints, which end blind. Water flows
from the pressure p1 at one end to p2 at the other:

      +---+---+---+---+        q = a^3 (p1 - p2 + rho g (y1 - y2))/(12 mu l)
      |   |   |   |   |
 p1 ->+---+---+---+---+-> p2   p + rho g y is linear along the joint
      |               |
      +---------------+        a = APERTURE - s/KN under the normal stress s, here half of APERTURE

The joint is level or inclined. An end without a condition is free: the pressure there is 0. The inclined
joint has gravity, and at its ends pressures, or levels, whose difference is that of p + rho g y.

Tolerance. FLOW STEADY ends when each domain lacks at most 1e-9 of the flow; there are 3 n of them. Last
digits of places are those of the aperture, of which q has the third power. Under the stress there is the
force ratio of rest.

Source: the cubic law: C. Louis, Rock hydraulics (1974); P. Witherspoon and others, Validity of cubic law for
fluid flow in a deformable rock fracture, Water Resources Research 16 (1980) 1016-1024.
"""

from math import hypot

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import domain, fan, flow_through

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # forces of the joint at rest
L, N, D, A, MU, RHO, G = 4.0, 4, 0.01, 1e-3, 1e-3, 1000.0, 10.0
KN, P1, P2, RISE, HIGH, LOW, REST, STEADY = 1e9, 1e5, 2e4, 2.0, 7.0, 5.0, 1e-7, 3 * N * 1e-9


def scene(case, rise=0.0):
    """Blocks on a joint with the middle at y = 2, whose left end is higher than the right one by `rise`."""
    m = case.model()
    m.property(1, density=2000.0, bulk=4e12, g=3e12)
    m.jproperty(1, kn=KN, ks=KN, friction=0.5, aperture=A, between=(1, 1))
    m.block(0, 0, 0, 4, L, 4, L, 0)
    m.split(-L, 2 + 1.5 * rise, 2 * L, 2 - 1.5 * rise)
    for k in range(1, N):
        m.split(k * L / N, 2 - rise * (k / N - 0.5) - 0.1, k * L / N, 5)
    m.round(D)
    if case.blocks == "sdef":
        m.change(0, L, 0, 4, type="sdef")
    for row in m.table("block") if case.blocks == "fdef" else ():
        fan(m, float(row["KX"]), float(row["KY"]))
    m.fluid(kw=2e9, density=RHO, viscosity=MU, mode="drained")
    m.boundary(-0.01, L + 0.01, 3.99, 4.01, impermeable=True)
    return m


def ends(m, left, right):
    """Conditions on both sides; steady flow into the left end and out of the right one."""
    m.boundary(-0.01, 0.01, -0.01, 4.01, **left)
    if right:
        m.boundary(L - 0.01, L + 0.01, -0.01, 4.01, **right)
    m.flow(steady=True)
    return flow_through(m, -0.1, 0.1, 0, 4), -flow_through(m, L - 0.1, L + 0.1, 0, 4)


def solve(case):
    digits = 3 * 4 * case.last_digit * L / A
    m = scene(case)
    exact = A**3 * P1 / (12 * MU * L)
    within = {"balance of the flow": STEADY * exact, "last digits of places": digits * exact}
    into, out = ends(m, {"ppressure": P1}, {})
    yield Answer("flow into the joint", "m2/s", into, exact, within)
    yield Answer("flow out of its free end", "m2/s", out, exact, within)
    share = {"balance of the flow": STEADY * P1, "last digits of places": digits * P1}
    found = []
    for k in range(1, 2 * N):
        x = k * L / (2 * N)
        found.append((x / L, float(domain(m, x, 2)[0]["KPP"]) / P1))
    worst = max(abs(p - 1 + s) for s, p in found) * P1
    yield Answer("pressures, greatest error", "Pa", worst, 0.0, share)

    m = scene(case)
    m.fix(0, L, 0, 2)
    s = KN * A / 2
    m.boundary(-0.01, L + 0.01, 3.99, 4.01, stress=(0, 0, -s))
    m.solve(REST, static=True)
    into, _ = ends(m, {"ppressure": P1}, {"ppressure": P2})
    exact = (A / 2) ** 3 * (P1 - P2) / (12 * MU * L)
    within = {"balance of the flow": STEADY * exact, "force ratio of rest": 3 * REST * exact}
    within["last digits of places"] = 2 * digits * exact
    yield Answer("flow under stress", "m2/s", into, exact, within)

    m = scene(case, RISE)
    m.gravity(0, -G)
    length = hypot(L, RISE)
    for name, left, right, fall in (
        ("pressures at the ends", {"ppressure": P1}, {"ppressure": P2}, P1 - P2 + RHO * G * RISE),
        ("levels at the ends", {"level": HIGH}, {"level": LOW}, RHO * G * (HIGH - LOW)),
    ):
        into, _ = ends(m, left, right)
        exact = A**3 * fall / (12 * MU * length)
        within = {"balance of the flow": STEADY * exact, "last digits of places": digits * exact}
        yield Answer(f"inclined, {name}", "m2/s", into, exact, within)
    case.draw(m, contacts=True)
    case.graph("x/L", "p/p1", {"exact": ([0, 1], [1, 0])}, [tuple(zip(*found, strict=True))])
