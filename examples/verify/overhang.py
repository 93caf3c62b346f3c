"""How far a stack of blocks can overhang

Blocks of the length b lie on each other, each farther out than the one below. The upper k blocks are
just in balance if their common centroid is above the end of what they lie on:

          +-------+           overhang of block k over the next one:  b/(2k) - D
        +-------+               sum over n: (b/2)(1 + 1/2 + 1/3 + ... + 1/n) - n D
       +-------+
    ______|

which without the rounding D of corners is the harmonic series. Each offset is multiplied by the same
factor; the greatest that stands is found by bisection, and is 1.

Tolerance. Half of the last interval; a stack whose centroid, at the height h, is beyond the edge by d
turns like an inverted pendulum, by (d/h)(cosh(p T) - 1), and is not seen to fall if that is too little
after T; and it leans by the overlap of its contacts over b/2 - D.

Source: R. Sutton, A problem of balancing, Am. J. Phys. 23 (1955) 547; in textbooks since J. G. Coffin
(1923).
"""

from math import cosh, pi, sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for

BLOCKS = ("rigid",)
G, DENSITY, K, LONG, HIGH, D, N = 10.0, 2000.0, 1e9, 4.0, 0.5, 0.05, 4
MASS = DENSITY * LONG * HIGH
WATCHED, SUNK = 5.0, 0.05  # s, m


def stack(case, factor):
    """The stack with its offsets times `factor`: block N lies on the base, whose end is x = 0."""
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, friction=2.0)
    m.fraction(0.1)
    m.gravity(0, -G)
    m.round(D)
    right = 6.0
    m.block(-6, -1, -6, N * HIGH, right, N * HIGH, right, -1)
    for k in range(N):
        m.split(-7, k * HIGH, 7, k * HIGH)
    m.split(0, -1.5, 0, 0.25 * HIGH)  # the base ends here
    m.delete(0, right, -1, 0)
    ends = 0.0
    for k in range(N):
        ends += factor * (LONG / (2 * (N - k)) - D)
        low, high = (k - 0.4) * HIGH if k else 0.0, (k + 1.4) * HIGH
        for x in (ends - LONG, ends):
            m.split(x, max(low, -0.4 * HIGH), x, high)
        m.delete(-6, ends - LONG, k * HIGH, (k + 1) * HIGH)
        m.delete(ends, right, k * HIGH, (k + 1) * HIGH)
    m.fix(-6, 0, -1, 0)
    return m


def falls(case, factor, draw=False):
    m = stack(case, factor)
    if draw:
        m.cycle(0)
        case.draw(m, window=(-6.2, 6, -1.2, 3.2))
    m.damping(2.0, sqrt(K / (N * MASS)) / (2 * pi), "mass")  # so that it is not shaken when it is set down
    m.cycle(400)
    m.damping(0.05, sqrt(K / MASS) / (2 * pi), "stiffness")
    cycle_for(m, 0.8 if draw else WATCHED)
    top = max(m.table("block"), key=lambda one: one["KX"])
    if draw:
        case.draw(m, window=(-6.2, 6, -1.2, 3.2))
    return float(top["KY"]) < (N - 0.5) * HIGH - SUNK


def solve(case):
    low, high = 0.9, 1.13
    falls(case, 1.2, draw=True)
    while high - low > 0.004:
        middle = (low + high) / 2
        low, high = (low, middle) if falls(case, middle) else (middle, high)
    reach = sum(LONG / (2 * k) - D for k in range(1, N + 1))
    middle = N * HIGH / 2  # height of the stack's centroid
    p = sqrt(G * middle / (LONG**2 / 3 + 4 * middle**2 / 3))
    yield Answer(
        "overhang of four blocks",
        "m",
        (low + high) / 2 * reach,
        reach,
        {
            "bisection": (high - low) / 2 * reach,
            "what 5 s do not show": N * SUNK / LONG * middle / (cosh(p * WATCHED) - 1),
            "overlap over b/2 - D": N * MASS * G / K * N * HIGH / (LONG / 2 - D),
        },
    )
