r"""A block with its weight beside the middle

A block stands on two contacts, left and right. Its upper right part is cut off, so that its centroid
lies beside the middle of its base. Moments about one contact give the force on the other:

      ______
     |      \          F_right = W (1/2 + c/a)
     |       \         F_left  = W (1/2 - c/a)
     |________\
     ^        ^        a = b - 2D, c: x of the centroid from the middle

Tolerance. The force ratio at which the run was ended; the lean of the block, by the difference of its
overlaps over a, moves the centroid by that times its height; last digits of the places.

Source: Archimedes, On the equilibrium of planes; report of 1980, 2.3, for the place of the contacts.
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import settle

BLOCKS = ("rigid", "sdef")
REALS = 64  # overlaps are 0.1 mm at 4 m
G, DENSITY, K, B, H, CUT, D = 10.0, 2000.0, 1e9, 4.0, 3.0, 2.5, 0.1


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, bulk=4e10, g=2e10, friction=1.0)
    m.fraction(0.2)
    m.gravity(0, -G)
    m.round(D)
    m.block(-4, -1, -4, H, 4, H, 4, -1)
    m.split(-5, 0, 5, 0)
    m.split(-B / 2, -0.5, -B / 2, H + 1)
    m.split(B / 2, -0.5, B / 2, H + 1)
    m.delete(-4, -B / 2, 0, H)
    m.delete(B / 2, 4, 0, H)
    m.split(B / 2, 0, B / 2 - CUT, H)
    m.delete(B / 2 - CUT / 2, B / 2, 0, H)
    m.fix(-4, 4, -1, 0)
    case.deform(m, -B / 2, B / 2, 0, H)
    whole, off = B * H, CUT * H / 2
    area = whole - off
    c = -off * (B / 2 - CUT / 3) / area  # of the centroid, from the middle
    weight, a = area * DENSITY * G, B - 2 * D
    settle(case, m, 2 * K, weight / G)
    contacts = m.table("contact")
    contacts = contacts[contacts["KCFN"] > 0]
    case.draw(m, contacts=True)
    lean = weight / K / a * (H / 2) / a
    for name, chosen, exact in (
        ("left", contacts["KXC"] < 0, weight * (0.5 - c / a)),
        ("right", contacts["KXC"] > 0, weight * (0.5 + c / a)),
    ):
        yield Answer(
            f"force on the {name} contact",
            "N/m",
            float(contacts["KCFN"][chosen].sum()),
            exact,
            {
                "lean of the block": weight * lean,
                "force ratio of rest": max(1e-10, 1e4 * case.last_digit) * weight,
                "last digits of places": 16 * case.last_digit * H * K,
            },
        )
