"""Discharge of a hopper

Polygons of the size d fall through a slot of the width B in the floor of a bin:

      |o o o o o|
      | o o o o |        rate = C sqrt(g) (B - k d)^n,  n = 3/2,  k = 1.4
      |o_o   o_o|
            B

The blocks that leave are deleted (DELETE OUTSIDE) and counted. While the bin is higher filled than it is
wide the rate does not depend on the height. For slots of 5 to 12 d the exponent n is fitted to the rates.

Tolerance. Rates of a few hundred blocks vary; experiments and calculations with discs give exponents that
differ by 0.15, as does the choice of k between 1.2 and 1.6.

Source: Beverloo, Leniger and van de Velde, Chemical Engineering Science 15 (1961), in two dimensions.
"""

import numpy as np

from udec_ia.layout import offsets as g
from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import loose_polygons, now

BLOCKS = ("rigid",)
D, WIDE, ROWS, GRAVITY, K = 1.0, 26, 44, 10.0, 1.4
SLOTS = (5.0, 6.5, 8.0, 10.0, 12.0)
SETTLES, SKIPPED, COUNTED, PIECE = 3.0, 60, 260, 100


def bin_of(case, slot):
    """A bin filled with polygons of 6 to 8 corners, and a slot in its floor."""
    m = case.model()
    m.round(0.1)
    w, h, pitch = WIDE * 1.08 * D, ROWS * 1.2 * D, 1.08 * D
    left, right = (w - slot) / 2, (w + slot) / 2
    m.block(-2, -2, -2, h, 0, h, 0, -2)
    m.block(w, -2, w, h, w + 2, h, w + 2, -2)
    m.block(0, -2, 0, 0, left, 0, left, -2)
    m.block(right, -2, right, 0, w, 0, w, -2)
    m.block(left, -2, left, 0, right, 0, right, -2)
    loose_polygons(m, WIDE, ROWS, pitch, (6, 9), 0.9)
    m.property(1, density=2000, kn=3e8, ks=3e8, friction=0.5)
    m.fix(-3, 0, -3, h)
    m.fix(w, w + 3, -3, h)
    m.fix(0, w, -3, 0)
    m.gravity(0, -GRAVITY)
    m.fraction(0.2)
    m.damping(0.05, 1.0, "mass")
    m.cycle(time=SETTLES)
    m.delete(left, right, -3, 0)
    m.delete(f"OUTSIDE -3 {w + 3} -3 {2 * h}")
    return m


def rate(m):
    """Blocks that leave in a second, between the first SKIPPED and as many more as are COUNTED."""
    times, left = [], []
    while not left or left[-1] < SKIPPED + COUNTED:
        m.cycle(PIECE)
        times.append(now(m))
        left.append(int(m.h.ci[g.NLEFT]))
        if now(m) > 100:
            break
    chosen = np.array(left) >= SKIPPED
    return float(np.polyfit(np.array(times)[chosen], np.array(left)[chosen], 1)[0])


def solve(case):
    rates = []
    for slot in SLOTS:
        m = bin_of(case, slot)
        rates.append(rate(m))
        if slot == SLOTS[2]:
            case.draw(m)
    free = np.array(SLOTS) - K * D
    exponent = np.polyfit(np.log(free), np.log(rates), 1)[0]
    yield Answer("exponent n", "-", float(exponent), 1.5, {"scatter of rates": 0.15})
    mean = float(np.exp(np.mean(np.log(rates) - 1.5 * np.log(free))))
    line = np.linspace(SLOTS[0], SLOTS[-1], 50)
    case.graph(
        "B/d", "blocks in a second", {"(B/d - 1.4)^1.5": (line, mean * (line - K) ** 1.5)}, [(SLOTS, rates)]
    )
