r"""Pressure spreads along a joint

A joint of the length L is full of water without pressure. At x = 0 the pressure p0 is held from t = 0 on; the
end x = L has the pressure 0, or is closed:

      p/p0 |\                        c = Kw a^2/(12 mu),   T = c t/L^2 = 0.1
           | \                       x/L        1/4    1/2    3/4
           |  '-._                   p = 0    .5761  .2628  .0883
           +------'''-- x/L          closed   .5762  .2643  .0987

      1 - x/L - sum of 2/(n pi) sin(n pi x/L) exp(-n^2 pi^2 T)               n = 1, 2, 3 ...
      1 - sum of 4/(n pi) sin(n pi x/(2 L)) exp(-n^2 pi^2 T/4)               n = 1, 3, 5 ...

The joint has N equal pieces: between grid-points, or between cross joints that have a hundredth of its
aperture. Then it is a chain of reservoirs and pipes, and each crossing is a reservoir too. numpy solves the
chain, in as many explicit steps as FLOW and as a sum of exponentials. Blocks do not move.

Tolerance. Against the chain in the same steps: water that leaks into cross joints, and last digits of places,
which are those of the aperture. Against the series besides: what the steps change in the chain, and by what
the exponentials of the chain differ from the series, which is the size of the pieces.

Source: H. Carslaw and J. Jaeger, Conduction of heat in solids (1959), section 3.4.
"""

from math import exp, pi, sin

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import domain, generate, rectangle

BLOCKS = ("rigid", "fdef")
L, N, D, A, CROSS = 2.0, 20, 0.01, 2e-3, 1e-2  # CROSS: aperture of cross joints over A
KW, MU, P0, T = 2e9, 1e-3, 1e5, 0.1
C = KW * A**2 / (12 * MU)
TIME = T * L**2 / C
PIECE = L / N


def scene(case, closed):
    """The joint at y = 0.5, with water in it."""
    m = case.model()
    m.property(1, density=2000.0, bulk=4e9, g=3e9)
    m.jproperty(1, kn=1e9, ks=1e9, aperture=A)
    m.jproperty(2, kn=1e9, ks=1e9, aperture=CROSS * A)
    m.block(0, 0, 0, 1, L, 1, L, 0)
    m.split(-1, 0.5, L + 1, 0.5, joint=1, jmaterial=1)
    for k in range(1, N if case.blocks == "rigid" else 0):
        m.split(k * PIECE, 0.45, k * PIECE, 2, joint=2, jmaterial=2)
    m.round(D)
    if case.blocks == "fdef":
        generate(m, rectangle(0, L, 0.5, 1, N, 2))
    m.fluid(kw=KW, viscosity=MU)
    m.boundary(-0.01, L + 0.01, 0.99, 1.01, impermeable=True)
    m.boundary(-0.01, 0.01, -0.01, 1.01, ppressure=P0)
    if closed:
        m.boundary(L - 0.01, L + 0.01, -0.01, 1.01, impermeable=True)
    m.ppressure(-1, L + 1, -1, 2, 0.0)
    return m


def chain(case, closed):
    """Matrix and constant of dp/dt = M p + b for the reservoirs of the joint, and the place of each."""
    if case.blocks == "rigid":  # piece, crossing, piece, crossing ... piece
        places = PIECE / 2 * np.arange(1, 2 * N)
        volumes = np.where(np.arange(2 * N - 1) % 2, 2 * D + CROSS * D, PIECE - 2 * D) * A
    else:  # between contacts, the outermost of which are D inside the ends
        contacts = np.clip(PIECE * np.arange(N + 1), D, L - D)
        places, volumes = (contacts[1:] + contacts[:-1]) / 2, np.diff(contacts) * A
    lengths = np.diff(places, prepend=0.0, append=L)
    k = A**3 / (12 * MU * lengths)
    k[-1] = 0.0 if closed else k[-1]
    m = np.diag(-k[:-1] - k[1:]) + np.diag(k[1:-1], 1) + np.diag(k[1:-1], -1)
    b = np.zeros(len(places))
    b[0] = k[0] * P0
    return KW * m / volumes[:, None], KW * b / volumes, places


def exponentials(m, b, time):
    """The solution of the chain that begins with p = 0."""
    values, vectors = np.linalg.eig(m)
    rest = np.linalg.solve(m, -b)
    return rest - (vectors @ (np.exp(values * time) * np.linalg.solve(vectors, rest))).real


def explicit(m, b, time, steps):
    """The same with explicit steps."""
    p = np.zeros(len(b))
    for _ in range(steps):
        p += time / steps * (m @ p + b)
    return p


def series(x, closed):
    """p/p0 at x/L."""
    if closed:
        return 1 - sum(
            4 / (n * pi) * sin(n * pi * x / 2) * exp(-((n * pi) ** 2) * T / 4) for n in range(1, 99, 2)
        )
    return 1 - x - sum(2 / (n * pi) * sin(n * pi * x) * exp(-((n * pi) ** 2) * T) for n in range(1, 99))


def solve(case):
    curves, found = {}, []
    for closed in (False, True):
        m = scene(case, closed)
        steps = m.flow(time=TIME).steps
        matrix, b, places = chain(case, closed)
        p = exponentials(matrix, b, TIME)
        late = exponentials(matrix, b, TIME * (1 + 2 * 4 * case.last_digit * L / A)) - p
        stepped = explicit(matrix, b, TIME, steps)
        leak = CROSS**3 * C * TIME / (PIECE**2 / 2) if case.blocks == "rigid" else 0.0
        name = "closed end" if closed else "p = 0 at the end"
        for x in (0.25, 0.5, 0.75):
            beside = 0.0 if case.blocks == "rigid" else PIECE / 2  # grid-points are there
            computed = float(sum(domain(m, x * L + d, 0.5)[0]["KPP"] for d in (-beside, beside))) / (2 * P0)
            at, chained, digits = (float(np.interp(x * L, places, one)) / P0 for one in (p, stepped, late))
            within = {"leak into cross joints": leak * at, "last digits": digits + steps * case.last_digit}
            yield Answer(f"{name}, p/p0 at {x:g} L, chain", "", computed, chained, within)
            exact = series(x, closed)
            within = within | {"explicit steps": abs(chained - at), "pieces": abs(at - exact)}
            yield Answer(f"{name}, p/p0 at {x:g} L, series", "", computed, exact, within)
            found.append((x, computed))
        x = np.linspace(0, 1, 60)
        curves[name] = (x, [series(float(one), closed) for one in x])
    case.draw(m, contacts=True)
    case.graph("x/L", "p/p0", curves, [tuple(zip(*found, strict=True))])
