"""Run-out of a rock and its energy line

A flat rock slides down a slope, along an arc of the radius R, and on to the plane, where it stops:

      o_
        \\  _ energy line      d(v2/2)/ds = g sin(a) - mu (g cos(a) + v2/R)
         \\    _
      H   \\_     _             height of the energy line: y + v2/(2g)
             `-----o
                 L

Without the arc's pressure the energy line would be straight, with the slope mu, and L = H/mu, wherever the
rock is on the way. On the arc the rock is pressed on by v2/R as well, so it loses more. The equation is
integrated by steps of a millimetre.

Tolerance. The rock has the length b: at both ends of the arc its pressure begins and ends within b, which
is worth v2 b/(R g) of way. The arc has corners of one degree: at each of them (v sin)2/2 may be lost.

Source: Newton's second law and Coulomb friction; A. Heim, Bergsturz und Menschenleben (1932), for the
energy line.
"""

from math import cos, radians, sin

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import row as row_of

BLOCKS = ("rigid",)
SLOPE, RADIUS, STEEP, PLANE, MU, G = radians(40), 30.0, 12.0, 60.0, 0.4, 10.0
B, H, DENSITY, FACETS = 1.0, 0.4, 2500.0, 40


def ground():
    """Corners of the surface, from the top of the slope to the end of the plane: x, y."""
    angles = np.linspace(SLOPE, 0, FACETS + 1)
    x, y = RADIUS * (sin(SLOPE) - np.sin(angles)), RADIUS * (1 - np.cos(angles))
    top = [-STEEP * cos(SLOPE), y[0] + STEEP * sin(SLOPE)]
    return np.vstack([top, np.stack([x, y], axis=-1), [x[-1] + PLANE, 0.0]])


def exact():
    """Way and v2/2 of the centre, from rest until it stops, by steps of a millimetre."""
    step, way, half, found = 1e-3, 0.0, 0.0, [(0.0, 0.0)]
    first = STEEP - 1.5 * B
    arc = first + (RADIUS - H / 2) * SLOPE
    while half >= 0:
        angle = SLOPE if way < first else SLOPE * (arc - way) / (arc - first) if way < arc else 0.0
        press = 2 * half / (RADIUS - H / 2) if first <= way < arc else 0.0
        half += step * (G * sin(angle) - MU * (G * cos(angle) + press))
        way += step
        found.append((way, half))
    return np.array(found)


def place(s, first, last):
    """Place of the centre after the way `s`; the arc is from `first` to `last`."""
    foot, r = RADIUS * sin(SLOPE), RADIUS - H / 2
    if s < first:
        angle, back = SLOPE, first - s
    else:
        angle, back = SLOPE * max(last - s, 0.0) / (last - first), min(last - s, 0.0)
    return foot - r * sin(angle) - back * cos(angle), RADIUS - r * cos(angle) + max(back, 0.0) * sin(angle)


def solve(case):
    m, surface = case.model(), ground()
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, friction=MU)
    m.round(0.02)
    low = -2.0
    outline = [*surface, (surface[-1][0], low), (surface[0][0], low)]
    m.block(*(float(c) for point in outline for c in point))
    along = np.array([cos(SLOPE), -sin(SLOPE)])
    out = np.array([sin(SLOPE), cos(SLOPE)])
    foot = surface[0] + B * along
    corners = [foot, foot + H * out, foot + B * along + H * out, foot + B * along]
    rock = m.block(*(float(c) for point in corners for c in point))
    m.fix(-100, 100, low - 10, 1e-3 + float(surface[0][1]) / 2)
    m.gravity(0, -G)
    m.damping(0.3, 100.0, "stiffness")
    m.fraction(0.1)
    rows = []
    for _ in range(400):
        m.cycle(time=0.05)
        row = row_of(m, "block", rock)
        rows.append([float(row[k]) for k in ("KX", "KY", "KXD", "KYD")])
        if len(rows) > 20 and abs(rows[-1][2]) < 1e-3:
            break
    x, y, vx, vy = np.array(rows).T
    way, first = exact(), STEEP - 1.5 * B
    last = first + (RADIUS - H / 2) * SLOPE
    speeds = np.interp([first, last], way[:, 0], 2 * way[:, 1])  # v2 at both ends of the arc
    stop = surface[-2][0] + way[-1, 0] - last
    corner = SLOPE / FACETS
    yield Answer(
        "place where it stops",
        "m",
        float(x[-1]),
        float(stop),
        {
            "ends of the arc": float(speeds.sum()) * B / (RADIUS * G),
            "corners of the arc": FACETS * float(speeds.mean()) * sin(corner) ** 2 / (2 * MU * G),
        },
    )
    lost = [place(s, first, last) for s in way[::500, 0]]
    case.graph(
        "x (m)",
        "energy height (m)",
        {"energy line": (np.array(lost)[:, 0], np.array(lost)[:, 1] + way[::500, 1] / G)},
        [(x[::3], (y + (vx**2 + vy**2) / (2 * G))[::3])],
    )
    case.draw(m)
