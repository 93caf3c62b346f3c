"""Free rocking of a slender block

A block that was pushed rises about one corner of its base and falls back. Without a bounce it is an
inverted pendulum; with the pivot in the corner, and for small angles, it comes back after

      .--.
      |  |         T/2 = (2/p) acosh(1/(1 - th0/al)),   p^2 = m g R/I0
      |  |
    --+__+--       th0: greatest angle, tan al = b/h, 2R: diagonal, I0: inertia about the corner

Here the pivot is the rounding of the corner, an arc of the radius D that rolls on the floor: the lever
of the weight is x(th) = e cos th - f sin th, its height y(th) = e sin th + f cos th + D, with e = b/2 -
D and f = h/2 - D. By the law of energy, without the approximation of small angles, the time between is
an integral:

    (I + m (x^2 + y^2)) th'^2/2 + m g y = const

Tolerance. The pivot is a spring, which swings by W/KN when the other corner leaves the floor; with that
the block may rise by 2 W/KN more or less, so that th0 changes by 2 W/(KN x(th0)). The other corner
leaves and hits the floor at an overlap of up to W/KN, with the velocity 2 e th'. Angles are read at
every tenth step.

Source: G. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. Seism. Soc.
Am. 53 (1963) 403-417.
"""

from math import atan, pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import now, on_base, push, row, settle, step

BLOCKS = ("rigid",)
G, DENSITY, K, B, H, D = 10.0, 2000.0, 1e10, 1.0, 4.0, 0.05
MASS, INERTIA = DENSITY * B * H, DENSITY * B * H * (B**2 + H**2) / 12
E, F = B / 2 - D, H / 2 - D


def lever(th):
    return E * np.cos(th) - F * np.sin(th)


def height(th):
    return E * np.sin(th) + F * np.cos(th) + D


def inertia(th):
    return INERTIA + MASS * (lever(th) ** 2 + height(th) ** 2)


def half_period(top):
    """Time from the floor up to the angle `top` and back, s; and the rate of rotation on the floor.

    With th = top sin(s) what is integrated is finite at the top.
    """
    s = (np.arange(4000) + 0.5) * pi / 2 / 4000
    th = top * np.sin(s)
    rate = np.sqrt(2 * MASS * G * (height(top) - height(th)) / inertia(th))
    start = float(np.sqrt(2 * MASS * G * (height(top) - height(0.0)) / inertia(0.0)))
    return 2 * float((top * np.cos(s) / rate).sum()) * pi / 2 / 4000, start


def rise(top):
    """Times and angles (degrees) of the way up and back."""
    s = (np.arange(2000) + 0.5) * pi / 2 / 2000
    th = top * np.sin(s)
    rate = np.sqrt(2 * MASS * G * (height(top) - height(th)) / inertia(th))
    up = np.cumsum(top * np.cos(s) / rate) * pi / 2 / 2000
    return np.r_[up, 2 * up[-1] - up[::-1]], np.degrees(np.r_[th, th[::-1]])


def solve(case):
    curves, computed = {}, []
    for share in (0.3, 0.6, 0.9):
        top = share * atan(E / F)
        exact, rate = half_period(top)
        m = case.model()
        m.property(1, density=DENSITY, kn=K, ks=K, friction=2.0)
        m.fraction(0.1)
        m.gravity(0, -G)
        m.round(D)
        on_base(case, m, B, H, width=6)
        settle(case, m, 2 * K, MASS)
        blocks = m.table("block")
        address = int(blocks["address"][blocks["KBFIX"] == 0][0])
        m.damping(0.2, sqrt(K / MASS) / (2 * pi), "stiffness")
        # about the right pivot, at (E, 0): clockwise
        push(m, address, KXD=rate * H / 2, KYD=rate * E, KTD=-rate)
        begin, t, turn, angle = now(m), [0.0], [0.0], 0.0
        every = 10
        while not turn[1:] or turn[-1] > 0:
            m.cycle(every)
            angle -= float(row(m, "block", address)["KTD"]) * every * step(m)
            t.append(now(m) - begin)
            turn.append(angle)
        back = float(np.interp(0.0, turn[:-3:-1], t[:-3:-1]))
        give = MASS * G / K
        longer = half_period(top + 2 * give / float(lever(top)))[0] - exact
        yield Answer(
            f"time to come back, th0 = {share:g} al",
            "s",
            back,
            exact,
            {
                "energy of the pivot's spring": longer,
                "overlap of the other corner": 2 * give / (2 * E * rate),
                "samples": every * step(m) / 2,
            },
        )
        if share == 0.9:
            continue
        computed.append((t[::40], np.degrees(turn[::40])))
        curves[f"th0 = {share:g} al"] = rise(top)
    case.graph("time (s)", "angle (degrees)", curves, computed)
