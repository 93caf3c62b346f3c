"""Shear of a continuously yielding joint

A joint under a constant normal stress sn is sheared. Its friction falls with its plastic displacement, and
there is no kink at a peak:

      ts |   .-._            dts/du = F ks,   F = 1 - ts/(sn tan phi_m)
         |  /    ''---       dphi_m/du = -(phi_m - phi)(1 - F)/R
         | /
         +------------ u     phi_m begins with phi_i and tends to phi

The two equations are integrated by the method of Runge and Kutta with steps of R/1000.

Tolerance. The program takes a step of the midpoint rule in each cycle: its error is the third derivative, of
which (ks du/ts)^2 is a measure. The normal stress of the block that is driven without turning is constant to
last digits.

Source: P. Cundall and R. Hart, Analysis of block test no. 1 (1984); the form of B. Brady and E. Brown, Rock
mechanics for underground mining (2004).
"""

from math import atan, radians, tan

import numpy as np

from udec_ia.studies.verification import Answer

BLOCKS = ("rigid",)
REALS = 64
KN, KS, PEAK, BASIC, R = 1e10, 5e9, 1.0, tan(radians(30)), 2e-3
LENGTH, DENSITY, D, STRESS, SPEED = 4.0, 2000.0, 0.1, 1e6, 0.02


def rates(ts, angle):
    f = min(max(1 - ts / (STRESS * tan(angle)), 0.0), 1.0)
    return f * KS, -(angle - atan(BASIC)) * (1 - f) / R


def curve(far):
    """Shear displacement and stress of the exact joint, up to the displacement `far`."""
    n = int(far / (R / 1000)) + 1
    h, ts, angle, found = far / n, 0.0, atan(PEAK), [0.0]
    for _ in range(n):
        a = rates(ts, angle)
        b = rates(ts + h / 2 * a[0], angle + h / 2 * a[1])
        c = rates(ts + h / 2 * b[0], angle + h / 2 * b[1])
        d = rates(ts + h * c[0], angle + h * c[1])
        ts += h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
        angle += h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
        ts = min(ts, STRESS * tan(angle))  # F is never negative
        found.append(ts)
    return np.linspace(0, far, n + 1), np.array(found)


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY)
    m.jproperty(1, model="yielding", kn=KN, ks=KS, initial_friction=PEAK, friction=BASIC, roughness=R)
    m.block(0, 0, 0, 2, LENGTH, 2, LENGTH, 0)
    m.split(-1, 1, LENGTH + 1, 1, joint=1, jmaterial=1)
    m.fix(0, LENGTH, 0, 1)
    m.round(D)
    m.boundary(-0.1, LENGTH + 0.1, 1.9, 2.1, stress=(0, 0, -STRESS))
    m.solve(1e-9, static=True)
    m.boundary(1, 3, 1.4, 1.6, xvel=SPEED, yvel=0.0, rotation=0.0)
    u, s = [0.0], [0.0]
    while u[-1] < 4 * R:
        m.cycle(5)
        u.append(abs(float(m.table("contact")["KCS"].mean())))
        s.append(abs(float(m.table("joint")["KCJTS"].mean())))
    exact = curve(u[-1])
    normal = float(m.table("joint")["KCJSN"].mean())
    error = (KS * u[1] / 5 / STRESS) ** 2
    within = {"normal stress": abs(normal / STRESS - 1) + 1e-9, "midpoint rule": error}
    for share in (0.05, 0.2, 1.0, 4.0):
        k = min(int(np.searchsorted(u, share * R)), len(u) - 1)
        right = float(np.interp(u[k], *exact))
        parts = {name: part * right for name, part in within.items()}
        yield Answer(f"shear stress after {share:g} R", "Pa", s[k], right, parts)
    case.graph(
        "shear displacement (mm)",
        "shear stress (MPa)",
        {"integrated": (exact[0] * 1e3, exact[1] / 1e6)},
        [(np.array(u[::20]) * 1e3, np.array(s[::20]) / 1e6)],
    )
