"""A block topples on a slope

A block of the base b and the height h does not slide, but falls over when its weight acts outside its
base:

         ____
        /   /            tan psi > b'/h
       /   /
      /___/.-'           b' = b - 2D   rigid and simply-deformable blocks
      .-'  psi           b' = b        fully-deformable blocks

Rigid blocks stand on the places where the rounding of their corners begins, at the distance D from the
corner; a block with zones stands on its grid-points. The slope is found by bisection, each time with a
new block.

Tolerance. Half of the last interval; a slope that is just too steep is not seen to topple the block
within T: it moves away from its balance by 5 % of b after that time only if tan psi is above the limit
by 0.05 b p^2/(g cosh(p T)), where p is the rate of an inverted pendulum; and the base leans on its
contacts by their overlap over b'.

Source: J. Ashby, Sliding and toppling modes of failure in models and jointed rock slopes, MSc thesis,
Imperial College (1971); R. Goodman and J. Bray (1976).
"""

from math import atan, cos, cosh, hypot, pi, sin, sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, on_base, row, settle

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # an overlap is 20 micrometres
G, DENSITY, K, D = 10.0, 2000.0, 1e9, 0.1
B, H, WATCHED = 1.0, 2.0, 3.0  # m, m, s
MASS = DENSITY * B * H


def falls(case, slope, draw):
    """True if the block topples; slope is the tangent of the angle."""
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, bulk=4e9, g=2e9, friction=3.0)
    m.fraction(0.2)
    m.round(D)
    on_base(case, m, B, H, width=8)
    m.gravity(0, -G)
    settle(case, m, 2 * K, MASS)
    blocks = m.table("block")
    address = blocks["address"][blocks["KBFIX"] == 0][0]
    m.gravity(G * sin(atan(slope)), -G * cos(atan(slope)))
    m.damping(2.0, sqrt(2 * K / MASS) / (2 * pi), "mass")  # so that it is not pushed by the change
    cycle_for(m, 0.1)
    m.damping(0.0, 1.0)
    if draw:
        case.draw(m, window=(-2.5, 3, -1.2, 2.3))
    for _ in range(10):
        cycle_for(m, WATCHED / 10)
        if row(m, "block", address)["KX"] > 0.05 * B:
            break
    if draw:
        cycle_for(m, 0.5)
        case.draw(m, window=(-2.5, 3, -1.2, 2.3))
    return row(m, "block", address)["KX"] > 0.05 * B


def solve(case):
    base = B if case.blocks == "fdef" else B - 2 * D
    low, high = (B - 3 * D) / H, (B + D) / H
    falls(case, high, draw=True)
    while high - low > 0.003:
        middle = (low + high) / 2
        low, high = (low, middle) if falls(case, middle, draw=False) else (middle, high)
    arm = hypot(base / 2, H / 2)
    p = sqrt(G * arm / ((B**2 + H**2) / 12 + arm**2))
    yield Answer(
        "slope at which it falls, tan psi",
        "",
        (low + high) / 2,
        base / H,
        {
            "bisection": (high - low) / 2,
            "what 3 s do not show": 0.05 * B * p**2 / (G * cosh(p * WATCHED)),
            "overlap over the base": 2 * MASS * G / K / base,
        },
    )
