"""A block is thrown

Nothing touches a block that flies; it moves in a parabola and spins at a constant rate:

     x = x0 + u t,   y = y0 + v t - g t^2/2,   phi = w t

Velocities are those of the middle of a step: a velocity that is given at the beginning counts as that
of half a step before, so that the fall is g t (t + dt)/2.

Tolerance. None but rounding: n additions, each to the last digit of what is summed up, and places of a
few hundred metres.

Source: G. Galilei, Discorsi (1638).
"""

from math import pi

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, push, row, step

BLOCKS = ("rigid", "sdef", "fdef")
G, U, V, SPIN, CYCLES = 10.0, 20.0, 40.0, 3.0, 2000


def solve(case):
    m = case.model()
    m.property(1, density=2000, kn=1e8, ks=1e8, bulk=4e7, g=2e7)
    m.fraction(0.5 if case.blocks == "rigid" else 0.3)
    m.round(0.1)
    m.block(-2, -1, -2, 3, 2, 3, 2, -1)
    m.split(-3, 0, 3, 0)
    m.split(-3, 2, 3, 2)
    m.delete(-2, 2, 0, 2)
    m.fix(-2, 2, -1, 0)
    case.deform(m, -2, 2, 2, 3)
    m.gravity(0, -G)
    address = int(block(m, 0, 2.5)["address"])
    spin = SPIN if case.blocks == "rigid" else 0.0  # a spinning block with zones is strained by it
    if case.blocks == "fdef":
        for point in m.table("gridpoint"):
            m.patch(f"gridpoint@{point['address']}.KXDG = {U}, gridpoint@{point['address']}.KYDG = {V}")
    push(m, address, KXD=U, KYD=V, KTD=spin)
    x, y = [0.0], [2.5]
    for _ in range(20):
        m.cycle(CYCLES // 20)
        x.append(float(row(m, "block", address)["KX"]))
        y.append(float(row(m, "block", address)["KY"]))
    n, dt, last = CYCLES, step(m), row(m, "block", address)
    time = n * dt
    digits = n * case.last_digit
    for what, unit, got, exact, size in (
        ("way in x", "m", last["KX"], U * time, U * time),
        ("way in y", "m", last["KY"] - 2.5, V * time - G * time * (time + dt) / 2, V * time + G * time**2),
        ("velocity in y", "m/s", last["KYD"], V - G * time, V + G * time),
        ("rate of spin", "rad/s", last["KTD"], spin, 2 * pi),
    ):
        yield Answer(what, unit, float(got), exact, {f"last digits of {n} sums": digits * size})
    t = np.linspace(0, time, 100)
    case.graph("x (m)", "y (m)", {"parabola": (U * t, 2.5 + V * t - G * t**2 / 2)}, [(x, y)])
