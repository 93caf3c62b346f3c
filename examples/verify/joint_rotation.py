"""Rotation stiffness of a joint

A block stands on a joint of the length L and the stiffness k per length. It leans under a moment M, and the
joint stays closed:

          M
        .--.            M/angle = k L^3/12                       linear between two contacts
       +---v---+                  k L p^2/4                      form of the report, ENDS
       |       |                  k L^3/12 (1 + 2/(n - 1)^2)     blocks with zones, n contacts
    ---+-------+---

p is the distance between the contacts, D inside both ends. Zones carry the force of a contact to a corner of
the mesh, so that n contacts share the length.

Tolerance. Contacts of rounded corners are D inside the ends of the joint; the stress is extended to these.
Zones bend: k times the height of the block over its modulus. The force ratio of rest.

Source: report of UDEC (1980), section 2.4, for ENDS; else the second moment of a line.
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, rectangle

BLOCKS = ("rigid", "fdef")
REALS = 64
K, L, H, D, DENSITY, GRAVITY, SIDEWAYS, E, N = 1e8, 4.0, 1.0, 0.02, 2000.0, 10.0, 2.0, 1e12, 10


def lean(case, unit):
    """Angle of the block at rest under its weight and a force sideways, and distance of the contacts."""
    m = case.model()
    m.property(1, density=DENSITY, bulk=E / 1.2, g=E / 2.6)
    m.jproperty(1, kn=K, ks=K, friction=3.0, unit=unit)
    m.block(0, -1, 0, H, L, H, L, -1)
    m.split(-1, 0, L + 1, 0, joint=1, jmaterial=1)
    m.fix(0, L, -1, 0)
    m.round(D)
    if case.blocks == "fdef":
        generate(m, rectangle(0, L, 0, H, N, 3))
    m.gravity(SIDEWAYS, -GRAVITY)
    m.solve(1e-9, 200_000, static=True)
    rows = m.table("contact")
    left, right = rows[rows["KXC"].argmin()], rows[rows["KXC"].argmax()]
    p = float(right["KXC"] - left["KXC"])
    case.draw(m, displacements=True, contacts=True)
    return float(right["KCN"] - left["KCN"]) / p, p


def solve(case):
    moment = DENSITY * L * H * SIDEWAYS * H / 2
    uniform = K * L**3 / 12
    within = {"contacts inside the ends, D/L": D / L * uniform, "force ratio of rest": 1e-6 * uniform}
    if case.blocks == "fdef":
        angle, _ = lean(case, "length")
        exact = uniform * (1 + 2 / N**2)
        within["zones that bend"] = 10 * K * H / E * exact
        yield Answer("contact by contact", "N m/rad", moment / angle, exact, within)
        return
    for name, unit in (("linear", "length"), ("report", "ends")):
        angle, p = lean(case, unit)
        exact = uniform if unit == "length" else K * L * p**2 / 4
        yield Answer(f"form: {name}", "N m/rad", moment / angle, exact, within)
