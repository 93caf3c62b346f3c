"""A wave runs along a bar and leaves it

A smooth pulse of stress enters a bar, whose sides keep its points in line, and leaves it at the other
end through dashpots that have the impedance of the bar:

      |]--->  _.-''-._  ----------[|       Cp = sqrt((K + 4G/3)/rho)    points move along the bar
      viscous              viscous         Cs = sqrt(G/rho)             points move across it

The speed is that between two zones at a quarter and three quarters of the length. What is left of the
pulse's energy when it should have gone is what the viscous end sends back.

Tolerance. In a chain of zones of the length d groups of waves of the wave number k are slower by (k
d)^2/8; k is that of the pulse, 2 pi over its length. A dashpot at the end of such a chain sends back a
share (k d)^2/16 of the amplitude, and w dt/4 as it is half a step late: of the energy the squares of
these, for the highest frequency in the pulse, which is twice as high. The peak's time is found by a
parabola through samples.

Source: J. Lysmer and R. Kuhlemeyer, Finite dynamic model for infinite media, J. Eng. Mech. Div. ASCE 95
(1969) 859-877.
"""

from math import pi, sqrt

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, now, rectangle

BLOCKS = ("fdef",)
LENGTH, N, DENSITY, BULK, SHEAR, STRESS = 10.0, 60, 2000.0, 2e8, 1e8, 1e4
KINDS = {  # speed, field of a zone's stress, direction that is held, stress put in at the left end
    "compression": (sqrt((BULK + 4 * SHEAR / 3) / DENSITY), "KZS11", {"yvel": 0}, (-2 * STRESS, 0, 0)),
    "shear": (sqrt(SHEAR / DENSITY), "KZS12", {"xvel": 0}, (0, -2 * STRESS, 0)),
}


def bar(case, speed, held, stress):
    """A bar with viscous ends, into which a pulse will run that is 0.4 of its length."""
    m = case.model()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    m.round(0.02)
    m.block(0, 0, 0, 1, LENGTH, 1, LENGTH, 0)
    generate(m, rectangle(0, LENGTH, 0, 1, N, 2))
    m.boundary(-1, LENGTH + 1, -1, 2, **held)
    for x in (0.0, LENGTH):
        m.boundary(x - 0.01, x + 0.01, -1, 2, viscous=True)
    lasts = 0.4 * LENGTH / speed
    times = np.linspace(0, lasts, 60)
    factors = 0.5 * (1 - np.cos(2 * pi * times / lasts))
    m.function(1, *np.stack([times, factors], axis=-1).ravel().tolist(), 1.001 * lasts, 0.0)
    m.boundary(-0.01, 0.01, -1, 2, stress=stress, function=1)  # half of it stays in the dashpots
    m.fraction(0.5)
    m.cycle(0)
    return m


def energy(m):
    """Kinetic and strain energy, J/m."""
    points, zones = m.table("gridpoint"), m.table("zone")
    kinetic = (points["KGPM"] * (points["KXDG"] ** 2 + points["KYDG"] ** 2)).sum() / 2
    a, b = BULK + 4 * SHEAR / 3, BULK - 2 * SHEAR / 3
    s11, s12, s22 = zones["KZS11"], zones["KZS12"], zones["KZS22"]
    strain = (a * (s11**2 + s22**2) - 2 * b * s11 * s22) / (a**2 - b**2) + s12**2 / SHEAR
    return float(kinetic + (zones["KZM"] / DENSITY * strain).sum() / 2)


def solve(case):
    exact, computed = {}, []
    for name, (speed, field, held, stress) in KINDS.items():
        m = bar(case, speed, held, stress)
        points = m.table("gridpoint")
        x = dict(zip(points["address"].tolist(), points["KXG"].tolist(), strict=True))
        place = np.array([np.mean([x[i] for i in row]) for row in m.table("zone")["KZG"].tolist()])
        two = [abs(place - LENGTH / 4).argmin(), abs(place - 3 * LENGTH / 4).argmin()]
        t, s, largest = [], [], 0.0
        while now(m) < 2 * LENGTH / speed:
            m.cycle(5)
            t.append(now(m))
            s.append(-m.table("zone")[field][two].astype(float))
            largest = max(largest, energy(m))
        arrival, t, s = [], np.array(t), np.array(s)
        for history in s.T:
            k = int(history.argmax())
            a, b, c = history[k - 1 : k + 2]
            arrival.append(t[k] + (t[1] - t[0]) * (a - c) / (2 * (a - 2 * b + c)))
        got = float(place[two[1]] - place[two[0]]) / (arrival[1] - arrival[0])
        kd = 2 * pi / (0.4 * LENGTH) * LENGTH / N
        wave = 2 * pi / (0.4 * LENGTH) * speed * (t[1] - t[0])
        yield Answer(
            f"speed, {name}",
            "m/s",
            got,
            speed,
            {
                "zones, (k d)^2/8": speed * kd**2 / 8,
                "peaks by parabolas": 0.032 * wave**2 * (t[1] - t[0]) / (arrival[1] - arrival[0]) * speed,
            },
        )
        yield Answer(
            f"energy that is left, {name}",
            "",
            energy(m) / largest,
            0.0,
            {
                "zones, ((2 k d)^2/16)^2": ((2 * kd) ** 2 / 16) ** 2,
                "dashpots, (2 w dt/4)^2": (2 * wave / 5 / 4) ** 2,
            },
        )
        for label, at, history in zip(("1/4", "3/4"), place[two], s.T, strict=True):
            phase = np.clip((t - at / speed) * speed / (0.4 * LENGTH), 0, 1)
            exact[f"{name} at {label}"] = t, STRESS * 0.5 * (1 - np.cos(2 * pi * phase)) / 1e3
            computed.append((t[::3], history[::3] / 1e3))
    case.graph("time (s)", "stress (kPa)", exact, computed)
