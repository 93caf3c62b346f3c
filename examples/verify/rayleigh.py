r"""Rayleigh damping depends on the frequency

A mass on one spring swings with w = sqrt(KN/m); by which share xi of critical it is damped depends on
w:

                                            xi  |\           /
    xi = (ALPHA/w + BETA w)/2                   | \        .'
                                                |  '.__..-'
    DAMP fcrit freq: least at freq, fcrit       +------------- w

Here the mass has always the same damping and its spring is made weaker and stiffer. It is pressed on
its base by gravity, and swings by a thousandth of its overlap.

Tolerance. The dashpot is late by half a step, as if the mass were less by BETA w^2 dt of itself;
central differences change w by (w dt)^2/24. The share is taken from the largest velocities of each half
swing, which fall between two steps: too small by up to (w dt)^2/8.

Source: Lord Rayleigh, The Theory of Sound (1877); K.-J. Bathe and E. Wilson, Numerical Methods in
Finite Element Analysis (1976).
"""

from math import log, pi, sqrt

import numpy as np

from udec_ia.layout.offsets import ALPHA, BETA
from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import on_base, push, row, step

BLOCKS = ("rigid",)
REALS = 64  # a swing is 10 micrometres
MASS, FCRIT, FREQ = 4000.0, 0.1, 20.0


def share(case, w):
    """The model and the velocities of the block after each cycle, at the frequency w."""
    m = case.model()
    m.property(1, density=2000, kn=MASS * w * w / 2, ks=MASS * w * w / 2, friction=1.0)
    m.fraction(0.01)
    m.round(0.2)
    on_base(case, m, 2.0, 1.0, width=6)
    blocks = m.table("block")
    address = int(blocks["address"][blocks["KBFIX"] == 0][0])
    sink = 0.01
    m.gravity(0, -sink * w * w)
    m.damping(2.0, w / (2 * pi), "mass")
    m.solve(1e-8)
    m.damping(FCRIT, FREQ)
    push(m, address, KYD=1e-3 * sink * w)
    speeds = []
    for _ in range(round(4.2 * pi / (w * step(m)))):
        m.cycle(1)
        speeds.append(float(row(m, "block", address)["KYD"]))
    return m, np.array(speeds)


def solve(case):
    measured, exact = [], []
    for w in np.array([0.25, 0.5, 1, 2, 4]) * 2 * pi * FREQ:
        m, v = share(case, w)
        alpha, beta = float(m.h.cr[ALPHA]), float(m.h.cr[BETA])
        k = np.flatnonzero(abs(v[1:-1]) > np.maximum(abs(v[:-2]), abs(v[2:]))) + 1
        decrement = log(abs(v[k[0]] / v[k[-1]])) / (len(k) - 1) * 2  # of a whole period
        xi = decrement / sqrt(4 * pi**2 + decrement**2)
        formula = (alpha / w + beta * w) / 2
        measured.append(xi)
        exact.append(formula)
        dt = step(m)
        yield Answer(
            f"damping at {w / 2 / pi:g} Hz, share of critical",
            "",
            xi,
            formula,
            {
                "dashpot, half a step late": beta * w * w * dt * formula,
                "central differences": (w * dt) ** 2 / 24 * formula,
                "maxima taken at steps": (w * dt) ** 2 / 8 / (pi * (len(k) - 1)),
            },
        )
    f = np.geomspace(4, 100, 100)
    curve = f, alpha / (4 * pi * f) + beta * pi * f
    points = np.array([0.25, 0.5, 1, 2, 4]) * FREQ, measured
    case.graph("frequency (Hz)", "share of critical damping", {"(ALPHA/w + BETA w)/2": curve}, [points])
