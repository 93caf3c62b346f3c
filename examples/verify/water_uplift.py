"""Uplift under a dam

A dam stands on the joint of its base, which has the same aperture everywhere. Water seeps from the level h1
through it to the level h2:

    h1 ~~~~+-----+            uplift  U = (h1 + h2)/2 rho g L       p is linear along the joint
           |     |            normal force of the joint      N = W - U
           |     |~~~~ h2     shear force of the joint       T = rho g (h1^2 - h2^2)/2
       ----+-----+----        N acts at the distance x from the heel:
              L               N x = W L/2 - rho g L^2 (h1 + 2 h2)/6 + rho g (h1^3 - h2^3)/6

The aperture is constant, as its least and greatest ones are APERTURE. FLOW STEADY finds the pressures, which
then stay (DRAINED) while the dam comes to rest.

Tolerance. The force ratio of rest and the balance of flow. Strain. The dam sinks by W/(L KN) and leans by
up to twice that over L, so that its face is deeper in the water and not quite upright. From the last
contacts, which are D inside the ends of the joint, to the ends the pressure is that outside. The place of N
is that of blocks with zones, whose joint has n pieces with a uniform pressure each: (h1 - h2) rho g L^2/(12
n^2) of the moment, and D times p1 and p2, as the outermost pieces are shorter.

Source: M. Levy, Comptes rendus Acad. Sci. 121 (1895); K. Terzaghi, Theoretical soil mechanics (1943).
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import flow_through, generate, rectangle

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # the joint closes by a tenth of a millimetre
L, H, D, A, N = 10.0, 12.0, 0.01, 1e-3, 8
KN, ROCK, WATER, MU, G, BULK, SHEAR, REST = 1e10, 2400.0, 1000.0, 1e-3, 10.0, 2e12, 1e12, 1e-7
LEVELS = ((0.0, 0.0), (8.0, 0.0), (10.0, 4.0), (12.0, 2.0))


def scene(case, h1, h2):
    """The dam at rest under water."""
    m = case.model()
    m.property(1, density=ROCK, bulk=BULK, g=SHEAR)
    m.jproperty(1, kn=KN, ks=KN, friction=2.0, aperture=A, residual_aperture=A, greatest_aperture=A)
    m.block(-5, -2, -5, H, L + 5, H, L + 5, -2)
    m.split(-6, 0, L + 6, 0, joint=1, jmaterial=1)
    for x in (0, L):
        m.split(x, -0.1, x, H + 1)
    m.delete(-5, 0, 0, H)
    m.delete(L, L + 5, 0, H)
    m.fix(-5, L + 5, -2, 0)
    m.round(D)
    if case.blocks == "fdef":
        generate(m, rectangle(0, L, 0, H, N, N))
    else:
        case.deform(m, 0, L, 0, H)
    m.gravity(0, -G)
    if h1 > 0:
        m.fluid(density=WATER, viscosity=MU, mode="drained")
        for x, level in ((0, h1), (L, h2)):
            m.boundary(x - 0.01, x + 0.01, -0.01, H + 0.01, level=level)
        m.flow(steady=True)
    m.solve(REST, static=True)
    return m


def solve(case):
    weight, unit = ROCK * G * L * H, WATER * G
    computed = []
    for h1, h2 in LEVELS:
        m = scene(case, h1, h2)
        name = f"levels {h1:g} and {h2:g} m"
        rows = m.table("contact")
        normal, shear = float(rows["KCFN"].sum()), float(abs(rows["KCFS"].sum()))
        uplift, thrust = (h1 + h2) / 2 * unit * L, unit * (h1**2 - h2**2) / 2
        strain, sinks = weight / L / BULK + unit * h1 / SHEAR, weight / L / KN
        rest = {"force ratio of rest": REST * weight, "strain": strain * weight}
        ends = {"joint ends": (D / L) * D * unit * (h1 + h2), "balance of the flow": 1e-7 * uplift}
        ends["the dam leans"] = thrust * 2 * sinks / L
        yield Answer(f"normal force, {name}", "N/m", normal, weight - uplift, rest | ends)
        computed.append((h1 + h2, normal / 1e6))
        if h1 == 0:
            continue
        yield Answer(
            f"shear force, {name}", "N/m", shear, thrust, rest | {"the dam sinks": unit * h1 * sinks}
        )
        if h1 == 10:
            q = flow_through(m, -0.1, 0.1, -0.1, 0.1)
            exact = A**3 * unit * (h1 - h2) / (12 * MU * L)
            yield Answer(f"seepage, {name}", "m2/s", q, exact, {"balance of the flow": 1e-7 * exact})
        if case.blocks == "fdef":
            place = float((rows["KCFN"] * rows["KXC"]).sum()) / normal
            moment = weight * L / 2 - unit * L**2 * (h1 + 2 * h2) / 6 + unit * (h1**3 - h2**3) / 6
            exact = moment / (weight - uplift)
            within = {why: part * L / normal for why, part in (rest | ends).items()}
            within["outermost pieces"] = D * unit * (h1 + h2) * L / normal
            within["uniform pressures"] = (h1 - h2) * unit * L**2 / (12 * N**2) / normal
            yield Answer(f"place of the normal force, {name}", "m", place, exact, within)
    case.draw(m, contacts=True)
    curve = [(weight - h * unit * L / 2) / 1e6 for h in (0, 14)]
    case.graph(
        "h1 + h2 (m)",
        "normal force (MN/m)",
        {"exact": ((0, 14), curve)},
        [tuple(zip(*computed, strict=True))],
    )
