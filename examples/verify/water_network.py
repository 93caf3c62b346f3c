"""A network of joints

Two sets of joints at right angles, with other apertures and spacings, are a network of pipes:

           |    |     |    |          pipe of the length l    Q = a^3/(12 mu l) dp
       ----+----+-----+----+----      crossing                sum of Q = 0
   p1 -----+----+-----+----+---- p2
       ----+----+-----+----+----      left    p1, less with height     right   p = 0
           |    |     |    |          bottom  q into each joint        top     IMPERMEABLE, or free: p = 0
           q    q     q    q

The pressures at the crossings follow from a linear system with one equation for each crossing, which numpy
solves. Blocks do not move.

Tolerance. FLOW STEADY ends when no domain lacks more than 1e-9 of the greatest flow; there are as many
domains as crossings and pipes. Last digits of places are those of an aperture, of which Q has the third
power.

Source: Kirchhoff's laws; C. Louis, Rock hydraulics (1974).
"""

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import domain, flow_through

BLOCKS = ("rigid",)
X, Y, WIDE, HIGH = (0.8, 2.0, 3.1, 4.1), (1.0, 2.2, 3.1), 5.0, 4.0
LEVEL, STEEP, D, MU = 1e-3, 6e-4, 0.01, 1e-3  # apertures of the two sets
P1, FALL, Q = 2e5, -1e4, 1e-4


def scene(case, top):
    """The blocks with conditions on all sides."""
    m = case.model()
    m.property(1, density=2000.0)
    m.jproperty(1, kn=1e9, ks=1e9, aperture=LEVEL)
    m.jproperty(2, kn=1e9, ks=1e9, aperture=STEEP)
    m.block(0, 0, 0, HIGH, WIDE, HIGH, WIDE, 0)
    for y in Y:
        m.split(-1, y, WIDE + 1, y, joint=1, jmaterial=1)
    for x in X:
        m.split(x, -1, x, HIGH + 1, joint=2, jmaterial=2)
    m.round(D)
    m.fluid(kw=2e9, density=1000.0, viscosity=MU)
    m.boundary(-0.01, 0.01, -0.01, HIGH + 0.01, ppressure=P1, pygrad=FALL)
    m.boundary(-0.01, WIDE + 0.01, -0.01, 0.01, flow=Q)
    if top == "impermeable":
        m.boundary(-0.01, WIDE + 0.01, HIGH - 0.01, HIGH + 0.01, impermeable=True)
    m.flow(steady=True)
    return m


def network(top):
    """Pressures at the crossings, a row for each joint of Y, and flows out on the right and at the top."""
    nx, ny = len(X), len(Y)
    a, b = np.zeros((nx * ny, nx * ny)), np.zeros(nx * ny)

    def pipe(i, j, k, aperture, length, outside=0.0):
        """From the crossing i, j to the crossing with the number k, or outside if k is None."""
        conductance, n = aperture**3 / (12 * MU * length), j * nx + i
        a[n, n] += conductance
        if k is None:
            b[n] += conductance * outside
        else:
            a[n, k] -= conductance
        return conductance

    right, up = np.zeros(ny), np.zeros(nx)
    for j, y in enumerate(Y):
        for i, x in enumerate(X):
            n = j * nx + i
            pipe(i, j, n - 1 if i else None, LEVEL, x - X[i - 1] if i else x, P1 + FALL * y)
            end = pipe(i, j, n + 1 if i + 1 < nx else None, LEVEL, (*X, WIDE)[i + 1] - x)
            right[j] = end if i + 1 == nx else right[j]
            if j:
                pipe(i, j, n - nx, STEEP, y - Y[j - 1])
            else:
                b[n] += Q
            if j + 1 < ny:
                pipe(i, j, n + nx, STEEP, Y[j + 1] - y)
            elif top == "free":
                up[i] = pipe(i, j, None, STEEP, HIGH - y)
    p = np.linalg.solve(a, b).reshape(ny, nx)
    return p, right * p[:, -1], up * p[-1]


def solve(case):
    digits = 3 * 4 * case.last_digit * WIDE / STEEP
    nx, ny = len(X), len(Y)
    domains = nx * ny + nx * (ny + 1) + ny * (nx + 1)
    for top in ("impermeable", "free"):
        m = scene(case, top)
        p, right, up = network(top)
        part = {"balance of the flow": domains * 1e-9, "last digits of places": digits}
        for j, y in enumerate(Y):
            out = -flow_through(m, WIDE - 0.1, WIDE, y - 0.1, y + 0.1)
            within = {why: share * float(right[j]) for why, share in part.items()}
            yield Answer(f"{top} top, flow out on the right at {y:g}", "m2/s", out, float(right[j]), within)
        if top == "free":
            for x, exact in zip(X, up, strict=True):
                out = -flow_through(m, x - 0.1, x + 0.1, HIGH - 0.1, HIGH)
                within = {why: share * float(exact) for why, share in part.items()}
                yield Answer(f"{top} top, flow out of it at {x:g}", "m2/s", out, float(exact), within)
        found = np.array([[float(domain(m, x, y)[0]["KPP"]) for x in X] for y in Y])
        worst = float(np.abs(found - p).max())
        within = {why: share * P1 for why, share in part.items()}
        yield Answer(f"{top} top, pressures, greatest error", "Pa", worst, 0.0, within)
        case.draw(m, contacts=True)
    curves = {f"exact, y = {y:g}": (X, p[j]) for j, y in enumerate(Y)}
    case.graph("x (m)", "pressure (Pa)", curves, [(X, found[j]) for j in range(ny)])
