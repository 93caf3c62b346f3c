"""Modulus of a bar that is cut by joints

A bar under the axial stress s shortens by the strain of its blocks and by the closure of its joints, which have the spacing
S and the stiffness kn per length (two contacts on a width of 1 m: kn = 2 KN):

     s -> |####|####|####|####| <- s        1/Em = 1/E + 1/(kn S)
             S

There is no Poisson effect, K = 2G/3, so that E = 2G. The modulus of the bar is the stress over the strain between the
centroids of the first and the last block.

Tolerance. Strains are taken from the lengths that the stresses act on now and not from those of before: one part in
1/e, e the strain of the bar. The force ratio at which the run was ended, and last digits of places.

Source: R. Goodman, Methods of Geological Engineering in Discontinuous Rocks (1976).
"""

from math import pi, sqrt

import numpy as np

from udec_ia.verify import Answer

BLOCKS = ("sdef", "fdef")
G, KN, DENSITY, N, S, STRESS = 1e9, 1e9, 2000.0, 5, 1.5, 1e5
LENGTH = N * S


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=KN, ks=KN, bulk=2 * G / 3, g=G, friction=1.0)
    m.fraction(0.3)
    m.round(0.02)
    m.block(0, 0, 0, 1, LENGTH, 1, LENGTH, 0)
    for k in range(1, N):
        m.split(k * S, -1, k * S, 2)
    for k in range(N):
        case.deform(m, k * S, (k + 1) * S, 0, 1)
    for x in (0.0, LENGTH):
        m.boundary(x - 0.001, x + 0.001, -1, 2, stress=(-STRESS, 0, 0))
    frequency = sqrt(2 * G / DENSITY) / (4 * LENGTH)
    m.damping(0.8, frequency, "mass")
    m.damping(0.8, frequency, "internal")
    before = np.ptp(m.table("block")["KX"])
    m.solve(1e-8)
    strain = float(1 - np.ptp(m.table("block")["KX"]) / before)
    case.draw(m, contour="s11")
    exact = 1 / (1 / (2 * G) + 1 / (2 * KN * S))
    yield Answer(
        "modulus",
        "Pa",
        STRESS / strain,
        exact,
        {
            "strain": 2 * strain * exact,
            "force ratio of rest": 1e-6 * exact,
            "last digits of places": 20 * case.last_digit / strain * exact,
        },
    )
