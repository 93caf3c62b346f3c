"""Modulus of a bar that is cut by joints

A bar under the axial stress s shortens by the strain of its blocks and by the closure of its joints,
which have the spacing S and the stiffness kn per length (two contacts on a width of 1 m: kn = 2 KN):

     s -> |####|####|####|####| <- s        1/Em = 1/E + 1/(kn S)
             S

There is no Poisson effect, K = 2G/3, so that E = 2G. The modulus of the bar is the stress over the
strain between the centroids of the first and the last block; in one piece, over that between its ends.

Tolerance. Strains are taken from the lengths that the stresses act on now and not from those of before:
one part in 1/e, e the strain of the bar. The force ratio at which the run was ended, and last digits of
places.

Source: R. Goodman, Methods of Geological Engineering in Discontinuous Rocks (1976).
"""

from itertools import pairwise
from math import sqrt

import numpy as np

from udec_ia.studies.verification import Answer

BLOCKS = ("sdef", "fdef")
REALS = 64  # strains are 1e-4 and less
G, KN, DENSITY, N, S, STRESS = 1e9, 1e9, 2000.0, 5, 1.5, 1e5
LENGTH = N * S


def shorten(case, cut):
    """The bar, cut or in one piece, under its stress, and its strain."""
    m = case.model()
    m.property(1, density=DENSITY, kn=KN, ks=KN, bulk=2 * G / 3, g=G, friction=1.0)
    m.fraction(0.3)
    m.round(0.02)
    m.block(0, 0, 0, 1, LENGTH, 1, LENGTH, 0)
    ends = [k * S for k in range(N + 1)] if cut else [0.0, LENGTH]
    for x in ends[1:-1]:
        m.split(x, -1, x, 2)
    for x1, x2 in pairwise(ends):
        case.deform(m, x1, x2, 0, 1)
    for x in (0.0, LENGTH):
        m.boundary(x - 0.001, x + 0.001, -1, 2, stress=(-STRESS, 0, 0))
    frequency = sqrt(2 * G / DENSITY) / (4 * LENGTH)
    m.damping(0.8, frequency, "mass")
    m.damping(0.8, frequency, "internal")
    table, field = ("block", "KX") if cut else ("corner", "KXP")
    before = np.ptp(m.table(table)[field])
    m.solve(1e-8)
    return m, float(1 - np.ptp(m.table(table)[field]) / before)


def solve(case):
    for cut in (False, True):
        m, strain = shorten(case, cut)
        exact = 1 / (1 / (2 * G) + (1 / (2 * KN * S) if cut else 0.0))
        yield Answer(
            "modulus, five blocks" if cut else "modulus, one block",
            "Pa",
            STRESS / strain,
            exact,
            {
                "strain": 2 * strain * exact,
                "force ratio of rest": 1e-6 * exact,
                "last digits of places": 20 * case.last_digit / strain * exact,
            },
        )
    case.draw(m, contacts=True)
