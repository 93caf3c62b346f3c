"""A joint full of water is squeezed

A block closes a joint of the length L and the aperture a, out of which no water can flow (UNDRAINED):

         | F or s            p = Kw u/(a - u)          u: closure
       +---v---+             F/L' = p + KN u           driven by u
       |       |             s = p (L - 2D)/L + KN u   pressed by the stress s: a square for u
    ---+~~~~~~~+---
       |  L    |

Water is between the contacts, which are D inside the ends of the joint, so that p acts on L - 2D. The joint
itself acts on the whole of L.

Tolerance. Driven: each cycle adds a last digit of places to the closure. Pressed: the force ratio of rest;
strain, which changes the length that the stress acts on.

Source: definition of the bulk modulus; K. Terzaghi, Erdbaumechanik (1925), effective stress.
"""

from math import sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, cycle_for, domain, step

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # closures are micrometres
L, H, D, A, KW, KN = 2.0, 1.0, 0.005, 1e-3, 2e8, 2e9
BULK, G, DENSITY, SPEED, REST = 4e12, 3e12, 2000.0, 1e-3, 1e-8
WAYS, STRESS = (2e-5, 1e-4, 3e-4), 2e6


def scene(case):
    """A block on a fixed one; water without pressure in the joint."""
    m = case.model()
    m.property(1, density=DENSITY, bulk=BULK, g=G)
    m.jproperty(1, kn=KN, ks=KN, aperture=A)
    m.block(0, -1, 0, H, L, H, L, -1)
    m.split(-1, 0, L + 1, 0, joint=1, jmaterial=1)
    m.fix(0, L, -1, 0)
    m.round(D)
    case.deform(m, 0, L, 0, H)
    m.fluid(kw=KW, mode="undrained")
    m.ppressure(-1, L + 1, -1, 1, 0.0)
    return m


def solve(case):
    between = L - 2 * D
    m = scene(case)
    start = float(block(m, L / 2, H / 2)["KY"])
    m.boundary(0, L, 0, H, xvel=0, yvel=-SPEED, rotation=0)
    gone, found = 0.0, []
    for way in WAYS:
        m.cycle(1)
        cycle_for(m, (way - gone) / SPEED)
        gone = u = start - float(block(m, L / 2, H / 2)["KY"])
        digits = u / (SPEED * step(m)) * case.last_digit * L / u / (1 - u / A)  # one in each cycle
        p = float(domain(m, L / 2, 0)[0]["KPP"])
        exact = KW * u / (A - u)
        yield Answer(
            f"pressure after {1e6 * way:g} um", "Pa", p, exact, {"last digits of places": digits * exact}
        )
        force = -float(m.reactions(-0.1, L + 0.1, 0.001, H + 0.1)["fy"].sum())
        exact = exact * between + KN * u * L
        within = {"last digits of places": digits * exact}
        yield Answer(f"force after {1e6 * way:g} um", "N/m", force, exact, within)
        found.append((u * 1e6, force / 1e6))
    case.draw(m, contacts=True)

    m = scene(case)
    m.boundary(-0.01, L + 0.01, H - 0.01, H + 0.01, stress=(0, 0, -STRESS))
    m.solve(REST, static=True)
    # STRESS = KW w u/(A - u) + KN u, w = (L - 2D)/L
    b = STRESS + KN * A + KW * between / L
    u = (b - sqrt(b * b - 4 * KN * A * STRESS)) / (2 * KN)
    p = KW * u / (A - u)
    share = {"force ratio of rest": REST, "strain, s/K": STRESS / BULK}
    computed = float(domain(m, L / 2, 0)[0]["KPP"])
    within = {why: 2 * part * p / (1 - u / A) for why, part in share.items()}
    yield Answer("pressure under stress", "Pa", computed, p, within)
    rows = m.table("contact")
    within = {why: part * STRESS * L for why, part in share.items()}
    yield Answer("force of the joint", "N/m", float(rows["KCFN"].sum()), KN * u * L, within)
    ways = [A * k / 300 for k in range(100)]
    curve = [1e-6 * (KW * u / (A - u) * between + KN * u * L) for u in ways]
    graph = {"exact": ([1e6 * u for u in ways], curve)}
    case.graph("closure (um)", "force (MN/m)", graph, [tuple(zip(*found, strict=True))])
