r"""A block bounces on one contact

A triangle stands on its corner, a mass on one spring. It is at rest when gravity becomes half as strong
again:

      \ /      m           w = sqrt(KN/m)             without damping
       V   ___ KN          w_d = w sqrt(1 - xi^2)     with a share xi of critical damping
                           ln(u1/u2) = 2 pi xi/sqrt(1 - xi^2)   the logarithmic decrement

xi = (ALPHA/w + BETA w)/2, with ALPHA and BETA of Rayleigh damping: both, mass alone, stiffness alone.

Tolerance. Central differences shorten a period by (w dt)^2/24. The dashpot is fed with the velocity of
half a step before, as if the mass were less by xi w dt of itself. A maximum is found by a parabola
through three steps: its place to 0.016 (w dt)^2 of a step, its height to (w dt)^4/128 of the swing.

Source: any textbook of vibrations, as J. P. Den Hartog, Mechanical Vibrations (1934).
"""

from math import asin, log, pi, sqrt

import numpy as np

from udec_ia.layout.offsets import ALPHA, BETA
from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import step

BLOCKS = ("rigid",)
G, KN, MASS = 10.0, 1e8, 2000.0
W = sqrt(KN / MASS)


def on_its_corner(case):
    """The triangle, at rest."""
    m = case.model()
    m.property(1, density=1000, kn=KN, ks=KN)
    m.fraction(0.02)
    m.round(0.1)
    m.block(-1.5, -1, -1.5, 2, 1.5, 2, 1.5, -1)
    m.split(-2, 0, 2, 0)
    m.split(0.1, -0.2, -1.1, 2.2)
    m.split(-0.1, -0.2, 1.1, 2.2)
    m.delete(-2, -0.5, 0, 1.3)
    m.delete(0.5, 2, 0, 1.3)
    m.fix(-2, 2, -1, 0)
    m.gravity(0, -G)
    m.damping(2.0, W / (2 * pi), "stiffness")
    m.cycle(2000)
    return m


def swing(m, cycles):
    """Overlaps beyond those of rest, after each cycle, from the time at which gravity became 1.5 g."""
    m.gravity(0, -1.5 * G)
    overlaps = []
    for _ in range(cycles):
        m.cycle(1)
        overlaps.append(float(m.table("contact")["KCN"].max()))
    return np.array(overlaps) - 1.5 * MASS * G / KN


def peaks(u):
    """Places, in cycles, and heights of the maxima, by parabolas."""
    k = np.flatnonzero((u[1:-1] > u[:-2]) & (u[1:-1] >= u[2:])) + 1
    a, b, c = u[k - 1], u[k], u[k + 1]
    shift = (a - c) / (2 * (a - 2 * b + c))
    return k + shift, b - (a - c) * shift / 4


def solve(case):
    curves, exacts = [], {}
    for label, fcrit, only in (
        ("no damping", 0.0, None),
        ("mass and stiffness", 0.1, None),
        ("mass", 0.1, "mass"),
        ("stiffness", 0.4, "stiffness"),
    ):
        m = on_its_corner(case)
        m.damping(fcrit, W / (2 * pi), only)
        u = swing(m, 400)
        dt, amplitude = step(m), 0.5 * MASS * G / KN
        xi = (float(m.h.cr[ALPHA]) / W + float(m.h.cr[BETA]) * W) / 2
        at, height = peaks(u)
        lag = {
            "dashpot, half a step late": xi * W * dt,
            "central differences": 2 / (W * dt) * asin(W * dt / 2) - 1,
        }
        lag["places of the maxima"] = 0.032 * (W * dt) ** 3 / (2 * pi)
        digits = 4 * case.last_digit * 2.0 / amplitude
        damped = W * sqrt(1 - xi**2)
        yield Answer(
            f"frequency, {label}",
            "rad/s",
            2 * pi / (at[1] - at[0]) / dt,
            damped,
            {name: part * damped for name, part in lag.items()}
            | {"last digits of places": damped * digits / (2 * pi * (W * dt)) / exp_of(xi)},
        )
        exact = 2 * pi * xi / sqrt(1 - xi**2)
        yield Answer(
            f"decrement, {label}",
            "",
            log(height[0] / height[1]),
            exact,
            {
                "dashpot, half a step late": xi * W * dt * exact,
                "heights of the maxima": (W * dt) ** 4 / 64,
                "last digits of places": 2 * digits / exp_of(xi),
            },
        )
        t = np.arange(1, len(u) + 1) * dt
        curves.append((t[::8] * 1e3, u[::8] * 1e6))
        decay, phase = np.exp(-xi * W * t), damped * t
        exacts[label] = (
            t * 1e3,
            -amplitude * decay * (np.cos(phase) + xi * W / damped * np.sin(phase)) * 1e6,
        )
    case.graph("time (ms)", "overlap beyond that of rest (micrometres)", exacts, curves)


def exp_of(xi):
    """Share of the swing that is left at the second maximum, 1.5 periods after the beginning."""
    return np.exp(-3 * pi * xi / sqrt(1 - xi**2))
