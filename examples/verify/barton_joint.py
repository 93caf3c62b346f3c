"""Closure and strength of a rough joint

A block is pressed on a joint of Barton and Bandis, lifted, pressed further, and then pushed along it:

        s |      /|       s = kni u/(1 - u/um1)              first loading
          |     //        s = kni (u - ur)/(1 - (u - ur)/um3)   unloading, reloading
          |  _-/ /        T/L = s tan(phi_r + JRC log10(JCS/s))
          +-----+--- u
             ur

ur is the closure that remains: both curves meet at the largest stress. kni, um1 and um3 follow from JRC, JCS
and the aperture.

Tolerance. The block is driven at a constant velocity, so that its closure in a cycle is known to the velocity
times the step; last digits of places make those of the closure.

Source: S. Bandis, A. Lumsden and N. Barton, Fundamentals of rock joint deformation (1983); N. Barton and
V. Choubey, The shear strength of rock joints in theory and practice (1977).
"""

from math import log10, radians, tan

import numpy as np

from udec_ia.layout.offsets import JOINT_SLIPS
from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64  # closures are 1e-4 of the block
JRC, JCS, ANGLE, KS = 8.0, 100e6, 28.0, 5e9
LENGTH, DENSITY, D, SPEED = 4.0, 2000.0, 0.1, 1e-3


def numbers():
    """kni (Pa/m), um1 and um3 (m) by the regressions, which are in mm and MPa."""
    aperture = JRC / 5 * (0.2 - 0.1)
    ratio = JCS / 1e6 / aperture
    kni = -7.15 + 1.75 * JRC + 0.02 * ratio
    um1 = -0.2960 - 0.0056 * JRC + 2.2410 * ratio**-0.2450
    um3 = -0.1032 - 0.0074 * JRC + 1.1350 * ratio**-0.2510
    um1 = min(um1, aperture)
    return kni * 1e9, um1 / 1e3, min(um1, um3) / 1e3


def stress(u, largest):
    """Normal stress at the closure u of a joint that has had the stress `largest`."""
    kni, um1, um3 = numbers()
    if u >= largest / (kni + largest / um1):
        return kni * u / (1 - u / um1)
    v = u - (largest / (kni + largest / um1) - largest / (kni + largest / um3))
    return kni * v / (1 - v / um3) if v > 0 else 0.0


def box(case):
    """A block on a fixed one, without weight."""
    m = case.model()
    m.property(1, density=DENSITY)
    m.jproperty(1, model="barton", jrc=JRC, jcs=JCS, sigmac=JCS, friction=tan(radians(ANGLE)), ks=KS)
    m.block(0, 0, 0, 2, LENGTH, 2, LENGTH, 0)
    m.split(-1, 1, LENGTH + 1, 1, joint=1, jmaterial=1)
    m.fix(0, LENGTH, 0, 1)
    m.round(D)
    return m


def solve(case):
    m, largest, curves = box(case), 0.0, []
    for name, velocity, goal in (("loading", -1, 6e6), ("unloading", 1, 1e6), ("reloading", -1, 20e6)):
        m.boundary(1, 3, 1.4, 1.6, xvel=0.0, yvel=velocity * SPEED, rotation=0.0)
        u, s = [], []
        while not s or velocity * (goal - s[-1]) < 0:
            m.cycle(10)
            u.append(float(m.table("contact")["KCN"].mean()))
            s.append(float(m.table("joint")["KCJSN"].mean()))
            largest = max(largest, s[-1])
        curves.append((np.array(u) * 1e6, np.array(s) / 1e6))
        right = stress(u[-1], largest)
        last = 20 * case.last_digit / u[-1] * right * (1 + right / (numbers()[0] * u[-1]))
        yield Answer(f"stress at the end of {name}", "Pa", s[-1], right, {"last digits of places": last})
    kni, um1, _ = numbers()
    way = np.linspace(0, curves[-1][0].max() * 1e-6, 200)
    exact = {"first loading": (way * 1e6, kni * way / (1 - way / um1) / 1e6)}
    case.graph("closure (micrometres)", "normal stress (MPa)", exact, curves)
    m.boundary(1, 3, 1.4, 1.6, xvel=0.05, yvel=0.0, rotation=0.0)
    while not (m.table("joint")["KCJFLAG"] & JOINT_SLIPS).all():
        m.cycle(10)
    pressed = float(m.table("joint")["KCJSN"].mean())
    strength = pressed * tan(radians(ANGLE + JRC * log10(JCS / pressed)))
    found = float(abs(m.table("joint")["KCJTS"].mean()))
    yield Answer("shear strength", "Pa", found, strength, {"last digits": 1e3 * case.last_digit * strength})
